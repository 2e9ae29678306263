#include "material/principal.h"
#include "base/two_across.h"

#include <Eigen/Dense>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

namespace glisson {
namespace {

Vec3d column(const Mat3d& a, std::size_t j) { return {a(0, j), a(1, j), a(2, j)}; }
void put_column(Mat3d& a, std::size_t j, const Vec3d& v) {
  for (std::size_t i = 0; i < 3; ++i) a(i, j) = v[i];
}

/// `v` made perpendicular to the unit vector `a` and of length 1; some such vector where too little is left.
Vec3d perpendicular(const Vec3d& v, const Vec3d& a) {
  const Vec3d rest = v - a * dot(v, a);
  const double length = norm(rest);
  if (length > 1e-9) return rest * (1.0 / length);
  return two_across(a)[0];
}

PrincipalFrame found_frame(const Mat3d& H) {
  const Sym3<double> E = green_strain(H);
  Eigen::Matrix3d strain;
  strain << E.xx, E.xy, E.zx, E.xy, E.yy, E.yz, E.zx, E.yz, E.zz;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(strain);
  PrincipalFrame f;
  for (std::size_t i = 0; i < 3; ++i) {  // descending
    const auto k = static_cast<Eigen::Index>(2 - i);
    const Eigen::Vector3d n = solver.eigenvectors().col(k);
    put_column(f.n, i, {n.x(), n.y(), n.z()});
    const double e = solver.eigenvalues()(k);
    f.b[i] = 2.0 * e / (1.0 + std::sqrt(std::max(0.0, 1.0 + 2.0 * e)));
  }
  put_column(f.n, 2, cross(column(f.n, 0), column(f.n, 1)));
  const Mat3d F = deformation_gradient(H);
  const Vec3d x = F * column(f.n, 0), y = F * column(f.n, 1), z = F * column(f.n, 2);
  const double length = norm(x);
  const Vec3d u0 = length > 1e-12 ? x * (1.0 / length) : Vec3d{1.0, 0.0, 0.0};
  const Vec3d u1 = perpendicular(y, u0), u2 = cross(u0, u1);
  put_column(f.u, 0, u0), put_column(f.u, 1, u1), put_column(f.u, 2, u2);
  if (dot(u2, z) < 0.0) f.b[2] = -2.0 - f.b[2];  // λ₃ → −λ₃
  return f;
}

}  // namespace

PrincipalFrame principal_frame(const Mat3d& H) {
  using Bits = std::array<std::uint64_t, 9>;
  thread_local std::optional<std::pair<Bits, PrincipalFrame>> last;  // a tangent asks nine times for the same
  const Bits asked = std::bit_cast<Bits>(H);
  if (!last || last->first != asked) last = {asked, found_frame(H)};
  return last->second;
}

}  // namespace glisson
