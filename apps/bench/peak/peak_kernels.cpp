// peak_kernels.cpp — compiled once for each instruction set.
#include "bench/peak/peak_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/peak/peak_kernels.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace glisson::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using V = hn::Vec<Floats>;

/// Twelve chains: a latency of 4 cycles on 2 units needs 8, and 12 with a and b fit the 16 registers of AVX2.
constexpr double kChains = 12;

float multiply_add(std::uint64_t rounds, float a, float b) {
  const Floats d;
  const V va = hn::Set(d, a), vb = hn::Set(d, b);
  V x0 = hn::Iota(d, 0.0F), x1 = hn::Add(x0, vb), x2 = hn::Add(x1, vb), x3 = hn::Add(x2, vb);
  V x4 = hn::Add(x3, vb), x5 = hn::Add(x4, vb), x6 = hn::Add(x5, vb), x7 = hn::Add(x6, vb);
  V x8 = hn::Add(x7, vb), x9 = hn::Add(x8, vb), x10 = hn::Add(x9, vb), x11 = hn::Add(x10, vb);
  for (std::uint64_t i = 0; i < rounds; ++i) {
    x0 = hn::MulAdd(x0, va, vb), x1 = hn::MulAdd(x1, va, vb), x2 = hn::MulAdd(x2, va, vb);
    x3 = hn::MulAdd(x3, va, vb), x4 = hn::MulAdd(x4, va, vb), x5 = hn::MulAdd(x5, va, vb);
    x6 = hn::MulAdd(x6, va, vb), x7 = hn::MulAdd(x7, va, vb), x8 = hn::MulAdd(x8, va, vb);
    x9 = hn::MulAdd(x9, va, vb), x10 = hn::MulAdd(x10, va, vb), x11 = hn::MulAdd(x11, va, vb);
  }
  const V low = hn::Add(hn::Add(hn::Add(x0, x1), hn::Add(x2, x3)), hn::Add(x4, x5));
  const V high = hn::Add(hn::Add(hn::Add(x6, x7), hn::Add(x8, x9)), hn::Add(x10, x11));
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(low, high)));
}

float sum(const float* values, std::size_t n) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  V s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
  for (const float* v = values; v != values + n; v += 8 * lanes) {
    s0 = hn::Add(s0, hn::Load(d, v)), s1 = hn::Add(s1, hn::Load(d, v + lanes));
    s2 = hn::Add(s2, hn::Load(d, v + 2 * lanes)), s3 = hn::Add(s3, hn::Load(d, v + 3 * lanes));
    s4 = hn::Add(s4, hn::Load(d, v + 4 * lanes)), s5 = hn::Add(s5, hn::Load(d, v + 5 * lanes));
    s6 = hn::Add(s6, hn::Load(d, v + 6 * lanes)), s7 = hn::Add(s7, hn::Load(d, v + 7 * lanes));
  }
  const V low = hn::Add(hn::Add(s0, s1), hn::Add(s2, s3)), high = hn::Add(hn::Add(s4, s5), hn::Add(s6, s7));
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(low, high)));
}

void triad(float* a, const float* b, const float* c, float s, std::size_t n) {
  const Floats d;
  const V factor = hn::Set(d, s);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    hn::Stream(hn::MulAdd(factor, hn::Load(d, c + i), hn::Load(d, b + i)), d, a + i);
  }
  hwy::FlushStream();
}

const PeakKernels* kernels() {
  static const PeakKernels table{.instruction_set = hwy::TargetName(HWY_TARGET),
                                 .flops_per_round = 2.0 * kChains * static_cast<double>(hn::Lanes(Floats())),
                                 .multiply_add = multiply_add,
                                 .sum = sum,
                                 .triad = triad};
  return &table;
}

}  // namespace glisson::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace glisson::cpu {

HWY_EXPORT(kernels);

const PeakKernels& peak_kernels() { return *HWY_DYNAMIC_DISPATCH(kernels)(); }

}  // namespace glisson::cpu
#endif
