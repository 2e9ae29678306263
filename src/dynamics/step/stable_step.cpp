#include "dynamics/step/stable_step.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <random>
#include <vector>

#include "base/symmetric_eigen.h"
#include "dynamics/step/step_rules.h"
#include "element/force_operator.h"

namespace glisson {
namespace {

constexpr int kKrylovSize = 24;
constexpr int kDenseSize = 96;  ///< unknowns up to which the whole matrix is decomposed
constexpr int kRestarts = 100;
constexpr double kRitzTolerance = 1e-4;  ///< residual over eigenvalue; it is added, so h* loses half of it at most
constexpr double kStepTolerance = 1e-5;  ///< of the Newton search; what is left over is taken off h*

/// M^(−½) [ Σ_blocks K(lame) + diag ] M^(−½).
class ScaledOperator {
 public:
  ScaledOperator(const Body& body, std::span<const LameParameters> lame, std::span<const double> diagonal,
                 std::span<const char> held)
      : body_(body), lame_(lame), diagonal_(diagonal), x_(body.vertex_count), y_(body.vertex_count),
        scale_(3 * body.vertex_count) {
    for (std::size_t i = 0; i < scale_.size(); ++i) {
      const double m = body.masses[i / 3];
      const bool moves = m > 0.0 && (held.empty() || held[i] == 0);
      scale_[i] = moves ? 1.0 / std::sqrt(m) : 0.0;
    }
  }

  Eigen::Index rows() const { return static_cast<Eigen::Index>(scale_.size()); }

  void perform_op(const double* in, double* out) const {
    for (std::size_t i = 0; i < scale_.size(); ++i) x_[i / 3][i % 3] = in[i] * scale_[i];
    apply_linear(body_, lame_, x_, y_);
    for (std::size_t i = 0; i < scale_.size(); ++i) {
      out[i] = scale_[i] * (y_[i / 3][i % 3] + diagonal_[i / 3] * x_[i / 3][i % 3]);
    }
  }

 private:
  const Body& body_;
  std::span<const LameParameters> lame_;
  std::span<const double> diagonal_;
  mutable std::vector<Vec3d> x_, y_;
  std::vector<double> scale_;
};

/// The largest eigenvalue bounded from above, and its vector.
struct TopPair {
  bool converged = false;
  double bound = 0.0;
  Eigen::VectorXd vector;
};

/// A unit mode with a tenth of noise, so that a search never starts orthogonal to the answer.
Eigen::VectorXd with_noise(const std::vector<double>& mode) {
  std::mt19937_64 random(1);
  Eigen::VectorXd noise(static_cast<Eigen::Index>(mode.size()));
  for (double& x : noise) x = 2.0 * static_cast<double>(random() >> 11U) * 0x1p-53 - 1.0;
  return Eigen::Map<const Eigen::VectorXd>(mode.data(), noise.size()) + 0.1 * noise.normalized();
}

/// A small body's vector of the largest eigenvalue, from the whole matrix.
Eigen::VectorXd dense_top_vector(const ScaledOperator& op) {
  Eigen::MatrixXd matrix(op.rows(), op.rows());
  for (Eigen::Index c = 0; c < matrix.cols(); ++c) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(op.rows(), c);
    op.perform_op(unit.data(), matrix.col(c).data());
  }
  return symmetric_eigen(matrix).vectors.rightCols<1>();
}

/// The same by Lanczos; empty where it does not converge.
/// @param mode  a unit vector near the answer, or empty
Eigen::VectorXd lanczos_top_vector(const ScaledOperator& op, const std::vector<double>& mode) {
  LanczosOptions options{1, kKrylovSize, kRestarts, kRitzTolerance, {}};
  if (!mode.empty()) options.start = with_noise(mode);
  const auto apply = [&op](const double* in, double* out) { op.perform_op(in, out); };
  try {
    const LanczosResult top = largest_eigenpairs(apply, op.rows(), options);
    return top.converged ? Eigen::VectorXd(top.pairs.vectors.col(0)) : Eigen::VectorXd();
  } catch (const std::exception&) {  // an inner decomposition failed: the caller falls back to the element bound
    return {};
  }
}

TopPair top_pair(const ScaledOperator& op, const std::vector<double>& mode) {
  TopPair top;
  top.vector = op.rows() <= kDenseSize ? dense_top_vector(op) : lanczos_top_vector(op, mode);
  if (top.vector.size() == 0) return top;
  Eigen::VectorXd image(op.rows());
  op.perform_op(top.vector.data(), image.data());
  const double value = top.vector.dot(image);
  top.bound = value + (image - value * top.vector).norm();
  top.converged = std::isfinite(top.bound);
  return top;
}

constexpr int kMostSearches = 40;
constexpr double kLargestLeap = 8.0;  ///< of h in the Newton search

/// xᵀAx for the quadratic forms of stiffness, viscosity and nodal damping at the vector of a top pair.
struct RayleighQuotients {
  double k, c, g;
};

/// Holds the three matrices of the scheme and evaluates φ(h).
class SchemeSpectrum {
 public:
  SchemeSpectrum(const Body& body, std::span<const double> stiffening, std::span<const double> viscosity,
                 std::span<const double> nodal_damping, std::span<const char> held)
      : body_(body), damping_(nodal_damping), held_(held) {
    for (std::size_t b = 0; b < body.blocks.size(); ++b) {
      const TissueBlock& block = body.blocks[b];
      elastic_.push_back({stiffening[b] * block.elastic.lambda, stiffening[b] * block.elastic.mu});
      const double w = viscosity.empty() ? 1.0 : viscosity[b];
      viscous_.push_back({w * block.viscous.lambda, w * block.viscous.mu});
    }
  }

  TopPair top_at(double h, const std::vector<double>& mode) const {
    std::vector<LameParameters> lame;
    for (std::size_t b = 0; b < elastic_.size(); ++b) {
      lame.push_back({h * h * elastic_[b].lambda + 2.0 * h * viscous_[b].lambda,
                      h * h * elastic_[b].mu + 2.0 * h * viscous_[b].mu});
    }
    std::vector<double> diagonal(body_.vertex_count, 0.0);
    for (std::size_t i = 0; i < damping_.size(); ++i) diagonal[i] = -2.0 * h * damping_[i];
    return top_pair(ScaledOperator(body_, lame, diagonal, held_), mode);
  }

  RayleighQuotients quotients(const Eigen::VectorXd& x) const {
    const std::vector<double> none(body_.vertex_count, 0.0);
    const std::vector<LameParameters> zero(elastic_.size());
    const auto form = [&](std::span<const LameParameters> lame, std::span<const double> diagonal) {
      Eigen::VectorXd y(x.size());
      ScaledOperator(body_, lame, diagonal, held_).perform_op(x.data(), y.data());
      return x.dot(y);
    };
    return {form(elastic_, none), form(viscous_, none), damping_.empty() ? 0.0 : form(zero, damping_)};
  }

 private:
  const Body& body_;
  std::span<const double> damping_;
  std::span<const char> held_;
  std::vector<LameParameters> elastic_, viscous_;
};

/// Root of k h² + 2 (c − g) h = 4, the formula of one mode with unit mass; infinite where there is none.
double mode_step(const RayleighQuotients& q) {
  const double d = q.g - q.c;
  if (!(q.k > 0.0) && !(d < 0.0)) return std::numeric_limits<double>::infinity();
  const double root = std::sqrt(d * d + 4.0 * std::max(0.0, q.k));
  // (d + root) / k without cancellation where viscosity dominates (d < 0)
  return d >= 0.0 ? (d + root) / q.k : 4.0 / (root - d);
}

double largest(const Sym3<double>& a) {
  Eigen::Matrix3d m;
  m << a.xx, a.xy, a.zx, a.xy, a.yy, a.yz, a.zx, a.yz, a.zz;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m, Eigen::EigenvaluesOnly).eigenvalues()(2);
}

/// Largest eigenvalue of Σ_a s_a s_aᵀ over the four vertices [1/m²].
double gradient_spread(const ElementRest& rest) {
  Sym3<double> sum;
  for (const Vec3d& s : rest.s) sum += outer_square(s);
  return largest(sum + outer_square(rest.s[0] + rest.s[1] + rest.s[2]));
}

}  // namespace

double modulus_bound(LameParameters lame) { return std::max(3.0 * lame.lambda + 2.0 * lame.mu, 2.0 * lame.mu); }

double damped_step(double k, double c) { return mode_step({k, c, 0.0}); }

namespace {

/// Bounds of an element's k and c over its mass.
RayleighQuotients element_quotients(const Body& body, const TissueBlock& block, std::size_t e, double stiffening,
                                    double viscosity) {
  const double factor = body.mass_factor.empty() ? 1.0 : body.mass_factor[e];
  const double per_mass = 4.0 * gradient_spread(body.rest[e]) / (block.tissue.density * factor);
  const double viscous = std::max(0.0, viscosity) * modulus_bound(block.viscous);
  return {stiffening * modulus_bound(block.elastic) * per_mass, viscous * per_mass, 0.0};
}

}  // namespace

double element_step(const Body& body, const TissueBlock& block, std::size_t e, double stiffening, double viscosity) {
  return mode_step(element_quotients(body, block, e, stiffening, viscosity));
}

double mass_factor_for(const Body& body, const TissueBlock& block, std::size_t e, double step, double viscosity) {
  const RayleighQuotients q = element_quotients(body, block, e, 1.0, viscosity);
  return 0.25 * step * (q.k * step + 2.0 * q.c);
}

double element_bound_step(const Body& body, std::span<const double> stiffening, std::span<const double> viscosity) {
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < body.blocks.size(); ++b) {
    const TissueBlock& block = body.blocks[b];
    const double w = viscosity.empty() ? 1.0 : viscosity[b];
    for (std::size_t e = block.begin; e < block.end; ++e) {
      step = std::min(step, element_step(body, block, e, stiffening[b], w));
    }
  }
  return step;
}

StableStep stable_step(const Body& body, std::span<const double> stiffening, std::span<const double> nodal_damping,
                       std::span<const char> held, StabilityGuess* guess, std::span<const double> viscosity) {
  const double safe = element_bound_step(body, stiffening, viscosity);
  const SchemeSpectrum spectrum(body, stiffening, viscosity, nodal_damping, held);
  std::vector<double> mode = guess != nullptr ? guess->mode : std::vector<double>{};
  double h = guess != nullptr && guess->step > safe ? guess->step : safe;
  // Newton: the mode that is worst at h gives the next h, never below h*. Where the damped modes are all negative at h
  // the worst one is nearly rigid and tells nothing: h grows until a stiff one shows.
  for (int i = 0; i < kMostSearches; ++i) {
    const TopPair top = spectrum.top_at(h, mode);
    if (!top.converged) break;
    mode.assign(top.vector.data(), top.vector.data() + top.vector.size());
    const double next = std::min(mode_step(spectrum.quotients(top.vector)), kLargestLeap * h);
    if (std::abs(next - h) < kStepTolerance * next) {
      if (guess != nullptr) *guess = {next, mode};
      // φ is convex and 0 at 0, so shrinking h by a fraction shrinks φ by at least that fraction.
      const double excess = std::max(0.0, (top.bound - 4.0) / top.bound);
      return {std::max(safe, h * (1.0 - excess)), false};
    }
    h = next;
  }
  // Drag that is taken off can leave a spectrum in which the search does not find its way; without it φ is larger, and
  // its step is still above that of the elements.
  if (std::any_of(viscosity.begin(), viscosity.end(), [](double w) { return w < 0.0; })) {
    std::vector<double> none_taken_off(viscosity.begin(), viscosity.end());
    for (double& w : none_taken_off) w = std::max(0.0, w);
    return stable_step(body, stiffening, nodal_damping, held, guess, none_taken_off);
  }
  return {safe, true};
}

}  // namespace glisson
