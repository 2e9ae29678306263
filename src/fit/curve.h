// curve.h — one measured test, as the fit uses it: in SI, cleaned, with what is known of its noise.
#pragma once

#include <string>
#include <vector>

namespace glisson::fit {

/// A test: how far the tool went and how hard it was pushed, at the same instants. Compression and insertion count positive.
struct Curve {
  std::string name;                  ///< unique among the curves of a fit, e.g. the file's stem
  std::string group;                 ///< repetitions of one test share it, e.g. "2 mm/s"
  std::vector<double> time;          ///< ascending, from 0 [s]
  std::vector<double> displacement;  ///< of the tool from the point of contact [m]
  std::vector<double> force;         ///< on the tool, along its motion [N]
  double velocity = 0.0;             ///< mean speed while loading [m/s]
  double noise = 0.0;                ///< standard deviation of the force about a smooth curve [N]; 0: not known
  double weight = 1.0;               ///< factor on the residuals, ≥ 0
  bool held_out = false;             ///< kept from the fit, to test it

  std::size_t size() const { return time.size(); }
};

}  // namespace glisson::fit
