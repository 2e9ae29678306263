// bench_row.cpp — what follows from the rows: fractions of the roof, equality of states, ratios.
#include "bench/bench_row.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <tuple>

namespace glisson::app {
namespace {

/// The row of a body, a model and a number of threads; null where it was not measured.
const BenchRow* find_row(const std::vector<BenchRow>& rows, const std::string& mesh, Model model, int threads) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const BenchRow& row) {
    return row.mesh == mesh && row.what.model == model && row.what.threads == threads;
  });
  return found == rows.end() ? nullptr : &*found;
}

std::string threads_text(int threads) { return fmt::format("{} thread{}", threads, threads == 1 ? "" : "s"); }

}  // namespace

const cpu::MachinePeak& BenchResult::peak(int threads) const {
  for (const cpu::MachinePeak& p : peaks) {
    if (p.threads == threads) return p;
  }
  throw std::out_of_range(fmt::format("the roofs of {} threads were not measured", threads));
}

bool disturbed(const BenchRow& row) { return row.spread > 0.15 || row.ns_per_tet_step > 1.1 * row.ns_p10; }

double fraction_of_fma_peak(const BenchRow& row, const cpu::MachinePeak& peak) {
  if (row.engine.instruction_set != peak.instruction_set) return 0.0;
  return 1e9 * row.engine.flops_per_tet / row.ns_per_tet_step / peak.multiply_add_flops;
}

double fraction_of_bandwidth(const BenchRow& row, const cpu::MachinePeak& peak) {
  return 1e9 * row.engine.bytes_per_tet / row.ns_per_tet_step / peak.memory_bytes();
}

std::string hash_mismatch(const std::vector<BenchRow>& rows) {
  std::map<std::tuple<std::string, Model>, const BenchRow*> first;
  for (const BenchRow& row : rows) {
    const BenchRow& other = *first.try_emplace({row.mesh, row.what.model}, &row).first->second;
    if (other.state_hash == row.state_hash) continue;
    return fmt::format("{}, {}: the state after {} steps is {:016x} on {} and {:016x} on {}; they must be equal",
                       row.mesh, word_of(row.what.model), kHashSteps, other.state_hash,
                       threads_text(other.what.threads), row.state_hash, threads_text(row.what.threads));
  }
  return {};
}

std::vector<BenchRatio> ratios(const BenchResult& result) {
  std::vector<BenchRatio> all;
  const auto add = [&](const std::string& name, const BenchRow* over, const BenchRow* under) {
    if (over != nullptr && under != nullptr) all.push_back({name, over->ns_per_tet_step / under->ns_per_tet_step});
  };
  const auto like = [&](const BenchRow& row, Model model, int threads) {
    return find_row(result.rows, row.mesh, model, threads);
  };
  const auto of_size = [&](std::size_t tets, int threads) -> const BenchRow* {
    for (const BenchRow& row : result.rows) {
      if (row.tets == tets) return find_row(result.rows, row.mesh, Model::full, threads);
    }
    return nullptr;
  };
  for (const BenchRow& row : result.rows) {
    if (row.what.model > Model::full && row.what.threads == 1) {
      add(fmt::format("{} / linear, {} tets", word_of(row.what.model), row.tets), &row, like(row, Model::linear, 1));
    }
    if (row.what.model != Model::full) continue;
    const int threads = row.what.threads;
    const std::string which = fmt::format("{} tets", row.tets);
    if (threads == 1) add("full / linear, " + which, &row, like(row, Model::linear, 1));
    if (threads == 1) add("full / law, " + which, &row, like(row, Model::law, 1));
    if (threads > 1) add(fmt::format("1 thread / {}, full, {}", threads, which), like(row, Model::full, 1), &row);
    if (row.tets > 500'000) {
      add(fmt::format("{} / 96000 tets, full, {}", row.tets, threads_text(threads)), &row, of_size(96'000, threads));
    }
  }
  for (const BenchRow& row : result.accounting) {
    const int threads = row.what.threads;
    const std::string on = threads > 1 ? ", " + threads_text(threads) : "";
    add(fmt::format("energies kept / not, {}, {} tets{}", word_of(row.what.model), row.tets, on), &row,
        like(row, row.what.model, threads));
  }
  return all;
}

}  // namespace glisson::app
