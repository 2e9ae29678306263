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
#include <vector>

#include "glisson/contact/shape.h"
#include "glisson/field.h"
#include "glisson/instruments/instrument.h"

namespace glisson {

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
  void declare(const InteractionStep& step, StepRows& rows, int round) override;
  void solved(const InteractionStep& step, const StepRows& rows) override;
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
  std::unique_ptr<State> state_;
};

}  // namespace glisson
