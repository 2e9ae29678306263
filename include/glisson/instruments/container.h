// container.h — a rigid vessel around tissue, with sensors for the load on its bottom and its sides.
//
//      │        │      open at the top; the pose is at the centre of the floor, z points up
//      │ tissue │
//      └────────┘      loads are forces of the tissue on the container: a block at rest loads the bottom by −z
//
// From free to bonded: friction 0 lets tissue slide and lift off; μ is Coulomb's; infinite μ does not slip while it
// presses; `holds_floor` and `holds_wall` prevent lift-off but allow sliding, as in a wet vessel; `bonded` fixes points
// that touched. In slow motion tool and container balance (docs/contact.md).
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <variant>

#include "glisson/field.h"
#include "glisson/instruments/instrument.h"

namespace glisson {

struct CylinderVessel {
  static constexpr std::string_view kName = "cylinder";
  double radius = 0.05;                                     ///< inner radius [m]
  double height = std::numeric_limits<double>::infinity();  ///< of the wall [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("radius", &CylinderVessel::radius, "mm", above(0), "inner radius").must(),
                field("height", &CylinderVessel::height, "mm", above(0), "height of the wall")
                    .otherwise("unlimited")
                    .or_infinite("the wall has no end"));
  }
};

struct BoxVessel {
  static constexpr std::string_view kName = "box";
  double width = 0.04, length = 0.04;                       ///< inner size along x and y [m]
  double height = std::numeric_limits<double>::infinity();  ///< of the walls [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("width", &BoxVessel::width, "mm", above(0), "inner width, along x").must(),
                field("length", &BoxVessel::length, "mm", above(0), "inner length, along y").must(),
                field("height", &BoxVessel::height, "mm", above(0), "height of the walls")
                    .otherwise("unlimited")
                    .or_infinite("the walls have no end"));
  }
};

struct ContainerOptions {
  std::string name = "container";
  std::variant<CylinderVessel, BoxVessel> vessel = CylinderVessel{};
  Pose pose{};                   ///< centre of the floor; its z is up
  double friction = 0.0;         ///< Coulomb's μ [-], may be infinite
  bool holds_floor = false;      ///< tissue on the floor does not lift off
  bool holds_wall = false;       ///< tissue at the wall does not lift off
  bool bonded = false;           ///< points that touched stay in place; friction is not used
  double push_out_speed = 0.05;  ///< largest speed of tissue that is outside the vessel when it is attached [m/s]

  template <class Take>
  static constexpr auto fields(Take take) {
    using C = ContainerOptions;
    return take(no_key("name", &C::name), no_key("vessel", &C::vessel), no_key("pose", &C::pose),
                field("friction", &C::friction, "-", at_least(0), "Coulomb's μ").or_infinite("tissue never slips"),
                no_key("holds_floor", &C::holds_floor), no_key("holds_wall", &C::holds_wall),
                no_key("bonded", &C::bonded),
                field("push_out_speed", &C::push_out_speed, "mm/s", above(0),
                      "largest speed of tissue that starts outside the vessel"));
  }
};

/// What the container's sensors carry: forces of the tissue on it [N], at Simulation::force_time().
struct ContainerLoads {
  Vec3d bottom{};            ///< on the floor
  Vec3d side{};              ///< on the whole wall
  double side_radial = 0.0;  ///< Σ f·n over the wall, n pointing out of the vessel: positive where tissue presses
  Vec3d total() const { return bottom + side; }
};

class Container final : public Interaction {
 public:
  /// @throws std::invalid_argument naming the option, its value and the allowed range
  explicit Container(const ContainerOptions& options);
  ~Container() override;

  const ContainerLoads& sensor_loads() const;  ///< of the last step
  Vec3d up() const;                            ///< the z of its pose; axial loads are along it
  const ContainerOptions& options() const;

  std::string label() const override { return "the container"; }
  void attached(const BodyView& body, double time) override;
  void body_changed(const BodyView& body, std::span<const std::uint32_t> origins) override;
  std::span<const std::uint32_t> reach(double time, double h) override;
  std::optional<std::span<const std::uint32_t>> keeps() override;
  std::optional<std::span<const std::uint32_t>> rests() override;
  void state_set(std::span<const Vec3d> displacement) override;
  std::string refuses_long_steps() const override { return {}; }
  void set_long_steps(bool are_long) override;
  void declare(const InteractionStep& step, StepRows& rows, int round) override;
  void solved(const InteractionStep& step, const StepRows& rows) override;
  int most_drag_stages() const override;
  void moved(const InteractionStep& step) override;
  bool add_contact(std::span<Vec3d> force, std::span<double> pressing) const override;
  void archive(Archive& ar) override;
  std::shared_ptr<const void> save_state() const override;
  void load_state(const std::shared_ptr<const void>& state, const BodyView* other_body) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace glisson
