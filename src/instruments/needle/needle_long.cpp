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

#include "base/two_across.h"
#include "instruments/needle/cantilever.h"
#include "instruments/needle/needle_solver.h"

namespace glisson {
namespace {

constexpr double kLongSlack = 1e-3;  ///< compliance of a row over the mean of W, as in a short step
constexpr shaft::Effort kLongEffort{.most_sweeps = 4000, .enough = 1e-11, .most_breaks = 30};
constexpr int kMostBreaks = 3;  ///< of a row from sticking to slip between iterations of a step: it slips from then on
constexpr double kMostGrowth = 0.15;  ///< of the spacing: by how much a path grows in a step

}  // namespace

/// By how much the needle passes a node within a long step [m]: at its end lengths of shaft are those there.
double Needle::Solver::way_past(std::size_t node_number) const {
  if (node_number < s.ways.size() && std::isfinite(s.ways[node_number])) return s.ways[node_number];
  return s.slips[node_number] != 0 ? dot(after - before, d) : 0.0;
}

/// What the rows of a long step want of each other. Rows across: two a held row; columns: the same, then one along a row.
struct Needle::Solver::LongRows {
  std::size_t n = 0, held = 0;
  bool cuts = false;
  std::vector<std::vector<VertexWeight>> means{};
  std::vector<Mat3d> W{};
  std::array<Vec3d, 2> e{};
  Eigen::MatrixXd A{}, B{}, D{};
  Eigen::VectorXd b{}, speed{};
  Vec3d bevel{};

  static Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }
  double w(std::size_t j, const Vec3d& x, std::size_t k, const Vec3d& y) const { return dot(x, W[j * n + k] * y); }
};

/// Sets up what acts across, with the bent needle's compliance. @return the trace of W across
double Needle::Solver::set_across(LongRows& r) const {
  const auto at = LongRows::at;
  double tissue = 0.0;
  for (std::size_t j = 0; j < r.held; ++j) {
    const Vec3d off = (all[j]->position + all[j]->velocity * h - after) * (1.0 / h);
    for (std::size_t i = 0; i < 2; ++i) {
      const Eigen::Index row = at(2 * j + i);
      tissue += r.w(j, r.e[i], j, r.e[i]);
      r.b[row] = -dot(r.e[i], off);
      if (r.cuts) {
        r.b[row] -=
            dot(r.e[i], r.W[j * r.n + r.n - 1] * r.bevel) + C(at(j), at(r.n - 1)) * dot(r.e[i], r.bevel) / (h * h);
      }
      for (std::size_t k = 0; k < r.n; ++k) {
        r.B(row, at(k)) = r.w(j, r.e[i], k, d);
        for (std::size_t l = 0; l < 2 && k < r.held; ++l) {
          r.A(row, at(2 * k + l)) = r.w(j, r.e[i], k, r.e[l]) + (i == l ? C(at(j), at(k)) / (h * h) : 0.0);
        }
      }
    }
  }
  return tissue;
}

Needle::Solver::LongRows Needle::Solver::long_rows(const InteractionStep& step) {
  const auto at = LongRows::at;
  LongRows r{.n = all.size(), .cuts = has_tip && s.tip_cuts};
  r.held = r.n - (r.cuts ? 1 : 0);
  for (const shaft::Row* row : all) r.means.push_back(row->weights);
  r.W = step.compliance->couple(r.means);
  r.e = two_across(d);
  C = cantilever(from_hand, s.bending_stiffness());
  r.bevel = r.cuts && s.step_h > 0.0 ? bevel_force() * -h : Vec3d{};
  const auto size = at(2 * r.held);
  r.A.resize(size, size), r.B.resize(size, at(r.n)), r.b.resize(size);
  r.D.resize(at(r.n), at(r.n)), r.speed.resize(at(r.n));
  const double tissue = set_across(r);
  for (std::size_t j = 0; j < r.n; ++j) {
    r.speed[at(j)] = dot(needle_velocity() - all[j]->velocity, d);
    if (j >= node.size()) r.speed[at(j)] -= tip_gap / h;
    if (r.cuts) r.speed[at(j)] -= dot(d, r.W[j * r.n + r.n - 1] * r.bevel);
    for (std::size_t k = 0; k < r.n; ++k) r.D(at(j), at(k)) = r.w(j, d, k, d);
  }
  if (r.held > 0) {
    r.A.diagonal().array() += kLongSlack * tissue / static_cast<double>(2 * r.held);
    r.A = (0.5 * (r.A + r.A.transpose())).eval();
  }
  return r;
}

/// Impulses along the needle, with those across eliminated.
std::vector<double> Needle::Solver::along_in_long(const LongRows& r, const Eigen::MatrixXd& D,
                                                  const Eigen::VectorXd& speed) {
  std::vector<shaft::AxialLimit> limits;
  std::vector<double> p;
  const double again = s.step_h > 0.0 ? h / s.step_h : 0.0;
  s.breaks.resize(s.nodes.size(), 0);
  s.stuck.resize(s.nodes.size(), 0);
  std::vector<int> in_sweeps(r.n, 0);
  for (std::size_t j = 0; j < r.n; ++j) {
    const bool is_tip = j >= node.size();
    limits.push_back(limit_of(j));
    if (!is_tip && s.breaks[node[j]] >= kMostBreaks) limits.back().slips = true;
    p.push_back(again * (is_tip ? s.tip_along : s.along[node[j]]));
  }
  const std::vector<double> speeds(speed.begin(), speed.end());
  const std::vector<char> slips =
      shaft::solve_along(D, speeds, limits, s.options.friction, h, p, kLongEffort, in_sweeps);
  for (std::size_t j = 0; j < node.size(); ++j) {
    if (s.stuck[node[j]] != 0 && slips[j] != 0) ++s.breaks[node[j]];
    s.stuck[node[j]] = slips[j] == 0;
  }
  keep_along(p, slips);
  return p;
}

/// Gives the impulses to the tissue, and keeps how far the needle passes its nodes.
void Needle::Solver::hand_out(const InteractionStep& step, const LongRows& r, const Impulses& p) {
  std::vector<Vec3d> whole;
  for (std::size_t j = 0; j < r.n; ++j) whole.push_back(p.across[j] + d * p.along[j]);
  step.compliance->spread_means(r.means, whole, step.vertices);
  for (std::size_t j = 0; j < r.n; ++j) {
    for (const VertexWeight& v : r.means[j]) step.impulses[step.place_of[v.vertex]] += whole[j] * v.weight;
  }
  s.ways.resize(s.nodes.size(), std::numeric_limits<double>::quiet_NaN());
  for (const std::size_t j : node) {
    shaft::read(step, s.nodes[j]);
    s.ways[j] = dot(needle_velocity() - s.nodes[j].velocity, d) * h;
  }
  if (has_tip) shaft::read(step, s.tip);
}

void Needle::Solver::solve_long(const InteractionStep& step, const ToolVelocity& tool) {
  const LongRows r = long_rows(step);
  Eigen::MatrixXd D = r.D;
  Eigen::VectorXd speed = r.speed;
  Eigen::LDLT<Eigen::MatrixXd> across_factor;
  if (r.held > 0) {
    across_factor.compute(r.A);
    const Eigen::MatrixXd solved = across_factor.solve(r.B);
    D -= r.B.transpose() * solved;
    speed -= solved.transpose() * r.b;
  }
  Impulses p{std::vector<Vec3d>(r.n), along_in_long(r, D, speed)};
  if (r.held > 0) {
    const Eigen::Map<const Eigen::VectorXd> along(p.along.data(), LongRows::at(r.n));
    const Eigen::VectorXd across_p = across_factor.solve(r.b - r.B * along);
    for (std::size_t j = 0; j < r.held; ++j) {
      p.across[j] = r.e[0] * across_p[LongRows::at(2 * j)] + r.e[1] * across_p[LongRows::at(2 * j + 1)];
    }
  }
  if (r.cuts) p.across.back() = r.bevel;
  bend(p.across);
  hand_out(step, r, p);
  if (step.interface_book != nullptr) book(step, p, tool);
  found = std::move(p);
}

/// Records the impulses in the energy ledger.
void Needle::Solver::book(const InteractionStep& step, const Impulses& p, const ToolVelocity& tool) const {
  for (std::size_t j = 0; j < all.size(); ++j) {
    for (const VertexWeight& w : all[j]->weights) {
      const std::uint32_t place = step.place_of[w.vertex];
      step.book(sink_along(j >= node.size()), place, d * p.along[j] * w.weight, tool);
      step.book(WorkSink::contact, place, p.across[j] * w.weight, tool);
    }
  }
}

std::string Needle::refuses_long_steps() const { return driver_refuses_long_steps(); }

/// Tries what comes after the step: events that are to be dated, and a path that grows past what its friction was found for.
bool Needle::overshoots(const InteractionStep& step) {
  const std::shared_ptr<const void> before = save_state();
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
  load_state(before, nullptr);
  return over;
}

}  // namespace glisson
