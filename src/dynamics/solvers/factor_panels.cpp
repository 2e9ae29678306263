#include "dynamics/solvers/factor_panels.h"

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace glisson {
namespace {

constexpr Eigen::Index kColumnsAtOnce = 24;  ///< of a triangle with signs that are factorised one by one
constexpr double kLeastPivot = 1e-12;  ///< of the diagonal that it comes from: below it there is no factor with signs

/// Rows of each column of L below its diagonal, ascending: those of A, and what columns leave to the one of their first row.
std::vector<std::vector<int>> rows_of_factor(const FactorPanels::Matrix& A, const Eigen::VectorXi& place) {
  std::vector<std::vector<int>> rows(static_cast<std::size_t>(A.cols()));
  for (Eigen::Index k = 0; k < A.outerSize(); ++k) {
    for (FactorPanels::Matrix::InnerIterator entry(A, k); entry; ++entry) {
      const auto [column, row] = std::minmax(place[entry.row()], place[entry.col()]);
      if (row > column) rows[static_cast<std::size_t>(column)].push_back(row);
    }
  }
  for (std::vector<int>& own : rows) {
    std::ranges::sort(own);  // with what earlier columns have left, each of them in order
    own.erase(std::unique(own.begin(), own.end()), own.end());
    if (own.empty()) continue;
    std::vector<int>& next = rows[static_cast<std::size_t>(own.front())];
    next.insert(next.end(), own.begin() + 1, own.end());
  }
  return rows;
}

}  // namespace

bool FactorPanels::factorise(const Matrix& A, Eigen::Index negative, StepInterrupt* interrupt) {
  const Matrix both = A.selfadjointView<Eigen::Lower>();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> back;
  if (A.cols() > 0) Eigen::AMDOrdering<int>()(both, back);
  order_ = back.inverse();
  find_panels(rows_of_factor(A, order_.indices()));
  find_places(A);
  negative_ = negative;
  return factorise_again(A, interrupt);
}

void FactorPanels::find_panels(const std::vector<std::vector<int>>& rows) {
  panels_.clear(), rows_.clear();
  panel_of_.resize(rows.size());
  std::size_t values = 0;
  const auto goes_on = [&](std::size_t c) {  // the same rows in the next column, but for that one
    return c + 1 < rows.size() && !rows[c].empty() && rows[c].front() == static_cast<int>(c + 1) &&
           rows[c].size() == rows[c + 1].size() + 1;
  };
  for (std::size_t first = 0, next = 0; first < rows.size(); first = next) {
    next = first + 1;
    while (goes_on(next - 1)) ++next;
    const std::vector<int>& below = rows[next - 1];
    for (std::size_t c = first; c < next; ++c) panel_of_[c] = panels_.size();
    const auto width = static_cast<Eigen::Index>(next - first), n = static_cast<Eigen::Index>(below.size());
    panels_.push_back({static_cast<Eigen::Index>(first), width, static_cast<Eigen::Index>(rows_.size()), n, values});
    rows_.insert(rows_.end(), below.begin(), below.end());
    values += static_cast<std::size_t>(width * (width + n));
  }
  values_.resize(values);
  gathered_.resize(rows.size());
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
  if (negative_ == 0) {
    change_.noalias() = rows * rows.topRows(columns).transpose();
  } else {
    scaled_ = rows.topRows(columns) * sign_.segment(by.first, by.width).asDiagonal();
    change_.noalias() = rows * scaled_.transpose();
  }
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

/// The columns from begin to end of a panel's triangle, one by one, and the rows of the triangle below them.
bool FactorPanels::factorise_signed(const Panel& panel, Eigen::Index begin, Eigen::Index end) {
  Block L = triangle(panel);
  for (Eigen::Index c = begin; c < end; ++c) {
    const double pivot = L(c, c);
    if (!(std::abs(pivot) > kLeastPivot * diagonal_[panel.first + c])) return false;
    const double sign = sign_[panel.first + c] = pivot > 0.0 ? 1.0 : -1.0;
    L(c, c) = std::sqrt(sign * pivot);
    L.col(c).tail(panel.width - c - 1) *= sign / L(c, c);
    for (Eigen::Index k = c + 1; k < end; ++k) {
      L.col(k).tail(panel.width - k) -= (sign * L(k, c)) * L.col(c).tail(panel.width - k);
    }
  }
  return true;
}

/// Of a panel: L S Lᵀ in the place of what its triangle has left, and below it L.
bool FactorPanels::factorise_triangle(const Panel& panel) {
  Block own = triangle(panel);
  if (negative_ == 0) {
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(own);  // in place
    if (factor.info() != Eigen::Success) return false;
  }
  for (Eigen::Index begin = 0; negative_ > 0 && begin < panel.width; begin += kColumnsAtOnce) {
    const Eigen::Index end = std::min(begin + kColumnsAtOnce, panel.width), left = panel.width - end;
    if (!factorise_signed(panel, begin, end)) return false;
    if (left == 0) break;
    const auto done = own.block(end, begin, left, end - begin);
    scaled_ = sign_.segment(panel.first + begin, end - begin).asDiagonal() * done.transpose();
    own.bottomRightCorner(left, left).triangularView<Eigen::Lower>() -= done * scaled_;
  }
  if (panel.rows == 0) return true;
  Block under = below(panel);
  own.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(under);
  if (negative_ > 0) under *= sign_.segment(panel.first, panel.width).asDiagonal();
  return true;
}

bool FactorPanels::factorise_again(const Matrix& A, StepInterrupt* interrupt) {
  diagonal_.setZero(negative_ > 0 ? A.rows() : 0);
  for (Eigen::Index i = 0; i < diagonal_.size(); ++i) diagonal_[order_.indices()[i]] = std::abs(A.coeff(i, i));
  sign_.setOnes(diagonal_.size());
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
    if (interrupt != nullptr && interrupt->wanted()) return false;
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
    if (!factorise_triangle(panel)) return false;
    acts_next(p);
  }
  return (sign_.array() < 0.0).count() == negative_;
}

/// One right side. Each number comes from the same operations in the same order as in solve_some(), so that it does not matter
/// what it is solved with.
void FactorPanels::solve_one(double* x) const {
  for (const Panel& p : panels_) {
    double* own = x + p.first;
    const double *L = triangle(p).data(), *under = below(p).data();
    for (Eigen::Index c = 0; c < p.width; ++c) {
      const double now = own[c] /= L[c * p.width + c];
      for (Eigen::Index i = c + 1; i < p.width; ++i) own[i] -= L[c * p.width + i] * now;
    }
    double* sum = gathered_.data();
    std::fill_n(sum, p.rows, 0.0);
    Eigen::Index c = 0;
    for (; c + 3 <= p.width; c += 3) {
      const double *a = under + c * p.rows, *b = a + p.rows, *d = b + p.rows;
      for (Eigen::Index i = 0; i < p.rows; ++i) sum[i] = sum[i] + a[i] * own[c] + b[i] * own[c + 1] + d[i] * own[c + 2];
    }
    for (; c < p.width; ++c) {
      for (Eigen::Index i = 0; i < p.rows; ++i) sum[i] += under[c * p.rows + i] * own[c];
    }
    for (Eigen::Index i = 0; i < p.rows; ++i) x[row(p.rows_at + i)] -= sum[i];
  }
  for (Eigen::Index i = 0; i < sign_.size(); ++i) x[i] *= sign_[i];
  for (auto p = panels_.rbegin(); p != panels_.rend(); ++p) {
    double* own = x + p->first;
    const double *L = triangle(*p).data(), *under = below(*p).data();
    double* at = gathered_.data();
    for (Eigen::Index i = 0; i < p->rows; ++i) at[i] = x[row(p->rows_at + i)];
    Eigen::Index c = 0;
    for (; c + 3 <= p->width; c += 3) {  // sums side by side: none waits for its last addition
      const double *a = under + c * p->rows, *b = a + p->rows, *d = b + p->rows;
      double of_a = 0.0, of_b = 0.0, of_d = 0.0;
      for (Eigen::Index i = 0; i < p->rows; ++i) of_a += a[i] * at[i], of_b += b[i] * at[i], of_d += d[i] * at[i];
      own[c] -= of_a, own[c + 1] -= of_b, own[c + 2] -= of_d;
    }
    for (; c < p->width; ++c) {
      double sum = 0.0;
      for (Eigen::Index i = 0; i < p->rows; ++i) sum += under[c * p->rows + i] * at[i];
      own[c] -= sum;
    }
    for (c = p->width; c-- > 0;) {
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
  for (Eigen::Index i = 0; i < sign_.size(); ++i) row_of(x, i) *= sign_[i];
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
