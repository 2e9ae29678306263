// ladder.h — the cheapest forward model that keeps its error below the noise of the data.
//
//   specimen · quasi_static · implicit, long steps · semi_implicit · central_difference, heavier tissue · …  ◀── compared ──▶  the scene itself
//   a cylinder between plates with friction, or a layer under an indenter, where [specimen] says so, or a scene of heat: by itself
//
// All are compared at the start of the parameters and at some places within their bounds, on one curve of each group (its
// repetitions go the same way). The cheapest whose error is everywhere below `tolerance` × noise is taken; if none is, the
// scene as it is written.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fit/forward/scene_model.h"
#include "fit/forward/section_forward.h"
#include "fit/model/model.h"

namespace glisson::fit {

/// What a model runs.
enum class RungKind {
  scene,          ///< the scene as it is written
  changed_scene,  ///< with other steps or a heavier tissue
  specimen,       ///< a material point, or a specimen that deforms alike all over
  barrel,         ///< a cylinder that bulges between its plates
  layer,          ///< a layer under an indenter
  heat            ///< a scene of heat as it is written
};

/// A model that was tried.
struct Rung {
  RungKind kind = RungKind::scene;
  std::string name;     ///< of its kind and steps: "specimen", "implicit, 40 steps" …
  double cost = 0.0;    ///< of one run of every curve compared, at the start [s]
  double error = 0.0;   ///< largest rms difference from the scene at the start [N]
  double share = 0.0;   ///< the largest of the places looked at, over the error allowed there; below 1 it serves [-]
  std::string failure;  ///< why it cannot be taken; empty: it ran everywhere
  std::shared_ptr<const Model> model;
  Integrator integrator{};  ///< of `steps`
  int steps = 0;            ///< equal ones that every run has; 0: the model chooses its steps otherwise
  bool serves() const { return failure.empty() && share < 1.0; }
  bool runs_scene() const {
    return kind == RungKind::scene || kind == RungKind::changed_scene || kind == RungKind::heat;
  }
};

struct Ladder {
  std::vector<Rung> rungs;  ///< the first is the scene itself; error 0 of itself
  std::size_t chosen = 0;
  std::vector<std::size_t> compared;        ///< curves
  std::vector<double> allowed;              ///< rms difference of each of them, at the start [N]
  std::vector<std::vector<double>> places;  ///< values of the parameters; the first is the start

  const std::shared_ptr<const Model>& model() const { return rungs[chosen].model; }
  const Rung& taken() const { return rungs[chosen]; }
};

/// What a fit needs to choose.
struct ForwardProblem {
  SceneText scene;
  ForwardSpec spec;
  std::optional<Specimen> specimen{};  ///< that deforms alike all over by what it is; then there is no other model
  std::optional<Plates> plates{};      ///< of a cylinder that bulges; then there is no other model
  std::optional<Layer> layer{};        ///< under an indenter; then there is no other model
  std::vector<Parameter> parameters;   ///< names are keys: of the scene, or of offset_model.h
  std::vector<Curve> curves;           ///< of all, those held out, too
  MeshLoader load{};
  const std::atomic<bool>* stop = nullptr;
  std::string taken;  ///< the model that an interrupted run of the same fit chose by its clock; empty: choose
};

/// Builds the models and chooses. @throws SceneError, std::invalid_argument for what cannot be used; std::runtime_error where
/// the scene itself does not run at the start. @throws std::invalid_argument also where the model taken is none of these
Ladder choose_forward(const ForwardProblem& problem);

/// The model taken for other curves than those it was compared on, where it goes by equal steps: none of them is longer than
/// the longest that was compared. nullptr where the steps are chosen otherwise: then other curves want a choice of their own.
std::shared_ptr<const Model> model_for(const Ladder& ladder, const ForwardProblem& compared,
                                       const ForwardProblem& other);

/// The error of the model taken at other values, e.g. the optimum: the largest rms difference from the scene over what is
/// allowed there, below 1 where the choice holds. @throws std::runtime_error where one of them does not run
double check_forward(const Ladder& ladder, const ForwardProblem& problem, std::span<const double> values);

/// The ladder in words: a line for each model, and which was taken.
std::string describe(const Ladder& ladder);

/// The largest rms difference of a cylinder that bulges, or of a layer, from one of more and smaller elements [N].
/// @throws std::runtime_error where one of them does not run
double grid_error(const Ladder& ladder, const ForwardProblem& problem, std::span<const double> values);

/// The specimen that an experiment is between smooth plates; none where it is something else.
std::optional<Specimen> homogeneous_specimen(const Variant& variant, const SceneModelOptions& options);

}  // namespace glisson::fit
