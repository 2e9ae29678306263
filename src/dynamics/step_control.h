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
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "dynamics/checkpoint.h"
#include "dynamics/part_bound.h"
#include "dynamics/stable_step.h"
#include "glisson/simulation.h"
#include "mechanics/body_change.h"

namespace glisson {

/// When a scheme takes the viscous force.
enum class Drag {
  lags,     ///< at v₋: the explicit scheme
  at_once,  ///< at v₊: the semi-implicit one
};

class StepControl {
 public:
  /// @param nodal_damping  γ_i per vertex [kg/s]; not copied: must last until mesh_changed names another
  /// @param options  step, enforce_stability and exact_steps of them
  /// @throws std::invalid_argument where the step given is not positive or above h*, unless stability is not enforced
  StepControl(const Body& body, std::span<const double> nodal_damping, Drag drag, const SimulationOptions& options,
              std::span<const double> stiffening);

  /// Takes in the present stiffness; lowers an automatic step where needed.
  /// @return false where a given step is above h* by now
  bool accept(std::span<const double> stiffening);

  /// Makes ready for mesh_changed, which does so the first time. @param stars  must outlive this
  void prepare_changes(const detail::VertexStars& stars);

  /// After elements were removed, split from each other or reshaped: h* falls to a bound from single elements
  /// (part_bound.h). A given step above that is checked against h* itself by the next accept(), which is slow.
  void mesh_changed(std::span<const double> nodal_damping, const BodyChange& change, const detail::VertexStars& stars);

  /// After tissues of the body have changed: an automatic step is found anew. Where a search takes too long it comes from
  /// the last one: with moduli at most r, viscosity at most c and densities at least d times those it was made for,
  ///   φ(h/s) ≤ 4 for s = max(√(r/d), c/d), with nodal damping that grows by g also for s ≥ r/g where c ≤ g.
  /// @param undeformed  whether the stiffness is that at rest
  /// @throws std::invalid_argument where a given step is above h*; nothing has changed then
  void tissues_changed(std::span<const double> stiffening, bool undeformed);

  void save(CheckpointWriter& out) const;
  void load(CheckpointReader& in);

  /// A state was set from outside: what its stiffness differs from that before is no rise within a step.
  void state_set(std::span<const double> stiffening) { last_.assign(stiffening.begin(), stiffening.end()); }
  /// Whether the next automatic step depends on how fast tets change shape: tissue of large strain that has stiffened.
  bool is_violent(std::span<const double> stiffening) const;
  /// Keeps an automatic step so short that no tet is strained by more than a hundredth in it.
  /// @param rate  largest norm of a tet's velocity gradient [1/s]; 0: no limit
  void limit_shape_change(double rate);

  /// Stiffness that acts beside the tissue. @param squared_frequency  ω² on the body's masses, from above [1/s²]
  void set_beside(double squared_frequency) { beside_ = squared_frequency; }

  double step() const {
    const double h = std::min(step_ * caution_, shape_step_);
    return automatic_ ? with_beside(h, beside_ / (kSafety * kSafety)) : h;
  }
  double stable_step() const { return with_beside(limits_.stable, beside_); }

 private:
  static constexpr double kSafety = 0.9;               ///< automatic step over h*
  static constexpr std::uint64_t kFirstWindow = 1000;  ///< [steps]

  /// h* of the scheme, and what an automatic step keeps below: at Drag::at_once also h* without viscosity, since
  /// viscosity hides what a longer step gets wrong.
  struct Limits {
    double stable = 0.0, pace = 0.0;  ///< [s]
  };
  /// What a search was made for.
  struct Searched {
    Limits limits;
    std::vector<double> level;    ///< stiffening per block
    std::vector<double> numbers;  ///< per block: shear and bulk modulus, the same of viscosity, density
  };
  /// How steps are chosen, all that a refused change of tissues leaves as it was.
  struct Chosen {
    StabilityGuess guess, pace_guess;
    Limits limits, rest_limits;
    std::vector<double> validated, rest_level;
    Searched searched;
    bool exact;
  };
  Chosen chosen() const;
  void restore(Chosen chosen);
  std::vector<double> block_numbers() const;
  Limits scaled_from_search(std::span<const double> level) const;
  void choose_limits(std::span<const double> stiffening, bool undeformed);
  bool search_is_needed() const;
  double with_beside(double step, double squared_frequency) const;
  std::vector<double> viscosity_at(std::span<const double> stiffening) const;
  Limits limits_at(std::span<const double> stiffening);
  Limits bound_at(std::span<const double> stiffening) const;
  [[noreturn]] void refuse_above(double stable) const;
  bool rises(std::span<const double> stiffening, double rise);
  double watch_rise(std::span<const double> stiffening);
  std::vector<double> level_of(std::span<const double> seen, double ahead) const;
  void relax(std::span<const double> stiffening);
  void come_back();

  const Body& body_;
  std::span<const double> nodal_damping_;
  Drag drag_;
  bool automatic_, enforce_, exact_asked_, exact_;
  bool scales_masses_;
  StabilityGuess guess_, pace_guess_;
  double step_ = 0.0;
  Limits limits_;
  std::unique_ptr<PartBound> part_bound_;  ///< none until the mesh changes
  bool unchecked_ = false;                 ///< a given step is above the bound of a mesh that has changed
  std::vector<double> validated_;          ///< stiffening per block up to which step_ is known to be stable
  std::vector<double> rest_level_;
  Limits rest_limits_;  ///< for rest_level_, the stiffness at rest
  Searched searched_;
  std::vector<double> seen_;  ///< largest stiffening per block in this window
  std::uint64_t window_ = kFirstWindow, in_window_ = 0;
  std::vector<double> lately_;                                   ///< the same of the last few steps
  std::vector<double> last_;                                     ///< of the last step
  double shape_step_ = std::numeric_limits<double>::infinity();  ///< [s]
  double beside_ = 0.0;                                          ///< ω² of what acts beside the tissue [1/s²]
  double caution_ = 1.0;  ///< factor on an automatic step while stiffness rises fast
};

}  // namespace glisson
