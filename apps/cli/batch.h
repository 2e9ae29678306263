// batch.h — runs variants side by side on the cores and records each of them.
//
// A variant runs on one thread from its start to its end, so its results do not depend on how many run at a time.
#pragma once

#include <memory>
#include <vector>

#include "glisson/scene/scene.h"
#include "report/variant_recorder.h"

namespace glisson::app {

struct Job {
  std::string name;  ///< in messages and progress
  Variant variant;
  RecorderOptions recorder;
  std::shared_ptr<RunObserver> also;  ///< watches the run too; may be null
};

struct BatchOptions {
  int threads = 1;
  bool quiet = false;
};

/// Builds every job once without a step, so that a mistake in the last one is told before the first one runs.
/// @throws SceneError, FileError
void require_runnable(const std::vector<Job>& jobs, const MeshLoader& load);

/// Runs all jobs, those that look longest first. Returns one recorder per job, in the order of the jobs; a job that
/// an interruption kept from starting has a recorder that is not started().
/// @throws OutputError where the disk refused, once all runs have ended
std::vector<std::unique_ptr<VariantRecorder>> run_batch(const std::vector<Job>& jobs, const BatchOptions& options,
                                                        const MeshLoader& load);

}  // namespace glisson::app
