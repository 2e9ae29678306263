#include "instruments/needle/tissue_zone.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace glisson {
namespace {

struct RulePoint {
  Vec3d at;  ///< in units of R
  double weight;
};

/// Gauss's rule for ∫ r² (1 − r²)² f(r²) dr on two radii, times Lebedev's of 14 points on the sphere
/// [AbramowitzStegun1964, §25.4].
std::array<RulePoint, 28> ball_rule() {
  constexpr double kHalfSum = 5.0 / 13.0, kProduct = 15.0 / 143.0;  // of the two r²: roots of t² − 10/13 t + 15/143
  const double root = std::sqrt(kHalfSum * kHalfSum - kProduct);
  const double outer = kHalfSum + root, inner = kHalfSum - root;
  const double share = (1.0 / 3.0 - inner) / (outer - inner);  // so that the mean of r² is 1/3
  std::array<RulePoint, 28> rule;
  std::size_t n = 0;
  for (const auto& [squared, weight] : {std::pair{inner, 1.0 - share}, std::pair{outer, share}}) {
    const double r = std::sqrt(squared), diagonal = r / std::sqrt(3.0);
    for (const double s : {-1.0, 1.0}) {
      for (const Vec3d& axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
        rule[n++] = {axis * (s * r), weight / 15.0};
      }
    }
    for (const double i : {-1.0, 1.0}) {
      for (const double j : {-1.0, 1.0}) {
        for (const double k : {-1.0, 1.0}) rule[n++] = {Vec3d{i, j, k} * diagonal, weight * 3.0 / 40.0};
      }
    }
  }
  return rule;
}

}  // namespace

std::vector<VertexWeight> zone_weights(const detail::TetLocator& locator, const TetMesh& mesh, const Vec3d& x,
                                       double radius, const Mat3d& axes) {
  static const std::array<RulePoint, 28> rule = ball_rule();
  std::vector<VertexWeight> weights;
  double sum = 0.0;
  for (const RulePoint& point : rule) {
    const auto found = locator.locate(x + axes * point.at * radius);
    if (!found) continue;
    for (std::size_t a = 0; a < 4; ++a) {
      weights.push_back({mesh.tets[found->tet][a], point.weight * found->weights[a]});
    }
    sum += point.weight;
  }
  std::sort(weights.begin(), weights.end(), [](const VertexWeight& a, const VertexWeight& b) {
    return a.vertex < b.vertex || (a.vertex == b.vertex && a.weight < b.weight);
  });
  std::vector<VertexWeight> joined;
  for (const VertexWeight& w : weights) {
    if (joined.empty() || joined.back().vertex != w.vertex) joined.push_back({w.vertex, 0.0});
    joined.back().weight += w.weight / sum;
  }
  return joined;
}

Mat3d zone_axes(const TetMesh& mesh, const Vec3d& direction) {
  constexpr double kAcross = 0.3;  // of an edge's length: the first edge with more across the needle is taken
  const Tet& tet = mesh.tets.front();
  Vec3d side;
  for (std::size_t a = 1; a < 4; ++a) {
    const Vec3d edge = mesh.vertices[tet[a]] - mesh.vertices[tet[0]];
    const Vec3d across = edge - direction * dot(edge, direction);
    const bool enough = norm(across) > kAcross * norm(edge);
    if (enough || norm(across) > norm(side)) side = across;
    if (enough) break;
  }
  side = side * (1.0 / norm(side));
  const Vec3d third = cross(direction, side);
  Mat3d axes;
  for (std::size_t i = 0; i < 3; ++i) {
    axes(i, 0) = side[i];
    axes(i, 1) = third[i];
    axes(i, 2) = direction[i];
  }
  return axes;
}

}  // namespace glisson
