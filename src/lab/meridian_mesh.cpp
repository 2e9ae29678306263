#include "lab/meridian_mesh.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "material/meridian_response.h"

namespace glisson::lab {
namespace {

/// The quadratic polynomials of −1, 0, 1 and their slopes.
struct Quadratic {
  std::array<double, 3> value, slope;
};
Quadratic quadratic(double x) {
  return {{0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)}, {x - 0.5, -2.0 * x, x + 0.5}};
}

/// @param r0  radius where the element begins @param dr, dz  its sizes [m]
void place_points(MeridianElement& e, double r0, double dr, double dz) {
  const double far = std::sqrt(0.6);
  const std::array<double, 3> at{-far, 0.0, far}, weight{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  Eigen::Matrix3d mass = Eigen::Matrix3d::Zero();
  for (std::size_t q = 0; q < MeridianElement::kPoints; ++q) {
    MeridianElement::Point& p = e.points[q];
    const double xi = at[q / 3], eta = at[q % 3], radius = r0 + 0.5 * (1.0 + xi) * dr;
    const Quadratic along_r = quadratic(xi), along_z = quadratic(eta);
    for (std::size_t n = 0; n < MeridianElement::kVertices; ++n) {
      p.by_r[n] = along_r.slope[n / 3] * along_z.value[n % 3] * 2.0 / dr;
      p.by_z[n] = along_r.value[n / 3] * along_z.slope[n % 3] * 2.0 / dz;
      p.by_hoop[n] = along_r.value[n / 3] * along_z.value[n % 3] / radius;
    }
    p.weight = 2.0 * std::numbers::pi * radius * weight[q / 3] * weight[q % 3] * 0.25 * dr * dz;
    p.linear = {1.0, xi, eta};
    const Eigen::Vector3d linear(1.0, xi, eta);
    mass += p.weight * linear * linear.transpose();
  }
  Eigen::Map<Eigen::Matrix3d>(e.inverse[0].data()) = mass.inverse();
}

/// J and ∂J/∂F.
struct Volume {
  double J;
  MeridianTensor cofactor;
};
Volume volume_of(const MeridianTensor& F) {
  const double plane = F[0] * F[3] - F[1] * F[2];
  return {plane * F[4], {F[3] * F[4], -F[2] * F[4], -F[1] * F[4], F[0] * F[4], plane}};
}
/// p ∂²J/∂F².
void add_curvature(std::array<MeridianTensor, 5>& tangent, const MeridianTensor& F, double p) {
  const auto add = [&](std::size_t a, std::size_t b, double x) { tangent[a][b] += p * x, tangent[b][a] += p * x; };
  add(0, 3, F[4]), add(1, 2, -F[4]);
  add(0, 4, F[3]), add(1, 4, -F[2]), add(2, 4, -F[1]), add(3, 4, F[0]);
}

double at(const MeridianElement::Linear& a, const MeridianElement::Linear& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

MeridianTensor gradient(const MeridianElement::Point& p, const MeridianElement::Vector& u) {
  MeridianTensor F{1.0, 0.0, 0.0, 1.0, 1.0};
  for (std::size_t n = 0; n < MeridianElement::kVertices; ++n) {
    const double ur = u[2 * n], uz = u[2 * n + 1];
    F[0] += ur * p.by_r[n], F[1] += ur * p.by_z[n], F[4] += ur * p.by_hoop[n];
    F[2] += uz * p.by_r[n], F[3] += uz * p.by_z[n];
  }
  return F;
}

/// Adds a point's stress and tangent.
void add_point(const MeridianElement::Point& p, const MeridianStress& s, MeridianElement::Answer& out) {
  for (std::size_t n = 0; n < MeridianElement::kVertices; ++n) {
    const double r = p.weight * p.by_r[n], z = p.weight * p.by_z[n], h = p.weight * p.by_hoop[n];
    out.force[2 * n] += r * s.P[0] + z * s.P[1] + h * s.P[4];
    out.force[2 * n + 1] += r * s.P[2] + z * s.P[3];
    MeridianTensor radial, axial;
    for (std::size_t a = 0; a < 5; ++a) {
      radial[a] = r * s.tangent[0][a] + z * s.tangent[1][a] + h * s.tangent[4][a];
      axial[a] = r * s.tangent[2][a] + z * s.tangent[3][a];
    }
    for (std::size_t m = 0; m < MeridianElement::kVertices; ++m) {
      const double br = p.by_r[m], bz = p.by_z[m], bh = p.by_hoop[m];
      out.tangent[2 * n][2 * m] += radial[0] * br + radial[1] * bz + radial[4] * bh;
      out.tangent[2 * n][2 * m + 1] += radial[2] * br + radial[3] * bz;
      out.tangent[2 * n + 1][2 * m] += axial[0] * br + axial[1] * bz + axial[4] * bh;
      out.tangent[2 * n + 1][2 * m + 1] += axial[2] * br + axial[3] * bz;
    }
  }
}

}  // namespace

MeridianElement::Answer MeridianElement::answer(const HyperelasticLaw& law, const Vector& u, const Linear& now) const {
  Answer out;
  std::array<MeridianTensor, kPoints> F;
  std::array<Volume, kPoints> volume;
  Linear change{};
  std::array<Vector, 3> change_by_u{};
  for (std::size_t q = 0; q < kPoints; ++q) {
    const Point& p = points[q];
    F[q] = gradient(p, u), volume[q] = volume_of(F[q]);
    const MeridianTensor& c = volume[q].cofactor;
    out.folded = out.folded || !(c[4] > 0.0) || !(F[q][4] > 0.0);
    if (out.folded) return out;
    for (std::size_t a = 0; a < 3; ++a) {
      const double share = p.weight * p.linear[a];
      change[a] += share * (volume[q].J - 1.0);
      for (std::size_t n = 0; n < kVertices; ++n) {
        change_by_u[a][2 * n] += share * (c[0] * p.by_r[n] + c[1] * p.by_z[n] + c[4] * p.by_hoop[n]);
        change_by_u[a][2 * n + 1] += share * (c[2] * p.by_r[n] + c[3] * p.by_z[n]);
      }
    }
  }
  const double bulk = bulk_modulus(law);
  for (std::size_t a = 0; a < 3; ++a) {
    out.pressure.value[a] = bulk * at(inverse[a], change);
    for (std::size_t k = 0; k < kUnknowns; ++k)
      out.pressure.by_u[a][k] = bulk * at(inverse[a], {change_by_u[0][k], change_by_u[1][k], change_by_u[2][k]});
  }
  for (std::size_t q = 0; q < kPoints; ++q) {
    MeridianStress s = isochoric_stress(law, F[q]);
    const double pressure = at(out.pressure.value, points[q].linear);
    for (std::size_t a = 0; a < 5; ++a) s.P[a] += pressure * volume[q].cofactor[a];
    add_curvature(s.tangent, F[q], at(now, points[q].linear));
    add_point(points[q], s, out);
  }
  for (std::size_t i = 0; i < kUnknowns; ++i)
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t k = 0; k < kUnknowns; ++k) out.tangent[i][k] += change_by_u[a][i] * out.pressure.by_u[a][k];
  return out;
}

std::vector<double> ends_and_middles(const std::vector<double>& sizes, double length) {
  std::vector<double> places{0.0};
  for (const double size : sizes)
    places.push_back(places.back() + 0.5 * size), places.push_back(places.back() + 0.5 * size);
  for (double& x : places) x *= length / places.back();
  places.back() = length;
  return places;
}

MeridianMesh::MeridianMesh(std::vector<double> columns_at, std::vector<double> rows_at)
    : radii(std::move(columns_at)), heights(std::move(rows_at)) {
  for (std::size_t i = 0; i + 2 < columns(); i += 2) {
    for (std::size_t k = 0; k + 2 < rows(); k += 2) {
      MeridianElement& e = elements.emplace_back();
      for (std::size_t n = 0; n < MeridianElement::kVertices; ++n) e.vertices[n] = (i + n / 3) * rows() + k + n % 3;
      place_points(e, radii[i], radii[i + 2] - radii[i], heights[k + 2] - heights[k]);
    }
  }
}

}  // namespace glisson::lab
