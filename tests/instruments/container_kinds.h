// container_kinds.h — containers from free to bonded, for tests of each kind.
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "glisson/instruments/container.h"

namespace glisson::test {

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

inline ContainerOptions with(double friction, bool holds, bool bonded) {
  ContainerOptions o;
  o.friction = friction, o.holds_floor = o.holds_wall = holds, o.bonded = bonded;
  return o;
}

inline std::vector<ContainerOptions> container_kinds() {
  return {with(0.0, false, false), with(0.3, false, false), with(kInfinite, false, false), with(0.0, true, false),
          with(0.0, false, true)};
}

inline std::string kind_of(const testing::TestParamInfo<ContainerOptions>& p) {
  const ContainerOptions& o = p.param;
  return o.bonded            ? "bonded"
         : o.holds_floor     ? "held"
         : o.friction == 0.0 ? "free"
         : o.friction > 1.0  ? "rough"
                             : "friction";
}

}  // namespace glisson::test
