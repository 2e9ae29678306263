// share_below.h — parts of simplices below a level of a linear field.
#pragma once

#include <algorithm>
#include <array>

namespace glisson::heat {

/// Share of a tet's volume below a level of a linear field with these values at its corners.
inline double share_below(std::array<double, 4> t, double level) {
  std::sort(t.begin(), t.end());
  const auto [a, b, c, d] = t;
  if (level <= a) return 0.0;
  if (level >= d) return 1.0;
  const auto along = [level](double from, double to) { return (level - from) / (to - from); };
  if (level <= b) return along(a, b) * along(a, c) * along(a, d);
  if (level >= c) return 1.0 - along(d, a) * along(d, b) * along(d, c);
  // a wedge of three tets, whose corners cut the edges ac, ad, bc and bd
  const double ac = along(a, c), ad = along(a, d), bc = along(b, c), bd = along(b, d);
  return ac * ad + bd * ac * (1.0 - ad) + (1.0 - ac) * bd * bc;
}

/// The same of a triangle's area.
inline double share_below(std::array<double, 3> t, double level) {
  std::sort(t.begin(), t.end());
  const auto [a, b, c] = t;
  if (level <= a) return 0.0;
  if (level >= c) return 1.0;
  return level <= b ? (level - a) / (b - a) * ((level - a) / (c - a))
                    : 1.0 - (c - level) / (c - a) * ((c - level) / (c - b));
}

}  // namespace glisson::heat
