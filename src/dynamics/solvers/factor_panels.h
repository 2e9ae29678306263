// factor_panels.h — a sparse Cholesky factor, L S Lᵀ = Q A Qᵀ, in dense panels: neighbouring columns with the same rows below them, of
// which finite elements have many, the three components of a vertex at least.
//
// Eigen's sparse factor goes entry by entry, and through the factor once for each right side. Panels are factorised (left-looking, as
// in [NgPeyton1993]) by products of dense matrices, and solved with for many right sides at once. Q is Eigen's minimum degree.
// S is 1, or of signs where A has some unknowns it is negative definite on (pressures beside displacements): such a matrix has a factor
// in any order [Vanderbei1995].
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "dynamics/solvers/step_interrupt.h"

namespace glisson {

class FactorPanels {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  /// Factorises A. @param A  its lower triangle  @param negative  how many of its eigenvalues are negative
  /// @param interrupt  asked between panels; null: nobody is asked
  /// @return whether so many are, and the others positive; false also where it was interrupted: it is to be made anew then
  bool factorise(const Matrix& A, Eigen::Index negative = 0, StepInterrupt* interrupt = nullptr);
  /// The same for a matrix with the entries of the last one, of other values.
  bool factorise_again(const Matrix& A, StepInterrupt* interrupt = nullptr);
  /// x ← A⁻¹ x, column by column: the same bytes for a column, whatever it is solved beside. @param x  as many rows as A
  void solve(Eigen::MatrixXd& x) const;

 private:
  using Block = Eigen::Map<Eigen::MatrixXd>;
  using ConstBlock = Eigen::Map<const Eigen::MatrixXd>;
  struct Panel {
    Eigen::Index first = 0, width = 0;   ///< columns of L
    Eigen::Index rows_at = 0, rows = 0;  ///< below the triangle, among rows_
    std::size_t values_at = 0;           ///< triangle, width × width, then what is below it, rows × width
  };
  void find_panels(const std::vector<std::vector<int>>& rows);
  void find_places(const Matrix& A);
  void solve_one(double* x) const;
  template <int N>
  void solve_some(double* x) const;
  bool factorise_triangle(const Panel& panel);
  bool factorise_signed(const Panel& panel, Eigen::Index begin, Eigen::Index end);
  void update(const Panel& by, Eigen::Index from, Eigen::Index columns, const Panel& panel);
  Block triangle(const Panel& p) { return {values_.data() + p.values_at, p.width, p.width}; }
  Block below(const Panel& p) { return {values_.data() + p.values_at + p.width * p.width, p.rows, p.width}; }
  ConstBlock triangle(const Panel& p) const { return {values_.data() + p.values_at, p.width, p.width}; }
  ConstBlock below(const Panel& p) const { return {values_.data() + p.values_at + p.width * p.width, p.rows, p.width}; }
  int row(Eigen::Index at) const { return rows_[static_cast<std::size_t>(at)]; }

  std::vector<Panel> panels_;
  std::vector<int> rows_;
  std::vector<double> values_;
  std::vector<std::size_t> panel_of_;                                    ///< per column of L
  std::vector<std::size_t> place_;                                       ///< among values_, per entry of A
  std::vector<Eigen::Index> place_of_row_;                               ///< per row of L: below the panel at hand
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order_;  ///< Q
  Eigen::Index negative_ = 0;                                            ///< of S
  Eigen::VectorXd sign_, diagonal_;                                      ///< S and Q |diag A|; empty: S is 1
  Eigen::MatrixXd change_, scaled_;
  mutable std::vector<double> ordered_, gathered_;
};

}  // namespace glisson
