#include "fit/forward/local_model.h"

#include <tbb/parallel_for.h>

#include <boost/random/sobol.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "fit/algebra/decompositions.h"

namespace glisson::fit {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
constexpr std::size_t kRunsPerTerm = 2;

/// All products of one, two and three coordinates.
Vector terms_at(const Vector& xi) {
  const Eigen::Index n = xi.size();
  std::vector<double> terms;
  for (Eigen::Index i = 0; i < n; ++i) {
    terms.push_back(xi[i]);
    for (Eigen::Index j = i; j < n; ++j) {
      terms.push_back(xi[i] * xi[j]);
      for (Eigen::Index k = j; k < n; ++k) terms.push_back(xi[i] * xi[j] * xi[k]);
    }
  }
  return Eigen::Map<const Vector>(terms.data(), static_cast<Eigen::Index>(terms.size()));
}

/// Points of a Sobol sequence, drawn towards the faces of the cube as the knots of Chebyshev are.
std::vector<Vector> points_of(std::size_t parameters, std::size_t count) {
  boost::random::sobol engine(parameters);
  std::vector<Vector> points;
  for (std::size_t i = 0; i < count; ++i) {
    Vector xi(static_cast<Eigen::Index>(parameters));
    for (double& x : xi) x = -std::cos(std::numbers::pi * boost::random::uniform_01<double>()(engine));
    points.push_back(std::move(xi));
  }
  return points;
}

}  // namespace

std::size_t LocalModel::runs_for(std::size_t parameters) {
  return 1 +
         kRunsPerTerm * static_cast<std::size_t>(terms_at(Vector::Zero(static_cast<Eigen::Index>(parameters))).size());
}

LocalModel::LocalModel(const Model& inner, const std::vector<std::size_t>& curves, Region region)
    : inner_(inner), region_(std::move(region)) {
  const auto n = static_cast<Eigen::Index>(region_.centre.size());
  if (n == 0 || region_.axes.size() != region_.centre.size())
    throw std::invalid_argument("a local model needs as many axes as parameters, one or more");
  Matrix axes(n, n);
  for (Eigen::Index k = 0; k < n; ++k)
    axes.col(k) = Eigen::Map<const Vector>(region_.axes[static_cast<std::size_t>(k)].data(), n);
  to_unit_ = inverse_of(axes);
  const Vector centre = Eigen::Map<const Vector>(region_.centre.data(), n);
  const Eigen::Index terms = terms_at(Vector::Zero(n)).size();
  points_ = runs_for(region_.centre.size());
  std::vector<Vector> at = points_of(region_.centre.size(), points_ - 1);
  at.insert(at.begin(), Vector::Zero(n));
  std::vector<Prediction> runs(at.size() * curves.size());
  tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t i) {
    const Vector values = centre + axes * at[i / curves.size()];
    runs[i] = inner_.predict(curves[i % curves.size()], {values.data(), static_cast<std::size_t>(n)});
  });
  for (const Prediction& run : runs) {
    if (failure_.empty() && run.force.empty()) failure_ = run.failure.empty() ? "no force" : run.failure;
  }
  if (!failure_.empty()) return;
  const auto rows = static_cast<Eigen::Index>(points_) - 1;
  Matrix basis(rows, terms);
  for (Eigen::Index i = 0; i < rows; ++i) basis.row(i) = terms_at(at[static_cast<std::size_t>(i) + 1]).transpose();
  const QrFactor qr(basis);
  const Matrix thin = qr.thin();
  const Vector left = (1.0 - thin.rowwise().squaredNorm().array()).max(1e-3).matrix();
  for (std::size_t c = 0; c < curves.size(); ++c) {
    Piece piece{runs[c].force, {}, 0.0};
    const auto samples = static_cast<Eigen::Index>(piece.middle.size());
    Matrix rise(rows, samples);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const std::vector<double>& force = runs[(static_cast<std::size_t>(i) + 1) * curves.size() + c].force;
      for (Eigen::Index s = 0; s < samples; ++s)
        rise(i, s) = force[static_cast<std::size_t>(s)] - piece.middle[static_cast<std::size_t>(s)];
    }
    piece.terms = qr.solve(rise);
    const Matrix missed = left.cwiseInverse().asDiagonal() * (rise - basis * piece.terms);
    piece.error = std::sqrt(missed.squaredNorm() / static_cast<double>(missed.size()));
    pieces_.emplace(curves[c], std::move(piece));
  }
}

Vector LocalModel::coordinates(std::span<const double> values) const {
  Vector apart(static_cast<Eigen::Index>(values.size()));
  for (std::size_t p = 0; p < values.size(); ++p) apart[static_cast<Eigen::Index>(p)] = values[p] - region_.centre[p];
  return to_unit_ * apart;
}

Prediction LocalModel::predict(std::size_t curve, std::span<const double> values) const {
  const auto piece = pieces_.find(curve);
  if (piece == pieces_.end()) return inner_.predict(curve, values);
  const Vector xi = coordinates(values);
  if (!(xi.cwiseAbs().maxCoeff() <= 1.0)) return inner_.predict(curve, values);
  const Vector more = piece->second.terms.transpose() * terms_at(xi);
  Prediction result{piece->second.middle, ""};
  for (std::size_t s = 0; s < result.force.size(); ++s) result.force[s] += more[static_cast<Eigen::Index>(s)];
  return result;
}

}  // namespace glisson::fit
