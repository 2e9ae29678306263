#include "heat/heat_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>

namespace glisson::heat {
namespace {

constexpr int kMostNewtonIterations = 60;
constexpr int kFreeIterations = 3;  // in which the limiter follows the temperatures; then it only takes more
constexpr double kFollows = 0.9;    // of what is allowed
constexpr std::array<double, 7> kLeaves{0.9, 0.9, 0.5, 0.5, 0.1, 0.1, 0.0};  // of what is allowed, round by round
constexpr double kNear = 1e-3;    // where it is looked whether the limiter leaves too much [K]
constexpr double kExact = 1e-12;  // of a temperature beside its neighbours' [K]
constexpr double kExactAlone =
    1e-10;  // of a temperature by the heat of its vertex alone: such a step is exact, too [K]
constexpr double kLeastCapacity = 0.2;  // of a vertex, where blood that comes with thaw feeds itself
constexpr int kDampedFrom = 6;          // iterations
// Of a linear solve, relative: as the square of what the last iteration gained.
constexpr double kLoosest = 0.1, kTightest = 1e-6;

/// Adds the CPU time of its life to a part of the work.
class Timed {
 public:
  Timed(bool counts, double& seconds) : seconds_(counts ? &seconds : nullptr), start_(counts ? std::clock() : 0) {}
  ~Timed() {
    if (seconds_ != nullptr) *seconds_ += static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC;
  }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  double* seconds_;
  std::clock_t start_;
};

}  // namespace

HeatStepper::HeatStepper(const HeatBody& body, int threads)
    : body_(&body), blocks_(body.size(), threads), finder_(body, blocks_), solver_(body, blocks_),
      fixed_(body.size(), 0), links_(body.size(), 0.0), residual_(body.size()), diagonal_(body.size()),
      else_in_(body.size()) {
  const Links& links = body.links();
  for (std::size_t p = 0; p < body.part_count(); ++p) {
    for (std::uint32_t k = links.begin[p]; k < links.begin[p + 1]; ++k)
      links_[body.vertex_of(p)] += std::abs(links.w[k]);
  }
}

void HeatStepper::set_work(const HeatWork& work, bool counts_time) {
  work_ = work;
  solver_.products = work.products, solver_.seconds = work.product_seconds, solver_.counts_time = counts_time;
}

HeatStepper::Distance HeatStepper::find_residual(const Input& in, Flows& flows) {
  const std::vector<VertexState>& states = finder_.states();
  const auto [beside, alone] = blocks_.largest<2>([&](std::size_t begin, std::size_t end) {
    std::array<double, 2> worst{};
    for (std::size_t i = begin; i < end; ++i) {
      flows.conduction[i] = finder_.conduction(i);
      if (fixed_[i] != 0) {
        residual_[i] = 0.0;
        continue;
      }
      const double r = in.heat[i] + in.h * (flows.sum(i) + in.sources[i]) - states[i].heat, size = std::abs(r);
      residual_[i] = r;
      const double by_all = size / (states[i].capacity + in.h * states[i].conductivity * links_[i]),
                   by_itself = size / states[i].capacity;
      if (!(by_all <= worst[0])) worst[0] = by_all;  // NaN, too
      if (!(by_itself <= worst[1])) worst[1] = by_itself;
    }
    return worst;
  });
  return {beside, alone};
}

void HeatStepper::find_else(const Input& in, const Flows& flows) {
  const std::vector<VertexState>& states = finder_.states();
  blocks_.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      else_in_[i] = fixed_[i] != 0 ? std::numeric_limits<double>::infinity()
                                   : flows.blood[i] + flows.metabolism[i] + flows.surface[i] + flows.lines[i] +
                                         in.sources[i] + (in.heat[i] - states[i].heat) / in.h;
    }
  });
}

void HeatStepper::set_diagonal(const Input& in, const Flows& flows) {
  const std::span<const double> sum = finder_.left_sum(), ratio = finder_.ratio();
  blocks_.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const VertexState& s = finder_.states()[i];
      if (fixed_[i] != 0) {
        diagonal_[i] = 1.0;
        continue;
      }
      double conducts = 0.0;
      const std::size_t first = body_->first_part(i), last = first + body_->parts(i).size();
      for (std::size_t p = first; p < last; ++p) conducts += ratio.empty() ? sum[p] : sum[p] * ratio[p];
      diagonal_[i] =
          std::max(s.capacity + in.h * flows.loss[i], kLeastCapacity * s.capacity) / s.conductivity + in.h * conducts;
    }
  });
}

void HeatStepper::change_temperature(double share, std::vector<double>& temperature) {
  blocks_.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (fixed_[i] != 0 || change_[i] == 0.0) continue;
      const VertexState& s = finder_.states()[i];
      temperature[i] =
          body_->temperature_of(i, s.heat + share * s.capacity * change_[i] / s.conductivity, temperature[i]);
    }
  });
}

int HeatStepper::step(const Input& in, std::vector<double>& temperature, Flows& flows) {
  const bool timed = solver_.counts_time;
  for (std::size_t i = 0; i < body_->size(); ++i) fixed_[i] = in.held[i] != 0 || body_->volume(i) == 0.0 ? 1 : 0;
  std::size_t round = 0;
  double last = std::numeric_limits<double>::infinity(), tolerance = kLoosest;
  ++work_.steps;
  for (int k = 1; k <= kMostNewtonIterations; ++k) {
    ++work_.iterations;
    {
      const Timed t(timed, work_.state_seconds);
      finder_.set_temperature(temperature, in.surfaces, in.dead, flows);
    }
    const bool follows = k <= kFreeIterations;  // leaves what these temperatures allow: nothing to tighten
    if (follows && finder_.has_negative()) {
      const Timed t(timed, work_.limiter_seconds);
      find_else(in, flows);
      finder_.limit(kFollows, else_in_, flows.limited);
      ++work_.limiter_rounds;
    }
    const auto residual = [&] {
      const Timed t(timed, work_.residual_seconds);
      return find_residual(in, flows);
    };
    Distance off = residual();
    if (!std::isfinite(off.beside)) return -1;
    bool tightened = false;
    const auto is_exact = [&] { return off.beside < kExact || off.alone < kExactAlone; };
    if ((off.beside < kNear || is_exact()) && !follows && finder_.has_negative()) {
      const Timed t(timed, work_.limiter_seconds);
      ++work_.limiter_rounds;
      find_else(in, flows);
      tightened = finder_.tighten(kLeaves[std::min(round, kLeaves.size() - 1)], else_in_, in.h, flows.limited);
    }
    if (tightened) ++round, off = residual();
    if (is_exact() && !tightened) return k;
    const double gained = off.beside / last;
    tolerance = std::isfinite(gained) ? std::clamp(0.9 * gained * gained, kTightest, kLoosest) : kLoosest;
    tolerance = std::max(tolerance, std::min(kLoosest, 0.1 * kExactAlone / off.alone));
    {
      const Timed t(timed, work_.solve_seconds);
      set_diagonal(in, flows);
      const HeatMatrix matrix{in.h, diagonal_, finder_.left(), finder_.ratio(), fixed_};
      work_.linear_iterations += static_cast<std::size_t>(solver_.solve(matrix, residual_, tolerance, change_));
    }
    work_.products = solver_.products, work_.product_seconds = solver_.seconds;
    // to and fro across a corner of H
    const double share = k > kDampedFrom && off.beside >= last && !tightened ? 0.5 : 1.0;
    last = off.beside;
    const Timed t(timed, work_.state_seconds);
    change_temperature(share, temperature);
  }
  return -1;
}

}  // namespace glisson::heat
