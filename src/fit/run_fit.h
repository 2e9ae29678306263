// run_fit.h — a fit from its description to its result: curves, forward model, search, proof, laws.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "fit/fit_result.h"
#include "fit/fit_spec.h"
#include "fit/search/multi_start.h"
#include "glisson/scene/scene.h"

namespace glisson::fit {

/// What is known of one law when a fit is interrupted.
struct LawMemory {
  std::vector<StartRecord> starts;
  std::string forward;   ///< name of the forward model that was chosen; empty: not yet
  double speedup = 0.0;  ///< how many times as fast as the scene it was then
};
/// Everything that need not be done again, by law.
using FitMemory = std::map<std::string, LawMemory>;

struct FitProgress {
  std::string law;    ///< that is fitted
  std::string stage;  ///< "forward models", "starts", "profiles", "bootstrap"
  std::size_t done = 0, planned = 1;
  double best_rms = 0.0;  ///< [N]; of all fitted curves
  int found = 0;          ///< how often the best optimum was found so far
  std::uint64_t forward_runs = 0;
};

/// What a law's fit will take, told when its forward model is chosen.
struct FitForecast {
  std::string law, forward;  ///< the forward model's name
  std::uint64_t least_runs = 0,
                most_runs = 0;  ///< forward runs: where every descent goes well, where starts have to go on
  double run_s = 0.0;           ///< of one run, one core
};

struct FitOptions {
  std::vector<std::string> laws;      ///< names of known_laws(), beside those of the file
  std::filesystem::path data_folder;  ///< that files of curves are relative to; empty: the folder of FIT.toml
  MeshLoader load;
  const std::atomic<bool>* stop = nullptr;
  FitMemory memory;  ///< of an interrupted run of the same fit
  std::function<void(const FitProgress&)> progress;
  std::function<void(const FitForecast&)> forecast;
  std::function<void(const FitMemory&)> remember;
};

/// Runs a fit. A fit that is stopped gives what it has, marked as not complete.
/// @throws SceneError, std::invalid_argument, std::runtime_error for descriptions, scenes and files that cannot be used
FitResult run_fit(const FitSpec& spec, const FitOptions& options);

}  // namespace glisson::fit
