// membrane_stiffness.cpp — the tangent of the sheet, for Newton's method.
//
//   P = F S,   δP = δF S + F δS,   δS = factor (δS₀ + 2 α S₀ (S₀:δE)),   δE = sym(Fᵀ δF),   factor = E_Y t e^{αQ}
//
// taut: S₀ is linear in E. Wrinkled: S₀ = e₁ n⊗n, whose direction n turns by (m·δE n)/(e₁ − e₂) towards m across it.
#include <Eigen/Dense>
#include <cmath>

#include "instruments/capsule/membrane.h"

namespace glisson {
namespace {

constexpr double kMostTangentExponent = 100.0;  ///< as that of the forces
constexpr double kAtRest = 1e-9;                ///< strain up to which a sheet at rest counts as taut

using Sheet2 = Eigen::Matrix2d;
using Edges2 = Eigen::Matrix<double, 3, 2>;

/// Stress over the factor, and its change with the strain.
struct SheetTangent {
  Sheet2 S0 = Sheet2::Zero();
  double factor = 0.0, q = 0.0;
  bool taut = false;
  double nu = 0.0, e1 = 0.0, e2 = 0.0;
  Eigen::Vector2d n = Eigen::Vector2d::UnitX(), m = Eigen::Vector2d::UnitY();

  SheetTangent(const MembraneLaw& law, const Sheet2& E) : nu(law.poisson_ratio) {
    const double mean = 0.5 * E.trace(), side = 0.5 * (E(0, 0) - E(1, 1)), radius = std::hypot(side, E(0, 1));
    e1 = mean + radius, e2 = mean - radius;
    const bool rests = std::max(std::abs(e1), std::abs(e2)) < kAtRest;
    if (!rests && !(e1 > 0.0)) return;
    taut = rests || e2 + nu * e1 > 0.0;
    if (taut) {
      S0 = E / (1.0 + nu) + Sheet2::Identity() * (nu / (1.0 - nu * nu) * E.trace());
    } else {
      const double angle = 0.5 * std::atan2(E(0, 1), side);
      n = {std::cos(angle), std::sin(angle)}, m = {-n.y(), n.x()};
      S0 = e1 * n * n.transpose();
    }
    q = S0.cwiseProduct(E).sum();
    factor = law.stiffness * std::exp(std::min(law.stiffening * q, kMostTangentExponent));
  }

  Sheet2 change(const Sheet2& dE, double alpha) const {
    Sheet2 dS0;
    if (taut) {
      dS0 = dE / (1.0 + nu) + Sheet2::Identity() * (nu / (1.0 - nu * nu) * dE.trace());
    } else {
      const double turn = m.dot(dE * n) / (e1 - e2);
      dS0 = n.dot(dE * n) * n * n.transpose() + e1 * turn * (m * n.transpose() + n * m.transpose());
    }
    const double more = alpha * q < kMostTangentExponent ? 2.0 * alpha * S0.cwiseProduct(dE).sum() : 0.0;
    return factor * (dS0 + more * S0);
  }
};

}  // namespace

std::array<std::array<Mat3d, 3>, 3> Membrane::stiffness(std::span<const Vec3d> positions, std::size_t triangle) const {
  std::array<std::array<Mat3d, 3>, 3> blocks{};
  const MembraneBlock& b = blocks_[triangle / kSize];
  const std::size_t k = triangle % kSize;
  const Vec3d& x0 = positions[b.corner[0][k]];
  const Vec3d d1 = positions[b.corner[1][k]] - x0, d2 = positions[b.corner[2][k]] - x0;
  const Strain strain_now = strain(positions, triangle);
  Sheet2 E, G;
  E << strain_now.e11, strain_now.e12, strain_now.e12, strain_now.e22;
  G << b.g00[k], b.g01[k], 0.0, b.g11[k];
  const SheetTangent tangent(law_, E);
  if (tangent.factor == 0.0) return blocks;
  Edges2 X;
  X << d1.x, d2.x, d1.y, d2.y, d1.z, d2.z;
  const Edges2 F = X * G;
  const double area = b.area[k];
  Eigen::Matrix<double, 6, 6> K;  // of the components of d1, then of d2
  for (Eigen::Index c = 0; c < 6; ++c) {
    Edges2 dX = Edges2::Zero();
    dX(c % 3, c / 3) = 1.0;
    const Edges2 dF = dX * G;
    const Sheet2 half = F.transpose() * dF;
    const Sheet2 dS = tangent.change(0.5 * (half + half.transpose()), law_.stiffening);
    const Edges2 dP = (dF * (tangent.factor * tangent.S0) + F * dS) * G.transpose() * area;
    K.col(c) << dP.col(0), dP.col(1);
  }
  const auto share = [](std::size_t corner, Eigen::Index edge) {  // of a corner's displacement in an edge's
    return corner == 0 ? -1.0 : static_cast<Eigen::Index>(corner) == edge + 1 ? 1.0 : 0.0;
  };
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          for (Eigen::Index p = 0; p < 2; ++p) {
            for (Eigen::Index q = 0; q < 2; ++q) {
              const auto row = 3 * p + static_cast<Eigen::Index>(i), column = 3 * q + static_cast<Eigen::Index>(j);
              blocks[a][c](i, j) += share(a, p) * share(c, q) * K(row, column);
            }
          }
        }
      }
    }
  }
  return blocks;
}

}  // namespace glisson
