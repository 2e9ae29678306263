// bench_text.h — the result of a benchmark as a table for people and as JSON for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "bench/bench_row.h"
#include "bench/measure.h"

namespace glisson::app {

/// Machine and roofs, one line a row, what the columns mean, and the ratios.
std::string bench_table(const BenchResult& result, const MeasureOptions& options);

/// The same with everything that makes it comparable: head, peaks, rows, accounting, ratios.
nlohmann::ordered_json bench_json(const BenchResult& result, const MeasureOptions& options);

/// cpu, instruction_set, compiler, flags, commit, version, date: what any result file starts with.
nlohmann::ordered_json machine_json();

}  // namespace glisson::app
