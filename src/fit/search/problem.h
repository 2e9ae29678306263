// problem.h — the residuals of a fit and their derivatives, on scaled parameters.
//
//   values (own units) ──to_scaled──▶ z in [0, 1], linear or logarithmic between the bounds
//   r_ci = w_c (F_model − F_measured) / s_c,   cost = ½ Σ ρ(r²)
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fit/model/model.h"
#include "fit/search/loss.h"
#include "glisson/fit.h"

namespace glisson::fit {

/// Residuals of all curves, one after the other, and their derivatives by z.
struct Residuals {
  std::vector<double> values;    ///< empty where a forward run failed
  std::vector<double> jacobian;  ///< row-major, values.size() × parameters; empty where not asked for
  std::string failure;
};

enum class Differences { central, one_sided };

class Problem {
 public:
  /// @param curves  those that are fitted @param indices  their numbers in the model @param spread  s_c of each [N], > 0
  Problem(std::vector<Parameter> parameters, std::vector<Curve> curves, std::vector<std::size_t> indices,
          std::vector<double> spread, const Model& model, Loss loss = {});

  /// The same parameters, model, loss and differences with other curves. @param origin  of each: the curve of this problem
  /// whose number in the model and spread it has
  std::unique_ptr<Problem> with(std::vector<Curve> curves, std::span<const std::size_t> origin) const;

  const std::vector<Parameter>& parameters() const { return parameters_; }
  const std::vector<Curve>& curves() const { return curves_; }
  const std::vector<double>& spread() const { return spread_; }
  const Model& model() const { return *model_; }
  std::size_t model_index(std::size_t curve) const { return indices_[curve]; }
  const Loss& loss() const { return loss_; }
  std::size_t size() const { return size_; }  ///< number of residuals
  /// The first residual of a curve.
  std::size_t offset(std::size_t curve) const { return offsets_[curve]; }

  /// z ↔ values; z is clamped to [0, 1].
  std::vector<double> to_scaled(std::span<const double> values) const;
  std::vector<double> to_values(std::span<const double> scaled) const;
  /// dvalue/dz of each parameter.
  std::vector<double> value_slopes(std::span<const double> scaled) const;

  /// Residuals without the loss, and their derivatives where these are asked for; the forward runs go side by side on all of
  /// oneTBB's threads. Same bytes on any number of threads.
  /// @param skip  parameters whose derivatives are left 0 (held fast); may be empty
  /// @param differences  central ones are one-sided at bounds; one-sided ones take half the runs and are of first order
  Residuals residuals(std::span<const double> scaled, bool derivatives, std::span<const char> skip = {},
                      Differences differences = Differences::central) const;

  /// ½ Σ ρ(r²).
  double cost(std::span<const double> residuals) const;
  /// ρ'(r²): how much a residual counts, 1 without a robust loss.
  double weight(double residual) const;

  /// Forward runs so far (a run of one curve each).
  std::uint64_t forward_runs() const { return runs_; }
  /// Step of the differences, in z.
  double difference_step = 1e-4;

 private:
  std::vector<Parameter> parameters_;
  std::vector<Curve> curves_;
  std::vector<std::size_t> indices_, offsets_;
  std::vector<double> spread_;
  const Model* model_;
  Loss loss_;
  std::size_t size_ = 0;
  mutable std::atomic<std::uint64_t> runs_{0};
};

}  // namespace glisson::fit
