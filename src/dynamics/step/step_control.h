// step_control.h — chooses the step, and keeps it below h* while the tissue stiffens.
//
// h* is computed for a level of stiffness per tissue block. While every element stays below that level the
// step is known to be stable and nothing is computed; when one rises above it, h* is computed anew with
// room to grow, so that the spectrum is visited a few times in a run, not each step. Where that takes too long
// (real time), the last h* gives a bound: for stiffness up to r times as large,
//   φ(h/r) of r K  =  (1/r) φ(h) of K  ≤ 4,   and without nodal damping φ(h/√r) of r K ≤ φ(h) of K ≤ 4.
// Once in a window of steps an automatic step may grow again: where the window's stiffest moment stayed well below the
// level, h* is computed for that. Each time the window doubles, so that tissue that swings costs no search a swing. After a
// short peak the bound brings it back within a few steps.
// A step is taken with the stiffness of the one before: where that rises by more than the room within a step, steps are
// shortened until it does not, and the level runs ahead of it. Exponential laws under impact need this.
//
// A few tets that are squashed would hold the step of a whole body. Those above the level of their block get one of their own
// (stiffness_levels.h), and what they take off the step is bounded by itself; the level of the block rises where that says
// more. The body lists which they are, so that a step in which nothing is above its level costs nothing. Once in a while the
// body is asked for all that is stiffer than at rest, and the level of the block is chosen anew.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "dynamics/step/element_step_bound.h"
#include "dynamics/step/stable_step.h"
#include "dynamics/step/stiffness_levels.h"
#include "element/body_change.h"
#include "glisson/archive.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// When a scheme takes the viscous force.
enum class Drag {
  lags,     ///< at v₋: the explicit scheme
  at_once,  ///< at v₊: the semi-implicit one
};

/// How fast a stiff element changes shape: the norm of its velocity gradient [1/s].
struct ShapeRate {
  StiffElement stiff;
  double rate = 0.0;
};

class StepControl {
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
  void state_set();
  /// Whether an automatic step depends on how fast an element changes shape: tissue of large strain that has stiffened.
  bool is_violent(const StiffElement& element) const;
  /// Keeps an automatic step so short that none of those is strained in it by more than a hundredth, or, where an element
  /// could be stiffer before it asked for a shorter step, by what would make it so.
  void limit_shape_change(std::span<const ShapeRate> changes);

  /// Stiffness that acts beside the tissue. @param squared_frequency  ω² on the body's masses, from above [1/s²]
  void set_added(double squared_frequency);
  /// The same after a step. An automatic step grows again by no more than kRegrowth a step where this falls: a torn membrane
  /// that whips back is slack at one step and a hundred times as stiff at the next.
  void follow_added(double squared_frequency);

  double step() const {
    if (!automatic_) return step_;
    const double room = 1.0 / (kSafety * kSafety);
    return std::min(caution_ * with_added(step_, {room * (stiff_.k + held_), stiff_.c / kSafety}), shape_step_);
  }
  double stable_step() const { return with_added(limits_.stable, added_); }
  /// What is wrong with a given step that accept() has refused, and the ways out.
  std::string too_large() const { return too_large(stable_step()); }

 private:
  static constexpr double kSafety = 0.9;                                 ///< automatic step over h*
  static constexpr double kRegrowth = 1.015;                             ///< of a step that tools held short
  static constexpr std::uint64_t kFirstWindow = 1000, kFirstProbe = 64;  ///< [steps]

  /// h* of the scheme, and what an automatic step keeps below: at Drag::at_once also h* without viscosity, since
  /// viscosity hides what a longer step gets wrong.
  struct Limits {
    double stable = 0.0, pace = 0.0;  ///< [s]
    void archive(Archive& ar) { ar(stable, pace); }
  };
  /// What a search was made for.
  struct Searched {
    Limits limits;
    std::vector<double> level;    ///< stiffening per block
    std::vector<double> numbers;  ///< per block: shear and bulk modulus, the same of viscosity, density
  };
  /// A search since steps were chosen anew, and where it left the next one to begin.
  struct Search {
    std::vector<double> level;
    Limits limits;
    StabilityGuess guess, pace_guess;
  };
  /// How steps are chosen, all that a refused change of tissues leaves as it was.
  struct Chosen {
    StabilityGuess guess, pace_guess, rest_guess, rest_pace_guess;
    Limits limits, rest_limits;
    std::vector<double> validated, rest_level;
    Searched searched;
    bool exact;
    AddedStiffness stiff;
  };
  Chosen chosen() const;
  void restore(Chosen chosen);
  std::vector<double> block_numbers() const;
  Limits scaled_from_search(std::span<const double> level) const;
  void choose_limits(std::span<const double> stiffening, bool undeformed);
  bool search_is_needed() const;
  void join_added() { added_ = {tools_ + stiff_.k, stiff_.c}; }
  AddedStiffness added_at(std::span<const double> level);
  double pace_of(const Limits& limits, const AddedStiffness& added, std::size_t above) const;
  double pace_above(std::span<const double> level, double enough);
  bool may_gain() const;
  void take_stiff();
  double with_added(double step, const AddedStiffness& added) const;
  std::vector<double> viscosity_at(std::span<const double> stiffening) const;
  Limits limits_at(std::span<const double> stiffening);
  Limits search(std::span<const double> stiffening);
  void forget_searches() { searches_.clear(), searches_made_ = 0; }
  bool drag_thickens() const;
  Limits bound_at(std::span<const double> stiffening) const;
  [[noreturn]] void refuse_above(double stable) const { throw std::invalid_argument(too_large(stable)); }
  std::string too_large(double stable) const;
  bool rises(std::span<const double> stiffening, double rise);
  bool holds_at(std::span<const double> stiffening);
  void take_base(std::vector<double> level, const Limits& limits);
  std::size_t most_levels() const;
  bool is_crowd(std::size_t tets) const;
  bool is_crowded() const;
  void choose_base(const std::vector<double>& least, bool forced);
  std::span<const StiffElement> without_crowd(std::span<const StiffElement> stiff);
  bool is_bounded() const;
  double largest_damping_rate() const;
  double slack(const StiffElement& stiff, double step) const;
  void be_cautious(double rise);
  void start_anew();
  void keep_guess() { rest_guess_ = guess_, rest_pace_guess_ = pace_guess_; }
  void list_from();
  void settle();
  void probe();
  std::vector<double> level_of(std::span<const double> seen, double ahead) const;
  void relax(std::span<const double> stiffening);
  void come_back();

  const Body& body_;
  const std::vector<double>& nodal_damping_;
  Drag drag_;
  bool automatic_, enforce_, exact_asked_, exact_;
  bool scales_masses_;
  StabilityGuess guess_, pace_guess_;
  StabilityGuess rest_guess_, rest_pace_guess_;  ///< from the search at rest: where those of a new start begin
  std::vector<Search> searches_;                 ///< the first few, for a state that is set again and again
  std::size_t searches_made_ = 0;
  double step_ = 0.0;
  Limits limits_;
  std::unique_ptr<ElementStepBound> element_bound_;  ///< none until the mesh changes
  bool unchecked_ = false;                           ///< a given step is above the bound of a mesh that has changed
  std::vector<double> validated_;                    ///< stiffening per block up to which step_ is known to be stable
  std::vector<double> rest_level_;
  Limits rest_limits_;  ///< for rest_level_, the stiffness at rest
  Searched searched_;
  std::vector<double> seen_;  ///< largest stiffening per block in this window
  std::uint64_t window_ = kFirstWindow, in_window_ = 0;
  std::vector<double> lately_;                                   ///< the same of the last few steps
  double shape_step_ = std::numeric_limits<double>::infinity();  ///< [s]
  StiffnessLevels levels_;
  std::vector<double> usual_, list_above_;  ///< stiffening per block from which elements are listed, and are now
  std::uint64_t probe_ = kFirstProbe, since_probe_ = 0;  ///< [steps]
  std::vector<StiffElement> few_;                        ///< the stiffest of a crowd
  std::vector<double> crowd_;     ///< per block, the stiffest of those left out; empty: none were
  bool probes_ = false;           ///< whether more than usual is listed, to choose the level of the blocks anew
  double damping_rate_ = 0.0;     ///< largest γ/m [1/s]
  double tools_ = 0.0;            ///< ω² of what acts beside the tissue [1/s²]
  double held_ = 0.0;             ///< the same that an automatic step is chosen for: at least as much
  AddedStiffness stiff_, added_;  ///< of single tets; of both
  double caution_ = 1.0;          ///< factor on an automatic step while stiffness rises fast
};

}  // namespace glisson
