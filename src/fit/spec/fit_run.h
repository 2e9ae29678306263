// fit_run.h — how a fit is run, beside what its file says, and what an interrupted one remembers.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "fit/search/multi_start.h"
#include "glisson/fit.h"

namespace glisson::fit {

/// What is known of one law when a fit is interrupted.
struct LawMemory {
  std::vector<StartRecord> starts;
  std::string forward;   ///< name of the forward model that was chosen; empty: not yet
  double speedup = 0.0;  ///< how many times as fast as the scene it was then
};
/// Everything that need not be done again, by law.
using FitMemory = std::map<std::string, LawMemory>;

/// Options of a fit that can be resumed.
struct FitRun : FitOptions {
  FitMemory memory;  ///< of an interrupted run of the same fit
  std::function<void(const FitMemory&)> remember;
};

}  // namespace glisson::fit
