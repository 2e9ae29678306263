// variable_mass_pace.h — the step that was asked for, with mass where tets do not bear it: variable mass scaling.
//
//   the step, and what the body bears at it without mass ─▶ levels of tets above that ─▶ masses of their vertices (step/mass_levels.h)
//          ▲                                                                                 │
//          └── shorter where their inertia shows, longer again where it does not ◀───────────┘
//
// At the step that the body bears without mass elements lack much at once, since their own bounds are below it. Motions near the
// stability limit grow where such mass comes and goes in turn, however safe each step is: with θ² = h² k/m in (0, 4), two steps in turn
// are stable only where both θ² are on the same side of 2. So mass that had to go again at once comes back later and later.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/pace/pace.h"
#include "dynamics/pace/restraint.h"
#include "dynamics/pace/stiff_masses.h"
#include "dynamics/step/added_levels.h"
#include "dynamics/step/mass_levels.h"

namespace glisson {

class VariableMassPace final : public Pace {
 public:
  /// @param state, ledger  must outlive this
  VariableMassPace(StepLimits limits, BodyState& state, EnergyLedger& ledger);

  bool accept(const LastStep& last) override;
  double step() const override { return restraint_.hold_back(step_, limits_, {}, drag_limit()); }
  double stable_step() const override;
  void step_made(double h) override { masses_.step_made(h); }
  /// Tets that are well below their levels need not be told, but those whose levels come down next.
  std::span<const StiffLimit> single_limits() const override { return levels_.limits(); }
  bool gives_mass() const override { return true; }
  void set_added(const AddedBeside& added) override;
  void follow_added(const AddedBeside& added) override;
  void state_set(const AddedBeside& added, MovingBody& moving) override;
  void mesh_changed(const BodyChange& change, const detail::VertexStars& stars) override;
  void tissues_changed(std::span<const double> stiffening, bool undeformed) override;
  void body_read(const detail::VertexStars* stars) override;
  void archive(Archive& ar, MovingBody& moving) override;

 private:
  /// With the mass that is given.
  double drag_limit() const;
  void take_added(const AddedBeside& added) override;
  void start_anew();
  void choose(double wanted);
  MassNeed mass_need() const;
  bool needs_mass() const;
  bool change_step(double wanted);
  double step_without_masses(std::span<const double> stiffening) const;
  bool follow_inertia(std::span<const double> stiffening);
  void bear(std::span<const double> stiffening, std::span<const StiffElement> stiff);
  void find_masses();
  void give_masses(MovingBody& moving);
  void list_from();
  std::uint32_t settling_part() const;
  void tell_settling();

  double longest_;           ///< the step that was asked for [s]
  double bearable_inertia_;  ///< SimulationOptions::mass_scaling_inertia
  Restraint restraint_;
  MassLevels levels_;
  AddedLevels added_levels_;        ///< of what acts beside the tissue, for mass
  bool bears_added_ = true;         ///< whether that is below them
  double with_mass_ = 0.0;          ///< ω² of it without mass [1/s²]
  std::vector<VertexMass> wanted_;  ///< masses for the step
  bool masses_are_new_ = false;     ///< whether they are to be given
  StiffMasses masses_;              ///< that vertices have
  EnergyLedger* ledger_;            ///< null: energies are not tracked
  double inertia_ = 0.0;            ///< of them, Σ Δm |a| over Σ |F| of what acts on the body, in the last step [-]
  double growth_ = 0.0;             ///< of the step, ln, that is still to be made
  std::vector<double> listed_before_;  ///< stiffness per block from which elements were listed a step ago
  std::uint64_t steps_ = 0;            ///< since steps were chosen anew
  /// Of mass that elements lack at rest: how long it has to wait after it went, since when it is there, and gone [steps].
  std::uint64_t pause_ = 0, since_came_ = 0, since_gone_ = 0;
};

}  // namespace glisson
