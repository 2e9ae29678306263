#include "fit/insertion/baseline.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "fit/algebra/decompositions.h"

namespace glisson::fit {
namespace {

double rms_left(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y) {
  const Eigen::VectorXd left = columns * least_squares(columns, y) - y;
  return std::sqrt(left.squaredNorm() / static_cast<double>(y.size()));
}

}  // namespace

Baseline baseline_of(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<Eigen::Index>(x.size());
  const double first = x.front(), length = x.back() - x.front();
  Eigen::MatrixXd powers(n, 3), growth(n, 2);
  Eigen::VectorXd force(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double s = (x[static_cast<std::size_t>(i)] - first) / length;
    powers.row(i) << 1.0, s, s * s;
    force(i) = y[static_cast<std::size_t>(i)];
  }
  Baseline best{rms_left(powers.leftCols(2), force), rms_left(powers, force)};
  for (double rate = 0.05; rate < 50.0; rate *= 1.02) {  // over the whole length
    growth << Eigen::VectorXd::Ones(n), (rate * powers.col(1)).array().exp().matrix();
    best.exponential = std::min(best.exponential, rms_left(growth, force));
  }
  return best;
}

}  // namespace glisson::fit
