// combined_shapes.cpp — union, intersection, difference and placement of shapes.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/require_fields.h"
#include "base/text.h"
#include "mesh/implicit/shape_node.h"

namespace glisson {
namespace {

using namespace detail;
using NodePtr = std::shared_ptr<const Solid::Node>;

/// min(a, b), below it by at most blend/4 where the two are closer than `blend`.
double blended_min(double a, double b, double blend) {
  const double h = blend - std::abs(a - b);
  return std::min(a, b) - (h > 0.0 ? h * h / (4.0 * blend) : 0.0);
}

class Union final : public Solid::Node {
 public:
  Union(const Bounds& box, std::vector<NodePtr> of, double blend) : Node(box), of_(std::move(of)), blend_(blend) {}

  double formula(const Vec3d& p) const override {
    double least = of_.front()->distance(p);
    for (std::size_t i = 1; i < of_.size(); ++i) {
      if (is_beyond(of_[i]->bounds, p, least + blend_)) continue;  // further off than it could matter
      least = blended_min(least, of_[i]->distance(p), blend_);
    }
    return least;
  }

 private:
  std::vector<NodePtr> of_;
  double blend_;
};

class Intersection final : public Solid::Node {
 public:
  Intersection(const Bounds& box, std::vector<NodePtr> of, double blend)
      : Node(box), of_(std::move(of)), blend_(blend) {}

  double formula(const Vec3d& p) const override {
    double most = of_.front()->distance(p);
    for (std::size_t i = 1; i < of_.size(); ++i) most = -blended_min(-most, -of_[i]->distance(p), blend_);
    return most;
  }

 private:
  std::vector<NodePtr> of_;
  double blend_;
};

class Difference final : public Solid::Node {
 public:
  Difference(NodePtr from, std::vector<NodePtr> others, double blend)
      : Node(from->bounds), from_(std::move(from)), others_(std::move(others)), blend_(blend) {}

  double formula(const Vec3d& p) const override {
    double most = from_->distance(p);
    for (const NodePtr& other : others_) {
      if (is_beyond(other->bounds, p, blend_ - most)) continue;  // further off than it could matter
      most = -blended_min(-most, other->distance(p), blend_);
    }
    return most;
  }

 private:
  NodePtr from_;
  std::vector<NodePtr> others_;
  double blend_;
};

class Placed final : public Solid::Node {
 public:
  Placed(NodePtr of, const Mat3d& turn, double scale, const Vec3d& move)
      : Node(box_of(of->bounds, turn, scale, move)), of_(std::move(of)), back_(transposed(turn)), scale_(scale),
        move_(move) {}

  double formula(const Vec3d& p) const override { return scale_ * of_->distance(back_ * (p - move_) * (1.0 / scale_)); }

 private:
  static Bounds box_of(const Bounds& b, const Mat3d& turn, double scale, const Vec3d& move) {
    if (!is_finite(b)) return kEverywhere;
    const Vec3d centre = (b.min + b.max) * 0.5, half = (b.max - b.min) * 0.5;
    const Vec3d at = turn * centre * scale + move;
    Vec3d extent{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) extent[i] += scale * std::abs(turn(i, j)) * half[j];
    }
    return {at - extent, at + extent};
  }

  NodePtr of_;
  Mat3d back_;
  double scale_;
  Vec3d move_;
};

Mat3d rotation(const Vec3d& axis, double angle) {
  const Vec3d n = unit(axis);
  const double c = std::cos(angle), s = std::sin(angle);
  Mat3d m = outer(n, n);
  for (auto& row : m.m) {
    for (double& x : row) x *= 1.0 - c;
  }
  for (std::size_t i = 0; i < 3; ++i) m(i, i) += c;
  const Vec3d t = n * s;
  m(2, 1) += t.x, m(0, 2) += t.y, m(1, 0) += t.z;
  m(1, 2) -= t.x, m(2, 0) -= t.y, m(0, 1) -= t.z;
  return m;
}

std::vector<NodePtr> nodes_of(const std::vector<Solid>& shapes, double blend) {
  if (shapes.empty()) throw std::invalid_argument("no shapes to combine; give at least one");
  if (!(blend >= 0.0) || !std::isfinite(blend)) {
    throw std::invalid_argument("blend [m] = " + show(blend) + " is outside the allowed range, ≥ 0 and finite");
  }
  std::vector<NodePtr> nodes;
  for (const Solid& s : shapes) nodes.push_back(s.node());
  return nodes;
}

}  // namespace

Solid unite(const std::vector<Solid>& shapes, double blend) {
  std::vector<NodePtr> nodes = nodes_of(shapes, blend);
  Bounds box = nodes.front()->bounds;
  for (const NodePtr& n : nodes) box = joined(box, n->bounds);
  if (nodes.size() > 1) box = grown(box, 0.25 * blend * static_cast<double>(nodes.size() - 1));
  return Solid(std::make_shared<Union>(box, std::move(nodes), blend));
}

Solid intersect(const std::vector<Solid>& shapes, double blend) {
  std::vector<NodePtr> nodes = nodes_of(shapes, blend);
  Bounds box = nodes.front()->bounds;
  for (const NodePtr& n : nodes) box = {greater(box.min, n->bounds.min), lesser(box.max, n->bounds.max)};
  return Solid(std::make_shared<Intersection>(box, std::move(nodes), blend));
}

Solid subtract(const Solid& shape, const std::vector<Solid>& others, double blend) {
  return Solid(std::make_shared<Difference>(shape.node(), nodes_of(others, blend), blend));
}

Solid Solid::placed(const PlacedShape& place) const {
  require_fields(std::string(PlacedShape::kName), place);
  const Mat3d turn = rotation(place.axis, place.angle_deg * std::numbers::pi / 180.0);
  return Solid(std::make_shared<Placed>(node_, turn, place.scale, place.move));
}

}  // namespace glisson
