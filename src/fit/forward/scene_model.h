// scene_model.h — any scene as a forward model: its tool or instrument follows the measured displacement.
//
//   values ──▶ ParametricVariant ──▶ Variant ── tool on the curve's History, nothing kept but forces ──▶ run_variant ──▶ F(t)
//
// The scene is read once; a run parses nothing, writes nothing and keeps no energies. Runs use one thread each, since a fit
// runs many side by side. Recent runs are kept: another contact of a press at constant speed (steady_press.h) and another zero
// of the force are read from a run that was made already.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "fit/forward/force_record.h"
#include "fit/forward/motion_model.h"
#include "fit/forward/steady_press.h"
#include "fit/model/kept_results.h"
#include "scene/build/parametric_variant.h"

namespace glisson::fit {

/// A scene's text and what is laid over it.
struct SceneText {
  std::string text, name;           ///< `name` stands for the file in messages
  std::filesystem::path base;       ///< where its relative paths start
  std::vector<Override> overrides;  ///< as --set
  std::string variant;              ///< empty: the only one
};
/// From a file. @throws std::runtime_error where it cannot be read
SceneText scene_text(const std::filesystem::path& file);

struct SceneModelOptions {
  std::string tool{};     ///< the tool or instrument that follows the curve; empty: the only one
  std::string force{};    ///< whose force is measured: a tool, an instrument, "bottom" or "side"; empty: that of `tool`
  double approach = 0.0;  ///< way of an instrument in the scene before it touches the tissue [m], ≥ 0
  MeshLoader load{};
  /// Last changes of the experiment before it runs for so long [s]: another integrator, another step.
  std::function<void(Variant&, double duration)> adjust{};
  const std::atomic<bool>* stop = nullptr;  ///< ends runs early, with a failure
  /// Halves a given step of the explicit schemes, five times at most, where it is above h*; else such a run fails.
  bool halves_step = false;
  double longest = std::numeric_limits<double>::infinity();  ///< a run that takes longer fails [s], wall clock
  std::vector<ContactRange> contacts{};  ///< of each curve: between which it will be asked for; empty: at 0 alone
  std::size_t recordings = 256;          ///< runs that are kept, ≥ 1
};

/// The force is that on the tissue along the tool's direction, positive when it presses: elastic, viscous, damping and what
/// capsules and contact add; without gravity and the inertia of the driven vertices, which jump to their speed at once.
/// Of explicit and semi-implicit runs it is the mean over 1 % of the run to both sides of an instant, since they ring.
/// "bottom" is what the container's floor carries downwards, "side" its wall.
class SceneModel final : public MotionModel {
 public:
  /// @param keys  of the parameters, as --set takes them; [i] addresses an element of a list of numbers
  /// @throws SceneError, std::invalid_argument for a text, keys or curves that cannot be used; the scene's values are checked
  ///         with each run, or by variant()
  SceneModel(const SceneText& scene, std::span<const std::string> keys, std::vector<Curve> curves,
             SceneModelOptions options = {});
  /// A press at constant speed is run as deep as any contact asks for; where that fails beyond what this curve needs of it,
  /// its forces up to there are given.
  Prediction predict_from(std::size_t curve, std::span<const double> values, double contact) const override;

  /// The experiment of a curve as it would run; one and the same for all curves that one press serves. @throws SceneError
  Variant variant(std::size_t curve, std::span<const double> values, double contact = 0.0) const;
  /// The step with which a run at these values ends [s]. @throws std::runtime_error where it does not run
  double last_step(std::size_t curve, std::span<const double> values) const;

 private:
  /// How the tool goes in a run.
  struct Motion {
    History way;
    double approach_time = 0.0;  ///< before it touches the tissue [s]
    double duration = 0.0;       ///< that steps and samples go by [s]; the run may be longer
    std::size_t points = 0;      ///< that are read from it
  };
  /// A run that was made.
  struct Recording {
    ForceRecord forces;
    std::string stopped;    ///< why it went no further than its forces; empty: it went to its end
    std::string refused;    ///< why there was no run at all
    bool unwanted = false;  ///< the fit is being stopped
  };
  Motion motion(std::size_t curve, double contact) const;
  /// None where the curve's motion has a run of its own.
  const SteadyPress* press_of(std::size_t curve, double contact) const;
  Recording record(std::size_t curve, std::span<const double> values, double contact) const;
  /// Instants of a run at which it is where the curve was [s].
  std::vector<double> instants(std::size_t curve, double contact) const;
  Prediction read(const Recording& recording, std::size_t curve, double contact) const;
  RunSummary run(Variant& variant, RunObserver& observer, const std::atomic<bool>& stop) const;
  double approach_time(const Curve& curve) const;

  scene::ParametricVariant scene_;
  SceneModelOptions options_;
  SteadyPresses steady_;
  std::vector<std::size_t> same_motion_;  ///< of each curve: the first that goes the same way
  /// By the press or the motion, then the values, and the contact of what is no press.
  mutable KeptResults<std::pair<std::size_t, std::vector<double>>, Recording> recordings_;
};

/// Keeps meshes read from files, for many runs at once.
MeshLoader kept_meshes(MeshLoader load);

}  // namespace glisson::fit
