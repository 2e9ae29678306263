#include "element/tissue_operator.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "element/block_response.h"
#include "element/element_shape.h"
#include "material/branch_weights.h"
#include "material/principal.h"

namespace glisson {
namespace {

constexpr std::size_t kElementsATask = 128;

/// Adds f_a = −V P s_a to the four vertices.
void scatter(const Body& body, std::size_t e, const Mat3d& P, std::span<Vec3d> force) {
  const Tet& t = body.elements[e];
  const ElementRest& rest = body.rest[e];
  Vec3d sum{};
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3d f = (P * rest.s[a]) * -rest.volume;
    force[t[a + 1]] += f;
    sum += f;
  }
  force[t[0]] -= sum;
}

}  // namespace

void make_semidefinite(ElementTangent& C) {
  const ElementTangent even = 0.5 * (C + C.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver{Eigen::Matrix<double, 9, 9>(even)};
  if (solver.eigenvalues().minCoeff() >= 0.0) return;
  const auto& V = solver.eigenvectors();
  C = V * solver.eigenvalues().cwiseMax(0.0).asDiagonal() * V.transpose();
}

TissueOperator::TissueOperator(const Body& body, StepKind step, int threads)
    : body_(body), step_(step), pool_(std::make_unique<detail::TaskPool>(threads)) {
  body_changed();
}

/// Does the same to elements that do not know of each other, some at a time.
void TissueOperator::for_elements(std::size_t begin, std::size_t end,
                                  const std::function<void(std::size_t)>& act) const {
  const std::size_t tasks = (end - begin + kElementsATask - 1) / kElementsATask;
  pool_->run(tasks, [&](std::size_t task, std::size_t) {
    const std::size_t first = begin + task * kElementsATask, last = std::min(end, first + kElementsATask);
    for (std::size_t e = first; e < last; ++e) act(e);
  });
}

void TissueOperator::body_changed() {
  responses_.clear();
  shapes_.assign(body_.elements.size(), {});
  first_branch_.clear(), first_stress_.clear();
  std::size_t branches = 0, stresses = 0;
  bool follows = false;
  shares_volume_ = false;
  for (const TissueBlock& block : body_.blocks) {
    responses_.emplace_back(block.tissue);
    first_branch_.push_back(branches), first_stress_.push_back(stresses);
    const std::size_t n = block.end - block.begin, k = block.tissue.maxwell.size();
    branches += n * k, stresses += k > 0 ? n : 0;
    follows = follows || responses_.back().paces().follows();
    shares_volume_ = shares_volume_ || block.tissue.volume_change == VolumeChange::average_nodal;
    for (std::size_t e = block.begin; e < block.end; ++e) shapes_[e] = element_shape(body_, block.tissue, e);
  }
  memory_.relaxed.resize(branches);
  memory_.stress.resize(stresses);
  memory_.pace.resize(follows ? branches : 0);
  has_memory_ = branches > 0;
}

/// ϑ̄ of every element of a block that shares it; empty where none does.
std::vector<double> TissueOperator::mean_volume_change(std::span<const Vec3d> u) const {
  std::vector<double> mean;
  if (!shares_volume_) return mean;
  mean.assign(body_.elements.size(), 0.0);
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    const TissueBlock& block = body_.blocks[b];
    if (block.tissue.volume_change != VolumeChange::average_nodal) continue;
    for (std::size_t e = block.begin; e < block.end; ++e) {
      mean[e] = responses_[b].volume_change(element_gradient(body_, e, u));
    }
    average(body_, block, mean);
  }
  return mean;
}

/// The measure of an element, where times of branches follow it.
template <class T>
T TissueOperator::measure_of_times(std::size_t b, std::size_t e, const Mat3<T>& H) const {
  return responses_[b].paces().follows() ? responses_[b].measure(H, shapes_[e]) : T(0.0);
}

/// Of a branch over the time since the past. @param x  measure of the element now
template <class T>
BranchWeights<T> TissueOperator::weights(const TissueMemory& past, std::size_t b, std::size_t e, std::size_t k,
                                         double since, T x) const {
  const MaxwellBranch& branch = body_.blocks[b].tissue.maxwell[k];
  if (branch.time_law) return responses_[b].paces().weights(k, since, past.pace[place_of(b, e) + k], x, step_);
  const BranchWeights<> w = branch_weights(since, branch.time);
  return {T(w.decay), T(w.from), T(w.to)};
}

/// Takes the paces of an element's branches down.
void TissueOperator::set_paces(std::size_t b, std::size_t e, const Mat3d& H) {
  const BranchPaces& paces = responses_[b].paces();
  if (!paces.follows()) return;
  const double x = responses_[b].measure(H, shapes_[e]);
  for (std::size_t k = 0; k < body_.blocks[b].tissue.maxwell.size(); ++k)
    memory_.pace[place_of(b, e) + k] = paces.at(k, x);
}

/// Σ g (S − q): what the branches have not relaxed yet.
template <class T>
Sym3<T> TissueOperator::overstress(std::size_t b, std::size_t e, double since, const Mat3<T>& H,
                                   const Sym3<T>& S) const {
  const TissueBlock& block = body_.blocks[b];
  const std::vector<MaxwellBranch>& branches = block.tissue.maxwell;
  const std::size_t at = e - block.begin;
  const Sym3<T> before = with_scalar<T>(memory_.stress[first_stress_[b] + at]);
  const T x = measure_of_times(b, e, H);
  Sym3<T> sum{};
  for (std::size_t k = 0; k < branches.size(); ++k) {
    const BranchWeights<T> w = weights(memory_, b, e, k, since, x);
    const Sym3<T> q = with_scalar<T>(memory_.relaxed[place_of(b, e) + k]) * w.decay + before * w.from + S * w.to;
    sum += (S - q) * T(branches[k].share);
  }
  return sum;
}

void TissueOperator::forces(const TissueState& state, std::span<Vec3d> elastic, std::span<Vec3d> viscous,
                            ElementWatch& watch) const {
  std::fill(elastic.begin(), elastic.end(), Vec3d{});
  std::fill(viscous.begin(), viscous.end(), Vec3d{});
  watch.reset(body_.blocks.size());
  const std::vector<double> mean = mean_volume_change(state.u);
  std::vector<Exerted> exerted(body_.elements.size());
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    const TissueBlock& block = body_.blocks[b];
    const bool dashpot = block.tissue.viscosity > 0.0, branches = !block.tissue.maxwell.empty();
    const bool shared = block.tissue.volume_change == VolumeChange::average_nodal;
    for_elements(block.begin, block.end,
                 [&](std::size_t e) { exerted[e] = exerted_by(b, e, state, shared ? &mean[e] : nullptr); });
    for (std::size_t e = block.begin; e < block.end; ++e) {
      const Exerted& x = exerted[e];
      if (x.inverted) watch.inverted.push_back(body_.mesh_tet[e]);
      if (dashpot) scatter(body_, e, x.dashpot, viscous);
      if (branches) scatter(body_, e, x.branches, viscous);
      scatter(body_, e, x.elastic, elastic);
      watch.see(b, e, x.ratio, x.norm);
    }
  }
}

/// @param mean  volume change that it shares with others; none: its own
TissueOperator::Exerted TissueOperator::exerted_by(std::size_t b, std::size_t e, const TissueState& state,
                                                   const double* mean) const {
  const TissueBlock& block = body_.blocks[b];
  const Response& response = responses_[b];
  const Mat3d H = element_gradient(body_, e, state.u);
  Exerted x;
  x.inverted = !(jacobian(H) > 0.0);
  x.elastic = response.elastic(H, shapes_[e], mean);
  if (block.tissue.viscosity > 0.0) x.dashpot = response.viscous(H, element_gradient(body_, e, state.v));
  if (!block.tissue.maxwell.empty()) {
    const Sym3<double> S = response.relaxing(H, x.elastic);
    x.branches = response.carry(H, overstress(b, e, state.since, H, S));
    x.elastic = sum(x.elastic, response.carry(H, S * -response.relaxing_share()));
  }
  const Stiffening stiff = response.stiffening(H, shapes_[e]);
  x.ratio = stiff.ratio, x.norm = stiff.norm;
  return x;
}

/// Shared volume changes store Σ_a V_a ½ κ ϑ_a² over the vertices: ½ κ of each element's mean square.
double TissueOperator::energy(std::span<const Vec3d> u) const {
  double sum = 0.0;
  for (const TissueBlock& block : body_.blocks) sum += BlockResponse(body_, block).energy(u);
  return sum;
}

/// Whether the tangent of a block is linearise_closed(): small strain, moduli that follow a law or none, branches of constant times.
bool TissueOperator::is_closed(std::size_t b) const {
  const Response& response = responses_[b];
  return response.has_small_tangent() && !response.paces().follows() &&
         response.tissue().viscous_tensor != ViscousTensor::pioletti;
}

/// P = λ ϑ I + 2 μ ε, viscous stress, and branches that have taken the share w = Σ g `to` of S, all of P or its deviator.
void TissueOperator::linearise_closed(std::size_t b, const TissueState& state, double rate,
                                      std::span<const double> mean, TissueTangent& out) const {
  const TissueBlock& block = body_.blocks[b];
  const Response& response = responses_[b];
  const bool shared = block.tissue.volume_change == VolumeChange::average_nodal;
  double relaxed = 0.0;
  for (const MaxwellBranch& branch : block.tissue.maxwell) {
    relaxed += branch.share * branch_weights(state.since, branch.time).to;
  }
  const bool deviator = block.tissue.maxwell_part == MaxwellPart::deviator;
  const double left = 1.0 - relaxed, volume_left = deviator ? 1.0 : left;
  const LameParameters viscous = block.tissue.viscosity > 0.0 ? response.viscosity() : LameParameters{0.0, 0.0};
  for (std::size_t e = block.begin; e < block.end; ++e) {
    const Mat3d H = element_gradient(body_, e, state.u);
    const SmallTangent t = response.small_tangent(H, shapes_[e], shared ? &mean[e] : nullptr);
    const double volume = trace(t.rise) / 3.0 * (volume_left - left);
    Sym3<double> rise = t.rise * left;
    rise.xx += volume, rise.yy += volume, rise.zz += volume;
    const double mu = left * t.mu + rate * viscous.mu;
    const double lambda = volume_left * t.lambda + (volume_left - left) * 2.0 / 3.0 * t.mu + rate * viscous.lambda;
    ElementTangent& C = out.local[e];
    const Mat3d from = full(rise);
    using Nine = Eigen::Map<const Eigen::Matrix<double, 9, 1>>;
    C.noalias() = Nine(from.m[0].data()) * Nine(t.gradient.m[0].data()).transpose();
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        C(4 * i, 4 * k) += lambda;
        C(3 * i + k, 3 * i + k) += mu;
        C(3 * i + k, 3 * k + i) += mu;
      }
    }
    if (!shared) continue;
    const double bulk = response.volume_modulus(H, shapes_[e]);
    out.volume[e] = identity<double>();
    out.pressure[e] = scaled(identity<double>(), volume_left * bulk);
    out.modulus[e] = bulk;
  }
}

void TissueOperator::linearise_by_duals(std::size_t b, std::size_t e, const TissueState& state, double rate,
                                        std::span<const double> mean, TissueTangent& out) const {
  const TissueBlock& block = body_.blocks[b];
  const Response& response = responses_[b];
  const bool dashpot = block.tissue.viscosity > 0.0, branches = !block.tissue.maxwell.empty();
  const bool shared = block.tissue.volume_change == VolumeChange::average_nodal;
  const Mat3d H0 = element_gradient(body_, e, state.u), R0 = element_gradient(body_, e, state.v);
  Mat3<Dual> H = with_scalar<Dual>(H0), R = with_scalar<Dual>(R0);
  const auto stress = [&](Dual theta) {
    Mat3<Dual> P = response.elastic(H, shapes_[e], shared ? &theta : nullptr);
    if (!branches) return P;
    const Sym3<Dual> S = response.relaxing(H, P);
    return sum(P, response.carry(H, overstress(b, e, state.since, H, S) - S * Dual(response.relaxing_share())));
  };
  const double fixed = shared ? mean[e] : 0.0;
  for (std::size_t c = 0; c < 9; ++c) {
    H(c / 3, c % 3).d = 1.0, R(c / 3, c % 3).d = rate;
    Mat3<Dual> P = stress(fixed);
    if (dashpot) P = sum(P, response.viscous(H, R));
    for (std::size_t r = 0; r < 9; ++r) {
      out.local[e](static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = P(r / 3, r % 3).d;
    }
    H(c / 3, c % 3).d = 0.0, R(c / 3, c % 3).d = 0.0;
  }
  if (!shared) return;
  out.volume[e] = response.volume_direction(H0);
  out.pressure[e] = detail::derivatives_of(stress({fixed, 1.0}));
  out.modulus[e] = response.volume_modulus(H0, shapes_[e]);
}

void TissueOperator::linearise(const TissueState& state, double rate, bool semidefinite, TissueTangent& out) const {
  const std::vector<double> mean = mean_volume_change(state.u);
  out.local.resize(body_.elements.size());
  out.volume.assign(shares_volume_ ? body_.elements.size() : 0, Mat3d{});
  out.pressure.assign(out.volume.size(), Mat3d{});
  out.modulus.assign(out.volume.size(), 0.0);
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    if (is_closed(b)) {
      linearise_closed(b, state, rate, mean, out);
      continue;
    }
    for_elements(body_.blocks[b].begin, body_.blocks[b].end,
                 [&](std::size_t e) { linearise_by_duals(b, e, state, rate, mean, out); });
  }
  if (!semidefinite) return;
  for_elements(0, out.local.size(), [&](std::size_t e) { make_semidefinite(out.local[e]); });
}

void TissueOperator::apply(const TissueTangent& tangent, std::span<const Vec3d> x, std::span<Vec3d> y) const {
  using Nine = Eigen::Matrix<double, 9, 1>;
  std::fill(y.begin(), y.end(), Vec3d{});
  std::vector<double> mean(shares_volume_ ? body_.elements.size() : 0, 0.0);
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    const TissueBlock& block = body_.blocks[b];
    const bool shared = block.tissue.volume_change == VolumeChange::average_nodal;
    const auto gradient = [&](std::size_t e) { return element_gradient(body_, e, x); };
    const auto inner = [](const Mat3d& a, const Mat3d& c) { return trace(transposed_product(a, c)); };
    if (shared) {
      for (std::size_t e = block.begin; e < block.end; ++e) mean[e] = inner(tangent.volume[e], gradient(e));
      average(body_, block, mean);
    }
    for (std::size_t e = block.begin; e < block.end; ++e) {
      const Mat3d H = gradient(e);
      Mat3d P;
      Eigen::Map<Nine>(P.m[0].data()) = tangent.local[e] * Eigen::Map<const Nine>(H.m[0].data());
      if (shared) P = sum(P, scaled(tangent.pressure[e], mean[e]));
      scatter(body_, e, scaled(P, -1.0), y);
    }
  }
}

void TissueOperator::advance_memory(const TissueState& state) {
  if (!has_memory_) return;
  const std::vector<double> mean = mean_volume_change(state.u);
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    const TissueBlock& block = body_.blocks[b];
    const std::vector<MaxwellBranch>& branches = block.tissue.maxwell;
    if (branches.empty()) continue;
    const bool shared = block.tissue.volume_change == VolumeChange::average_nodal;
    for (std::size_t e = block.begin; e < block.end; ++e) {
      const std::size_t at = e - block.begin;
      const Mat3d H = element_gradient(body_, e, state.u);
      const Sym3<double> S =
          responses_[b].relaxing(H, responses_[b].elastic(H, shapes_[e], shared ? &mean[e] : nullptr));
      Sym3<double>& before = memory_.stress[first_stress_[b] + at];
      const double x = measure_of_times(b, e, H);
      for (std::size_t k = 0; k < branches.size(); ++k) {
        const BranchWeights<> w = weights(memory_, b, e, k, state.since, x);
        Sym3<double>& q = memory_.relaxed[place_of(b, e) + k];
        q = q * w.decay + before * w.from + S * w.to;
      }
      before = S;
      set_paces(b, e, H);
    }
  }
}

MemoryChange TissueOperator::change_by_one_step(const TissueMemory& earlier, double since,
                                                std::span<const Vec3d> u) const {
  MemoryChange sum;
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    const TissueBlock& block = body_.blocks[b];
    const std::vector<MaxwellBranch>& branches = block.tissue.maxwell;
    for (std::size_t e = block.begin; !branches.empty() && e < block.end; ++e) {
      const std::size_t at = first_stress_[b] + e - block.begin;
      const Sym3<double>& S = memory_.stress[at];
      const double x = measure_of_times(b, e, element_gradient(body_, e, u));
      Sym3<double> change{};
      for (std::size_t k = 0; k < branches.size(); ++k) {
        const std::size_t place = place_of(b, e) + k;
        const BranchWeights<> w = weights(earlier, b, e, k, since, x);
        const Sym3<double> q = earlier.relaxed[place] * w.decay + earlier.stress[at] * w.from + S * w.to;
        if (w.decay < 1.0) change += (memory_.relaxed[place] - q) * (branches[k].share / (1.0 - w.decay));
      }
      sum.overstress += body_.rest[e].volume * contract(change, change);
      sum.stress += body_.rest[e].volume * contract(S, S);
    }
  }
  return {std::sqrt(sum.overstress), std::sqrt(sum.stress)};
}

BranchMemory TissueOperator::branch_memory(std::size_t b, double since, std::span<const Vec3d> u) const {
  const TissueBlock& block = body_.blocks[b];
  BranchMemory memory;
  const std::size_t n = block.tissue.maxwell.size();
  memory.branches = n;
  for (std::size_t e = block.begin; n > 0 && e < block.end; ++e) {
    const Sym3<double>& before = memory_.stress[first_stress_[b] + e - block.begin];
    const double x = measure_of_times(b, e, element_gradient(body_, e, u));
    for (std::size_t k = 0; k < n; ++k) {
      const BranchWeights<> w = weights(memory_, b, e, k, since, x);
      memory.held.push_back(memory_.relaxed[place_of(b, e) + k] * w.decay + before * w.from);
      memory.left.push_back(1.0 - w.to);
    }
  }
  return memory;
}

std::vector<Sym3<double>> TissueOperator::branch_stresses(std::size_t b, std::span<const Vec3d> u) const {
  const TissueBlock& block = body_.blocks[b];
  const std::size_t n = block.tissue.maxwell.size();
  if (n == 0) return {};
  const std::vector<Sym3<double>> S = BlockResponse(body_, block).relaxing(u);
  std::vector<Sym3<double>> stresses;
  for (std::size_t i = 0; i < S.size() * n; ++i) {
    stresses.push_back((S[i / n] - memory_.relaxed[first_branch_[b] + i]) * block.tissue.maxwell[i % n].share);
  }
  return stresses;
}

void TissueOperator::tissues_changed(std::span<const std::size_t> blocks, std::span<const Vec3d> u) {
  const TissueMemory before = std::move(memory_);
  const std::vector<std::size_t> first_branch = first_branch_, first_stress = first_stress_;
  memory_ = {};
  body_changed();
  const auto copy = [](const auto& from, std::size_t at, std::size_t count, auto& to, std::size_t place) {
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(at), count, to.begin() + static_cast<std::ptrdiff_t>(place));
  };
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    const TissueBlock& block = body_.blocks[b];
    const std::size_t n = block.end - block.begin, k = block.tissue.maxwell.size();
    if (k == 0) continue;
    if (std::find(blocks.begin(), blocks.end(), b) != blocks.end()) {
      set_branch_stresses(b, std::vector<Sym3<double>>(n * k), u);
      continue;
    }
    copy(before.relaxed, first_branch[b], n * k, memory_.relaxed, first_branch_[b]);
    if (responses_[b].paces().follows()) copy(before.pace, first_branch[b], n * k, memory_.pace, first_branch_[b]);
    copy(before.stress, first_stress[b], n, memory_.stress, first_stress_[b]);
  }
}

void TissueOperator::set_branch_stresses(std::size_t b, std::span<const Sym3<double>> stresses,
                                         std::span<const Vec3d> u) {
  if (stresses.empty()) return;
  const TissueBlock& block = body_.blocks[b];
  const std::vector<Sym3<double>> S = BlockResponse(body_, block).relaxing(u);
  const std::size_t n = block.tissue.maxwell.size();
  for (std::size_t i = 0; i < stresses.size(); ++i) {
    memory_.relaxed[first_branch_[b] + i] = S[i / n] - stresses[i] * (1.0 / block.tissue.maxwell[i % n].share);
  }
  for (std::size_t e = block.begin; e < block.end; ++e) set_paces(b, e, element_gradient(body_, e, u));
  std::copy(S.begin(), S.end(), memory_.stress.begin() + static_cast<std::ptrdiff_t>(first_stress_[b]));
}

}  // namespace glisson
