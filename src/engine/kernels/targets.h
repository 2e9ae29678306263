// targets.h — the instruction sets that kernels are compiled for. Comes before any header of Highway.
//
// 128-bit kernels need SSE4 or NEON, and vectors of a size known to the compiler: processors that have neither take the
// scalar ones. kernels.cpp hands out what response_kernels.cpp compiles, so both take the list from here.
#pragma once

#ifdef GLISSON_WITHOUT_AVX512
#define GLISSON_NO_TARGETS (HWY_AVX3 | HWY_AVX3_DL)
#else
#define GLISSON_NO_TARGETS 0
#endif
#define HWY_DISABLED_TARGETS \
  (GLISSON_NO_TARGETS | HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
