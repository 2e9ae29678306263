// model.h — what a fit needs to know of the mechanics: parameters in, the force on each curve out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "glisson/fit.h"

namespace glisson::fit {

/// The simulated force at the instants of a curve.
struct Prediction {
  std::vector<double> force;  ///< [N]; as long as the curve, empty where the run failed
  std::string failure;        ///< why there is no force; empty: there is
  bool reused = false;        ///< read from a run that was made before, for other values or another curve
};

/// A forward model of a set of curves. predict() may be called from many threads at once.
class Model {
 public:
  virtual ~Model() = default;
  virtual std::size_t curves() const = 0;
  /// @param values  one for each parameter, in its own unit, within its bounds
  virtual Prediction predict(std::size_t curve, std::span<const double> values) const = 0;
};

}  // namespace glisson::fit
