#include "instruments/needle/tissue_zone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/symmetric_eigen.h"
#include "glisson/mesh.h"

namespace glisson {
namespace {

constexpr double kFine = 0.6, kCoarse = 0.7;  ///< edges over R: up to here made up for, from there on not
constexpr double kSpread = 1.05;              ///< of edges: the radius of the load that a single vertex spreads
constexpr double kInside = 1e-3;              ///< of R: how far inside the body a point of its surface looks for edges
constexpr std::uint32_t kNoGuess = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kFewest = 3, kMost = 12;  ///< radii of a rule for fine meshes

struct RulePoint {
  Vec3d at;  ///< in units of r
  double weight;
};

/// For coarse meshes: Gauss's rule for ∫ r² (1 − r²)² f(r²) dr on two radii, times Lebedev's of 14 points on the sphere
/// [AbramowitzStegun1964, §25.4].
std::vector<RulePoint> coarse_rule() {
  constexpr double kHalfSum = 5.0 / 13.0, kProduct = 15.0 / 143.0;  // of the two r²: roots of t² − 10/13 t + 15/143
  const double root = std::sqrt(kHalfSum * kHalfSum - kProduct);
  const double outer = kHalfSum + root, inner = kHalfSum - root;
  const double share = (1.0 / 3.0 - inner) / (outer - inner);  // so that the mean of r² is 1/3
  std::vector<RulePoint> rule;
  for (const auto& [squared, weight] : {std::pair{inner, 1.0 - share}, std::pair{outer, share}}) {
    const double r = std::sqrt(squared), diagonal = r / std::sqrt(3.0);
    for (const double s : {-1.0, 1.0}) {
      for (const Vec3d& axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
        rule.push_back({axis * (s * r), weight / 15.0});
      }
    }
    for (const double i : {-1.0, 1.0}) {
      for (const double j : {-1.0, 1.0}) {
        for (const double k : {-1.0, 1.0}) rule.push_back({Vec3d{i, j, k} * diagonal, weight * 3.0 / 40.0});
      }
    }
  }
  return rule;
}

/// Gauss's rule for the mean of f(t) over (0, 1) by the weight (1 − t)² √t.
std::vector<RuleNode> radial_rule(std::size_t points) {
  constexpr double a = 2.0, b = 0.5;  // (1 − t)^a t^b
  const auto n = static_cast<Eigen::Index>(points);
  Eigen::VectorXd diagonal(n), beside(n - 1);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto i = static_cast<double>(k);
    const double sum = 2.0 * i + a + b;
    diagonal[k] = (b * b - a * a) / (sum * (sum + 2.0));
    if (k == 0) continue;
    beside[k - 1] = std::sqrt(4.0 * i * (i + a) * (i + b) * (i + a + b) / (sum * sum * (sum + 1.0) * (sum - 1.0)));
  }
  return gauss_rule(diagonal, beside);
}

/// s² ds = ½ √t dt with t = s². On each sphere a spiral of points over one half, and their mirror images through X.
std::vector<RulePoint> fine_rule(std::size_t radii) {
  const std::size_t half = 2 * radii * radii;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<RulePoint> rule;
  double turn = 0.0;
  for (const RuleNode& square : radial_rule(radii)) {
    const double r = std::sqrt(square.at), weight = square.weight / (2.0 * static_cast<double>(half));
    for (std::size_t k = 0; k < half; ++k, turn += golden) {
      const double z = (static_cast<double>(k) + 0.5) / static_cast<double>(half), across = std::sqrt(1.0 - z * z);
      const Vec3d at = Vec3d{across * std::cos(turn), across * std::sin(turn), z} * r;
      rule.push_back({at, weight});
      rule.push_back({at * -1.0, weight});
    }
  }
  return rule;
}

/// The rule for a ball whose radius is so many edges: with one radius more than that.
const std::vector<RulePoint>& rule_for(double edges) {
  static const auto rules = [] {
    std::array<std::vector<RulePoint>, kMost + 1> all;
    all[kFewest - 1] = coarse_rule();
    for (std::size_t radii = kFewest; radii <= kMost; ++radii) all[radii] = fine_rule(radii);
    return all;
  }();
  if (edges * kCoarse <= 1.0) return rules[kFewest - 1];
  return rules[static_cast<std::size_t>(std::clamp(1.0 + std::ceil(edges), double{kFewest}, double{kMost}))];
}

}  // namespace

TissueZones::TissueZones(const TetMesh& mesh, std::span<const char> removed, double radius, const Mat3d& axes)
    : mesh_(&mesh), locator_(mesh, removed), radius_(radius), axes_(axes), edge_squared_(mesh.vertices.size()),
      count_(mesh.vertices.size(), 0) {
  std::vector<double> volumes(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!removed.empty() && removed[t] != 0) continue;
    const double six_volumes = std::abs(six_rest_volume(mesh, t));
    for (const std::uint32_t v : mesh.tets[t]) {
      volumes[v] += six_volumes;
      edge_squared_[v] += six_volumes * std::pow(std::numbers::sqrt2 * six_volumes, 2.0 / 3.0);
    }
  }
  for (std::size_t v = 0; v < volumes.size(); ++v) {
    if (volumes[v] > 0.0) edge_squared_[v] /= volumes[v];
  }
  rule_for(0.0);  // all rules are made at the first call, which is not to be that of a needle's first touch
}

/// Of the tets around X, linear within each; 0 where there is none.
double TissueZones::edge_squared(const Vec3d& x) const {
  for (const double side : {0.0, 1.0, -1.0}) {
    const Vec3d inward{axes_(0, 2), axes_(1, 2), axes_(2, 2)};
    const auto found = locator_.locate(x + inward * (side * kInside * radius_));
    if (!found) continue;
    double mean = 0.0;
    for (std::size_t a = 0; a < 4; ++a) mean += found->weights[a] * edge_squared_[mesh_->tets[found->tet][a]];
    return mean;
  }
  return 0.0;
}

std::vector<VertexWeight> TissueZones::weights(const Vec3d& x) {
  const double edge = std::sqrt(edge_squared(x)),
               share = std::clamp((kCoarse - edge / radius_) / (kCoarse - kFine), 0.0, 1.0);
  const double radius = std::sqrt(radius_ * radius_ - share * kSpread * edge * edge);
  std::vector<VertexWeight> weights;
  double sum = 0.0;
  const std::vector<RulePoint>& rule = rule_for(edge > 0.0 ? radius_ / edge : 0.0);
  guesses_.resize(rule.size(), kNoGuess);
  weights.reserve(4 * rule.size());
  for (std::size_t k = 0; k < rule.size(); ++k) {
    const RulePoint& point = rule[k];
    const Vec3d at = x + axes_ * point.at * radius;
    const auto found = guesses_[k] == kNoGuess ? locator_.locate(at) : locator_.locate(at, guesses_[k]);
    if (!found) continue;
    guesses_[k] = found->tet;
    for (std::size_t a = 0; a < 4; ++a) {
      weights.push_back({mesh_->tets[found->tet][a], point.weight * found->weights[a]});
    }
    sum += point.weight;
  }
  return joined(weights, sum);
}

/// One weight a vertex, ascending. They are summed in the order of their sizes, so that the sum is that of any order of the points.
std::vector<VertexWeight> TissueZones::joined(std::span<const VertexWeight> weights, double sum) {
  std::vector<VertexWeight> joined;
  for (const VertexWeight& w : weights) {
    if (count_[w.vertex]++ == 0) joined.push_back({w.vertex, 0.0});
  }
  std::ranges::sort(joined, {}, &VertexWeight::vertex);
  std::uint32_t end = 0;
  for (const VertexWeight& j : joined) end += std::exchange(count_[j.vertex], end);  // to where its weights begin
  by_vertex_.resize(weights.size());
  for (const VertexWeight& w : weights) by_vertex_[count_[w.vertex]++] = w.weight;
  auto begin = by_vertex_.begin();
  for (VertexWeight& j : joined) {
    const auto last = by_vertex_.begin() + std::exchange(count_[j.vertex], 0);
    std::sort(begin, last);
    for (; begin != last; ++begin) j.weight += *begin / sum;
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
  side = unit(side);
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
