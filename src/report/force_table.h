// force_table.h — the columns of forces.csv and how a sample fills them.
//
//   forces.csv         time and columns of the first instrument (tools come first) ·
//                      container · energies · what each support carries · further energies · its pose and vectors
//   forces_<name>.csv  time and columns of every further instrument
//
// Vectors are in the scene's axes. Scalars are along the instrument's direction, positive when it presses.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "glisson/scene/scene.h"

namespace glisson {

/// Turns the samples of one variant into rows of numbers.
class ForceTable {
 public:
  ForceTable(const Variant& variant, const BuiltVariant& built);

  /// Columns of forces.csv, each with its unit.
  const std::vector<std::string>& columns() const { return columns_; }
  /// A row of forces.csv. A scene without instruments has 0 in the columns of a tool.
  std::vector<double> row(const Sample& sample) const;

  /// A file beside forces.csv.
  struct Further {
    std::string name;
    std::vector<std::string> columns;
    std::size_t instrument = 0;  ///< of the sample
  };
  const std::vector<Further>& further() const { return further_; }
  static std::vector<double> row_of(const Further& file, const Sample& sample);

 private:
  std::vector<Further> further_;
  std::vector<std::string> columns_;
  std::size_t lead_ = 0;  ///< columns of the first instrument, and what stands in for such of a tool in a container
  std::size_t own_ = 0;   ///< time and columns of the first instrument before its record_columns(), which come last
  bool contained_, stores_;
};

}  // namespace glisson
