// root_series.h — the stretch U of a tet without its eigenvectors, where stretches are close to each other.
//
//   C = m (I + X), m = ⅓ tr C:   U⁻¹ = m^(−½) [(1 + whole) I + first X + second cof X],   tr U = m^½ (3 + trace)
//
// with cof X = X² − J₂ I. Series: material/invariant_series.h. Up to `largest_J2` what they leave out is below the rounding of
// floats.
#pragma once

#include "material/invariant_series.h"

namespace glisson {

template <class Number = double>
struct RootSeries {
  InvariantSeries<Number> whole{}, first{}, second{}, trace{};
  Number largest_J2 = 0;
};

RootSeries<> root_series();
/// The same for lanes, worked out once.
const RootSeries<float>& lane_root_series();

}  // namespace glisson
