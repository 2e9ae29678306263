// curvature_sizes.cpp — see curvature_sizes.h.
//
// Cubes that the surface crosses are halved until the edge asked for in them is twice their side. Curvature is taken over a quarter of
// the side to both sides, so that a bend or crease is seen from a coarse cube, and measured in a fine one.
#include "mesher/lattice/curvature_sizes.h"
#include "base/two_across.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace glisson::lattice {
namespace {

constexpr double kShareOfSide = 0.25;
constexpr std::size_t kMostPoints = 2000000;

class CurvatureSampler {
 public:
  CurvatureSampler(const BodyRegion& region, double per_radius, double finest, double coarsest)
      : region_(region), per_radius_(per_radius), finest_(finest), coarsest_(coarsest) {}

  std::vector<SizePoint> run() {
    const Vec3d size = region_.bounds.max - region_.bounds.min;
    std::array<int, 3> n{};
    for (std::size_t d = 0; d < 3; ++d) n[d] = std::max(1, static_cast<int>(std::ceil(size[d] / coarsest_)));
    for (int k = 0; k < n[2]; ++k) {
      for (int j = 0; j < n[1]; ++j) {
        for (int i = 0; i < n[0]; ++i) {
          cube(region_.bounds.min + Vec3d{i + 0.5, j + 0.5, k + 0.5} * coarsest_, coarsest_);
        }
      }
    }
    return std::move(points_);
  }

 private:
  void cube(const Vec3d& centre, double side) {
    const double value = region_.distance(centre), reach = 0.8661 * side;
    if (std::abs(value) > reach) return;
    Vec3d p = centre;
    for (int i = 0; i < 3; ++i) {
      const Vec3d g = gradient(p, side);
      const double slope2 = dot(g, g);
      if (slope2 > 1e-4) p -= g * (region_.distance(p) / slope2);
    }
    if (!(norm(p - centre) < 2.0 * reach)) p = centre;
    const double edge = std::max(finest_, 1.0 / (per_radius_ * curvature(p, side) + 1e-300));
    if (edge < 2.0 * side && side > finest_) {
      for (int c = 0; c < 8; ++c) {
        cube(centre + Vec3d{c & 1 ? 0.25 : -0.25, c & 2 ? 0.25 : -0.25, c & 4 ? 0.25 : -0.25} * side, 0.5 * side);
      }
    } else if (edge < coarsest_) {
      points_.push_back({p, edge});
      if (points_.size() > kMostPoints) {
        throw std::invalid_argument("the curvature of the surface of region \"" + region_.name +
                                    "\" needs more than two million places; give its size a larger edge");
      }
    }
  }

  Vec3d gradient(const Vec3d& p, double side) const {
    const double h = 1e-3 * side;
    Vec3d g{};
    for (std::size_t d = 0; d < 3; ++d) {
      Vec3d step{};
      step[d] = h;
      g[d] = (region_.distance(p + step) - region_.distance(p - step)) / (2.0 * h);
    }
    return g;
  }
  Vec3d normal(const Vec3d& p, double side) const {
    const Vec3d g = gradient(p, side);
    return g * (1.0 / std::max(norm(g), 1e-9));
  }

  /// The larger principal curvature, its size [1/m]: the eigenvalues of the normal's change along the surface.
  double curvature(const Vec3d& p, double side) const {
    const double step = kShareOfSide * side;
    const Vec3d n = normal(p, side);
    const auto [a, b] = two_across(n);
    const Vec3d da = (normal(p + a * step, side) - normal(p - a * step, side)) * (0.5 / step);
    const Vec3d db = (normal(p + b * step, side) - normal(p - b * step, side)) * (0.5 / step);
    const double aa = dot(da, a), bb = dot(db, b), ab = 0.5 * (dot(da, b) + dot(db, a));
    return std::abs(0.5 * (aa + bb)) + std::hypot(0.5 * (aa - bb), ab);
  }

  const BodyRegion& region_;
  double per_radius_, finest_, coarsest_;
  std::vector<SizePoint> points_;
};

double distance_from_box(const Vec3d& p, const Bounds& box) {
  Vec3d away{};
  for (std::size_t d = 0; d < 3; ++d) away[d] = std::max({0.0, box.min[d] - p[d], p[d] - box.max[d]});
  return norm(away);
}

}  // namespace

std::vector<SizePoint> curvature_sizes(const BodyRegion& region, double per_radius, double finest, double coarsest) {
  return CurvatureSampler(region, per_radius, finest, coarsest).run();
}

SizePoints::SizePoints(std::vector<SizePoint> points, double growth, double within)
    : points_(std::move(points)), growth_(growth), within_(within) {
  if (!points_.empty()) build(0, static_cast<std::uint32_t>(points_.size()));
}

std::uint32_t SizePoints::build(std::uint32_t begin, std::uint32_t end) {
  const auto at = static_cast<std::uint32_t>(nodes_.size());
  Node node{{points_[begin].at, points_[begin].at}, points_[begin].edge, begin, end, 0};
  for (std::uint32_t i = begin; i < end; ++i) {
    node.edge = std::min(node.edge, points_[i].edge);
    for (std::size_t d = 0; d < 3; ++d) {
      node.box.min[d] = std::min(node.box.min[d], points_[i].at[d]);
      node.box.max[d] = std::max(node.box.max[d], points_[i].at[d]);
    }
  }
  nodes_.push_back(node);
  if (end - begin <= kLeaf) return at;
  const Vec3d size = node.box.max - node.box.min;
  const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(points_.begin() + begin, points_.begin() + middle, points_.begin() + end,
                   [axis](const SizePoint& a, const SizePoint& b) { return a.at[axis] < b.at[axis]; });
  build(begin, middle);
  const std::uint32_t second = build(middle, end);
  nodes_[at].second = second;
  return at;
}

double SizePoints::grown(double edge, double distance) const {
  return edge + growth_ * std::max(0.0, distance - within_);
}

double SizePoints::at(const Vec3d& p, double most) const {
  if (!nodes_.empty()) search(0, p, most);
  return most;
}

void SizePoints::search(std::uint32_t index, const Vec3d& p, double& least) const {
  const Node& node = nodes_[index];
  if (grown(node.edge, distance_from_box(p, node.box)) >= least) return;
  if (node.second == 0) {
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      least = std::min(least, grown(points_[i].edge, norm(p - points_[i].at)));
    }
    return;
  }
  search(index + 1, p, least);
  search(node.second, p, least);
}

}  // namespace glisson::lattice
