#include "fit/insertion/run_insertion_fit.h"

#include <chrono>

#include "fit/forward/scene_model.h"
#include "fit/insertion/membrane_account.h"
#include "scene/build/parametric_variant.h"

namespace glisson::fit {
namespace {

Variant variant_of(const FitSpec& spec) {
  const SceneText text = scene_text(spec.scene);
  return scene::ParametricVariant(text.text, text.name, text.base, spec.set, spec.variant, {}).with({});
}

}  // namespace

FitResult run_insertion_fit(const FitSpec& spec, const FitRun& options) {
  const auto begin = std::chrono::steady_clock::now();
  const InsertionSpec& insertion = *spec.insertion;
  const DataSpec& data = spec.data.front();
  const std::filesystem::path folder = options.data_folder.empty() ? spec.file.parent_path() : options.data_folder;
  const MeasuredInsertion measured = read_insertion(folder / data.files.front(), data, insertion);
  const InsertionScene scene(variant_of(spec), insertion, options.load);
  const auto progress = [&](int run, double rms) {
    if (!options.progress) return;
    FitProgress p{"membranes", "runs", static_cast<std::size_t>(run), static_cast<std::size_t>(insertion.runs)};
    p.best_rms = rms;
    p.forward_runs = static_cast<std::uint64_t>(run);
    options.progress(p);
  };
  const std::atomic<bool> never{false};
  const MembraneFit fit = fit_membranes(measured, insertion, scene, options.stop ? *options.stop : never, progress);
  FitResult result;
  fill_result(fit, measured, insertion, scene.speed(), result);
  result.complete = options.stop == nullptr || !*options.stop;
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  result.forward_run_s = result.wall_s / fit.runs;
  return result;
}

}  // namespace glisson::fit
