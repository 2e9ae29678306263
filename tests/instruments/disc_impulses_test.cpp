// Impulses within discs: what they have to fulfil, for points that nearly coincide and for points that are held, too.
#include "contact/disc_impulses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace glisson::disc_impulses_test {
namespace {

/// Largest fault: slip within a disc, of the largest speed; or a size other than the limit, or a slip that is not along it.
double fault(const Eigen::MatrixXd& W, const Eigen::VectorXd& r, const std::vector<double>& most,
             const Eigen::VectorXd& J) {
  const Eigen::VectorXd slip = r - W * J;
  const double speed = r.cwiseAbs().maxCoeff();
  double worst = 0.0;
  for (std::size_t j = 0; j < most.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(2 * j);
    const Eigen::Vector2d own = J.segment<2>(at), s = slip.segment<2>(at);
    worst = std::max(worst, own.norm() / most[j] - 1.0);
    const double off = own.norm() < (1.0 - 1e-9) * most[j] ? s.norm() : (s - s.norm() * own / own.norm()).norm();
    worst = std::max(worst, off / speed);
  }
  return worst;
}

// Random points, some of them three times nearly at one place, some held in one direction or both: each stops within its disc, or its
// slip is along an impulse of the limit; and there nothing is left to do.
TEST(DiscImpulses, StopOrSlipAlongTheirLimit) {
  int most_sweeps = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto n = static_cast<Eigen::Index>(1 + random() % 30), modes = 2 * n + 4;
    Eigen::MatrixXd B = Eigen::MatrixXd::NullaryExpr(2 * n, modes, [&] { return normal(random); });
    for (Eigen::Index j = 1; j < n; ++j) {
      if (random() % 3 == 0) B.middleRows<2>(2 * j) = B.middleRows<2>(2 * j - 2) + 1e-3 * B.middleRows<2>(2 * j);
      if (random() % 5 == 0) B.row(2 * j).setZero();
      if (random() % 10 == 0) B.middleRows<2>(2 * j).setZero();
    }
    const Eigen::MatrixXd W = B * B.transpose();
    const Eigen::VectorXd r = Eigen::VectorXd::NullaryExpr(2 * n, [&] { return normal(random); });
    std::vector<double> most(static_cast<std::size_t>(n));
    for (double& m : most) m = std::pow(10.0, 1.5 * normal(random) - 1.0);
    Eigen::VectorXd J = Eigen::VectorXd::Zero(2 * n);
    most_sweeps = std::max(most_sweeps, solve_within_discs(W, r, most, J));
    EXPECT_LT(fault(W, r, most, J), 1e-7) << seed;
    const int again = solve_within_discs(W, r, most, J);
    EXPECT_LE(again, 5) << seed;
  }
  EXPECT_LT(most_sweeps, 1000);  // 650
  RecordProperty("most_sweeps", most_sweeps);
}

// One point: the exact answer, also where it is held across.
TEST(DiscImpulses, AreExactForOnePoint) {
  Eigen::Matrix2d A;
  A << 4.0, 0.0, 0.0, 1.0;
  EXPECT_LT((within_disc(A, {4.0, 2.0}, 10.0) - Eigen::Vector2d{1.0, 2.0}).norm(), 1e-14);
  const Eigen::Vector2d J = within_disc(A, {4.0, 2.0}, 1.0), slip = Eigen::Vector2d{4.0, 2.0} - A * J;
  EXPECT_NEAR(J.norm(), 1.0, 1e-14);
  EXPECT_LT((slip - slip.norm() * J).norm(), 1e-12);
  A(1, 1) = 0.0;
  EXPECT_LT((within_disc(A, {4.0, 0.0}, 3.0) - Eigen::Vector2d{1.0, 0.0}).norm(), 1e-14);
  EXPECT_LT((within_disc(A, {4.0, 1e-3}, 3.0) - Eigen::Vector2d{1.0, std::sqrt(8.0)}).norm(), 1e-2);
  EXPECT_EQ(within_disc(Eigen::Matrix2d::Zero(), {3.0, 4.0}, 5.0), (Eigen::Vector2d{3.0, 4.0}));
  EXPECT_EQ(within_disc(A, {0.0, 0.0}, 5.0), Eigen::Vector2d::Zero());
}

}  // namespace
}  // namespace glisson::disc_impulses_test
