// combined_shapes.cpp — union, intersection, difference and placement of shapes.
//
// Parts are blended one after the other, each with what came of those before it. A blend moves the value by a quarter of its
// distance at most, so that all parts before one may be left out that are further off than that adds up to (`clearance`).
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/require_fields.h"
#include "base/text.h"
#include "mesher/implicit/shape_node.h"

namespace glisson {
namespace {

using namespace detail;
using NodePtr = std::shared_ptr<const Solid::Node>;

/// min(a, b), below it by at most blend/4 where the two are closer than `blend`.
double blended_min(double a, double b, double blend) {
  const double h = blend - std::abs(a - b);
  return std::min(a, b) - (h > 0.0 ? h * h / (4.0 * blend) : 0.0);
}

/// By how much `count` blended parts may fall short of the least of them, and a hundredth for rounding.
double shift(double blend, std::size_t count) { return 0.26 * blend * static_cast<double>(count); }

/// How much nearer a part has to be than `count` parts before it for these not to matter.
double clearance(double blend, std::size_t count) { return blend + shift(blend, count); }

class Union final : public Solid::Node {
 public:
  Union(const Bounds& box, std::vector<NodePtr> of, double blend) : Node(box), of_(std::move(of)), blend_(blend) {}

  double formula(const Vec3d& p) const override {
    const std::size_t near = nearest_box(p);
    const double of_near = of_[near]->distance(p);
    std::size_t i = near;
    if (!far_before(near, p, of_near)) i = 0;
    double least = i == near ? of_near : of_.front()->distance(p);
    for (++i; i < of_.size(); ++i) {
      if (is_beyond(of_[i]->bounds, p, least + blend_)) continue;  // further off than it could matter
      least = blended_min(least, i == near ? of_near : of_[i]->distance(p), blend_);
    }
    return least;
  }

 private:
  std::size_t nearest_box(const Vec3d& p) const {
    std::size_t nearest = 0;
    double least = box_distance(of_.front()->bounds, p);
    for (std::size_t i = 1; i < of_.size() && least > 0.0; ++i) {
      const double distance = box_distance(of_[i]->bounds, p);
      if (distance < least) least = distance, nearest = i;
    }
    return nearest;
  }
  /// Whether all parts before one are too far off to matter beside it.
  bool far_before(std::size_t part, const Vec3d& p, double distance) const {
    const double reach = distance + clearance(blend_, part);
    return std::all_of(of_.begin(), of_.begin() + static_cast<std::ptrdiff_t>(part),
                       [&](const NodePtr& n) { return is_beyond(n->bounds, p, reach); });
  }
  bool below(const Vec3d& p, double bound) const override {
    return std::any_of(of_.begin(), of_.end(), [&](const NodePtr& n) { return n->surely_below(p, bound); });
  }

  std::vector<NodePtr> of_;
  double blend_;
};

class Intersection final : public Solid::Node {
 public:
  Intersection(const Bounds& box, std::vector<NodePtr> of, double blend)
      : Node(box), of_(std::move(of)), blend_(blend) {}

  double formula(const Vec3d& p) const override {
    double most = of_.front()->distance(p);
    for (std::size_t i = 1; i < of_.size(); ++i) {
      if (!of_[i]->cheap() && of_[i]->surely_below(p, most - blend_)) continue;  // deeper inside than it could matter
      most = -blended_min(-most, -of_[i]->distance(p), blend_);
    }
    return most;
  }

 private:
  bool below(const Vec3d& p, double bound) const override {
    const double each = bound - shift(blend_, of_.size() - 1);
    return std::all_of(of_.begin(), of_.end(), [&](const NodePtr& n) { return n->surely_below(p, each); });
  }

  std::vector<NodePtr> of_;
  double blend_;
};

class Difference final : public Solid::Node {
 public:
  Difference(NodePtr from, std::vector<NodePtr> others, double blend)
      : Node(from->bounds), from_(std::move(from)), others_(std::move(others)), blend_(blend) {}

  double formula(const Vec3d& p) const override {
    const Taken taken = deepest_taken(p);
    std::size_t i = 0;
    double most = -taken.distance;
    if (taken.part < others_.size() && alone_matters(taken, p)) {
      i = taken.part + 1;
    } else {
      most = from_->distance(p);
    }
    for (; i < others_.size(); ++i) {
      if (is_beyond(others_[i]->bounds, p, blend_ - most)) continue;  // further off than it could matter
      most = -blended_min(-most, i == taken.part ? taken.distance : others_[i]->distance(p), blend_);
    }
    return most;
  }

 private:
  /// Of those taken out that are cheap and whose box p is in, the one that p is nearest to or deepest in.
  struct Taken {
    std::size_t part;
    double distance;
  };
  Taken deepest_taken(const Vec3d& p) const {
    Taken taken{others_.size(), std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < others_.size(); ++i) {
      if (!others_[i]->cheap() || box_distance(others_[i]->bounds, p) > 0.0) continue;
      const double distance = others_[i]->distance(p);
      if (distance < taken.distance) taken = {i, distance};
    }
    return taken;
  }
  /// Whether the shape, and those taken out of it before, are too deep inside or far off to matter beside that one.
  bool alone_matters(const Taken& taken, const Vec3d& p) const {
    const double bound = -taken.distance - clearance(blend_, taken.part + 1);
    return from_->surely_below(p, bound) &&
           std::all_of(others_.begin(), others_.begin() + static_cast<std::ptrdiff_t>(taken.part),
                       [&](const NodePtr& other) { return other->surely_above(p, -bound); });
  }
  bool below(const Vec3d& p, double bound) const override {
    const double each = bound - shift(blend_, others_.size());
    return from_->surely_below(p, each) && std::all_of(others_.begin(), others_.end(), [&](const NodePtr& other) {
             return other->surely_above(p, -each);
           });
  }

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
  bool cheap() const override { return of_->cheap(); }

 private:
  bool below(const Vec3d& p, double bound) const override {
    const double of_part = bound / scale_, rounding = 1e-12 * std::abs(of_part);
    return of_->surely_below(back_ * (p - move_) * (1.0 / scale_), of_part - rounding);
  }

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
