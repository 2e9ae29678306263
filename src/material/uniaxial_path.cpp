#include "material/uniaxial_path.h"

#include <algorithm>
#include <cmath>

#include "material/branch_weights.h"

namespace glisson {
namespace {

constexpr double kLeast = 0.02, kMost = 50.0;  ///< stretches across that are looked at

}  // namespace

UniaxialPath::UniaxialPath(const Tissue& tissue)
    : response_(tissue), branches_(std::min(tissue.maxwell.size(), kMostBranches)) {}

/// P of a stage, all parts.
template <class T>
Axial<T> UniaxialPath::stress(const Stage& stage, T side) const {
  const Axial<T> h{side - T(1.0), T(stage.z.stretch - 1.0)};
  const Axial<T> elastic = response_.elastic(h);
  Axial<T> P = elastic;
  if (stage.weight > 0.0)
    P = P + response_.viscous(h, Axial<T>{(side - T(stage.from)) * T(1.0 / stage.weight), T(stage.z.rate)});
  if (branches_ == 0) return P;
  const Axial<T> S = response_.relaxing(h, elastic);
  Axial<T> q = Axial<T>{T(stage.kept.side), T(stage.kept.along)} + S * T(stage.share);
  if (response_.paces().follows()) {
    const auto constant = [](Axial<double> a) { return Axial<T>{T(a.side), T(a.along)}; };
    const T x = response_.measure(h);
    for (std::size_t b = 0; b < branches_; ++b) {
      const MaxwellBranch& branch = response_.tissue().maxwell[b];
      if (!branch.time_law) continue;
      const BranchWeights<T> w = response_.paces().weights(b, stage.length, pace_[b], x);
      q = q + (constant(q_[b]) * w.decay + constant(relaxing_) * w.from + S * w.to) * T(branch.share);
    }
  }
  return P - response_.carry(h, q);
}

/// Newton, kept between the bounds that the sign of the lateral stress gives.
UniaxialState UniaxialPath::solve(const Stage& stage, double guess) {
  constexpr int kSteps = 80;
  double low = kLeast, high = kMost, side = std::clamp(guess, 2.0 * kLeast, 0.5 * kMost);
  for (int i = 0; i < kSteps; ++i) {
    const Axial<Dual> P = stress(stage, Dual(side, 1.0));
    if (!std::isfinite(P.side.v) || !std::isfinite(P.along.v)) break;
    const double newton = side - P.side.v / P.side.d;
    // the next move would be of the order of this one's square: the stress is carried there to first order
    if (std::abs(newton - side) < 1e-8 * side) return {P.along.v + P.along.d * (newton - side), newton, true};
    (P.side.v > 0.0 ? high : low) = side;
    side = newton > low && newton < high ? newton : 0.5 * (low + high);
  }
  return {stress(stage, side).along, side, false};
}

/// What the branches keep of the past at the end of h, and what they take of the stress there.
void UniaxialPath::weigh(double h, Stage& stage) const {
  stage.length = h, stage.kept = {}, stage.share = 0.0;
  for (std::size_t b = 0; b < branches_; ++b) {
    const MaxwellBranch& branch = response_.tissue().maxwell[b];
    if (branch.time_law) continue;
    const BranchWeights<> w = branch_weights(h, branch.time);
    stage.kept = stage.kept + (q_[b] * w.decay + relaxing_ * w.from) * branch.share;
    stage.share += branch.share * w.to;
  }
}

void UniaxialPath::update_branches(double h, double side, double stretch) {
  if (branches_ == 0) return;
  const Axial<double> strain{side - 1.0, stretch - 1.0};
  const Axial<double> S = response_.relaxing(strain, response_.elastic(strain));
  for (std::size_t b = 0; b < branches_; ++b) {
    const MaxwellBranch& branch = response_.tissue().maxwell[b];
    const BranchWeights<> w = branch.time_law ? response_.paces().weights(b, h, pace_[b], response_.measure(strain))
                                              : branch_weights(h, branch.time);
    q_[b] = q_[b] * w.decay + relaxing_ * w.from + S * w.to;
  }
  relaxing_ = S;
  set_paces(strain);
}

void UniaxialPath::set_paces(Axial<double> h) {
  if (!response_.paces().follows()) return;
  const double x = response_.measure(h);
  for (std::size_t b = 0; b < branches_; ++b) pace_[b] = response_.paces().at(b, x);
}

UniaxialState UniaxialPath::start(double rate) {
  side_ = stretch_ = 1.0, side_rate_ = last_slope_ = 0.0;
  relaxing_ = {}, q_ = {};
  set_paces({});
  if (!response_.is_viscous()) return {0.0, 1.0, true};
  // nothing is deformed yet; across, the viscous stress alone is 0, and it is linear in the rates
  const Axial<double> none{}, along = response_.viscous(none, {0.0, rate}),
                              across = response_.viscous(none, {1.0, 0.0});
  side_rate_ = across.side != 0.0 ? -along.side / across.side : 0.0;
  return {along.along + side_rate_ * across.along, 1.0, true};
}

UniaxialState UniaxialPath::at(double stretch) {
  const UniaxialState s = solve({.z = {stretch, 0.0}, .kept = {}}, side_ + last_slope_ * (stretch - stretch_));
  if (s.converged && stretch != stretch_) last_slope_ = (s.lateral_stretch - side_) / (stretch - stretch_);
  side_ = s.lateral_stretch, stretch_ = stretch;
  return s;
}

UniaxialState UniaxialPath::advance(double h, StretchRate middle, StretchRate end) {
  Stage last{.z = end, .kept = {}};
  double guess = side_ + last_slope_ * (end.stretch - stretch_);
  if (response_.is_viscous()) {
    Stage first{.z = middle, .from = side_, .weight = kMiddle * h, .kept = {}};
    weigh(kMiddle * h, first);
    const UniaxialState s = solve(first, side_ + kMiddle * h * side_rate_);
    if (!s.converged) return s;
    const double rate = (s.lateral_stretch - side_) / first.weight;
    last.from = side_ + (1.0 - kMiddle) * h * rate, last.weight = first.weight;
    guess = last.from + last.weight * rate;
  }
  weigh(h, last);
  const UniaxialState s = solve(last, guess);
  if (!s.converged) return s;
  if (last.weight > 0.0) side_rate_ = (s.lateral_stretch - last.from) / last.weight;
  if (end.stretch != stretch_) last_slope_ = (s.lateral_stretch - side_) / (end.stretch - stretch_);
  update_branches(h, s.lateral_stretch, end.stretch);
  side_ = s.lateral_stretch, stretch_ = end.stretch;
  return s;
}

}  // namespace glisson
