// force_table.h — the columns of forces.csv and how a sample fills them.
//
//   forces.csv         time, depth and forces of the first tool, or of the first instrument where there is no tool ·
//                      container · energies · what each support carries
//   forces_<name>.csv  time, depth and forces of every further tool and instrument
//
// Vectors are in the scene's axes. Scalars are along the tool's direction, positive when it presses.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "glisson/scene/scene.h"

namespace glisson {

/// Turns the samples of one variant into rows of numbers.
class ForceTable {
 public:
  explicit ForceTable(const Variant& variant);

  /// Columns of forces.csv, each with its unit.
  const std::vector<std::string>& columns() const { return columns_; }
  /// A row of forces.csv. A scene without tool and instrument has 0 in the tool's columns.
  std::vector<double> row(const Sample& sample) const;

  /// A file beside forces.csv.
  struct Further {
    std::string name;  ///< of the tool or instrument
    bool instrument = false;
    std::size_t index = 0;  ///< among the tools or instruments of the variant
  };
  const std::vector<Further>& further() const { return further_; }
  static const std::vector<std::string>& columns_of(const Further& file);
  std::vector<double> row_of(const Further& file, const Sample& sample) const;

 private:
  std::vector<double> tool_row(const Sample& sample, std::size_t tool) const;
  std::vector<double> instrument_row(const Sample& sample, std::size_t instrument) const;

  std::vector<Vec3d> tools_, instruments_;  // directions, unit vectors
  std::vector<Further> further_;
  std::vector<std::string> columns_;
  bool contained_;
};

}  // namespace glisson
