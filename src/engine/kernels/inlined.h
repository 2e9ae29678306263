// inlined.h — lambdas inside kernels are asked for by name to be inlined.
//
// In long bodies the compiler leaves them as calls, which pass vectors through memory: a push took twice as long.
#pragma once

#define GLISSON_INLINED __attribute__((always_inline))
