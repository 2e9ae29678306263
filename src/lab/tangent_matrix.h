// tangent_matrix.h — the symmetric tangent of a body of elements: summed entry by entry, factored as L D Lᵀ.
//
// Both halves are stored, a column's entries by ascending rows. Which entries there are follows from the elements alone: the order
// of elimination is found once for all factors. Rows are not exchanged for large pivots, as the tangent of a solid allows.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace glisson::lab {

class TangentMatrix {
 public:
  /// @param groups  of unknowns that an element couples with each other: only these have entries
  TangentMatrix(std::size_t unknowns, const std::vector<std::vector<std::size_t>>& groups);
  ~TangentMatrix();
  TangentMatrix(TangentMatrix&&) noexcept;

  void clear();
  /// Adds what an element says of its unknowns. @param block  of [row][column], in the order of the group
  template <class Block>
  void add(std::size_t group, const Block& block) {
    const std::vector<int>& places = places_[group];
    for (std::size_t i = 0, at = 0; i < block.size(); ++i) {
      for (std::size_t k = 0; k < block.size(); ++k) values_[static_cast<std::size_t>(places[at++])] += block[i][k];
    }
  }
  /// The entry of two unknowns of one group.
  double& operator()(std::size_t row, std::size_t column);
  /// The row and the column become those of the unit matrix.
  void fix(std::size_t row);
  /// x += factor × the row.
  void add_row(std::size_t row, double factor, std::vector<double>& x) const;
  /// False where a pivot vanishes or is not finite.
  bool factor();
  /// x ← A⁻¹ x, after factor().
  void solve(std::vector<double>& x) const;

 private:
  struct Factor;
  int place_of(std::size_t row, std::size_t column) const;

  std::vector<int> begin_, rows_;         ///< where each column begins, and one past the last; the row of each entry
  std::vector<double> values_;            ///< of each entry
  std::vector<std::vector<int>> places_;  ///< of each group's entries, a row after the other
  std::unique_ptr<Factor> factor_;
};

}  // namespace glisson::lab
