// machine_peak.cpp — see machine_peak.h.
#include "bench/peak/machine_peak.h"

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <barrier>
#include <chrono>
#include <cstdint>
#include <limits>
#include <new>
#include <thread>
#include <vector>

#include "bench/peak/peak_kernels.h"

namespace glisson::cpu {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kTrySeconds = 0.02;  // of multiply-adds
constexpr int kArithmeticTries = 8, kMemoryTries = 6;
constexpr std::size_t kArrayBytes = 128UL << 20;  // each of three; four times the largest L3 we have seen on one die
constexpr float kContraction = 0.5F;              // x ← x/2 + b stays between its start and 2 b: never denormal

/// Runs `work(thread)` on all threads at once, several times. @return seconds of the fastest, first start to last end
template <class Work>
double fastest(int threads, int tries, const Work& work) {
  std::barrier gate(threads);
  std::vector<Clock::time_point> begin(static_cast<std::size_t>(threads)), end(begin.size());
  double best = std::numeric_limits<double>::infinity();
  const auto run = [&](std::size_t i) {
    for (int t = 0; t < tries; ++t) {
      gate.arrive_and_wait();
      begin[i] = Clock::now();
      work(i);
      end[i] = Clock::now();
      gate.arrive_and_wait();
      if (i > 0) continue;
      const auto took = *std::max_element(end.begin(), end.end()) - *std::min_element(begin.begin(), begin.end());
      best = std::min(best, std::chrono::duration<double>(took).count());
    }
  };
  std::vector<std::jthread> others;
  for (std::size_t i = 1; i < begin.size(); ++i) others.emplace_back(run, i);
  run(0);
  return best;
}

/// Where results go, so that no loop is taken out as useless.
struct Sink {
  alignas(64) float value = 0.0F;
};

double multiply_add_flops(int threads) {
  const PeakKernels& kernels = peak_kernels();
  std::vector<Sink> sinks(static_cast<std::size_t>(threads));
  std::uint64_t rounds = 200'000;
  const auto work = [&](std::size_t i) { sinks[i].value += kernels.multiply_add(rounds, kContraction, 1.0F); };
  const double trial = fastest(threads, 2, work);
  rounds = std::max<std::uint64_t>(1000, static_cast<std::uint64_t>(static_cast<double>(rounds) * kTrySeconds / trial));
  const double seconds = fastest(threads, kArithmeticTries, work);
  return kernels.flops_per_round * static_cast<double>(rounds) * threads / seconds;
}

/// A thread's share of the three arrays, touched first by that thread.
struct Share {
  hwy::AlignedFreeUniquePtr<float[]> a, b, c;
  alignas(64) float sum = 0.0F;
};

void take_share(Share& share, std::size_t n) {
  for (auto* array : {&share.a, &share.b, &share.c}) {
    *array = hwy::AllocateAligned<float>(n);
    if (*array == nullptr) return;
    std::fill_n(array->get(), n, 1.0F);
  }
}

void measure_memory(MachinePeak& peak) {
  const PeakKernels& kernels = peak_kernels();
  const std::size_t threads = static_cast<std::size_t>(peak.threads);
  const std::size_t n = kArrayBytes / sizeof(float) / threads / kStreamFloats * kStreamFloats;
  std::vector<Share> shares(threads);
  fastest(peak.threads, 1, [&](std::size_t i) { take_share(shares[i], n); });
  for (const Share& share : shares) {
    if (share.c == nullptr) throw std::bad_alloc();
  }
  const double bytes = 3.0 * sizeof(float) * static_cast<double>(n * threads);
  peak.read_bytes = bytes / fastest(peak.threads, kMemoryTries, [&](std::size_t i) {
                      for (const auto* array : {&shares[i].a, &shares[i].b, &shares[i].c})
                        shares[i].sum += kernels.sum(array->get(), n);
                    });
  peak.triad_bytes = bytes / fastest(peak.threads, kMemoryTries, [&](std::size_t i) {
                       kernels.triad(shares[i].a.get(), shares[i].b.get(), shares[i].c.get(), 0.5F, n);
                     });
}

}  // namespace

MachinePeak measure_machine_peak(int threads) {
  MachinePeak peak{.threads = std::max(1, threads)};
  peak.instruction_set = instruction_set();
  peak.multiply_add_flops = multiply_add_flops(peak.threads);
  measure_memory(peak);
  return peak;
}

MachinePeak best_of(const MachinePeak& a, const MachinePeak& b) {
  return {a.threads, std::max(a.multiply_add_flops, b.multiply_add_flops), std::max(a.read_bytes, b.read_bytes),
          std::max(a.triad_bytes, b.triad_bytes), a.instruction_set};
}

std::string instruction_set() { return peak_kernels().instruction_set; }

}  // namespace glisson::cpu
