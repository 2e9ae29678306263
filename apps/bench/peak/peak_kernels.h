// peak_kernels.h — the loops that find out what this machine can do, in the instruction set chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace glisson::cpu {

struct PeakKernels {
  const char* instruction_set = "";  ///< Highway's name of it, e.g. AVX2, AVX3 (AVX-512)
  double flops_per_round = 0.0;      ///< of one round of multiply_add

  /// Rounds of independent multiply-adds x ← a x + b in registers, more of them than a processor has in flight.
  /// @return a number that depends on all of them
  float (*multiply_add)(std::uint64_t rounds, float a, float b) = nullptr;
  /// Σ values. @param n  a multiple of kStreamFloats; values aligned to a vector
  float (*sum)(const float* values, std::size_t n) = nullptr;
  /// a ← b + s c past the caches. The same of n and alignment.
  void (*triad)(float* a, const float* b, const float* c, float s, std::size_t n) = nullptr;
};

/// Array lengths are multiples of this, whatever the vector length (to 2048 bits).
constexpr std::size_t kStreamFloats = 512;

const PeakKernels& peak_kernels();

}  // namespace glisson::cpu
