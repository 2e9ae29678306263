#include "heat/heat_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace glisson::heat {
namespace {

constexpr int kMostIterations = 60;
constexpr int kFreeIterations = 4;                            // after which the limiter keeps its shares
constexpr std::array<double, 4> kLeaves{0.9, 0.5, 0.1, 0.0};  // of what is allowed, round by round
constexpr double kExact = 1e-12;                              // of a temperature beside its neighbours' [K]
constexpr double kLeastCapacity = 0.2;  // of a vertex, where blood that comes with thaw feeds itself
constexpr double kLinear = 1e-6;        // of a linear solve, relative; Newton's method goes on from there

int place_of(const Eigen::SparseMatrix<double>& m, int row, int column) {
  const int* begin = m.innerIndexPtr() + m.outerIndexPtr()[column];
  const int* end = m.innerIndexPtr() + m.outerIndexPtr()[column + 1];
  return static_cast<int>(std::lower_bound(begin, end, row) - m.innerIndexPtr());
}

}  // namespace

HeatStepper::HeatStepper(const HeatBody& body) : body_(&body), finder_(body), states_(body.size()) {
  const int n = static_cast<int>(body.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1.0);
  for (const Conductance& c : body.conductances()) {
    const int i = static_cast<int>(c.i), j = static_cast<int>(c.j);
    entries.emplace_back(i, j, 1.0), entries.emplace_back(j, i, 1.0);
  }
  matrix_.resize(n, n);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  for (int i = 0; i < n; ++i) diagonal_.push_back(place_of(matrix_, i, i));
  for (const Conductance& c : body.conductances()) {
    const int i = static_cast<int>(c.i), j = static_cast<int>(c.j);
    places_.push_back({place_of(matrix_, i, j), place_of(matrix_, j, i)});
  }
  links_.assign(body.size(), 0.0);
  for (const Conductance& c : body.conductances()) links_[c.i] += std::abs(c.w), links_[c.j] += std::abs(c.w);
  symmetric_.setTolerance(kLinear), general_.setTolerance(kLinear);
}

Eigen::VectorXd HeatStepper::solve(const Eigen::VectorXd& residual) {
  if (body_->tissues() == 1) return symmetric_.compute(matrix_).solve(residual);
  return general_.compute(matrix_).solve(residual);
}

// With what the limiter left of conductances below 0, which is found anew each time.
void HeatStepper::set_matrix(const Input& in, std::span<const double> temperature, const Flows& flows) {
  double* value = matrix_.valuePtr();
  std::fill(value, value + matrix_.nonZeros(), 0.0);
  for (std::size_t i = 0; i < body_->size(); ++i) {
    const VertexState& s = states_[i];
    value[diagonal_[i]] =
        in.held[i] != 0 || s.capacity == 0.0
            ? 1.0
            : std::max(s.capacity + in.h * flows.loss[i], kLeastCapacity * s.capacity) / s.conductivity;
  }
  const auto all = body_->conductances();
  for (std::size_t e = 0; e < all.size(); ++e) {
    const Conductance& c = all[e];
    const double w = in.h * finder_.conductances()[e];
    double wi = w, wj = w;
    if (body_->tissues() > 1) {  // δΘ of this tissue over that of the vertices' means
      const ThermalTissue& t = body_->tissue(c.tissue);
      wi *= thermal_state(t, temperature[c.i]).conductivity / states_[c.i].conductivity;
      wj *= thermal_state(t, temperature[c.j]).conductivity / states_[c.j].conductivity;
    }
    if (in.held[c.i] == 0) value[diagonal_[c.i]] += wi;
    if (in.held[c.j] == 0) value[diagonal_[c.j]] += wj;
    if (in.held[c.i] == 0 && in.held[c.j] == 0) value[places_[e][0]] -= wj, value[places_[e][1]] -= wi;
  }
}

int HeatStepper::step(const Input& in, std::vector<double>& temperature, Flows& flows) {
  const std::size_t n = body_->size();
  Eigen::VectorXd residual(static_cast<Eigen::Index>(n));
  Limiter limiter = Limiter::follows;
  std::size_t round = 0;
  double last = std::numeric_limits<double>::infinity();
  for (int k = 1; k <= kMostIterations; ++k) {
    finder_.find(temperature, in.surfaces, limiter, kLeaves[std::min(round, kLeaves.size() - 1)], flows);
    double worst = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      states_[i] = body_->state(i, temperature[i]);
      double& r = residual[static_cast<Eigen::Index>(i)];
      r = in.held[i] != 0 || states_[i].capacity == 0.0
              ? 0.0
              : in.heat[i] + in.h * (flows.sum(i) + in.sources[i]) - states_[i].heat;
      const double per_kelvin = states_[i].capacity + in.h * states_[i].conductivity * links_[i];
      const double off = per_kelvin > 0.0 ? std::abs(r) / per_kelvin : 0.0;
      if (!(off <= worst)) worst = off;  // NaN, too
    }
    if (!std::isfinite(worst)) return -1;
    limiter = k < kFreeIterations ? Limiter::follows : Limiter::keeps;
    if (worst < kExact && !finder_.keeps_too_much()) return k;
    if (k == kFreeIterations || worst < kExact) limiter = Limiter::tightens, round += k == kFreeIterations ? 0 : 1;
    set_matrix(in, temperature, flows);
    const Eigen::VectorXd change = solve(residual);
    const double share = k > kFreeIterations && worst >= last && limiter == Limiter::keeps
                             ? 0.5
                             : 1.0;  // to and fro across a corner of H
    last = worst;
    for (std::size_t i = 0; i < n; ++i) {
      if (in.held[i] != 0 || states_[i].capacity == 0.0) continue;
      const double heat = states_[i].heat +
                          share * states_[i].capacity * change[static_cast<Eigen::Index>(i)] / states_[i].conductivity;
      temperature[i] = body_->temperature_of(i, heat, temperature[i]);
    }
  }
  return -1;
}

}  // namespace glisson::heat
