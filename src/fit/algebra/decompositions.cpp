#include "fit/algebra/decompositions.h"

#include <Eigen/Dense>
#include <algorithm>

namespace glisson::fit {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

SingularDirections singular_directions(const Matrix& a) {
  const Matrix r = Eigen::HouseholderQR<Matrix>(a).matrixQR().topRows(std::min(a.rows(), a.cols()));
  Matrix square = Matrix::Zero(a.cols(), a.cols());
  square.topRows(r.rows()) = r.triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Matrix> svd(square, Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixV()};
}

Vector least_squares(const Matrix& a, const Vector& b, std::optional<double> rank) {
  Eigen::ColPivHouseholderQR<Matrix> qr(a);
  if (rank) qr.setThreshold(*rank);
  return qr.solve(b);
}

struct QrFactor::Factor {
  Eigen::HouseholderQR<Matrix> qr;
};

QrFactor::QrFactor(const Matrix& a) : factor_(new Factor{Eigen::HouseholderQR<Matrix>(a)}) {}
QrFactor::~QrFactor() = default;
Matrix QrFactor::thin() const {
  const auto& qr = factor_->qr;
  return qr.householderQ() * Matrix::Identity(qr.rows(), qr.cols());
}
Matrix QrFactor::solve(const Matrix& b) const { return factor_->qr.solve(b); }

Matrix inverse_of(const Matrix& a) { return a.inverse(); }

Vector solve(const Matrix& a, const Vector& b) { return a.partialPivLu().solve(b); }

std::optional<DefiniteSolution> solve_definite(const Matrix& a, const Vector& b) {
  const Eigen::LLT<Matrix> factor(a);
  if (factor.info() != Eigen::Success) return {};
  return DefiniteSolution{factor.solve(b), 2.0 * factor.matrixLLT().diagonal().array().log().sum()};
}

}  // namespace glisson::fit
