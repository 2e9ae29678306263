// found_inside.h — vertices that were inside a solid when it was attached: there it is taken to grow to its size, so that they come out.
#pragma once

#include <cstdint>
#include <set>
#include <utility>

#include "contact/point_rows.h"
#include "glisson/archive.h"

namespace glisson {

class FoundInside {
 public:
  /// Marks a row that has its solid, start pose and vertex, before prepare(); `begun`: this is not the first step.
  void mark(ContactRow& row, std::uint32_t vertex, std::uint32_t solid, const Vec3d& start, bool begun) {
    if (!begun && distance_to(*row.solid->shape, start).distance < -row.solid->tolerance())
      inside_.insert({vertex, solid});
    row.comes_out = !inside_.empty() && inside_.count({vertex, solid}) != 0;
  }
  /// After prepare().
  void settle(const ContactRow& row, std::uint32_t vertex, std::uint32_t solid) {
    if (row.comes_out && row.inside == 0.0) inside_.erase({vertex, solid});
  }
  void archive(Archive& ar) { ar(inside_); }

 private:
  std::set<std::pair<std::uint32_t, std::uint32_t>> inside_;
};

}  // namespace glisson
