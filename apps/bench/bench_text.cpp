// bench_text.cpp — see bench_text.h.
#include "bench/bench_text.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "build_info.h"
#include "glisson/version.h"
#include "report/report_page.h"

namespace glisson::app {
namespace {

constexpr double kBusy = 0.5;  // load average from which figures are not to be trusted

constexpr const char* kLegend =
    "ns, p10   wall time per tet and step: median of {} repetitions of about {:g} s, and tenth percentile of bursts "
    "of\n"
    "          2 ms, which other programs disturb less; spread is (p90 - p10) / median of the repetitions\n"
    "*         disturbed: the spread is above 15 %, or the median 10 % above p10; take p10, or measure again\n"
    "flops     useful additions, multiplications, divisions and roots per tet and step, a fused one counted as two;\n"
    "          padding and the bounds of the stable step are not counted (docs/engine.md)\n"
    "bytes     rest data and state read or written per tet and step\n"
    "of FMA, of memory\n"
    "          flops and bytes over the roofs measured in this run with as many threads; bodies that fit the caches\n"
    "          can exceed the memory roof\n"
    "state     hash after {} steps from the same state, equal for all threads or the run fails\n"
    "Energies are not computed (SimulationOptions::track_energies = false) unless stated.\n";

std::string percent(double fraction) { return fraction > 0.0 ? fmt::format("{:.1f} %", 100.0 * fraction) : "-"; }
std::string count(double value) { return value > 0.0 ? fmt::format("{:.1f}", value) : "-"; }

/// Characters, of which "×" is one and two bytes.
std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string roof_text(const cpu::MachinePeak& p) {
  return fmt::format("{:>7} thread{} {:8.1f} GFLOP/s   memory {:6.1f} GB/s (read {:.1f}, triad {:.1f})\n", p.threads,
                     p.threads == 1 ? " " : "s", 1e-9 * p.multiply_add_flops, 1e-9 * p.memory_bytes(),
                     1e-9 * p.read_bytes, 1e-9 * p.triad_bytes);
}

std::string row_text(const BenchRow& row, const cpu::MachinePeak& peak, std::size_t width) {
  return fmt::format("{:<{}}  {:<16} {:>8} {:>7} {:>8.2f}{} {:>7.2f} {:>7} {:>7} {:>7} {:>8} {:>9}  {:016x}\n",
                     row.mesh, width, word_of(row.what.model), row.tets, row.what.threads, row.ns_per_tet_step,
                     disturbed(row) ? "*" : " ", row.ns_p10, percent(row.spread), count(row.engine.flops_per_tet),
                     count(row.engine.bytes_per_tet), percent(fraction_of_fma_peak(row, peak)),
                     percent(fraction_of_bandwidth(row, peak)), row.state_hash);
}

nlohmann::ordered_json row_json(const BenchRow& row, const cpu::MachinePeak& peak) {
  nlohmann::ordered_json json;
  json["model"] = word_of(row.what.model);
  json["tets"] = row.tets;
  json["threads"] = row.what.threads;
  json["ns_per_tet_step"] = row.ns_per_tet_step;
  json["ns_p10"] = row.ns_p10;
  json["spread"] = row.spread;
  json["disturbed"] = disturbed(row);
  json["preempted"] = row.preempted;
  json["instruction_set"] = row.engine.instruction_set;
  json["flops_per_tet"] = row.engine.flops_per_tet;
  json["bytes_per_tet"] = row.engine.bytes_per_tet;
  json["fraction_of_fma_peak"] = fraction_of_fma_peak(row, peak);
  json["fraction_of_bandwidth"] = fraction_of_bandwidth(row, peak);
  json["state_hash"] = fmt::format("{:016x}", row.state_hash);
  json["mesh"] = row.mesh;
  json["submeshes"] = row.engine.submeshes;
  json["threads_used"] = row.engine.threads;
  json["h_s"] = row.step_s;
  json["steps"] = row.steps;
  json["energies_kept"] = row.what.accounting;
  json["peak_rss_MiB"] = nullptr;
  if (row.peak_rss_mib) json["peak_rss_MiB"] = *row.peak_rss_mib;
  return json;
}

nlohmann::ordered_json peak_json(const cpu::MachinePeak& peak) {
  return {{"threads", peak.threads},
          {"instruction_set", peak.instruction_set},
          {"fma_peak_gflops", 1e-9 * peak.multiply_add_flops},
          {"bandwidth_GBps", 1e-9 * peak.memory_bytes()},
          {"bandwidth_kind", peak.memory_kind()},
          {"read_GBps", 1e-9 * peak.read_bytes},
          {"triad_GBps", 1e-9 * peak.triad_bytes}};
}

}  // namespace

std::string bench_table(const BenchResult& result, const MeasureOptions& options) {
  std::string text = fmt::format("{}, {}; {}, {}; commit {}\n", machine_text(), cpu::instruction_set(),
                                 GLISSON_BUILD_COMPILER, GLISSON_BUILD_FLAGS, GLISSON_BUILD_COMMIT);
  for (const cpu::MachinePeak& peak : result.peaks) text += roof_text(peak);
  if (result.load_average > kBusy) {
    text += fmt::format("Other programs were running (load average {:.1f}): rows on several threads suffer most.\n",
                        result.load_average);
  }
  std::size_t width = 4;
  for (const BenchRow& row : result.rows) width = std::max(width, characters(row.mesh));
  text +=
      fmt::format("\n{:<{}}  {:<16} {:>8} {:>7} {:>8}  {:>7} {:>7} {:>7} {:>7} {:>8} {:>9}  {}\n", "body", width,
                  "model", "tets", "threads", "ns", "p10", "spread", "flops", "bytes", "of FMA", "of memory", "state");
  for (const BenchRow& row : result.rows) text += row_text(row, result.peak(row.what.threads), width);
  text += "\n" + fmt::format(kLegend, options.repetitions, options.repetition_s, kHashSteps) + "\n";
  for (const BenchRatio& ratio : ratios(result)) {
    text += fmt::format("{:<46} {:6.2f}\n", ratio.name, ratio.value);
  }
  return text;
}

nlohmann::ordered_json machine_json() {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  nlohmann::ordered_json json;
  json["cpu"] = machine_text();
  json["instruction_set"] = cpu::instruction_set();
  json["compiler"] = GLISSON_BUILD_COMPILER;
  json["flags"] = GLISSON_BUILD_FLAGS;
  json["commit"] = GLISSON_BUILD_COMMIT;
  json["version"] = GLISSON_VERSION;
  json["date"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
  return json;
}

nlohmann::ordered_json bench_json(const BenchResult& result, const MeasureOptions& options) {
  nlohmann::ordered_json json = machine_json();
  if (!result.rows.empty()) json["instruction_set"] = result.rows.front().engine.instruction_set;
  json["fma_peak_gflops"] = 1e-9 * result.peaks.front().multiply_add_flops;
  json["bandwidth_GBps"] = 1e-9 * result.peaks.front().memory_bytes();
  json["load_average"] = result.load_average;
  json["repetitions"] = options.repetitions;
  json["repetition_s"] = options.repetition_s;
  json["hash_steps"] = kHashSteps;
  for (const char* list : {"peaks", "rows", "accounting"}) json[list] = nlohmann::ordered_json::array();
  for (const cpu::MachinePeak& peak : result.peaks) json["peaks"].push_back(peak_json(peak));
  for (const BenchRow& row : result.rows) json["rows"].push_back(row_json(row, result.peak(row.what.threads)));
  for (const BenchRow& row : result.accounting) {
    json["accounting"].push_back(row_json(row, result.peak(row.what.threads)));
  }
  json["ratios"] = nlohmann::ordered_json::object();
  for (const BenchRatio& ratio : ratios(result)) json["ratios"][ratio.name] = ratio.value;
  return json;
}

}  // namespace glisson::app
