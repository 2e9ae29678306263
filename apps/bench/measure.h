// measure.h — times the step of a body.
//
//   settle ─▶ state restored ─▶ 20 steps, hash ─▶ rounds: [ case 1: restored, timed │ case 2: restored, timed │ … ]
//
// Cases of a body are timed in turn, so that a slow moment of the machine touches all of them and their ratios hold;
// a body of more than half a million tets is measured one case after the other, as a program would hold it. Each
// repetition starts from the same state and must end in the same one.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/bench_row.h"

namespace glisson::app {

struct MeasureOptions {
  int repetitions = 11;
  double repetition_s = 0.1;  ///< wall time of one, about
};

/// Rows in the order of `cases`.
/// @throws std::runtime_error where a state is not finite, or a repetition ends in another state than the one before
std::vector<BenchRow> measure(const BenchBody& body, std::span<const BenchCase> cases, const MeasureOptions& options);

}  // namespace glisson::app
