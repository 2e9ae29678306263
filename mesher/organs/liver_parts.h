// liver_parts.h — a list of shapes in the making, in millimetres.
#pragma once

#include <string>
#include <vector>

#include "glisson/implicit.h"
#include "glisson/liver.h"

namespace glisson::detail {

class LiverParts {
 public:
  /// @param scale  factor on all lengths
  explicit LiverParts(double scale) : to_m_(1e-3 * scale) {}

  struct Point {
    Vec3d at;       ///< [mm]
    double radius;  ///< [mm]
  };

  void ball(const std::string& name, const Vec3d& center, double radius) {
    add(name, BallShape{center * to_m_, radius * to_m_});
  }
  void ellipsoid(const std::string& name, const Vec3d& center, const Vec3d& semi_axes, double exponent) {
    add(name, EllipsoidShape{center * to_m_, semi_axes * to_m_, exponent, exponent});
  }
  void tube(const std::string& name, const std::vector<Point>& points) {
    TubeShape tube;
    for (const Point& p : points) tube.points.push_back({p.at * to_m_, p.radius * to_m_});
    add(name, tube);
  }
  void place(const std::string& name, const std::string& of, const Vec3d& axis, double angle_deg, const Vec3d& move) {
    add(name, PlacedShape{of, 1.0, axis, angle_deg, move * to_m_});
  }
  void unite(const std::string& name, std::vector<std::string> of, double blend) {
    add(name, UnionShape{std::move(of), blend * to_m_});
  }
  void subtract(const std::string& name, std::vector<std::string> of, double blend) {
    add(name, DifferenceShape{std::move(of), blend * to_m_});
  }
  /// A region: the part of a shape inside another.
  void region(const std::string& name, const std::string& shape, const std::string& within) {
    add(name, IntersectionShape{{shape, within}, 0.0});
    body_.regions.push_back({name, name, false});
  }

  /// A region: a whole shape of the same name.
  void region(const std::string& name) { body_.regions.push_back({name, name, false}); }

  const ImplicitBody& body() const { return body_; }

 private:
  template <class S>
  void add(const std::string& name, S shape) {
    body_.shapes.push_back({name, std::move(shape)});
  }

  double to_m_;
  ImplicitBody body_;
};

/// The regions `hepatic_veins` and `portal_veins`, inside the shape `whole`, for edges of these lengths there [mm].
void add_veins(LiverParts& parts, double hepatic_edge, double portal_edge);

/// The vena cava, which lies in its groove at the back.
inline std::vector<LiverParts::Point> vena_cava() {
  return {{{-2, 60, -100}, 12}, {{0, 54, 0}, 12}, {{4, 46, 100}, 12}};
}

/// The vertex sets of the liver's surface: where it is held, and what it faces.
void add_liver_sets(TetMesh& mesh, const LiverOptions& options);

}  // namespace glisson::detail
