// heat_places.h — what is read of a temperature at places of the mesh at rest: points, lines, planes, isotherms.
//
// Values are given at the vertices and linear within tets. Where a place lies in the mesh is found once.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "glisson/mesh.h"

namespace glisson {

/// Points of a body, as thermocouples are.
class HeatPoints {
 public:
  HeatPoints() = default;
  /// @param points  at rest [m] @throws std::invalid_argument naming the first that lies outside the body
  HeatPoints(const TetMesh& mesh, std::span<const Vec3d> points);
  /// @param values  of all vertices @return  one a point
  std::vector<double> read(std::span<const double> values) const;
  std::size_t size() const { return places_.size(); }

 private:
  struct Place {
    std::array<std::uint32_t, 4> vertices{};
    std::array<double, 4> weights{};
  };
  std::vector<Place> places_;
};

/// A straight line through a body, read at points that are an eighth of a mean tet's edge apart and linear between these. What of it lies
/// outside the body does not count.
class HeatLine {
 public:
  /// @param from,to  its ends at rest [m] @throws std::invalid_argument where it has no length or misses the body
  HeatLine(const TetMesh& mesh, const Vec3d& from, const Vec3d& to);
  /// Length on which a value is below a level [m].
  double length_below(std::span<const double> values, double level) const;
  /// ∫ value ds [value · m]: of shares the length that they stand for.
  double integral(std::span<const double> values) const;

 private:
  HeatPoints points_;
  std::vector<char> joined_;  ///< 1: from this point to the next the line is in the body
  double spacing_ = 0.0;      ///< [m]
};

/// A plane through a body.
class HeatPlane {
 public:
  struct Section {
    double area = 0.0;   ///< [m²]
    double width = 0.0;  ///< largest extent within the plane, of all directions half a degree apart [m]
  };
  /// @param point  on it [m] @param normal  of any length @throws std::invalid_argument where it misses the body
  HeatPlane(const TetMesh& mesh, const Vec3d& point, const Vec3d& normal);
  /// What of it is below a level.
  Section below(std::span<const double> values, double level) const;

 private:
  struct Corner {
    std::uint32_t a = 0, b = 0;
    double share = 0.0;          ///< of b
    std::array<double, 2> at{};  ///< in the plane [m]
  };
  std::vector<std::array<Corner, 3>> triangles_;
};

/// What of a body is below a level: its volume and the box around it; nothing: a volume of 0 and a box without size.
struct IsothermExtent {
  double volume = 0.0;  ///< [m³]
  Vec3d low{}, high{};  ///< [m]
};
IsothermExtent isotherm_extent(const TetMesh& mesh, std::span<const double> values, double level);

}  // namespace glisson
