// interval.h — a range that holds a parameter with a stated confidence.
#pragma once

namespace glisson::fit {

/// In the parameter's own unit. An open end lies at the parameter's bound: the curves do not limit it before.
struct Interval {
  double low = 0.0, high = 0.0;
  bool low_open = false, high_open = false;

  bool open() const { return low_open && high_open; }
  bool holds(double value) const { return low <= value && value <= high; }
};

}  // namespace glisson::fit
