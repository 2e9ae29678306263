// small_models.h — models of a line of code, and noise whose bytes are the same everywhere, for the tests of the proof.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "fit/search/problem.h"

namespace glisson::fit::testing_models {

/// F = f(x, velocity, values) at the displacements of its curves.
class Formula final : public Model {
 public:
  using Function = std::function<double(double x, double velocity, std::span<const double> values)>;
  Formula(std::vector<Curve> curves, Function f) : curves_(std::move(curves)), f_(std::move(f)) {}
  std::size_t curves() const override { return curves_.size(); }
  Prediction predict(std::size_t c, std::span<const double> values) const override {
    Prediction p;
    for (const double x : curves_[c].displacement) p.force.push_back(f_(x, curves_[c].velocity, values));
    return p;
  }

 private:
  std::vector<Curve> curves_;
  Function f_;
};

/// Standard normal numbers by Box and Muller, for the library's own differ from one library to the next.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : random_(seed * 0x9E3779B97F4A7C15ull + 1) {}
  double uniform() { return (static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53; }
  double operator()() { return std::sqrt(-2.0 * std::log(uniform())) * std::cos(6.283185307179586 * uniform()); }
  /// A first-order process of unit variance: x_i = ρ x_{i−1} + √(1 − ρ²) ε_i.
  std::vector<double> correlated(std::size_t n, double rho) {
    std::vector<double> x(n);
    for (std::size_t i = 0; i < n; ++i)
      x[i] = i == 0 ? (*this)() : rho * x[i - 1] + std::sqrt(1.0 - rho * rho) * (*this)();
    return x;
  }

 private:
  std::mt19937_64 random_;
};

/// A curve without forces: n points from `first` to `last`.
inline Curve plan(std::size_t n, double first, double last, double velocity = 1.0) {
  Curve c;
  c.velocity = velocity;
  c.group = std::to_string(velocity);
  for (std::size_t i = 0; i < n; ++i) {
    const double x = first + (last - first) * static_cast<double>(i) / static_cast<double>(n - 1);
    c.displacement.push_back(x);
    c.time.push_back((x - first) / velocity);
  }
  c.force.assign(n, 0.0);
  return c;
}

/// Force of a cylinder of unit area and height, pressed by x between smooth plates: one Ogden term,
/// λ = 1 − x, F = −(2μ/α) (λ^(α−1) − λ^(−α/2−1)), compression positive.
inline double ogden(double x, double mu, double alpha) {
  const double stretch = 1.0 - x;
  return -(2.0 * mu / alpha) * (std::pow(stretch, alpha - 1.0) - std::pow(stretch, -0.5 * alpha - 1.0));
}

/// `copies` of a plan, named, with the formula's force at `truth`.
inline std::vector<Curve> simulate(Curve c, std::size_t copies, const Formula::Function& f,
                                   const std::vector<double>& truth) {
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < c.size(); ++i) c.force[i] = f(c.displacement[i], c.velocity, truth);
  for (std::size_t k = 0; k < copies; ++k) {
    curves.push_back(c);
    curves.back().name = "curve " + std::to_string(k + 1);
  }
  return curves;
}

inline std::vector<std::size_t> indices_of(const std::vector<Curve>& curves) {
  std::vector<std::size_t> indices(curves.size());
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i;
  return indices;
}

/// A problem with the model that its curves need, and one spread for all.
struct Twin {
  Formula model;
  Problem problem;
  Twin(std::vector<Parameter> parameters, const std::vector<Curve>& curves, double spread, Formula::Function f,
       Loss loss = {})
      : model(curves, std::move(f)), problem(std::move(parameters), curves, indices_of(curves),
                                             std::vector<double>(curves.size(), spread), model, loss) {}
};

}  // namespace glisson::fit::testing_models
