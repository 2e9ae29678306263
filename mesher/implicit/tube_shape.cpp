// tube_shape.cpp — a tube as round cones along a spline, found through boxes about short runs of them.
#include <algorithm>
#include <cmath>

#include "base/require_fields.h"
#include "mesher/implicit/shape_node.h"

namespace glisson {
namespace {

using namespace detail;

constexpr int kPiecesASpan = 8;  ///< a quarter turn in a span bends by 11° between pieces
constexpr std::size_t kRun = 8;  ///< pieces that share a box

/// All balls between two: their common tangent cone, and a ball at each end.
struct RoundCone {
  Vec3d from, axis;  ///< axis: unit
  double length, radius, end_radius, sine, cosine;

  RoundCone(const TubePoint& a, const TubePoint& b)
      : from(a.at), axis(b.at - a.at), length(norm(axis)), radius(a.radius), end_radius(b.radius), sine(0.0),
        cosine(1.0) {
    axis = length > 0.0 ? axis * (1.0 / length) : Vec3d{1.0, 0.0, 0.0};
    const double narrowing = radius - end_radius;
    if (std::abs(narrowing) >= length) {  // one ball holds the other
      if (narrowing < 0.0) from = b.at;
      radius = std::max(radius, end_radius);
      length = 0.0;
      return;
    }
    sine = narrowing / length;
    cosine = std::sqrt(1.0 - sine * sine);
  }

  double distance(const Vec3d& p) const {
    const Vec3d q = p - from;
    if (length == 0.0) return norm(q) - radius;
    const double along = dot(q, axis), across = norm(q - axis * along);
    const double foot = along - across * sine / cosine;  // centre of the ball that p sees
    if (foot <= 0.0) return norm(q) - radius;
    if (foot >= length) return norm(q - axis * length) - end_radius;
    return cosine * across + sine * along - radius;
  }

  Bounds bounds() const {
    const Vec3d to = from + axis * length;
    const double r = length > 0.0 ? end_radius : radius;
    return joined({from - all(radius), from + all(radius)}, {to - all(r), to + all(r)});
  }
};

/// A point of the spline through b and c between a and d; knots grow by the root of the distance.
Vec3d spline(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d, double t) {
  const auto knot = [](const Vec3d& p, const Vec3d& q) { return std::max(1e-9, std::sqrt(norm(q - p))); };
  const double t1 = knot(a, b), t2 = t1 + knot(b, c), t3 = t2 + knot(c, d), s = t1 + (t2 - t1) * t;
  const auto mix = [s](const Vec3d& p, double from, const Vec3d& q, double to) {
    return p * ((to - s) / (to - from)) + q * ((s - from) / (to - from));
  };
  const Vec3d ab = mix(a, 0.0, b, t1), bc = mix(b, t1, c, t2), cd = mix(c, t2, d, t3);
  return mix(mix(ab, 0.0, bc, t2), t1, mix(bc, t1, cd, t3), t2);
}

std::vector<RoundCone> pieces_of(const std::vector<TubePoint>& points) {
  const std::size_t n = points.size();
  std::vector<RoundCone> pieces;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const TubePoint &b = points[i], &c = points[i + 1];
    // Beyond its ends the line goes on as it came.
    const Vec3d before = i > 0 ? points[i - 1].at : b.at * 2.0 - c.at;
    const Vec3d after = i + 2 < n ? points[i + 2].at : c.at * 2.0 - b.at;
    const int count = n > 2 ? kPiecesASpan : 1;
    TubePoint last = b;
    for (int k = 1; k <= count; ++k) {
      const double t = static_cast<double>(k) / count;
      const TubePoint next{k == count ? c.at : spline(before, b.at, c.at, after, t),
                           b.radius + (c.radius - b.radius) * t};
      pieces.emplace_back(last, next);
      last = next;
    }
  }
  return pieces;
}

class Tube final : public Solid::Node {
 public:
  explicit Tube(const std::vector<RoundCone>& pieces) : Node(box_of(pieces, 0, pieces.size())), pieces_(pieces) {
    for (std::size_t i = 0; i < pieces.size(); i += kRun)
      runs_.push_back(box_of(pieces, i, std::min(i + kRun, pieces.size())));
  }

  double formula(const Vec3d& p) const override {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      if (is_beyond(runs_[r], p, least)) continue;
      const std::size_t end = std::min((r + 1) * kRun, pieces_.size());
      for (std::size_t i = r * kRun; i < end; ++i) least = std::min(least, pieces_[i].distance(p));
    }
    return least;
  }

 private:
  static Bounds box_of(const std::vector<RoundCone>& pieces, std::size_t begin, std::size_t end) {
    Bounds box = pieces[begin].bounds();
    for (std::size_t i = begin; i < end; ++i) box = joined(box, pieces[i].bounds());
    return box;
  }

  std::vector<RoundCone> pieces_;
  std::vector<Bounds> runs_;
};

}  // namespace

Fault TubeShape::check() const {
  if (points.size() < 2) return {"needs two points or more, got " + std::to_string(points.size()), "points"};
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i].at == points[i - 1].at) {
      return {"has the same point twice, as " + std::to_string(i - 1) + " and " + std::to_string(i) + "; leave one out",
              "points"};
    }
  }
  return {};
}

Solid::Solid(const TubeShape& shape) {
  require_fields(std::string(TubeShape::kName), shape);
  node_ = std::make_shared<Tube>(pieces_of(shape.points));
}

}  // namespace glisson
