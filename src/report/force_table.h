// force_table.h — the columns of forces.csv and how a sample fills them.
//
//   forces.csv         time, depth and forces of the first tool · energies · what each support carries
//   forces_<tool>.csv  time, depth and forces of every further tool
//
// Vectors are in the scene's axes. Scalars are along the tool's direction, positive when it presses.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "glisson/scene.h"

namespace glisson {

/// Turns the samples of one variant into rows of numbers.
class ForceTable {
 public:
  explicit ForceTable(const Variant& variant);

  /// Columns of forces.csv, each with its unit.
  const std::vector<std::string>& columns() const { return columns_; }
  /// A row of forces.csv. A scene without a tool has 0 in the tool's columns.
  std::vector<double> row(const Sample& sample) const;

  std::size_t tools() const { return directions_.size(); }
  /// Columns of forces_<tool>.csv: the first twelve of forces.csv.
  static const std::vector<std::string>& tool_columns();
  std::vector<double> tool_row(const Sample& sample, std::size_t tool) const;

 private:
  std::vector<Vec3d> directions_;  // unit vectors, one per tool
  std::vector<std::string> columns_;
};

}  // namespace glisson
