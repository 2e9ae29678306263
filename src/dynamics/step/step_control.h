// step_control.h — chooses the step, and keeps it below h* while the tissue stiffens.
//
// h* is computed for a level of stiffness per tissue block. While every element stays below that level the step is stable and
// nothing is computed; when one rises above it, h* is computed again with a safety factor, so that a run needs few searches.
// Where a search takes too long (real time), the last h* gives a bound: for stiffness up to r times as large,
//   φ(h/r) of r K  =  (1/r) φ(h) of K  ≤ 4,   and without nodal damping φ(h/√r) of r K ≤ φ(h) of K ≤ 4.
// Where viscosity that does not grow with K limits the step, K has room: with h_K that of the tissue without viscosity,
//   φ(x h) of r K  ≤  x [ φ(h) + max(0, x r − 1) h² λ_max(K) ]  ≤  4   for   x [ 1 + max(0, x r − 1) (h/h_K)² ] = 1.
// Once in a window of steps an automatic step may grow again: where the stiffest moment of the window stayed well below the
// level, h* is computed for that moment. The window doubles each time, so that oscillating tissue costs no search a cycle.
// After a short peak the bound restores the step within a few steps.
// The stiffness in a step is known one step late: where it rises by more than the safety factor within a step, steps are
// shortened until it does not, and the level is set ahead of it. Exponential laws under impact need this.
//
// A few squashed tets would limit the step of a whole body. Those above the level of their block have their own level
// (stiffness_levels.h), and their effect on the step is bounded separately; the level of the block rises where that gives the
// longer step. The body lists these tets, so that a step in which nothing is above its level costs nothing. Every few hundred
// steps the body lists all tets that are stiffer than at rest, and the level of the block is chosen again.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/step/added_levels.h"
#include "dynamics/step/element_step_bound.h"
#include "dynamics/step/mass_levels.h"
#include "dynamics/step/stable_step.h"
#include "dynamics/step/step_rules.h"
#include "dynamics/step/stiffness_levels.h"
#include "element/body_change.h"
#include "glisson/archive.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// When a scheme takes the viscous force.
enum class Drag {
  lags,       ///< at v₋: the explicit scheme
  in_stages,  ///< in stages from v₋ on (element/drag_stages.h)
  at_once,    ///< at v₊: the semi-implicit one
};

/// How fast a stiff element changes shape: the norm of its velocity gradient [1/s].
struct ShapeRate {
  StiffElement stiff;
  double rate = 0.0;
};

/// Stiffness that acts beside the tissue.
struct AddedBeside {
  double squared_frequency = 0.0;            ///< ω² on the body's masses, from above: it shortens the step [1/s²]
  double with_mass = 0.0;                    ///< the same of what gets mass in the place of a shorter step [1/s²]
  std::span<const VertexStiffness> to_bear;  ///< what that mass is for
};

/// What a refused change of tissues leaves as it was.
struct StepChoice {
  /// h* of the scheme, and what an automatic step keeps below: at Drag::at_once also h* without viscosity, since
  /// viscosity hides what a longer step gets wrong.
  struct Limits {
    double stable = 0.0, pace = 0.0;  ///< [s]
    void archive(Archive& ar) { ar(stable, pace); }
  };
  /// Limits for a stiffening per block.
  struct Known {
    Limits limits;
    std::vector<double> level;
  };
  /// What the last search was made for.
  struct Searched : Known {
    std::vector<double> numbers;  ///< per block: shear and bulk modulus, the same of viscosity, density
  };
  /// What the last search of drag_limit_ was made for, and gave.
  struct SearchedDrag {
    double limit = 0.0;           ///< [s]
    std::vector<double> numbers;  ///< as Searched has them
  };
  /// Where the next search begins.
  struct Guess {
    StabilityGuess stable, pace;
  };

  Known now_, rest_;  ///< the present level, and the stiffness at rest
  Searched searched_;
  Guess guess_, rest_guess_;  ///< the second is from the search at rest
  bool exact_ = true;         ///< whether each level is searched
  double undragged_ = 0.0;    ///< h* of the stiffness at rest alone, from below; 0: not known [s]
  /// What drag in stages leaves of a step beside any stiffness [s].
  double drag_limit_ = std::numeric_limits<double>::infinity();
  SearchedDrag drag_searched_;
  AddedStiffness stiff_;  ///< of single tets
};

class StepControl : StepChoice {
 public:
  /// @param nodal_damping  γ_i per vertex [kg/s]; not copied: must outlive this, and follow the body
  /// @param options  step, enforce_stability and exact_steps of them
  /// @throws std::invalid_argument where the step given is not positive or above h*, unless stability is not enforced
  StepControl(const Body& body, const std::vector<double>& nodal_damping, Drag drag, const SimulationOptions& options,
              std::span<const double> stiffening);

  /// Takes in the present stiffness; lowers an automatic step where needed.
  /// @param stiff  elements above what list_above() said before it was evaluated
  /// @return false where a given step is above h* by now
  bool accept(std::span<const double> stiffening, std::span<const StiffElement> stiff);
  /// Stiffness per block from which elements have to be listed for the next accept().
  std::span<const double> list_above() const { return list_above_; }
  /// Per element, from which it has to be listed where that is more; empty: none is. Valid until the next accept() or change.
  std::span<const StiffLimit> single_limits() const;

  /// Makes ready for mesh_changed, which does so the first time. @param stars  must outlive this
  void prepare_changes(const detail::VertexStars& stars);

  /// After elements were removed, split from each other or reshaped: h* falls to a bound from single elements
  /// (element_step_bound.h). A given step above that is checked against h* itself by the next accept(), which is slow.
  void mesh_changed(const BodyChange& change, const detail::VertexStars& stars);

  /// After tissues of the body have changed: an automatic step is found anew. Where a search takes too long it comes from
  /// the last one: with moduli at most r, viscosity at most c and densities at least d times those it was made for,
  ///   φ(h/s) ≤ 4 for s = max(√(r/d), c/d), with nodal damping that grows by g also for s ≥ r/g where c ≤ g.
  /// @param undeformed  whether the stiffness is that at rest
  /// @throws std::invalid_argument where a given step is above h*; nothing has changed then
  void tissues_changed(std::span<const double> stiffening, bool undeformed);

  bool follows_changes() const { return element_bound_ != nullptr; }
  /// The body has been read; archive comes next. @param stars  where follows_changes() was true when it was written
  void body_read(const detail::VertexStars* stars);
  void archive(Archive& ar);

  /// A state is set from outside: steps are chosen as if the body had been made in it.
  void state_set(const AddedBeside& added);
  /// Whether is_violent() may be true of any.
  bool may_be_violent() const {
    return automatic_ && enforce_ &&
           std::ranges::any_of(body_.blocks, [](const TissueBlock& b) { return !is_small(b); });
  }
  /// Whether an automatic step depends on how fast an element changes shape: tissue of large strain that has stiffened.
  bool is_violent(const StiffElement& element) const;
  /// Keeps an automatic step so short that none of those is strained in it by more than a hundredth, or, where an element
  /// could be stiffer before it asked for a shorter step, by what would make it so.
  void limit_shape_change(std::span<const ShapeRate> changes);

  void set_added(const AddedBeside& added);
  /// The same after a step. An automatic step grows again by no more than kRegrowth a step where this falls: a torn membrane
  /// that whips back is slack at one step and a hundred times as stiff at the next.
  void follow_added(const AddedBeside& added);
  /// The same after archive() has read.
  void added_read(const AddedBeside& added) { take_added(added); }

  double step() const {
    if (!automatic_) return step_;
    const double room = 1.0 / (kSafety * kSafety);
    const double h =
        std::min(caution_ * with_added(step_, {room * (stiff_.k + held_), stiff_.c / kSafety}), shape_step_);
    return std::min(h, kSafety * drag_limit());
  }
  double stable_step() const {
    return std::min(with_added(now_.limits.stable, {tools_ + stiff_.k, stiff_.c}), drag_limit());
  }
  /// Variable mass scaling shortens its step where added mass has an effect. @param inertia  Σ Δm |a| over Σ |F| of what acts on the
  /// body, for the next accept() [-]
  void take_inertia(double inertia) { inertia_ = inertia; }
  /// Mass that stiff tets need beside their own for the step of variable mass scaling, where that has become other since this was
  /// asked last; ascending by vertex, others need none.
  std::optional<std::span<const VertexMass>> new_masses() {
    if (!std::exchange(masses_are_new_, false)) return std::nullopt;
    return stiff_masses_;
  }
  /// What is wrong with a given step that accept() has refused, and the ways out.
  std::string too_large() const { return too_large(stable_step()); }

 private:
  static constexpr std::uint64_t kFirstWindow = 1000, kFirstProbe = 64;  ///< [steps]

  /// A search since steps were chosen anew, and where it left the next one to begin.
  struct Search : Known {
    Guess ended;
  };

  // h* of a level
  std::vector<double> viscosity_at(std::span<const double> stiffening) const;
  Limits limits_at(std::span<const double> stiffening);
  Limits search(std::span<const double> stiffening);
  double pace_from(const Known& known, std::span<const double> stiffening) const;
  Limits bound_at(std::span<const double> stiffening) const;
  bool is_bounded() const;
  bool drag_thickens() const;
  std::vector<double> weighed(std::span<const double> stiffening) const;
  double drag_limit_of(double explicit_step) const;
  /// With the mass that variable mass scaling gives.
  double drag_limit() const { return heavy_step_ ? std::max(drag_limit_, step_ / kSafety) : drag_limit_; }
  MassNeed mass_need() const;
  void search_drag_limit();
  void scale_drag_limit();
  void limit_drag_by_elements(std::span<const std::uint32_t> shapes);
  double undragged_step(std::span<const double> level) const;
  double beside_drag(double h, double r, std::span<const double> level) const;
  double with_added(double step, const AddedStiffness& added) const;
  [[noreturn]] void refuse_above(double stable) const { throw std::invalid_argument(too_large(stable)); }
  std::string too_large(double stable) const;

  // changes of the body
  double largest_damping_rate() const;
  void look_at_body();
  void remember_search();
  std::vector<double> block_numbers() const;
  Limits scaled_from_search(std::span<const double> level) const;
  void choose_limits(std::span<const double> stiffening, bool undeformed);
  void forget_searches() { searches_.clear(), searches_made_ = 0; }
  void start_anew();

  // levels (step_levels.cpp)
  std::vector<char> thickening() const;
  void choose_heavy(double wanted);
  double step_without_masses(std::span<const double> stiffening) const;
  bool needs_mass() const;
  bool change_heavy(double wanted);
  bool follow_inertia(std::span<const double> stiffening);
  std::uint32_t heavy_part() const;
  void tell_heavy();
  void bear(std::span<const double> stiffening, std::span<const StiffElement> stiff);
  void list_from();
  void take_added(const AddedBeside& added);
  AddedStiffness added_at(std::span<const double> level);
  void take_stiff();
  void take_base(Known base);
  std::vector<double> level_of(std::span<const double> seen, double ahead) const;
  std::vector<double> risen(std::span<const double> stiffening, double ahead) const;
  std::size_t most_levels() const;
  std::span<const StiffElement> without_crowd(std::span<const StiffElement> stiff);
  bool is_crowded() const;
  bool rises(std::span<const double> stiffening, double rise);
  bool holds_at(std::span<const double> stiffening);
  void be_cautious(double rise);
  double slack(const StiffElement& stiff, double step) const;
  double pace_of(const Limits& limits, const AddedStiffness& added, std::size_t above) const;
  double pace_above(std::span<const double> level, double enough);
  void choose_base(const std::vector<double>& least, bool forced);
  void probe();
  void settle();
  void relax(std::span<const double> stiffening);

  const Body& body_;
  const std::vector<double>& nodal_damping_;
  Drag drag_;
  int drag_stages_;
  double weight_;  ///< of stiffness, see weighed()
  bool automatic_, enforce_, exact_asked_;
  bool scales_masses_;
  std::vector<Search> searches_;  ///< the first few, for a state that is set again and again
  std::size_t searches_made_ = 0;
  double step_ = 0.0;
  double damping_rate_ = 0.0;                        ///< largest γ/m [1/s]
  std::unique_ptr<ElementStepBound> element_bound_;  ///< none until the mesh changes
  double drag_part_ = 0.0;                           ///< drag_limit_ by single elements; 0: not found yet [s]
  bool unchecked_ = false;                           ///< a given step is above the bound of a mesh that has changed

  std::vector<double> seen_, lately_;  ///< largest stiffening per block in this window, in the last few steps
  std::uint64_t window_ = kFirstWindow, in_window_ = 0;
  StiffnessLevels levels_;
  std::optional<MassLevels> mass_levels_;   ///< with variable mass scaling
  std::vector<double> usual_, list_above_;  ///< stiffening per block from which elements are listed, and are now
  std::vector<double> listed_before_;       ///< the same a step ago, with variable mass scaling
  std::uint64_t probe_ = kFirstProbe, since_probe_ = 0;  ///< [steps]
  bool probes_ = false;            ///< whether more than usual is listed, to choose the level of the blocks anew
  std::vector<StiffElement> few_;  ///< the stiffest of a crowd
  std::vector<double> crowd_;      ///< per block, the stiffest of those left out; empty: none were

  std::optional<double> heavy_step_;      ///< of variable mass scaling [s]
  double bearable_inertia_;               ///< SimulationOptions::mass_scaling_inertia
  AddedLevels added_levels_;              ///< of what acts beside the tissue, for mass
  bool bears_added_ = true;               ///< whether they are above it
  double with_mass_ = 0.0;                ///< ω² of that without mass [1/s²]
  std::vector<VertexMass> stiff_masses_;  ///< for that step
  bool masses_are_new_ = false;
  double inertia_ = 0.0;       ///< see take_inertia
  double heavy_growth_ = 0.0;  ///< of the step, ln, that is still to be made
  /// Of mass that elements lack at rest: how long it has to wait after it went, since when it is there, and gone [steps].
  std::uint64_t pause_ = 0, since_came_ = 0, since_gone_ = 0;

  double tools_ = 0.0;    ///< ω² of what acts beside the tissue [1/s²]
  double held_ = 0.0;     ///< the same that an automatic step is chosen for: at least as much
  double caution_ = 1.0;  ///< factor on an automatic step while stiffness rises fast
  double shape_step_ = std::numeric_limits<double>::infinity();  ///< [s]
};

}  // namespace glisson
