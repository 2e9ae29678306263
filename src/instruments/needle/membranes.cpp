// membranes.cpp — the membranes across a needle's path: those that are given, and those that are drawn.
//
// Drawn are a distance and a force in turn, both from SplitMix64 [Steele2014]: an exponential variate by comparisons of uniform
// ones alone [Neumann1951], and a normal one as the sum of twelve less 6. Additions, products and comparisons give the same
// bytes on every machine; logarithms and the distributions of the standard library do not promise that.
#include <algorithm>

#include "glisson/instruments/needle.h"

namespace glisson {
namespace {

class MembraneSequence {
 public:
  explicit MembraneSequence(std::uint64_t seed) : state_(seed) {}

  /// In [0, 1).
  double uniform() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

  /// Of mean 1: falling runs of uniform numbers are counted until one is of odd length.
  double exponential() {
    for (double whole = 0.0;; whole += 1.0) {
      const double first = uniform();
      double last = first;
      bool odd = true;
      for (double next = uniform(); next < last; next = uniform()) {
        last = next;
        odd = !odd;
      }
      if (odd) return whole + first;
    }
  }

  /// Of mean 0 and deviation 1, within ±6.
  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }

 private:
  std::uint64_t state_;
};

}  // namespace

std::vector<InnerMembrane> membranes_of(const NeedleOptions& options) {
  std::vector<InnerMembrane> all = options.membranes;
  if (!options.drawn_membranes) return all;
  const MembraneProcess& process = *options.drawn_membranes;
  MembraneSequence random(process.seed);
  for (double depth = 0.0;;) {
    depth += process.spacing * random.exponential();
    if (depth > options.length) break;
    double share = 0.0;
    while (!(share > 0.0)) share = 1.0 + process.spread * random.normal();
    all.push_back({depth, process.puncture * share, {}});
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.depth < b.depth; });
  return all;
}

}  // namespace glisson
