// workspace.h — what the operations that improve a mesh share.
#pragma once

#include <vector>

#include "mesher/lattice/crease.h"
#include "mesher/lattice/region_fields.h"
#include "mesher/lattice/tet_complex.h"
#include "mesher/lattice/tet_quality.h"

namespace glisson::lattice {

inline constexpr double kSlack = 0.02;  ///< of the edge: a vertex may leave its surfaces by this much
inline constexpr double kFlipSlack =
    0.1;  ///< of the edge: so may the middle of an edge or face that a change puts there

struct Workspace {
  TetComplex& complex;
  const RegionFields& fields;
  std::vector<CreaseSides> sides{};  ///< of vertices on creases

  /// Length of edges asked for at a vertex [m].
  double edge(std::uint32_t v) const { return complex.edges[v]; }
  double quality(std::uint32_t t) const {
    const Tet& x = complex.tets[t];
    return quality(x);
  }
  double quality(const Tet& x) const {
    const auto& p = complex.points;
    return tet_quality(p[x[0]], p[x[1]], p[x[2]], p[x[3]], complex.edge_in(x));
  }
  double star_quality(std::uint32_t v) const {
    double least = 1.0;
    for (const std::uint32_t t : complex.stars[v]) least = std::min(least, quality(t));
    return least;
  }
};

}  // namespace glisson::lattice
