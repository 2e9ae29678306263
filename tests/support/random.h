// random.h — numbers for RapidCheck properties, spread over their whole range from the first case on.
#pragma once

#include <rapidcheck.h>

namespace glisson::test {

/// A whole number in [low, high).
inline int integer(int low, int high) { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high)); }

/// A number in [low, high], a millionth of the range apart.
inline double number(double low, double high) { return low + (high - low) * 1e-6 * integer(0, 1000001); }

}  // namespace glisson::test
