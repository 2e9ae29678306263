// shape.h — shapes of rigid tools and walls: signed distances with their gradients, each in its own frame.
//
//   own frame:      │  hand  │ z          The origin is the tip, the solid lies at z > 0: with the axes of space as its
//                   │        │ ▲          own, a tool stands above the tissue and presses along −z.
//                   └───┬────┘ └──▶ x
//   tissue ═════════════╧═══════════
#pragma once

#include <string_view>
#include <variant>

#include "glisson/field.h"
#include "glisson/math.h"
#include "glisson/words.h"

namespace glisson {

/// Flat-ended cylinder.
struct FlatPunch {
  static constexpr std::string_view kName = "punch";
  double radius = 5e-3;      ///< [m]
  double edge_radius = 0.0;  ///< radius of the rounded edge [m], at most the radius and half the length
  double length = 0.1;       ///< [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("radius", &FlatPunch::radius, "mm", above(0), "radius"),
                field("edge_radius", &FlatPunch::edge_radius, "mm", at_least(0), "radius of the rounded edge"),
                field("length", &FlatPunch::length, "mm", above(0), "length"));
  }
  Fault check() const;
};

struct Ball {
  static constexpr std::string_view kName = "ball";
  double radius = 5e-3;  ///< [m]; its centre is at z = radius

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("radius", &Ball::radius, "mm", above(0), "radius"));
  }
};

enum class TipForm {
  conical,
  bevelled,  ///< the point is at x = +radius
  blunt
};
template <>
inline constexpr Word<TipForm> kWords<TipForm>[] = {
    {"conical", TipForm::conical, "a cone"},
    {"bevelled", TipForm::bevelled, "cut by one plane, its point to the side"},
    {"blunt", TipForm::blunt, "a hemisphere"}};

/// A needle as a solid, for palpation and coarse contact; Needle pierces.
struct NeedleShape {
  static constexpr std::string_view kName = "probe";
  double diameter = 1.27e-3;  ///< [m]
  double length = 0.1;        ///< with the tip [m]
  TipForm tip = TipForm::conical;
  /// Conical: full angle of the cone; bevelled: between its plane and the shaft, at most 1.55 [rad].
  double tip_angle = 0.35;

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("diameter", &NeedleShape::diameter, "mm", above(0), "diameter"),
                field("length", &NeedleShape::length, "mm", above(0), "length with the tip"),
                field("tip", &NeedleShape::tip, "shape of the tip"),
                field("tip_angle", &NeedleShape::tip_angle, "rad", between(0.02, 3.1),
                      "full angle of the cone, or between the bevel and the shaft"));
  }
  double tip_length() const;  ///< [m]
  Fault check() const;
};

/// All of z ≥ 0.
struct Plate {
  static constexpr std::string_view kName = "plate";
  template <class Take>
  static constexpr auto fields(Take take) {
    return take();
  }
};

/// Everything outside an infinite cylinder about z: its wall seen from inside.
struct CylinderWall {
  static constexpr std::string_view kName = "wall";
  double radius = 0.05;  ///< [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(no_key("radius", &CylinderWall::radius, "m", above(0)));
  }
};

/// A box that stands on the middle of its lower face.
struct Block {
  static constexpr std::string_view kName = "block";
  Vec3d size{0.01, 0.01, 0.01};  ///< along its own x, y and z [m]
  double edge_radius = 0.0;      ///< [m], at most half the smallest size

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("size", &Block::size, "mm", above(0), "edges along its own x, y and z"),
                field("edge_radius", &Block::edge_radius, "mm", at_least(0), "radius of the rounded edges"));
  }
  Fault check() const;
};

using Shape = std::variant<FlatPunch, Ball, NeedleShape, Plate, CylinderWall, Block>;

/// Signed distance of a point from a shape, negative inside, and its gradient.
struct ShapeDistance {
  double distance = 0.0;  ///< φ [m]; never more than the true distance, and equal to it except near the rim of a bevel
  Vec3d normal{};         ///< ∇φ, a unit vector
};

/// @param x  in the frame of the shape [m]. Cost: 5 to 20 ns
ShapeDistance distance_to(const Shape& shape, const Vec3d& x);

}  // namespace glisson
