// samples.h — rows of a test, and the cutting of them.
#pragma once

#include <cstddef>
#include <vector>

#include "fit/data/data_spec.h"

namespace glisson::fit {

struct Samples {
  std::vector<double> time, displacement, force;

  std::size_t size() const { return time.size(); }
  /// Rows first to last − 1.
  Samples part(std::size_t first, std::size_t last) const;
  void push(const Samples& from, std::size_t row);
};

/// Turning points of the way: first row, deepest and highest rows in turn, last row. A turn counts where the way back is
/// longer than `least` of the whole span.
std::vector<std::size_t> turning_points(const std::vector<double>& displacement, double least);

/// The rows that are within the bounds and before `until`.
Samples cropped(const Samples& rows, const CropSpec& crop, double height, double noise);

struct Resampled {
  Samples rows;
  double rows_a_point = 1.0;  ///< averaged
};
/// Points evenly over time or displacement: the mean of the rows of each bin, or the row next to its middle. Bins without
/// rows give no point; fewer rows than points stay as they are.
///
/// The mean of a bin of width h lies off the curve by F″ h²/24 at most.
Resampled resampled(const Samples& rows, const ResampleSpec& spec);

}  // namespace glisson::fit
