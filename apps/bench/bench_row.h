// bench_row.h — a measurement, and the run it belongs to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/bench_case.h"
#include "bench/peak/machine_peak.h"
#include "glisson/simulation/simulation.h"

namespace glisson::app {

struct BenchRow {
  std::string mesh;
  BenchCase what;
  std::size_t tets = 0;
  EngineInfo engine;
  double ns_per_tet_step = 0.0;        ///< median of the repetitions
  double ns_p10 = 0.0;                 ///< tenth percentile of bursts of some 2 ms, which others seldom reach into
  double spread = 0.0;                 ///< (p90 − p10) / median of the repetitions
  std::uint64_t preempted = 0;         ///< times that a thread lost its core to others while the row was timed
  double step_s = 0.0;                 ///< h [s]
  std::uint64_t steps = 0;             ///< timed, of all repetitions
  std::uint64_t state_hash = 0;        ///< after kHashSteps steps from the initial state
  std::optional<double> peak_rss_mib;  ///< of the process while the body's rows were measured
};

/// Whether others had a part in the row's median: repetitions lie apart by more than 15 %, or the median above short bursts by
/// more than 10 %.
bool disturbed(const BenchRow& row);

/// Steps from the initial state after which the state is hashed.
constexpr int kHashSteps = 20;

struct BenchResult {
  double load_average = 0.0;            ///< programs that were running in the minute before
  std::vector<cpu::MachinePeak> peaks;  ///< per number of threads
  std::vector<BenchRow> rows;           ///< without accounting, by body, model, threads
  std::vector<BenchRow> accounting;     ///< some of them measured with energies kept

  /// The roofs of a number of threads. @throws std::out_of_range where it was not measured
  const cpu::MachinePeak& peak(int threads) const;
};

/// Flops and bytes of a row over the roofs of as many threads; 0 where they are not counted, or the row ran in another
/// instruction set than the peak.
double fraction_of_fma_peak(const BenchRow& row, const cpu::MachinePeak& peak);
double fraction_of_bandwidth(const BenchRow& row, const cpu::MachinePeak& peak);

/// What is wrong with the rows: bodies that end in other states on other numbers of threads. Empty: nothing.
std::string hash_mismatch(const std::vector<BenchRow>& rows);

/// A comparison that people ask for, e.g. {"full / linear, 768 tets, 1 thread", 2.1}.
struct BenchRatio {
  std::string name;
  double value = 0.0;
};
std::vector<BenchRatio> ratios(const BenchResult& result);

}  // namespace glisson::app
