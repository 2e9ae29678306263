// offset_model.h — parameters of the measurement rather than of the tissue: where contact was, and the zero of the force.
//
//   curve.contact_mm          the tool meets the tissue at this displacement of every curve
//   curve.force_offset_N      added to the simulated force of every curve
//   curve.NAME.contact_mm     of the curve of that name alone, added to the common one; likewise the force
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fit/forward/motion_model.h"
#include "fit/forward/steady_press.h"

namespace glisson::fit {

/// Whether a key is one of those above.
bool is_curve_key(const std::string& key);

/// A model with such parameters around one without.
class OffsetModel final : public Model {
 public:
  /// @param keys  of all parameters in their order; those that are not curve keys go on to `inner`, in theirs
  /// @throws std::invalid_argument for a curve that does not exist
  OffsetModel(std::shared_ptr<const MotionModel> inner, std::span<const std::string> keys);
  std::size_t curves() const override { return inner_->curves(); }
  Prediction predict(std::size_t curve, std::span<const double> values) const override;

 private:
  struct Offset {
    std::size_t parameter = 0;
    bool force = false;
    std::string curve;  ///< empty: all
  };
  std::shared_ptr<const MotionModel> inner_;
  std::vector<Offset> offsets_;
  std::vector<std::size_t> passed_;
};

/// Where each curve may meet the tissue within the bounds of the parameters, whose names are keys [m].
std::vector<ContactRange> contact_ranges(std::span<const Parameter> parameters, std::span<const Curve> curves);

/// The keys that are not curve keys, in their order.
std::vector<std::string> inner_keys(std::span<const std::string> keys);

}  // namespace glisson::fit
