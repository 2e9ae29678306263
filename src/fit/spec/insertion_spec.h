// insertion_spec.h — what [insertion] of FIT.toml says: a needle whose inner membranes are read off a measured curve.
#pragma once

#include <cstdint>
#include <string>

namespace glisson::fit {

struct InsertionSpec {
  std::string instrument;    ///< the needle; empty: the only instrument
  double start = 0.0;        ///< measured position at which the tip of the scene starts [m]
  double least_drop = 0.25;  ///< a fall by that much … [N]
  double within = 5e-4;      ///< … within this way is a membrane that breaks [m]
  double piece = 3e-3;       ///< length of the pieces of constant cutting force between two drops [m]
  double grid = 2e-4;        ///< the curves are compared so often [m], …
  double margin = 3e-4;      ///< … but not this near to a drop [m]
  double peak = 1e-3;        ///< the force before a drop counts as much as that length of the curve [m]
  std::int32_t runs = 8;     ///< of the scene, at most
};

}  // namespace glisson::fit
