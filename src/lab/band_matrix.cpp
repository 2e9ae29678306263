#include "lab/band_matrix.h"

#include <cmath>

namespace glisson::lab {

void BandMatrix::fix(std::size_t row) {
  std::fill_n(data_.begin() + static_cast<std::ptrdiff_t>(row * stride_), stride_, 0.0);
  const std::size_t last = std::min(row + half_, rows_ - 1);
  for (std::size_t r = row > half_ ? row - half_ : 0; r <= last; ++r) (*this)(r, row) = 0.0;
  (*this)(row, row) = 1.0;
}

void BandMatrix::add_row(std::size_t row, double factor, std::vector<double>& x) const {
  const std::size_t last = std::min(row + half_, rows_ - 1);
  for (std::size_t c = row > half_ ? row - half_ : 0; c <= last; ++c)
    x[c] += factor * data_[row * stride_ + c + half_ - row];
}

bool BandMatrix::factor() {
  for (std::size_t k = 0; k < rows_; ++k) {
    const double* pivot = &data_[k * stride_ + half_];
    if (pivot[0] == 0.0 || !std::isfinite(pivot[0])) return false;
    const std::size_t width = std::min(half_, rows_ - 1 - k);
    for (std::size_t i = 1; i <= width; ++i) {
      if (pivot[i] == 0.0) continue;
      const double share = pivot[i] / pivot[0];
      double* row = &data_[(k + i) * stride_ + half_];  // from its diagonal on
      for (std::size_t c = i; c <= width; ++c) row[c - i] -= share * pivot[c];
    }
  }
  return true;
}

void BandMatrix::solve(std::vector<double>& x) const {
  for (std::size_t k = 0; k < rows_; ++k) {
    const double* row = &data_[k * stride_ + half_];
    const std::size_t width = std::min(half_, rows_ - 1 - k);
    const double part = x[k] / row[0];
    for (std::size_t c = 1; c <= width; ++c) x[k + c] -= row[c] * part;
  }
  for (std::size_t k = rows_; k-- > 0;) {
    const double* row = &data_[k * stride_ + half_];
    const std::size_t width = std::min(half_, rows_ - 1 - k);
    double sum = x[k];
    for (std::size_t c = 1; c <= width; ++c) sum -= row[c] * x[k + c];
    x[k] = sum / row[0];
  }
}

}  // namespace glisson::lab
