#include "instruments/needle/cantilever.h"

#include <algorithm>

namespace glisson {

double cantilever(double at, double of, double bending_stiffness) {
  if (!(bending_stiffness > 0.0)) return 0.0;
  const double x = std::max(0.0, at), y = std::max(0.0, of);
  const double a = std::min(x, y), b = std::max(x, y);
  return a * a * (3.0 * b - a) / (6.0 * bending_stiffness);
}

Eigen::MatrixXd cantilever(std::span<const double> distances, double bending_stiffness) {
  const auto n = static_cast<Eigen::Index>(distances.size());
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
  if (!(bending_stiffness > 0.0)) return C;
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index k = 0; k < n; ++k) {
      C(j, k) =
          cantilever(distances[static_cast<std::size_t>(j)], distances[static_cast<std::size_t>(k)], bending_stiffness);
    }
  }
  return C;
}

}  // namespace glisson
