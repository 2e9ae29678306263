// step_limits.h — h* of a scheme at a level of stiffness: searched for, or bounded by what a search has found.
//
// h* is computed for a level of stiffness per tissue block. Where a search takes too long (real time), the last h* gives a bound: for
// stiffness up to r times as large,
//   φ(h/r) of r K  =  (1/r) φ(h) of K  ≤ 4,   and without nodal damping φ(h/√r) of r K ≤ φ(h) of K ≤ 4.
// Where viscosity that does not grow with K limits the step, K has room: with h_K that of the tissue without viscosity,
//   φ(x h) of r K  ≤  x [ φ(h) + max(0, x r − 1) h² λ_max(K) ]  ≤  4   for   x [ 1 + max(0, x r − 1) (h/h_K)² ] = 1.
// A body that has changed has a bound from its single elements (element_step_bound.h); other tissues have one from the last search: with
// moduli at most r, viscosity at most c and densities at least d times those it was made for,
//   φ(h/s) ≤ 4 for s = max(√(r/d), c/d), with nodal damping that grows by g also for s ≥ r/g where c ≤ g.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
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
  lags,       ///< at v₋: the explicit scheme
  in_stages,  ///< in stages from v₋ on (element/drag_stages.h)
  at_once,    ///< at v₊: the semi-implicit one
};

class StepLimits {
 public:
  /// h* of the scheme, and what an automatic step keeps below: at Drag::at_once also h* without viscosity, since viscosity hides what
  /// a longer step gets wrong.
  struct Limits {
    double stable = 0.0, pace = 0.0;  ///< [s]
    void archive(Archive& ar) { ar(stable, pace); }
  };
  /// Limits for a stiffening per block.
  struct Known {
    Limits limits;
    std::vector<double> level;
    void archive(Archive& ar) { ar(limits), ar.same_size(level); }
  };
  /// What is known of a body, for going back to.
  struct Knowledge {
    /// What the last search was made for.
    struct Searched : Known {
      std::vector<double> numbers;  ///< per block: shear and bulk modulus, the same of viscosity, density
    };
    /// What the last search of drag_limit was made for, and gave.
    struct SearchedDrag {
      double limit = 0.0;           ///< [s]
      std::vector<double> numbers;  ///< as Searched has them
    };
    /// Where the next search begins.
    struct Guess {
      StabilityGuess stable, pace;
    };

    Known rest;
    Searched searched;
    Guess guess, rest_guess;  ///< the second is from the search at rest
    bool exact = true;        ///< whether each level is searched
    double undragged = 0.0;   ///< h* of the stiffness at rest alone, from below; 0: not known [s]
    /// What drag in stages leaves of a step beside any stiffness [s].
    double drag_limit = std::numeric_limits<double>::infinity();
    SearchedDrag drag_searched;
  };

  /// @param nodal_damping  γ_i per vertex [kg/s]; not copied: must outlive this, and follow the body
  /// @param stiffening  at rest
  StepLimits(const Body& body, const std::vector<double>& nodal_damping, Drag drag, const SimulationOptions& options,
             std::span<const double> stiffening);

  const Body& body() const { return body_; }
  Drag drag() const { return drag_; }
  int drag_stages() const { return drag_stages_; }
  double weight() const { return weight_; }
  const Known& rest() const { return known_.rest; }
  double drag_limit() const { return known_.drag_limit; }
  /// Whether limits at a level follow from those at another: where C stays what it is, or its force lags.
  bool is_bounded() const;

  /// Limits at a level, by a search where searches are asked for. @param now  known by now
  Limits find(const Known& now, std::span<const double> level) {
    return known_.exact ? search(level) : bound(now, level);
  }
  /// By a search. The same searches follow from the same start: those that were made then are not made again.
  Limits search(std::span<const double> level);
  /// From what is known by now or at rest, whichever gives more.
  Limits bound(const Known& now, std::span<const double> level) const;
  /// The second of these from what is known at a level, from below [s].
  double pace_from(const Known& known, std::span<const double> level) const;
  /// What is left of a step of the tissue alone when stiffness and viscosity act beside it [s].
  double with_added(double step, const AddedStiffness& added) const;
  /// What a step is to be found for: the seen stiffness with room, not below that at rest.
  std::vector<double> with_room(std::span<const double> seen, double ahead) const;
  /// Per block, whether its viscosity grows with its stiffness.
  std::vector<char> thickening() const;

  /// Makes ready for mesh_changed, which does so the first time. @param stars  must outlive this
  void prepare_changes(const detail::VertexStars& stars);
  /// After elements were removed, split from each other or reshaped: limits fall to a bound from single elements.
  /// @param now  falls, too
  void mesh_changed(const BodyChange& change, const detail::VertexStars& stars, Known& now);
  /// After tissues of the body have changed. @param undeformed  whether the stiffness is that at rest
  /// @return what is known of the present stiffness
  Known choose(std::span<const double> stiffening, bool undeformed);
  /// They are taken.
  void tissues_taken();
  bool follows_changes() const { return element_bound_ != nullptr; }
  /// The body has been read; archive comes next. @param stars  where follows_changes() was true when it was written
  void body_read(const detail::VertexStars* stars);
  /// Searches begin as in a body that was just made.
  void start_anew();
  const Knowledge& knowledge() const { return known_; }
  void go_back(const Knowledge& known) { known_ = known; }
  void archive(Archive& ar);

 private:
  /// A search since steps were chosen anew, and where it left the next one to begin.
  struct Search : Known {
    Knowledge::Guess ended;
  };

  std::vector<double> viscosity_at(std::span<const double> level) const;
  std::vector<double> weighed(std::span<const double> level) const;
  Limits search_anew(std::span<const double> level);
  bool drag_thickens() const;
  double drag_limit_of(double explicit_step) const;
  void search_drag_limit();
  void scale_drag_limit();
  void limit_drag_by_elements(std::span<const std::uint32_t> shapes);
  double undragged_step(std::span<const double> level) const;
  double beside_drag(double h, double r, std::span<const double> level) const;
  double largest_damping_rate() const;
  void look_at_body();
  void remember_search();
  void forget_searches() { searches_.clear(), searches_made_ = 0; }
  std::vector<double> block_numbers() const;
  Limits scaled_from_search(std::span<const double> level) const;

  const Body& body_;
  const std::vector<double>& nodal_damping_;
  Drag drag_;
  int drag_stages_;
  double weight_;  ///< of stiffness, see weighed()
  bool exact_asked_, scales_masses_;
  double damping_rate_ = 0.0;  ///< largest γ/m [1/s]
  Knowledge known_;
  std::vector<Search> searches_;  ///< the first few, for a state that is set again and again
  std::size_t searches_made_ = 0;
  std::unique_ptr<ElementStepBound> element_bound_;  ///< none until the mesh changes
  double drag_part_ = 0.0;                           ///< drag limit by single elements; 0: not found yet [s]
};

}  // namespace glisson
