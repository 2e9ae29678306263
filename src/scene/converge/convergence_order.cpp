#include "glisson/scene/convergence_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace glisson {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFlat = 0.85 * kPi;      // edges of a support within a face, which may be curved
constexpr double kReentrant = 1.1 * kPi;  // less is a facet of a curved surface
constexpr double kAlong = 0.99;           // cosine from which on a face lies across an axis
constexpr unsigned kX = 1, kY = 2, kZ = 4, kAll = kX | kY | kZ;

/// The smallest root of `f` in (0.3, 1), found by steps and halving; `none` without one.
template <class F>
double smallest_root(F f, double none) {
  constexpr int kSteps = 140;
  const auto at = [](int i) { return 0.3 + 0.7 * i / kSteps; };
  for (int i = 0; i < kSteps - 1; ++i) {
    double a = at(i), b = at(i + 1);
    if (f(a) * f(b) > 0.0) continue;
    for (int k = 0; k < 50; ++k) {
      const double middle = 0.5 * (a + b);
      (f(a) * f(middle) <= 0.0 ? b : a) = middle;
    }
    return 0.5 * (a + b);
  }
  return none;
}

unsigned bits(const Axes& axes) { return (axes.x ? kX : 0u) | (axes.y ? kY : 0u) | (axes.z ? kZ : 0u); }

unsigned axis_of(const Vec3d& direction) {
  const double length = norm(direction);
  if (std::abs(direction.x) > kAlong * length) return kX;
  if (std::abs(direction.y) > kAlong * length) return kY;
  return std::abs(direction.z) > kAlong * length ? kZ : 0u;
}

unsigned held_by(const ToolSpec& tool) {
  if (tool.rotation && tool.axial_free) return kAll & ~axis_of(tool.rotation->axis);
  return tool.sideways_free ? axis_of(tool.motion.direction) : kAll;
}

/// The components that supports and tools hold at each vertex.
std::vector<unsigned> held_components(const Variant& variant, const TetMesh& mesh) {
  std::vector<unsigned> held(mesh.vertices.size(), 0u);
  const auto hold = [&](const std::string& set, unsigned components) {
    for (const std::uint32_t v : mesh.vertex_set(set)) held[v] |= components;
  };
  for (const FixedSpec& fixed : variant.fixed) hold(fixed.set, bits(fixed.axes));
  for (const ToolSpec& tool : variant.tools) hold(tool.set, held_by(tool));
  return held;
}

/// A triangle of the surface.
struct Face {
  Triangle corners;
  Vec3d normal;       // outward, of length 1
  unsigned held = 0;  // components that all its corners hold
};

class Edges {
 public:
  Edges(const Variant& variant, const TetMesh& mesh) : mesh_(mesh) {
    const std::vector<unsigned> held = held_components(variant, mesh);
    for (const unsigned h : held) never_ &= h;
    for (const Triangle& t : boundary_triangles(mesh)) {
      const Vec3d n = cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
      faces_.push_back({t, n * (1.0 / norm(n)), held[t[0]] & held[t[1]] & held[t[2]] & ~never_});
    }
    const auto stiffest = [&](const Tissue& t) {
      const LameParameters l = t.lame();
      poisson_ratio_ = std::max(poisson_ratio_, 0.5 * l.lambda / (l.lambda + l.mu));
    };
    stiffest(variant.tissue);
    for (const RegionSpec& region : variant.regions) stiffest(region.tissue);
  }

  /// The least λ.
  double exponent() const {
    double least = 1.0;
    const unsigned across = never_ == kX || never_ == kY || never_ == kZ ? never_ : 0u;  // plane strain
    std::map<std::array<std::uint32_t, 2>, const Face*> open;
    for (const Face& face : faces_) {
      if ((axis_of(face.normal) & across) != 0) continue;  // nothing moves across it: a plane of symmetry
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = face.corners[i], b = face.corners[(i + 1) % 3];
        const auto [other, is_new] = open.try_emplace({std::min(a, b), std::max(a, b)}, &face);
        if (!is_new) least = std::min(least, between(*other->second, face));
      }
    }
    return least;
  }

 private:
  const Vec3d& at(std::uint32_t v) const { return mesh_.vertices[v]; }

  /// The angle of the body between two triangles with a common edge.
  double angle(const Face& one, const Face& other) const {
    const double turn = std::acos(std::clamp(dot(one.normal, other.normal), -1.0, 1.0));
    double beyond = 0.0;  // how far the other triangle rises above this one
    for (const std::uint32_t v : other.corners) beyond = std::max(beyond, dot(at(v) - at(one.corners[0]), one.normal));
    const double size = norm(at(one.corners[1]) - at(one.corners[0]));
    return beyond > 1e-6 * size ? kPi + turn : kPi - turn;
  }

  double between(const Face& one, const Face& other) const {
    const double w = angle(one, other);
    const bool one_component = never_ == (kX | kY) || never_ == (kX | kZ) || never_ == (kY | kZ);
    if (one.held == other.held) {
      if (w < kReentrant) return 1.0;
      return one_component ? kPi / w : free_edge_exponent(w);
    }
    if (one_component) return std::min(1.0, 0.5 * kPi / w);
    if (w > kFlat) return 0.5;
    if (one.held != 0 && other.held != 0) return 1.0;  // as beside a plane of symmetry
    const Face& held = one.held != 0 ? one : other;
    if (held.held != (kAll & ~never_)) return free_edge_exponent(2.0 * w);
    return bonded_edge_exponent(w, poisson_ratio_);
  }

  const TetMesh& mesh_;
  std::vector<Face> faces_;
  unsigned never_ = kAll;  // components that no vertex can move
  double poisson_ratio_ = 0.0;
};

}  // namespace

double bonded_edge_exponent(double angle, double poisson_ratio) {
  const double kappa = 3.0 - 4.0 * poisson_ratio, half = 0.5 * (kappa + 1.0);
  const auto f = [&](double l) {
    const double s = std::sin(l * angle), t = l * std::sin(angle);
    return kappa * s * s - half * half + t * t;
  };
  return angle < kPi ? smallest_root(f, angle > 0.5 * kPi ? 0.5 : 1.0) : 0.5;  // wider: complex, of real part ½
}

double free_edge_exponent(double angle) {
  if (angle <= kPi) return 1.0;
  return smallest_root([&](double l) { return std::sin(l * angle) + l * std::sin(angle); }, 0.5);
}

double largest_order(const Variant& variant, const TetMesh& mesh) {
  if (!variant.instruments.empty() || !variant.capsules.empty() || variant.container) return 1.0;
  return std::clamp(2.0 * Edges(variant, mesh).exponent(), 1.0, 2.0);
}

}  // namespace glisson
