// band_matrix.h — a symmetric matrix whose entries lie near the diagonal, factored in place.
//
// Elimination without exchange of rows, as the tangent of a solid allows, of the half above the diagonal alone. Cost: ½ n w² for
// n rows of half-width w.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace glisson::lab {

class BandMatrix {
 public:
  BandMatrix(std::size_t rows, std::size_t half_width)
      : rows_(rows), half_(half_width), stride_(2 * half_width + 1), data_(rows * stride_) {}

  void clear() { std::fill(data_.begin(), data_.end(), 0.0); }
  /// |row − column| ≤ half width.
  double& operator()(std::size_t row, std::size_t column) { return data_[row * stride_ + column + half_ - row]; }
  /// The row and the column become those of the unit matrix.
  void fix(std::size_t row);
  /// x += factor × the row.
  void add_row(std::size_t row, double factor, std::vector<double>& x) const;
  /// False where a pivot vanishes.
  bool factor();
  /// x ← A⁻¹ x, after factor().
  void solve(std::vector<double>& x) const;

 private:
  std::size_t rows_, half_, stride_;
  std::vector<double> data_;
};

}  // namespace glisson::lab
