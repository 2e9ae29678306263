// measured_insertion.h — force over position of a measured insertion, and the drops in it.
#pragma once

#include <string>
#include <vector>

#include "fit/data/data_spec.h"
#include "fit/spec/insertion_spec.h"

namespace glisson::fit {

/// Force over position, of ascending positions.
struct ForceCurve {
  std::vector<double> position, force;  ///< [m], [N]

  /// Linear between the points, constant beyond.
  double at(double x) const;
};

struct Drop {
  double position = 0.0, force = 0.0;  ///< of the highest point before it [m], [N]
  double least = 0.0;                  ///< force within the drop's length after that point [N]
};

struct MeasuredInsertion {
  std::string name;
  ForceCurve curve;         ///< points of one position are averaged
  std::vector<Drop> drops;  ///< the first is the puncture of the surface

  /// Positions where curves are compared, up to `last`: those of the grid that are not near a drop.
  std::vector<double> grid(const InsertionSpec& spec, double last) const;
};

/// Sorts the points of a file by position. A drop begins at a point from which the force falls by `least_drop` within the length
/// `within`; of points nearer to each other than that, the highest. @throws SceneError where the file cannot be used or has none
MeasuredInsertion read_insertion(const std::filesystem::path& file, const DataSpec& data, const InsertionSpec& spec);

}  // namespace glisson::fit
