#include "lab/tangent_matrix.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

namespace glisson::lab {

struct TangentMatrix::Factor {
  using Sparse = Eigen::SparseMatrix<double>;

  Sparse matrix;
  Eigen::SimplicialLDLT<Sparse> ldlt;
};

TangentMatrix::TangentMatrix(std::size_t unknowns, const std::vector<std::vector<std::size_t>>& groups)
    : factor_(std::make_unique<Factor>()) {
  std::vector<std::vector<int>> columns(unknowns);
  for (const std::vector<std::size_t>& group : groups) {
    for (const std::size_t column : group) columns[column].insert(columns[column].end(), group.begin(), group.end());
  }
  begin_.push_back(0);
  for (std::vector<int>& column : columns) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    rows_.insert(rows_.end(), column.begin(), column.end());
    begin_.push_back(static_cast<int>(rows_.size()));
  }
  values_.resize(rows_.size());
  for (const std::vector<std::size_t>& group : groups) {
    std::vector<int>& places = places_.emplace_back();
    for (const std::size_t row : group) {
      for (const std::size_t column : group) places.push_back(place_of(row, column));
    }
  }
  const auto size = static_cast<Eigen::Index>(unknowns);
  factor_->matrix = Eigen::Map<const Factor::Sparse>(size, size, static_cast<Eigen::Index>(values_.size()),
                                                     begin_.data(), rows_.data(), values_.data());
  factor_->ldlt.analyzePattern(factor_->matrix);
}

TangentMatrix::~TangentMatrix() = default;
TangentMatrix::TangentMatrix(TangentMatrix&&) noexcept = default;

void TangentMatrix::clear() { std::fill(values_.begin(), values_.end(), 0.0); }

int TangentMatrix::place_of(std::size_t row, std::size_t column) const {
  const auto from = rows_.begin() + begin_[column], to = rows_.begin() + begin_[column + 1];
  return static_cast<int>(std::lower_bound(from, to, static_cast<int>(row)) - rows_.begin());
}

double& TangentMatrix::operator()(std::size_t row, std::size_t column) {
  return values_[static_cast<std::size_t>(place_of(row, column))];
}

void TangentMatrix::fix(std::size_t row) {
  for (int i = begin_[row]; i < begin_[row + 1]; ++i) {
    const auto at = static_cast<std::size_t>(i);
    values_[at] = 0.0;
    (*this)(row, static_cast<std::size_t>(rows_[at])) = 0.0;
  }
  (*this)(row, row) = 1.0;
}

void TangentMatrix::add_row(std::size_t row, double factor, std::vector<double>& x) const {
  for (int i = begin_[row]; i < begin_[row + 1]; ++i) {  // symmetric: a column is a row
    const auto at = static_cast<std::size_t>(i);
    x[static_cast<std::size_t>(rows_[at])] += factor * values_[at];
  }
}

bool TangentMatrix::factor() {
  std::copy(values_.begin(), values_.end(), factor_->matrix.valuePtr());
  factor_->ldlt.factorize(factor_->matrix);
  return factor_->ldlt.info() == Eigen::Success && factor_->ldlt.vectorD().allFinite();
}

void TangentMatrix::solve(std::vector<double>& x) const {
  Eigen::Map<Eigen::VectorXd> b(x.data(), static_cast<Eigen::Index>(x.size()));
  b = factor_->ldlt.solve(b).eval();
}

}  // namespace glisson::lab
