// membranes.h — the membranes across a needle's path: those that are given, and those that are drawn.
//
// Drawn are a distance and a force in turn, both from SplitMix64 [Steele2014]: an exponential variate by comparisons of uniform
// ones alone [Neumann1951], and a normal one as the sum of twelve less 6. Additions, products and comparisons give the same
// bytes on every machine; logarithms and the distributions of the standard library do not promise that.
#pragma once

#include <vector>

#include "glisson/instruments/needle.h"

namespace glisson {

/// All of a needle, by ascending depth, down to its length.
std::vector<InnerMembrane> membranes_of(const NeedleOptions& options);

}  // namespace glisson
