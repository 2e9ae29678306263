// membrane_frequency.cpp — the largest frequency of a sheet at rest on its masses.
//
// The sheet is blown up by a thousandth, so that it is taut everywhere and its forces are smooth; its tangent along a
// direction is a central difference of forces. Lanczos' largest value with its residual added bounds λ_max from above
// unless the start is orthogonal to the answer [ZhouLi2011].
#include <Eigen/Dense>
#include <cmath>

#include "instruments/capsule/membrane.h"

namespace glisson {
namespace {

constexpr double kBlownUp = 1.001;
constexpr int kMostSteps = 40;
constexpr double kEnough = 0.02;  ///< residual over the value
/// Rotations of triangles against each other, which turn parts of the tangent, and its change of kind at folds.
constexpr double kMargin = 1.05;

/// Numbers in (−1, 1) that are the same everywhere.
std::vector<double> start_vector(std::size_t n) {
  std::vector<double> x(n);
  std::uint64_t state = 0x9e3779b97f4a7c15u;
  for (double& a : x) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    a = static_cast<double>(static_cast<std::int64_t>(state)) * 0x1p-63;
  }
  return x;
}

double norm_of(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double a : x) sum += a * a;
  return std::sqrt(sum);
}

/// Lanczos' largest value of a symmetric operator plus its residual.
template <class Operator>
double largest_eigenvalue(Operator apply, std::size_t n) {
  std::vector<double> now = start_vector(n), before(n, 0.0);
  const double length = norm_of(now);
  for (double& a : now) a /= length;
  Eigen::VectorXd diagonal(kMostSteps), beside(kMostSteps);
  double above = 0.0, beta = 0.0;
  for (int k = 0; k < kMostSteps; ++k) {
    std::vector<double> next = apply(now);
    double alpha = 0.0;
    for (std::size_t i = 0; i < n; ++i) alpha += next[i] * now[i];
    for (std::size_t i = 0; i < n; ++i) next[i] -= alpha * now[i] + beta * before[i];
    beta = norm_of(next);
    diagonal[k] = alpha, beside[k] = beta;
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
    ritz.computeFromTridiagonal(diagonal.head(k + 1), beside.head(k));
    const double value = ritz.eigenvalues()[k], residual = beta * std::abs(ritz.eigenvectors()(k, k));
    above = value + residual;
    if (!(residual > kEnough * value) || !(beta > 0.0)) break;
    for (double& a : next) a /= beta;
    before = std::move(now);
    now = std::move(next);
  }
  return above;
}

}  // namespace

void Membrane::sharpen(std::span<const Vec3d> rest) {
  const std::size_t n = rest.size();
  double edge = 0.0;
  for (const double area : area_) edge = std::max(edge, std::sqrt(area));
  std::vector<Vec3d> middle(rest.begin(), rest.end());
  for (Vec3d& x : middle) x = x * kBlownUp;
  std::vector<Vec3d> at(n), up(n), down(n);
  const auto apply = [&](const std::vector<double>& u) {
    double most = 0.0;
    for (std::size_t i = 0; i < 3 * n; ++i) most = std::max(most, std::abs(u[i]) / std::sqrt(masses_[i / 3]));
    const double d = most > 0.0 ? 1e-6 * edge / most : 0.0;
    const auto forces = [&](double sign, std::vector<Vec3d>& f) {
      for (std::size_t i = 0; i < n; ++i) {
        const double scale = sign * d / std::sqrt(masses_[i]);
        at[i] = middle[i] + Vec3d{u[3 * i], u[3 * i + 1], u[3 * i + 2]} * scale;
      }
      f.assign(n, Vec3d{});
      add_forces(at, f);
    };
    forces(1.0, up), forces(-1.0, down);
    std::vector<double> y(3 * n);
    for (std::size_t i = 0; i < 3 * n; ++i) {
      y[i] = d > 0.0 ? (down[i / 3][i % 3] - up[i / 3][i % 3]) / (2.0 * d * std::sqrt(masses_[i / 3])) : 0.0;
    }
    return y;
  };
  if (n == 0) return;
  const double above = kMargin * largest_eigenvalue(apply, 3 * n);
  sharp_rate_ = seen_.modulus > 0.0 ? above / seen_.modulus : kNone;
}

}  // namespace glisson
