// contact.h — rigid instruments that press on the surface of a body: punches, balls, needle shapes, plates, blocks.
//
//   tool's frame:      │  hand  │ z          A shape is a signed distance φ with its outward normal, in the tool's own frame.
//                      │        │ ▲          The origin is the tip, the body of the tool lies at z > 0: with the axes of
//                      └───┬────┘ └──▶ x     space as its own, a tool stands above the tissue and presses along −z.
//   tissue ════════════════╧═══════════════
//
// At the end of a step no point of the surface may be inside the tool; an impulse along the normal moves it out, never
// a spring, so that there is no stiffness to choose and no effect on the stable step. Friction is Coulomb's cone on the
// motion relative to the tool (docs/contact.md).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "glisson/field.h"
#include "glisson/instruments/instrument.h"
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

class ContactTool;

struct ContactOptions {
  using Instrument = ContactTool;  ///< constructed from these options
  std::string name = "tool";
  Shape shape = FlatPunch{};
  double friction = 0.0;         ///< Coulomb's μ [-]; ∞: never slips while it presses
  bool bonded = false;           ///< points that touched stay in place, pulled or pressed; friction is not used
  Vec3d direction{0, 0, -1};     ///< direction of the depth; any length
  double push_out_speed = 0.05;  ///< largest speed of tissue that is inside the tool when it is attached [m/s]

  template <class Take>
  static constexpr auto fields(Take take) {
    using C = ContactOptions;
    return take(no_key("name", &C::name), no_key("shape", &C::shape),
                field("friction", &C::friction, "-", at_least(0), "Coulomb's μ against the surface")
                    .or_infinite("it never slips"),
                field("bonded", &C::bonded, "points that touched stay in place, in tension and compression"),
                no_key("direction", &C::direction).direction(),
                field("push_out_speed", &C::push_out_speed, "mm/s", above(0),
                      "largest speed of tissue that starts inside the tool"));
  }
};

/// Pressure on the tool, per vertex of the surface.
struct ContactPressure {
  std::span<const std::uint32_t> vertices;  ///< loaded vertices, ascending
  std::span<const double> pascals;  ///< normal force over a third of the present area of the triangles around it
  std::span<const Vec3d> forces;    ///< the whole force on the tissue at it, friction included [N]
};

/// A rigid tool in contact with the surface of the body, including both sides of a cut.
class ContactTool final : public Instrument {
 public:
  /// @throws std::invalid_argument naming the option, its value and the allowed range
  ContactTool(const ContactOptions& options, std::shared_ptr<ToolDriver> driver);
  ~ContactTool() override;

  /// Of the last step; valid until the next.
  ContactPressure contact_pressure() const;
  bool touches() const;             ///< in the last step
  double contact_area() const;      ///< of the loaded vertices [m²]
  double largest_pressure() const;  ///< of the last step [Pa]
  /// Rows solved in the last step, and sweeps over them.
  struct Effort {
    std::size_t vertices = 0, triangles = 0;
    int sweeps = 0;
    bool corrected = false;  ///< solved twice, so as to create no energy
  };
  Effort effort() const;
  const ContactOptions& options() const;

  InstrumentForm form() const override;
  std::string refuses_long_steps() const override;
  /// @throws std::invalid_argument where steps are long and it starts inside the body
  void attached(const BodyView& body, double time) override;
  void body_changed(const BodyView& body, std::span<const std::uint32_t> origins) override;
  std::span<const std::uint32_t> reach(double time, double h) override;
  std::optional<std::span<const std::uint32_t>> keeps() override;
  void add_forces(const InteractionStep& step) override;
  void constrain(const InteractionStep& step) override;
  void tell_held(const InteractionStep& step, HeldRows& held) const override;
  int most_drag_stages() const override;
  void moved(const InteractionStep& step) override;
  bool add_contact(std::span<Vec3d> force, std::span<double> pressing) const override;
  Vec3d handle() const override;
  void archive(Archive& ar) override;
  std::shared_ptr<const void> save_state() const override;
  void load_state(const std::shared_ptr<const void>& state, const BodyView* other_body) override;

 private:
  std::span<const InstrumentColumn> record_columns() const override;
  struct State;
  void book(const InteractionStep& step) const;
  std::unique_ptr<State> state_;
};

}  // namespace glisson
