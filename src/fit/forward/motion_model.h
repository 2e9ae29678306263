// motion_model.h — forward models that follow a measured displacement, and can be asked to follow it shifted.
#pragma once

#include <span>
#include <vector>

#include "fit/model/model.h"
#include "glisson/fit.h"
#include "instruments/motion/monotone_cubic.h"

namespace glisson::fit {

/// The motion of a curve from rest on: d(t) [m], with d = 0 at its begin; of a press never below.
///
/// It begins with what was before the curve's first instant (Curve::past_time), where that is known. Between the measured instants it goes by cubics that do not overshoot, as a recorded tool does. A curve whose first
/// point is in the tissue already (d > 0, e.g. after a shift of the contact) is led there at the speed with which it goes on; of a
/// specimen that is gripped and held from the first row on, at once.
class History {
 public:
  /// @param contact  where the tool meets the tissue, in displacements of the curve [m]
  explicit History(const Curve& curve, double contact = 0.0);

  double begin() const { return way_.times().front(); }  ///< ≤ 0 [s]
  double end() const { return way_.times().back(); }     ///< [s]
  double at(double time) const { return way_.at(time); }
  double rate(double time) const { return way_.slope(time); }
  const std::vector<double>& times() const { return way_.times(); }
  const std::vector<double>& displacements() const { return way_.points(); }
  /// How many of times() come before the curve's own instants.
  std::size_t lead() const { return lead_; }

 private:
  std::size_t lead_ = 0;
  MonotoneCubic<double> way_;
};

class MotionModel : public Model {
 public:
  explicit MotionModel(std::vector<Curve> curves) : curves_(std::move(curves)) {}
  std::size_t curves() const final { return curves_.size(); }
  const Curve& curve(std::size_t index) const { return curves_[index]; }
  Prediction predict(std::size_t curve, std::span<const double> values) const final {
    return predict_from(curve, values, 0.0);
  }
  /// The same where the tool meets the tissue at another displacement than the curve says. @param contact  [m]
  virtual Prediction predict_from(std::size_t curve, std::span<const double> values, double contact) const = 0;

 private:
  std::vector<Curve> curves_;
};

/// Complains about curves that no model can follow. @throws std::invalid_argument naming the curve
void require_curves(std::span<const Curve> curves);

}  // namespace glisson::fit
