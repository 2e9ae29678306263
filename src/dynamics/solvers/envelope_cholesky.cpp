#include "dynamics/solvers/envelope_cholesky.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace glisson {
namespace {

using Row = Eigen::Map<const Eigen::VectorXd>;

/// Column of the first entry of a row of a symmetric matrix.
Eigen::Index first_of(const Eigen::SparseMatrix<double>& matrix, Eigen::Index row) {
  Eigen::Index first = row;
  for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, row); it; ++it) first = std::min(first, it.row());
  return first;
}

/// Vertices reached from `start`, nearest first, few neighbours before many.
std::vector<std::uint32_t> walk(const std::vector<std::vector<std::uint32_t>>& neighbours, std::uint32_t start,
                                std::vector<char> seen) {
  std::vector<std::uint32_t> order{start};
  seen[start] = 1;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t from = order.size();
    for (const std::uint32_t v : neighbours[order[k]]) {
      if (seen[v] == 0) order.push_back(v), seen[v] = 1;
    }
    std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(from), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return neighbours[a].size() < neighbours[b].size(); });
  }
  return order;
}

}  // namespace

std::vector<std::uint32_t> close_order(const std::vector<std::vector<std::uint32_t>>& neighbours) {
  std::vector<std::uint32_t> place(neighbours.size());
  std::vector<char> seen(neighbours.size(), 0);
  std::uint32_t next = 0;
  for (std::uint32_t v = 0; v < neighbours.size(); ++v) {
    if (seen[v] != 0) continue;
    std::uint32_t rim = v;
    for (int i = 0; i < 3; ++i) rim = walk(neighbours, rim, seen).back();
    for (const std::uint32_t w : walk(neighbours, rim, seen)) place[w] = next++, seen[w] = 1;
  }
  return place;
}

std::size_t EnvelopeCholesky::entries(const Eigen::SparseMatrix<double>& matrix) {
  std::size_t sum = 0;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) sum += static_cast<std::size_t>(r - first_of(matrix, r) + 1);
  return sum;
}

bool EnvelopeCholesky::factorise(const Eigen::SparseMatrix<double>& matrix) {
  const Eigen::Index n = matrix.rows();
  std::vector<Eigen::Index> first_column;
  std::vector<std::size_t> begin;
  std::vector<double> values(entries(matrix), 0.0), inverse(static_cast<std::size_t>(n), 0.0);
  std::size_t at = 0;
  for (Eigen::Index r = 0; r < n; ++r) {
    const Eigen::Index first = first_of(matrix, r);
    first_column.push_back(first), begin.push_back(at);
    double* row = values.data() + at;
    double diagonal = 0.0;
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, r); it && it.row() <= r; ++it) {
      if (it.row() == r) {
        diagonal = it.value();
      } else {
        row[it.row() - first] = it.value();
      }
    }
    for (Eigen::Index c = first; c < r; ++c) {  // l_rc = (a_rc − Σ l_rk l_ck) / l_cc
      const auto k = static_cast<std::size_t>(c);
      const Eigen::Index from = std::max(first, first_column[k]), count = c - from;
      const Row mine(row + (from - first), count), other(values.data() + begin[k] + (from - first_column[k]), count);
      row[c - first] = (row[c - first] - mine.dot(other)) * inverse[k];
    }
    diagonal -= Row(row, r - first).squaredNorm();
    if (!(diagonal > 0.0)) return false;
    inverse[static_cast<std::size_t>(r)] = 1.0 / std::sqrt(diagonal);
    at += static_cast<std::size_t>(r - first);
  }
  pack(first_column, begin, values, inverse);
  return true;
}

/// Takes eight rows at a time, from the first column of any of them.
void EnvelopeCholesky::pack(const std::vector<Eigen::Index>& first, const std::vector<std::size_t>& begin,
                            const std::vector<double>& rows, const std::vector<double>& inverse) {
  panels_.clear(), values_.clear();
  const auto n = static_cast<Eigen::Index>(first.size());
  for (Eigen::Index r0 = 0; r0 < n; r0 += kPanelRows) {
    const Eigen::Index count = std::min<Eigen::Index>(kPanelRows, n - r0);
    const auto k0 = static_cast<std::size_t>(r0), k1 = static_cast<std::size_t>(r0 + count);
    const Eigen::Index from = std::min(r0, *std::min_element(first.begin() + r0, first.begin() + r0 + count));
    Panel panel{from, r0, values_.size(), Corner::Zero(count, count)};
    Corner identity = Corner::Identity(count, count);
    values_.resize(values_.size() + static_cast<std::size_t>(count * (r0 - from)), 0.0);
    for (std::size_t k = k0; k < k1; ++k) {
      const auto row = static_cast<Eigen::Index>(k - k0);
      double* out = values_.data() + panel.at + static_cast<std::size_t>(row * (r0 - from));
      panel.inverse(row, row) = 1.0 / inverse[k];
      for (Eigen::Index c = first[k]; c < static_cast<Eigen::Index>(k); ++c) {
        const double value = rows[begin[k] + static_cast<std::size_t>(c - first[k])];
        if (c < r0) {
          out[c - from] = value;
        } else {
          panel.inverse(row, c - r0) = value;
        }
      }
    }
    panel.inverse.triangularView<Eigen::Lower>().solveInPlace(identity);
    panel.inverse = identity;
    panels_.push_back(std::move(panel));
  }
}

void EnvelopeCholesky::solve(Eigen::VectorXd& x) const {
  const auto before = [&](const Panel& p) {
    return Eigen::Map<const Eigen::MatrixXd>(values_.data() + p.at, p.begin - p.first, p.inverse.rows());
  };
  for (const Panel& p : panels_) {
    Part own = x.segment(p.begin, p.inverse.rows());
    if (p.first < p.begin) own.noalias() -= before(p).transpose() * x.segment(p.first, p.begin - p.first);
    x.segment(p.begin, own.size()) = p.inverse.lazyProduct(own);
  }
  for (auto p = panels_.rbegin(); p != panels_.rend(); ++p) {
    const Part own = p->inverse.transpose().lazyProduct(x.segment(p->begin, p->inverse.rows()));
    x.segment(p->begin, own.size()) = own;
    if (p->first < p->begin) x.segment(p->first, p->begin - p->first).noalias() -= before(*p) * own;
  }
}

}  // namespace glisson
