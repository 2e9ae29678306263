// model.h — what a fit needs to know of the mechanics: parameters in, the force on each curve out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace glisson::fit {

enum class Scale { linear, logarithmic };

/// A number that the fit is free to choose, in the unit of its key.
struct Parameter {
  std::string name;              ///< what it is called in tables, unique, e.g. "tissue.law.slope_Pa"
  std::string unit;              ///< for tables; may be empty
  double low = 0.0, high = 1.0;  ///< bounds, low < high; both > 0 where the scale is logarithmic
  Scale scale = Scale::linear;
  double start = 0.0;  ///< of the first start, within the bounds
};

/// The simulated force at the instants of a curve.
struct Prediction {
  std::vector<double> force;  ///< [N]; as long as the curve, empty where the run failed
  std::string failure;        ///< why there is no force; empty: there is
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
