#include "dynamics/solvers/factor_panels.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <utility>

namespace glisson {
namespace {

/// Whether the column after `column` has the same rows, but for `column` itself.
bool goes_on(const FactorPanels::Matrix& L, Eigen::Index column) {
  const int *begin = L.outerIndexPtr() + column, *rows = L.innerIndexPtr();
  const int here = begin[1] - begin[0], next = begin[2] - begin[1];
  return here == next + 1 && rows[begin[0] + 1] == column + 1;
}

}  // namespace

bool FactorPanels::factorise(const Matrix& A) {
  const Eigen::SimplicialLLT<Matrix> factor(A);
  if (factor.info() != Eigen::Success) return false;
  order_ = factor.permutationP();
  find_panels(factor.matrixL().nestedExpression());
  find_places(A);
  return factorise_again(A);  // its values: the same bytes whenever this matrix is factorised
}

void FactorPanels::find_panels(const Matrix& L) {
  panels_.clear(), rows_.clear(), values_.clear();
  panel_of_.resize(static_cast<std::size_t>(L.cols()));
  for (Eigen::Index first = 0, next = 0; first < L.cols(); first = next) {
    next = first + 1;
    while (next < L.cols() && goes_on(L, next - 1)) ++next;
    const Eigen::Index width = next - first;
    const int *begin = L.outerIndexPtr() + first, *row = L.innerIndexPtr() + begin[0];
    const Eigen::Index rows = begin[1] - begin[0] - width;
    std::fill_n(panel_of_.begin() + first, width, panels_.size());
    panels_.push_back({first, width, static_cast<Eigen::Index>(rows_.size()), rows, values_.size()});
    rows_.insert(rows_.end(), row + width, row + width + rows);
    values_.resize(values_.size() + static_cast<std::size_t>(width * (width + rows)));
  }
}

void FactorPanels::find_places(const Matrix& A) {
  place_.clear();
  for (Eigen::Index k = 0; k < A.outerSize(); ++k) {
    for (Matrix::InnerIterator entry(A, k); entry; ++entry) {
      const auto [column, low] = std::minmax(order_.indices()[entry.row()], order_.indices()[entry.col()]);
      const Panel& p = panels_[panel_of_[static_cast<std::size_t>(column)]];
      const Eigen::Index c = column - p.first, in_triangle = low - p.first;
      const auto begin = rows_.begin() + p.rows_at;
      const Eigen::Index under = std::lower_bound(begin, begin + p.rows, low) - begin;
      const Eigen::Index at =
          in_triangle < p.width ? c * p.width + in_triangle : p.width * p.width + c * p.rows + under;
      place_.push_back(p.values_at + static_cast<std::size_t>(at));
    }
  }
}

/// Takes from a panel what an earlier one has in its columns. @param from, columns  rows of the earlier one that are those columns
void FactorPanels::update(const Panel& by, Eigen::Index from, Eigen::Index columns, const Panel& panel) {
  const Eigen::Index n = by.rows - from;
  const auto rows = below(by).middleRows(from, n);
  change_.resize(n, columns);
  change_.noalias() = rows * rows.topRows(columns).transpose();
  double *own = triangle(panel).data(), *under = below(panel).data();
  for (Eigen::Index k = 0; k < columns; ++k) {
    const Eigen::Index c = row(by.rows_at + from + k) - panel.first;
    for (Eigen::Index i = k; i < columns; ++i) {
      own[c * panel.width + row(by.rows_at + from + i) - panel.first] -= change_(i, k);
    }
    for (Eigen::Index i = columns; i < n; ++i) {
      under[c * panel.rows + place_of_row_[static_cast<std::size_t>(row(by.rows_at + from + i))]] -= change_(i, k);
    }
  }
}

bool FactorPanels::factorise_again(const Matrix& A) {
  std::ranges::fill(values_, 0.0);
  for (std::size_t k = 0; k < place_.size(); ++k) values_[place_[k]] += A.valuePtr()[k];
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> first(panels_.size(), kNone),
      next(panels_.size(), kNone);                    // panels that act on one, as a list
  std::vector<Eigen::Index> from(panels_.size(), 0);  // the first row of one that still acts
  place_of_row_.resize(panel_of_.size());
  const auto acts_next = [&](std::size_t p) {
    if (from[p] == panels_[p].rows) return;
    const std::size_t on = panel_of_[static_cast<std::size_t>(row(panels_[p].rows_at + from[p]))];
    next[p] = std::exchange(first[on], p);
  };
  for (std::size_t p = 0; p < panels_.size(); ++p) {
    const Panel& panel = panels_[p];
    for (Eigen::Index i = 0; i < panel.rows; ++i) place_of_row_[static_cast<std::size_t>(row(panel.rows_at + i))] = i;
    for (std::size_t by = first[p], after; by != kNone; by = after) {
      after = next[by];
      const auto begin = rows_.begin() + panels_[by].rows_at, end = begin + panels_[by].rows;
      const auto last = std::lower_bound(begin + from[by], end, panel.first + panel.width);
      const Eigen::Index columns = last - begin - from[by];
      update(panels_[by], from[by], columns, panel);
      from[by] += columns;
      acts_next(by);
    }
    Block own = triangle(panel);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(own);  // in place
    if (factor.info() != Eigen::Success) return false;
    if (panel.rows == 0) continue;
    Block under = below(panel);
    own.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(under);
    acts_next(p);
  }
  return true;
}

/// One right side. Each number comes from the same operations in the same order as in solve_some(), so that it does not matter
/// what it is solved with.
void FactorPanels::solve_one(double* x) const {
  for (const Panel& p : panels_) {
    double* own = x + p.first;
    const double *L = triangle(p).data(), *under = below(p).data();
    gathered_.assign(static_cast<std::size_t>(p.rows), 0.0);
    double* sum = gathered_.data();
    for (Eigen::Index c = 0; c < p.width; ++c) {
      const double now = own[c] /= L[c * p.width + c];
      for (Eigen::Index i = c + 1; i < p.width; ++i) own[i] -= L[c * p.width + i] * now;
      for (Eigen::Index i = 0; i < p.rows; ++i) sum[i] += under[c * p.rows + i] * now;
    }
    for (Eigen::Index i = 0; i < p.rows; ++i) x[row(p.rows_at + i)] -= sum[i];
  }
  for (auto p = panels_.rbegin(); p != panels_.rend(); ++p) {
    double* own = x + p->first;
    const double *L = triangle(*p).data(), *under = below(*p).data();
    gathered_.resize(static_cast<std::size_t>(p->rows));
    double* at = gathered_.data();
    for (Eigen::Index i = 0; i < p->rows; ++i) at[i] = x[row(p->rows_at + i)];
    constexpr Eigen::Index kSide = 4;  // sums side by side: none waits for its last addition
    for (Eigen::Index c = 0; c < p->width; c += kSide) {
      const Eigen::Index n = std::min(kSide, p->width - c);
      std::array<double, kSide> sum{};
      std::array<const double*, kSide> column;
      for (Eigen::Index k = 0; k < kSide; ++k) column[k] = under + (c + std::min(k, n - 1)) * p->rows;
      for (Eigen::Index i = 0; i < p->rows; ++i) {
        for (Eigen::Index k = 0; k < kSide; ++k) sum[k] += column[k][i] * at[i];
      }
      for (Eigen::Index k = 0; k < n; ++k) own[c + k] -= sum[k];
    }
    for (Eigen::Index c = p->width; c-- > 0;) {
      const double now = own[c] /= L[c * p->width + c];
      for (Eigen::Index i = 0; i < c; ++i) own[i] -= L[i * p->width + c] * now;
    }
  }
}

/// N right sides at once. @param x  N numbers a row
template <int N>
void FactorPanels::solve_some(double* x) const {
  using Row = Eigen::Array<double, N, 1>;  // whose operations are of whole vectors, which a loop's need not be
  const auto row_of = [](double* rows, Eigen::Index i) { return Eigen::Map<Row>(rows + N * i); };
  for (const Panel& p : panels_) {
    double* own = x + N * p.first;
    const double *L = triangle(p).data(), *under = below(p).data();
    for (Eigen::Index c = 0; c < p.width; ++c) {
      const Row now = row_of(own, c) /= L[c * p.width + c];
      for (Eigen::Index i = c + 1; i < p.width; ++i) row_of(own, i) -= L[c * p.width + i] * now;
    }
    for (Eigen::Index i = 0; i < p.rows; ++i) {
      Row sum = Row::Zero();
      for (Eigen::Index c = 0; c < p.width; ++c) sum += under[c * p.rows + i] * row_of(own, c);
      row_of(x, row(p.rows_at + i)) -= sum;
    }
  }
  for (auto p = panels_.rbegin(); p != panels_.rend(); ++p) {
    double* own = x + N * p->first;
    const double *L = triangle(*p).data(), *under = below(*p).data();
    for (Eigen::Index c = 0; c < p->width; ++c) {
      Row sum = Row::Zero();
      for (Eigen::Index i = 0; i < p->rows; ++i) sum += under[c * p->rows + i] * row_of(x, row(p->rows_at + i));
      row_of(own, c) -= sum;
    }
    for (Eigen::Index c = p->width; c-- > 0;) {
      const Row now = row_of(own, c) /= L[c * p->width + c];
      for (Eigen::Index i = 0; i < c; ++i) row_of(own, i) -= L[i * p->width + c] * now;
    }
  }
}

void FactorPanels::solve(Eigen::MatrixXd& x) const {
  constexpr int kSome = 8;
  const auto& place = order_.indices();
  for (Eigen::Index first = 0, n = 0; first < x.cols(); first += n) {
    n = std::min<Eigen::Index>(kSome, x.cols() - first);
    const bool alone = n == 1;
    const Eigen::Index wide = alone ? 1 : kSome;
    ordered_.assign(static_cast<std::size_t>(wide * x.rows()), 0.0);
    const auto at = [&](Eigen::Index i, Eigen::Index k) { return static_cast<std::size_t>(wide * place[i] + k); };
    for (Eigen::Index k = 0; k < n; ++k) {
      for (Eigen::Index i = 0; i < x.rows(); ++i) ordered_[at(i, k)] = x(i, first + k);
    }
    alone ? solve_one(ordered_.data()) : solve_some<kSome>(ordered_.data());
    for (Eigen::Index k = 0; k < n; ++k) {
      for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, first + k) = ordered_[at(i, k)];
    }
  }
}

}  // namespace glisson
