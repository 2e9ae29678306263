// law_search.h — one law's way from a description to its optimum.
//
//   scene + law ──ladder──▶ cheapest honest forward model ──cache──▶ Problem ──many starts──▶ optimum
//        ▲                                                                              │
//        └──────────── the scene itself, where the choice no longer holds there ◀───────┘
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fit/forward/ladder.h"
#include "fit/laws/fit_curves.h"
#include "fit/search/cached_model.h"
#include "fit/search/derivative_check.h"
#include "fit/spec/fit_run.h"

namespace glisson::fit {

/// What derivatives ask for.
struct RunsAtOnce {
  std::size_t motions = 0;     ///< of the fitted curves that take a run of their own
  std::size_t parameters = 0;  ///< whose differences are runs; contact and zero of the force may be read from one
};

class LawSearch {
 public:
  /// @param law  what it sets over the fit's own keys, and its free numbers
  /// @throws SceneError, std::invalid_argument, std::runtime_error where scene, keys or curves cannot be used
  LawSearch(const FitSpec& spec, LawSpec law, const FitCurves& curves, const FitRun& options);

  /// Looks for the optimum, from what `memory` knows on; `told` hears after each batch of starts.
  void search(LawMemory& memory, const std::function<void(const MultiStart&)>& told);
  /// Compares a specimen with a body of tets at the optimum; for forward_words().
  void compare_specimen();
  /// Takes a lower cost that was found elsewhere for the optimum.
  void improve(std::span<const double> scaled);

  const LawSpec& law() const { return law_; }
  const Problem& problem() const { return *problem_; }
  const Ladder& ladder() const { return ladder_; }
  /// Whether a run is that of a scene, step by step: no closed form and no table.
  bool dear() const;
  RunsAtOnce runs_at_once() const;
  /// How descents of this problem go.
  DescentOptions descent() const;
  const DerivativeCheck& derivatives() const { return derivatives_; }
  const MultiStart& found() const { return found_; }
  /// The best optimum. @throws std::runtime_error where no start ended in one
  const Optimum& optimum() const;
  std::vector<double> values() const { return problem_->to_values(optimum().scaled); }
  /// Force of every curve at the optimum, in the order of the fit's curves.
  std::vector<Prediction> predictions() const;
  /// The model taken, for other tests of the same law. @throws as the constructor
  std::shared_ptr<const Model> model_of(std::vector<Curve> curves) const;
  std::uint64_t forward_runs() const { return former_runs_ + model_->runs(); }
  double forward_seconds() const { return former_seconds_ + model_->seconds(); }
  const SceneText& scene() const { return forward_.scene; }
  /// What is said of the forward model: which was taken, and how far it is from the scene.
  std::string forward_words() const;
  /// Largest rms difference of the forward model from the scene, over the places where they were compared [N].
  std::optional<double> forward_error() const;

 private:
  void take_model(std::size_t rung);
  void look_again_at_forward();
  void compare_grids();
  ForwardProblem problem_at_optimum(std::vector<Curve> curves) const;

  const FitSpec& spec_;
  LawSpec law_;
  const FitCurves& curves_;
  FitRun options_;
  ForwardProblem forward_;
  Ladder ladder_;
  std::shared_ptr<CachedModel> model_;
  std::unique_ptr<Problem> problem_;
  DerivativeCheck derivatives_;
  MultiStart found_;
  Optimum optimum_;
  std::optional<double> share_at_optimum_, specimen_error_;
  std::string second_look_;
  double speedup_ = 1.0;  ///< of the model taken over the scene, by the clock of the run that chose it
  std::uint64_t former_runs_ = 0;
  double former_seconds_ = 0.0;
};

/// The scene of a fit: a file, or one made for its specimen; over it the fit's keys and the law's.
SceneText scene_of(const FitSpec& spec, const LawSpec& law);

/// The root mean square of force differences at a point, over all fitted curves, in their common_unit; infinite where a run fails.
double rms_at(const Problem& problem, std::span<const double> scaled);

}  // namespace glisson::fit
