// run_end.h — what is said when runs have ended, and with which exit code.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/variant_recorder.h"

namespace glisson::app {

/// Those that were started: an interruption may keep the others from it.
std::vector<const VariantRecorder*> started_of(const std::vector<std::unique_ptr<VariantRecorder>>& recorders);

/// A table on standard output: variant, with its scene where there are several, steps, step, wall time, pace, peak force, how it ended.
void print_results(const std::vector<const VariantRecorder*>& variants);

/// Prints the verdict of each check (CheckData of web/src/report_data.ts). @param of  what they belong to; may be empty
/// @param only_failed  whether those that pass are left out @return  how many failed
int print_checks(const nlohmann::json& checks, const std::string& of, bool only_failed);

/// The exit code; says on standard error what the numbers of a run ended.
int end_of(const std::vector<const VariantRecorder*>& variants);

}  // namespace glisson::app
