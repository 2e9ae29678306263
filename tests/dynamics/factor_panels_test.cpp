// Solves in panels are those of the factor they were taken from, for one right side and for many.
#include "dynamics/solvers/factor_panels.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace glisson {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// A symmetric positive definite matrix of n blocks of three, each coupled to a few others.
Matrix some_blocks(int n, int couplings, std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < 3; ++k) entries.emplace_back(3 * i + k, 3 * i + k, 1.0 + 6.0 * couplings);
    for (int c = 0; c < couplings; ++c) {
      const int j = static_cast<int>(random() % static_cast<unsigned>(n));
      if (j == i) continue;
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          const double x = number(random);
          entries.emplace_back(3 * i + a, 3 * j + b, x), entries.emplace_back(3 * j + b, 3 * i + a, x);
        }
      }
    }
  }
  Matrix A(3 * n, 3 * n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

/// Whether A x is what x was found for, for one right side and for many.
void expect_solves(const FactorPanels& panels, const Matrix& A) {
  for (const int columns : {1, 3, 25}) {
    const Eigen::MatrixXd b = Eigen::MatrixXd::Random(A.rows(), columns);
    Eigen::MatrixXd x = b;
    panels.solve(x);
    EXPECT_LT((A * x - b).norm(), 1e-13 * b.norm()) << A.rows() << " " << columns;
  }
}

Matrix lower(const Matrix& A) { return A.triangularView<Eigen::Lower>(); }

// A body of one vertex, of vertices without any coupling, with few and with many; and with other values at the same entries.
TEST(FactorPanels, SolveForAllColumns) {
  std::mt19937 random(3);
  FactorPanels panels;
  ASSERT_TRUE(panels.factorise(Matrix(0, 0)));
  for (const auto& [n, couplings] : {std::pair{1, 0}, {40, 0}, {40, 1}, {200, 4}, {60, 30}}) {
    Matrix A = some_blocks(n, couplings, random);
    ASSERT_TRUE(panels.factorise(lower(A)));
    expect_solves(panels, A);
    A *= 3.0;
    A.diagonal() *= 1.5;
    ASSERT_TRUE(panels.factorise_again(lower(A)));
    expect_solves(panels, A);
  }
}

// What is not positive definite is refused, at once and again, and harms nothing.
TEST(FactorPanels, RefuseWhatIsNotDefinite) {
  std::mt19937 random(5);
  const Matrix A = some_blocks(50, 4, random);
  Matrix broken = A;
  broken.coeffRef(77, 77) = -1.0;
  FactorPanels panels;
  EXPECT_FALSE(panels.factorise(lower(broken)));
  ASSERT_TRUE(panels.factorise(lower(A)));
  EXPECT_FALSE(panels.factorise_again(lower(broken)));
  ASSERT_TRUE(panels.factorise_again(lower(A)));
  expect_solves(panels, A);
}

// A column has the same bytes alone and among others.
TEST(FactorPanels, SolveAColumnAloneAsAmongOthers) {
  std::mt19937 random(9);
  const Matrix A = some_blocks(150, 5, random);
  FactorPanels panels;
  ASSERT_TRUE(panels.factorise(lower(A)));
  Eigen::MatrixXd together = Eigen::MatrixXd::Random(A.rows(), 13);
  const Eigen::MatrixXd b = together;
  panels.solve(together);
  for (Eigen::Index k = 0; k < b.cols(); ++k) {
    Eigen::MatrixXd x = b.col(k);
    panels.solve(x);
    EXPECT_EQ(x.col(0), together.col(k)) << k;
  }
}

/// Vertices of four unknowns, the fourth a pressure: −D on its diagonal, coupled with the other three of the vertices around it.
Matrix some_pressures(int n, std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const Matrix blocks = some_blocks(n, 4, random);
  std::vector<Eigen::Triplet<double>> entries;
  const auto both = [&](int row, int column, double x) {
    entries.emplace_back(row, column, x), entries.emplace_back(column, row, x);
  };
  for (int k = 0; k < blocks.outerSize(); ++k) {
    for (Matrix::InnerIterator x(blocks, k); x; ++x) {
      entries.emplace_back(static_cast<int>(x.row()), static_cast<int>(x.col()), x.value());
    }
  }
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(3 * n + i, 3 * n + i, -0.02);
    for (int j : {i, (i + 1) % n, static_cast<int>(random() % static_cast<unsigned>(n))}) {
      for (int a = 0; a < 3; ++a) both(3 * n + i, 3 * j + a, number(random));
    }
  }
  Matrix A(4 * n, 4 * n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

// A matrix that is negative definite on some unknowns; panels of few columns and of many.
TEST(FactorPanels, SolveWithPressures) {
  std::mt19937 random(11);
  FactorPanels panels;
  for (const int n : {1, 40, 300}) {
    Matrix A = some_pressures(n, random);
    ASSERT_TRUE(panels.factorise(lower(A), n)) << n;
    expect_solves(panels, A);
    A *= 3.0;
    ASSERT_TRUE(panels.factorise_again(lower(A))) << n;
    expect_solves(panels, A);
  }
}

// Other signs than those it is said to have are refused: as many as there are, and no pivot that is rounding alone.
TEST(FactorPanels, RefuseOtherSigns) {
  std::mt19937 random(13);
  const Matrix A = some_pressures(50, random);
  FactorPanels panels;
  EXPECT_FALSE(panels.factorise(lower(A)));
  EXPECT_FALSE(panels.factorise(lower(A), 49));
  EXPECT_FALSE(panels.factorise(lower(A), 51));
  Matrix singular = A;
  for (int i = 0; i < 200; ++i) singular.coeffRef(199, i) = singular.coeffRef(i, 199) = A.coeff(198, i);
  singular.coeffRef(199, 199) = singular.coeffRef(198, 199) = singular.coeffRef(199, 198) = A.coeff(198, 198);
  EXPECT_FALSE(panels.factorise(lower(singular), 50));
  ASSERT_TRUE(panels.factorise(lower(A), 50));
  expect_solves(panels, A);
}

// The same bytes whether the entries were known or not.
TEST(FactorPanels, GiveTheSameBytesAgain) {
  std::mt19937 random(7);
  const Matrix A = some_blocks(80, 5, random), other = 2.0 * A;
  FactorPanels once, again;
  ASSERT_TRUE(once.factorise(lower(A)));
  ASSERT_TRUE(again.factorise(lower(other)) && again.factorise_again(lower(A)));
  Eigen::MatrixXd x = Eigen::MatrixXd::Random(A.rows(), 2), y = x;
  once.solve(x), again.solve(y);
  EXPECT_EQ(x, y);
}

}  // namespace
}  // namespace glisson
