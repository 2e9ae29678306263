// force_record.h — the forces of a run over its time, and what a load cell would show of them.
#pragma once

#include <optional>
#include <vector>

#include "instruments/motion/monotone_cubic.h"

namespace glisson::fit {

class ForceRecord {
 public:
  ForceRecord() = default;
  /// @param times  ascending, as many as forces [s], [N] @param rings  whether the forces are those of a scheme that rings
  ForceRecord(std::vector<double> times, std::vector<double> forces, bool rings);

  bool empty() const { return !cubic_; }
  double span() const { return end() - begin(); }  ///< [s]
  /// Whether it goes as far as an instant, to rounding.
  bool holds(double time) const { return cubic_ && end() >= time - 1e-9 * span(); }
  /// The force at an instant [N]: of monotone cubics through the samples; where they ring, the mean of straight lines between
  /// them over 1 % of a run to both sides of the instant, less near the ends of the record.
  /// @param run  how long the run is of which 1 % is meant [s]
  double at(double time, double run) const;

 private:
  double begin() const { return cubic_->times().front(); }
  double end() const { return cubic_->times().back(); }
  std::size_t piece(double time) const;
  double line(double time, std::size_t i) const;
  double sum(double time) const;

  std::optional<MonotoneCubic<double>> cubic_;  ///< none: no sample
  std::vector<double> sums_;                    ///< ∫ F dt up to each sample; empty where nothing rings
};

}  // namespace glisson::fit
