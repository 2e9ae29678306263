#include "dynamics/state/loaded_faces.h"

#include <algorithm>
#include <tuple>

#include "mesh/topology/faces.h"

namespace glisson {
namespace {

constexpr double kAlongTheNormal = 1e-12;  ///< of a traction, up to which its part in the face is rounding

/// x ↦ v × x.
Mat3d cross_matrix(const Vec3d& v) { return {{{{0.0, -v.z, v.y}, {v.z, 0.0, -v.x}, {-v.y, v.x, 0.0}}}}; }

/// a + weight b.
Mat3d sum(const Mat3d& a, double weight, const Mat3d& b) {
  Mat3d m;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m(i, j) = a(i, j) + weight * b(i, j);
  }
  return m;
}

/// Integral of products of the corners' shape functions: ∫ N_a N_b = area/12 (1 + δ_ab).
double pair_weight(std::size_t a, std::size_t b) { return a == b ? 1.0 / 6.0 : 1.0 / 12.0; }

double rim(const Corners& x) { return norm(x[1] - x[0]) + norm(x[2] - x[1]) + norm(x[0] - x[2]); }

}  // namespace

std::array<std::uint32_t, 3> corners_of(const Body& body, const LoadedFace& face) {
  const auto& at = detail::kFaceCorners[face.opposite];
  const Tet& t = body.elements[face.element];
  return {t[at[0]], t[at[1]], t[at[2]]};
}

std::vector<LoadedFace> spanned_faces(const Body& body, std::span<const std::uint32_t> set) {
  std::vector<char> in_set(body.vertex_count, 0);
  for (const std::uint32_t v : set) in_set[v] = 1;
  struct Side {
    std::array<std::uint32_t, 3> corners;  // ascending
    LoadedFace face;
  };
  std::vector<Side> sides;
  for (std::uint32_t e = 0; e < body.elements.size(); ++e) {
    for (std::uint8_t a = 0; a < 4; ++a) {
      const LoadedFace face{e, a};
      if (!is_there(body, face)) break;
      std::array<std::uint32_t, 3> corners = corners_of(body, face);
      if (std::any_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return in_set[v] == 0; })) continue;
      std::sort(corners.begin(), corners.end());
      sides.push_back({corners, face});
    }
  }
  std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.corners < b.corners; });
  std::vector<LoadedFace> faces;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].corners == sides[i].corners) ++end;
    if (end == i + 1) faces.push_back(sides[i].face);  // more sides: inside the body
    i = end;
  }
  std::sort(faces.begin(), faces.end(), [](const LoadedFace& a, const LoadedFace& b) {
    return std::tie(a.element, a.opposite) < std::tie(b.element, b.opposite);
  });
  return faces;
}

TurningTraction::TurningTraction(const Vec3d& traction, double pressure, const Corners& rest) {
  const Vec3d n = unit(area_vector(rest)), a = rest[1] - rest[0], b = rest[2] - rest[0];
  const Vec3d s = traction - n * dot(traction, n);
  normal = dot(traction, n) - pressure;
  along = norm(s) > kAlongTheNormal * norm(traction) ? norm(s) : 0.0;
  if (along == 0.0) return;
  const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), d = aa * bb - ab * ab;
  first = (bb * dot(s, a) - ab * dot(s, b)) / d;
  second = (aa * dot(s, b) - ab * dot(s, a)) / d;
}

Vec3d TurningTraction::force(const Corners& x) const {
  const Vec3d area = area_vector(x);
  Vec3d f = area * (normal / 3.0);
  if (along > 0.0) f += unit((x[1] - x[0]) * first + (x[2] - x[0]) * second) * (along * norm(area) / 3.0);
  return f;
}

std::array<Mat3d, 3> TurningTraction::slope(const Corners& x) const {
  const Vec3d a = x[1] - x[0], b = x[2] - x[0], area = area_vector(x);
  // d area = ½ (da × b + a × db)
  const std::array<Mat3d, 2> of_area{cross_matrix(b * -0.5), cross_matrix(a * 0.5)};
  std::array<Mat3d, 3> slope{};
  const Vec3d s = a * first + b * second, n = unit(area);
  for (std::size_t k = 0; k < 2; ++k) {
    Mat3d& m = slope[k + 1];
    m = sum(Mat3d{}, normal / 3.0, of_area[k]);
    if (along > 0.0) {
      const Vec3d t = unit(s);
      m = sum(m, along / 3.0, outer(t, n) * of_area[k]);
      const double turn = along * norm(area) / 3.0 * (k == 0 ? first : second) / norm(s);
      m = sum(m, turn, sum(identity<double>(), -1.0, outer(t, t)));
    }
    slope[0] = sum(slope[0], -1.0, m);
  }
  return slope;
}

double TurningTraction::stiffness(const Corners& x) const {
  const Vec3d a = x[1] - x[0], b = x[2] - x[0];
  double sum = (std::abs(normal) + along) * rim(x) / 6.0;
  if (along > 0.0) {
    const double share = (std::abs(first) + std::abs(second) + std::abs(first + second)) / norm(a * first + b * second);
    sum += along * norm(area_vector(x)) / 3.0 * share;
  }
  return sum;
}

MomentTraction::MomentTraction(const Vec3d& moment, std::span<const Corners> faces) {
  double whole = 0.0;
  for (const Corners& x : faces) {
    const double area = norm(area_vector(x));
    whole += area;
    centre += (x[0] + x[1] + x[2]) * (area / 3.0);
  }
  centre *= 1.0 / whole;
  Mat3d inertia{};  // ∫ (r·r I − r rᵀ) dA
  for (const Corners& x : faces) {
    const double area = norm(area_vector(x));
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        const Vec3d p = x[a] - centre, q = x[b] - centre;
        const double w = area * pair_weight(a, b);
        inertia = sum(inertia, w * dot(p, q), identity<double>());
        inertia = sum(inertia, -w, outer(p, q));
      }
    }
  }
  alpha = inverse(inertia) * moment;
}

std::array<Vec3d, 3> MomentTraction::forces(const Corners& x) const {
  std::array<Vec3d, 3> f{};
  const double area = norm(area_vector(x));
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) f[a] += cross(alpha, x[b] - centre) * (area * pair_weight(a, b));
  }
  return f;
}

double MomentTraction::stiffness(const Corners& x) const {
  double most = 0.0;
  for (const Vec3d& corner : x) most = std::max(most, norm(cross(alpha, corner - centre)));
  return 2.0 * (norm(alpha) * norm(area_vector(x)) / 3.0 + most * rim(x) / 6.0);
}

}  // namespace glisson
