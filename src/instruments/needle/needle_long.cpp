// needle_long.cpp — a needle in a long step: what its rows exert at the end of it.
//
//   across   P (x_j + h v_j + h Σ W_jk p_k − tip) = −C p_⊥/h     the tissue is on the bent needle          direct
//   along    with p_⊥ eliminated: sticks, or slips at its limit   as in a short step                         Gauss–Seidel
//
// W_jk, a 3 × 3 block, is the velocity that a unit impulse at row k gives row j within the step, through the factor of the tangent;
// P takes what is across the needle. Nothing is corrected later: both hold at the end of the step.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "glisson/archive.h"
#include "glisson/simulation/integrator.h"
#include "instruments/needle/needle_solver.h"

namespace glisson {
namespace {

constexpr double kLongSlack = 1e-3;  ///< compliance of a row over the mean of W, as in a short step
constexpr shaft::Effort kLongEffort{.most_sweeps = 4000, .enough = 1e-11, .most_breaks = 30};
constexpr int kMostBreaks = 3;  ///< of a row from sticking to slip between iterations of a step: it slips from then on
constexpr double kMostGrowth = 0.15;  ///< of the spacing: by how much a path grows in a step

/// Two directions across a third.
std::array<Vec3d, 2> two_across(const Vec3d& d) {
  const Vec3d helper = std::abs(d.x) < 0.6 ? Vec3d{1.0, 0.0, 0.0} : Vec3d{0.0, 1.0, 0.0};
  const Vec3d c = cross(d, helper), e = c * (1.0 / norm(c));
  return {e, cross(d, e)};
}

}  // namespace

/// By how much the needle passes a node within a long step [m]: at its end lengths of shaft are those there.
double Needle::Solver::way_past(std::size_t node_number) const {
  if (node_number < s.ways.size() && std::isfinite(s.ways[node_number])) return s.ways[node_number];
  return s.slips[node_number] != 0 ? dot(after - before, d) : 0.0;
}

Needle::Solver::Impulses Needle::Solver::solve_long(const InteractionStep& step) {
  const std::size_t n = all.size();
  const bool cuts = has_tip && s.tip_cuts;
  const std::size_t held = n - (cuts ? 1 : 0);
  std::vector<std::vector<VertexWeight>> means;
  for (const shaft::Row* row : all) means.push_back(row->weights);
  const std::vector<Mat3d> W = step.compliance->couple(means);
  const std::array<Vec3d, 2> e = two_across(d);
  const auto w = [&](std::size_t j, const Vec3d& a, std::size_t k, const Vec3d& b) { return dot(a, W[j * n + k] * b); };
  const auto at = [](std::size_t i) { return static_cast<Eigen::Index>(i); };
  const Eigen::MatrixXd C = shaft::cantilever(from_hand, s.bending_stiffness());
  const Vec3d bevel = cuts && s.step_h > 0.0 ? bevel_force() * -h : Vec3d{};

  // rows across: two a held row; columns: the same, then one along a row
  const auto size = at(2 * held);
  Eigen::MatrixXd A(size, size), B(size, at(n));
  Eigen::VectorXd b(size), speed(at(n));
  double tissue = 0.0;  // trace of W across
  for (std::size_t j = 0; j < held; ++j) {
    const Vec3d off = (all[j]->position + all[j]->velocity * h - after) * (1.0 / h);
    for (std::size_t i = 0; i < 2; ++i) {
      const Eigen::Index row = at(2 * j + i);
      tissue += w(j, e[i], j, e[i]);
      b[row] = -dot(e[i], off);
      if (cuts) b[row] -= dot(e[i], W[j * n + n - 1] * bevel) + C(at(j), at(n - 1)) * dot(e[i], bevel) / (h * h);
      for (std::size_t k = 0; k < n; ++k) {
        B(row, at(k)) = w(j, e[i], k, d);
        for (std::size_t l = 0; l < 2 && k < held; ++l) {
          A(row, at(2 * k + l)) = w(j, e[i], k, e[l]) + (i == l ? C(at(j), at(k)) / (h * h) : 0.0);
        }
      }
    }
  }
  Eigen::MatrixXd D(at(n), at(n));
  for (std::size_t j = 0; j < n; ++j) {
    speed[at(j)] = dot(needle_velocity() - all[j]->velocity, d);
    if (j >= node.size()) speed[at(j)] -= tip_gap / h;
    if (cuts) speed[at(j)] -= dot(d, W[j * n + n - 1] * bevel);
    for (std::size_t k = 0; k < n; ++k) D(at(j), at(k)) = w(j, d, k, d);
  }
  Eigen::LDLT<Eigen::MatrixXd> across_factor;
  if (held > 0) {
    A.diagonal().array() += kLongSlack * tissue / static_cast<double>(2 * held);
    A = (0.5 * (A + A.transpose())).eval();
    across_factor.compute(A);
    const Eigen::MatrixXd solved = across_factor.solve(B);
    D -= B.transpose() * solved;
    speed -= solved.transpose() * b;
  }

  std::vector<shaft::AxialLimit> limits;
  std::vector<double> start;
  const double again = s.step_h > 0.0 ? h / s.step_h : 0.0;
  s.breaks.resize(s.nodes.size(), 0);
  s.stuck.resize(s.nodes.size(), 0);
  std::vector<int> in_sweeps(n, 0);
  for (std::size_t j = 0; j < n; ++j) {
    const bool is_tip = j >= node.size();
    limits.push_back(limit_of(j));
    if (!is_tip && s.breaks[node[j]] >= kMostBreaks) limits.back().slips = true;
    start.push_back(again * (is_tip ? s.tip_along : s.along[node[j]]));
  }
  Impulses p{std::vector<Vec3d>(n), std::move(start)};
  const std::vector<double> speeds(speed.begin(), speed.end());
  const std::vector<char> slips =
      shaft::solve_along(D, speeds, limits, s.options.friction, h, p.along, kLongEffort, in_sweeps);
  for (std::size_t j = 0; j < node.size(); ++j) {
    if (s.stuck[node[j]] != 0 && slips[j] != 0) ++s.breaks[node[j]];
    s.stuck[node[j]] = slips[j] == 0;
  }
  keep_along(p.along, slips);

  Eigen::VectorXd across_p(size);
  if (held > 0) {
    const Eigen::Map<const Eigen::VectorXd> along(p.along.data(), at(n));
    across_p = across_factor.solve(b - B * along);
  }
  for (std::size_t j = 0; j < held; ++j) p.across[j] = e[0] * across_p[at(2 * j)] + e[1] * across_p[at(2 * j + 1)];
  if (cuts) p.across.back() = bevel;
  bend(p.across, C);
  std::vector<Vec3d> whole;
  for (std::size_t j = 0; j < n; ++j) whole.push_back(p.across[j] + d * p.along[j]);
  step.compliance->spread_means(means, whole, step.vertices);
  for (std::size_t j = 0; j < n; ++j) {
    for (const VertexWeight& v : means[j]) step.impulses[step.place_of[v.vertex]] += whole[j] * v.weight;
  }
  s.ways.resize(s.nodes.size(), std::numeric_limits<double>::quiet_NaN());
  for (const std::size_t j : node) {
    shaft::read(step, s.nodes[j]);
    s.ways[j] = dot(needle_velocity() - s.nodes[j].velocity, d) * h;
  }
  if (has_tip) shaft::read(step, s.tip);
  return p;
}

std::string Needle::refuses_long_steps() const {
  if (!driver().yields()) return {};
  return "is moved by a force or a hand; give it a path in time, or take integrator = " + supporting_integrators();
}

/// Tries what comes after the step: events that are to be dated, and a path that grows past what its friction was found for.
bool Needle::overshoots(const InteractionStep& step) {
  Archive kept;
  archive(kept);
  const std::size_t events_before = events().size();
  const bool was_held = state_->at_membrane || state_->next_region.has_value();
  const NeedleStage stage_before = state_->stage;
  const Vec3d end = state_->tip.rest;
  state_->tries = true;
  moved(step);
  state_->tries = false;
  const State& s = *state_;
  bool over = !was_held && (s.at_membrane || s.next_region.has_value());
  for (std::size_t k = events_before; k < events().size(); ++k) over = over || events()[k].event != "drop";
  if (stage_before == NeedleStage::inside && s.stage == NeedleStage::inside) {
    over = over || norm(s.tip.rest - end) > kMostGrowth * s.options.spacing;
  }
  Archive back(kept.bytes());
  archive(back);
  return over;
}

}  // namespace glisson
