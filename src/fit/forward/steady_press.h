// steady_press.h — curves that one run serves, wherever they meet the tissue.
//
//   d ┤        ╱ run, as deep as any curve and contact asks for     A press at constant speed from the surface on is the same
//     │      ╱○                                                     run wherever contact is: the point i of a curve that meets
//     │    ╱○   ○ points of a curve, read at (d_i − contact)/v      the tissue at `contact` is read from it at (d_i − contact)/v.
//     └──╱────────── t
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "glisson/fit.h"

namespace glisson::fit {

/// Where a curve may meet the tissue, in its displacements [m].
struct ContactRange {
  double low = 0.0, high = 0.0;
  bool holds(double contact) const { return low <= contact && contact <= high; }
};

struct SteadyPress {
  double speed = 0.0;      ///< [m/s], > 0
  double depth = 0.0;      ///< the deepest that any of its curves asks for [m], > 0
  double duration = 0.0;   ///< of its longest curve where contact is 0: what steps and samples go by [s]
  std::size_t points = 0;  ///< of its curve of most points
};

/// The presses that stand for curves, and which is whose.
struct SteadyPresses {
  std::vector<SteadyPress> presses;
  std::vector<std::optional<std::size_t>> of;  ///< of each curve; none: its motion is anything else
};

/// Curves share a press where their speed is the same and the longer of them is at most half as long again. A curve has none
/// where its displacement is not linear in time from rest on to 1e-9 of its length, at both ends of its contact's range; where
/// it has a past, is driven by a load, or touches nothing at first; or where the lowest contact makes it more than half as
/// deep again, for then the longer run costs what its readings save.
/// @param contacts  of each curve; empty: all are met at 0
SteadyPresses steady_presses(std::span<const Curve> curves, std::span<const ContactRange> contacts);

}  // namespace glisson::fit
