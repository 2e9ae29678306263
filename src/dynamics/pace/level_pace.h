// level_pace.h — steps that are stable by a level of stiffness per tissue block, and levels of single tets.
//
// A few squashed tets would limit the step of a whole body. Those above the level of their block have their own level
// (stiffness_levels.h), and their effect on the step is bounded separately. The body lists these tets, so that a step in which nothing is
// above its level costs nothing.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dynamics/pace/pace.h"
#include "dynamics/step/stiffness_levels.h"

namespace glisson {

class LevelPace : public Pace {
 public:
  bool accept(const LastStep& last) final;
  double stable_step() const final;
  void mesh_changed(const BodyChange& change, const detail::VertexStars& stars) final;

 protected:
  LevelPace(StepLimits limits, bool enforces) : Pace(std::move(limits), enforces), levels_(body()) {}

  /// Tets have risen above their levels, and have others. @param rise  how many times as stiff as a step before the worst of them is
  /// @return false where a given step does not support it
  virtual bool rises(std::span<const double> stiffening, double rise) = 0;
  /// All are below their levels.
  virtual void is_calm() {}
  /// The stiffness is taken in. @return as accept()
  virtual bool settles(std::span<const double> stiffening) = 0;
  /// The step has been found.
  virtual void hold_back(const LastStep&) {}
  /// The body has changed, and its limits have fallen to a bound.
  virtual void bound_fell() = 0;
  /// From where elements are listed.
  virtual void list_from();
  /// Steps are chosen by another level of the blocks.
  virtual void take_base(StepLimits::Known base);
  void take_stiff();
  void start_anew();
  /// What single tets take off the step, which depends on the level of their blocks.
  AddedStiffness added_at(std::span<const double> level);
  /// The same as StepLimits::with_room, and nowhere below the present level.
  std::vector<double> risen(std::span<const double> stiffening, double ahead) const;
  std::size_t most_levels() const;
  /// Whether some of a crowd that is not looked after is above the level of its block.
  bool is_crowded() const;

  static constexpr double kMostAhead = 4.0;  ///< how far a level runs ahead of a rise
  StiffnessLevels levels_;
  AddedStiffness stiff_;       ///< of single tets
  std::vector<double> usual_;  ///< stiffness per block from which elements are listed, but for probes
  std::vector<double> crowd_;  ///< per block, the stiffest of those left out; empty: none were
  bool probes_ = false;        ///< whether more than usual is listed, to choose the level of the blocks anew
  bool unchecked_ = false;     ///< the step is above the bound of a mesh that has changed

 private:
  bool bear(std::span<const double> stiffening, std::span<const StiffElement> stiff);
  std::span<const StiffElement> without_crowd(std::span<const StiffElement> stiff);

  std::vector<StiffElement> few_;  ///< the stiffest of a crowd
};

}  // namespace glisson
