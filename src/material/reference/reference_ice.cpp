#include "material/reference/reference_ice.h"

namespace glisson::reference {

Eigen::Matrix3d Ice::strain(const Eigen::Matrix3d& F) const {
  const Eigen::Matrix3d relative = F * first_.inverse();
  return 0.5 * (relative.transpose() * relative - Eigen::Matrix3d::Identity());
}

void Ice::form(double amount, const Eigen::Matrix3d& F) {
  if (networks_.empty()) first_ = F;
  networks_.push_back({amount, strain(F)});
}

void Ice::melt(double kept) {
  for (Network& n : networks_) n.amount *= kept;
}

double Ice::amount() const {
  double sum = 0.0;
  for (const Network& n : networks_) sum += n.amount;
  return sum;
}

double Ice::energy(const Eigen::Matrix3d& F) const {
  double sum = 0.0;
  for (const Network& n : networks_) {
    const Eigen::Matrix3d D = strain(F) - n.strain;
    sum += n.amount * (0.5 * lame_.lambda * D.trace() * D.trace() + lame_.mu * D.squaredNorm());
  }
  return first_.determinant() * sum;
}

Eigen::Matrix3d Ice::piola(const Eigen::Matrix3d& F) const {
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  for (const Network& n : networks_) {
    const Eigen::Matrix3d D = strain(F) - n.strain;
    S += n.amount * (lame_.lambda * D.trace() * Eigen::Matrix3d::Identity() + 2.0 * lame_.mu * D);
  }
  return first_.determinant() * F * first_.inverse() * S * first_.inverse().transpose();
}

}  // namespace glisson::reference
