// island.h — rows of tools that move each other's vertices, in the order in which they are solved.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "contact/row_group.h"

namespace glisson {

struct Island {
  std::vector<std::size_t> tools;
  std::vector<ContactRow*> points;
  std::vector<DiscRow*> discs;
  std::vector<shaft::Block*> shafts;
  std::vector<GivenRow*> pushes;
  std::vector<HoldRow*> holds;  ///< one per place
  std::vector<std::pair<HoldRow*, std::uint32_t>>
      given_by;  ///< all of several tools, and of which of `holds` each is a part
  std::vector<HoldRow> joint;

  /// Movement at which rows have been solved [m].
  double enough() const;
  /// Rows that miss their places by more once the solver has given up have not been met [m].
  double may_miss() const { return 20.0 * enough(); }
  /// All yield from now on, by the same part of what an impulse moves its own point.
  void soften();
};

}  // namespace glisson
