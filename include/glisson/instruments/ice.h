// ice.h — tets that freeze while a body moves: they become stiffer in the shape that they have at that time.
//
//   auto ice = std::make_shared<Ice>(IceOptions{.factor = 100});
//   simulation.attach(ice);
//   ice->set_shares(simulation, tets, shares);      between steps; 0 melted … 1 frozen
//
// Forces are continuous where tissue freezes; strain from then on meets the stiffness of ice. What thaws loses its ice and the force of it,
// and goes by the law of its tissue again. Tissue itself is evaluated as without ice: a body with none of it takes the same steps, and
// frozen tets cost some 0.1 µs more each in a step. Law: docs/heat.md.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "glisson/field.h"
#include "glisson/simulation/interaction.h"

namespace glisson {

struct IceOptions {
  /// Stiffness of what is frozen over that of its tissue at rest: λ and μ alike [-].
  double factor = 100.0;
  /// The same of viscosity; other than 1 it needs `implicit` or `quasi_static` [-].
  double viscosity_factor = 1.0;
  /// Share of its volume by which tissue grows when it freezes; water alone: 0.09 [-].
  double expansion = 0.0;

  template <class Take>
  static constexpr auto fields(Take take) {
    using I = IceOptions;
    return take(
        field("factor", &I::factor, "-", between(1, 10000),
              "stiffness of frozen tissue over that of the tissue at rest, for strain from freezing on")
            .advise("steps of central_difference become shorter by its root; integrator = \"implicit\" has none"),
        field("viscosity_factor", &I::viscosity_factor, "-", between(1, 10000),
              "the same of viscosity; other than 1 it needs implicit or quasi_static"),
        field("expansion", &I::expansion, "-", between(0, 0.1),
              "share of its volume by which tissue grows as it freezes; 0.09 is that of water"));
  }
};

/// Ice in a body. It acts on frozen tets alone.
class Ice final : public Interaction {
 public:
  /// @throws std::invalid_argument naming the option, its value and the allowed range
  explicit Ice(const IceOptions& options = {});
  ~Ice() override;

  const IceOptions& options() const;
  /// Sets how much of each tet is frozen, between steps or in Interaction::between_steps; the others stay. Removed tets are ignored, and
  /// one that is nearly flat or inverted starts to freeze at a later call.
  /// @param simulation  that it is attached to @param shares  one a tet, 0 … 1
  /// @throws std::invalid_argument for a tet or share that is none, or where a given step is too large for the ice; nothing is changed then
  /// Cost: some 0.3 µs a tet, and a pass over the vertices of the body.
  void set_shares(Simulation& simulation, std::span<const std::uint32_t> tets, std::span<const double> shares);
  double share(std::uint32_t tet) const;  ///< 0 for a tet that is not frozen or does not exist
  std::size_t frozen_tets() const;        ///< with a share above 0
  /// Cauchy stress that ice adds in a tet, at force_time() [Pa]; 0 where it is not frozen.
  Mat3d stress(std::uint32_t tet) const;
  double energy() const override;  ///< stored, at force_time() [J]
  /// By what has thawed (below 0), expanded or been removed, so far [J].
  double changed_energy() const override;

  std::string label() const override { return "ice"; }
  void attached(const BodyView& body, double time) override;
  void body_changed(const BodyView& body, std::span<const std::uint32_t> origins) override;
  std::span<const std::uint32_t> reach(double time, double h) override;
  std::optional<std::span<const std::uint32_t>> keeps() override;
  int most_drag_stages() const override;
  void add_forces(const InteractionStep& step) override;
  std::string refuses_long_steps() const override { return {}; }
  void set_long_steps(bool are_long) override;
  bool constrains_long_steps() const override { return false; }
  void add_forces_at(std::span<const Vec3d> displacement, std::span<Vec3d> force) override;
  void add_viscous_forces_at(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity,
                             std::span<Vec3d> force) override;
  void add_tet_stiffness(std::vector<TetStiffness>& all, double rate) const override;
  double squared_frequency() const override;
  bool add_stiffness_bound(std::vector<VertexStiffness>& all) const override;
  void state_set(std::span<const Vec3d> displacement) override;
  void archive(Archive& ar) override;
  std::shared_ptr<const void> save_state() const override;
  void load_state(const std::shared_ptr<const void>& state, const BodyView* other_body) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace glisson
