// needle.cpp — the forces of a needle in a step: rows of the path, solved along and across.
#include "glisson/instruments/needle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/require_fields.h"
#include "contact/row_group.h"
#include "glisson/simulation/simulation.h"
#include "instruments/needle/cantilever.h"
#include "instruments/needle/needle_solver.h"

namespace glisson {
namespace {

constexpr double kPullBack = 0.2;  ///< share of an error of position that a step takes back
constexpr double kSlack = 1e-3;    ///< compliance of a row over the mean of W: rows of one vertex would have no answer
constexpr double kLeastMobility = 1e-30;  ///< [1/kg]: so that rows of held tissue have an answer, too
constexpr double kReach = 1e-3;           ///< of the spacing: how far before the path's end the tip is there
constexpr int kMostBreaks =
    3;  ///< of a row from sticking to slip between iterations of a long step: it slips from then on
constexpr double kMostGrowth = 0.15;  ///< of the spacing: by how much a path grows in a long step

}  // namespace

Needle::Needle(const NeedleOptions& options, std::shared_ptr<ToolDriver> driver)
    : Instrument(options.name, std::move(driver), options.direction), state_(std::make_unique<State>()) {
  detail::require_fields("needle \"" + options.name + "\"", options);
  state_->options = options;
  state_->membranes = membranes_of(options);
}

Needle::~Needle() = default;

NeedleStage Needle::stage() const { return state_->stage; }
const NeedleOptions& Needle::options() const { return state_->options; }
InstrumentForm Needle::form() const {
  return {.kind = InstrumentForm::Kind::needle, .radius = 0.5 * state_->options.diameter};
}

double Needle::tip_force() const { return state_->step_h > 0.0 ? state_->tip_along / state_->step_h : 0.0; }

std::vector<TissueInterval> Needle::crossing() const {
  return state_->crossing(pose_.position + state_->bend_tip, direction());
}

double Needle::inserted_length() const {
  double length = 0.0;
  for (const TissueInterval& i : crossing()) length += i.to - i.from;
  return length;
}

double Needle::path_length() const { return state_->nodes.empty() ? 0.0 : state_->rest_depth(direction()); }

std::vector<Vec3d> Needle::path() const {
  std::vector<Vec3d> points;
  for (const shaft::Row& node : state_->nodes) points.push_back(node.position);
  if (state_->stage == NeedleStage::inside && !state_->is_through()) points.push_back(state_->tip.position);
  return points;
}

std::vector<Vec3d> Needle::centre_line() const {
  const State& s = *state_;
  std::vector<Vec3d> line{pose_.position - direction() * s.options.length};
  for (std::size_t j = 0; j < s.nodes.size(); ++j) {
    const double behind = dot(s.nodes[j].position - pose_.position, direction());
    if (behind >= 0.0 || j >= s.bend.size()) continue;
    line.push_back(pose_.position + direction() * behind + s.bend[j]);
  }
  line.push_back(pose_.position + s.bend_tip);
  return line;
}

void Needle::Solver::find_rows(const InteractionStep& step) {
  if (s.entered > 0) {
    const std::size_t end = s.end_of(s.entered - 1);
    for (std::size_t j = 0; j < s.nodes.size(); ++j) {
      if (!shaft::read(step, s.nodes[j]) || j >= end) continue;
      const double behind = dot(s.nodes[j].position - before, d) - (step.is_long ? way_past(j) : 0.0);
      if (behind >= 0.0) continue;
      all.push_back(&s.nodes[j]);
      node.push_back(j);
      from_hand.push_back(s.options.length + behind);
    }
  }
  if (!s.tip_acts() || !shaft::read(step, s.tip)) return;
  tip_gap = dot(s.tip.position - before, d);
  has_tip = tip_gap <= std::max(0.0, dot(after - before, d)) + kReach * s.options.spacing;
  if (!has_tip) return;
  all.push_back(&s.tip);
  from_hand.push_back(s.options.length);
}

/// By how much the needle passes a node within a long step [m]: at its end lengths of shaft are those there.
double Needle::Solver::way_past(std::size_t node_number) const {
  if (node_number < s.ways.size() && s.ways[node_number].next) return *s.ways[node_number].next;
  return s.slips[node_number] != 0 ? dot(after - before, d) : 0.0;
}

/// Where a longer shaft is held back more, ways found from ways swing to and fro: the secant through the last two leads to where they agree.
void Needle::State::Way::take(double way) {
  last_found = found, found = way, next = way;
  if (last_found && used != last_used) {
    const double slope = (way - *last_found) / (used - last_used);
    if (slope < 0.0) next = used + (way - used) / (1.0 - slope);
  }
  last_used = used;
}

/// The tissue stays on the bent needle, all but a tip that cuts.
shaft::Block Needle::Solver::block(const InteractionStep& step, const ToolVelocity& tool) {
  const bool cuts = has_tip && s.tip_cuts;
  shaft::Block b{
      .direction = d, .velocity = needle_velocity(), .tool = tool, .h = h, .held = all.size() - (cuts ? 1 : 0)};
  for (const shaft::Row* row : all) b.add(*row);
  b.friction = s.options.friction;
  C = cantilever(from_hand, s.bending_stiffness());
  b.compliance = C / (h * h);
  const Vec3d bevel = cuts && s.step_h > 0.0 ? bevel_force() : Vec3d{};
  const double again = s.step_h > 0.0 ? h / s.step_h : 0.0;  // the last step's forces are a good start
  for (std::size_t j = 0; j < all.size(); ++j) {
    const bool is_tip = j >= node.size();
    b.sinks.push_back(sink_along(is_tip));
    b.limits.push_back(limit_of(j));
    b.along.push_back(again * (is_tip ? s.tip_along : s.along[node[j]]));
  }
  b.across.resize(all.size());
  if (cuts) b.across.back() = bevel * -h;
  step.is_long ? set_long(b, bevel) : set_short(step, b, bevel);
  return b;
}

/// What the rows of a short step move one another by, and make up for: errors of position in part, so that nothing rings.
void Needle::Solver::set_short(const InteractionStep& step, shaft::Block& b, const Vec3d& bevel) const {
  b.W = s.mobility.of(step, s.nodes, node, has_tip ? &s.tip : nullptr);
  for (std::size_t j = 0; j < all.size(); ++j) {
    if (j < b.held)
      b.off.push_back(off_by(j)), b.more.push_back(b.held < all.size() ? bevel * bevel_moves(b, j) : Vec3d{});
    b.closing.push_back(j >= node.size() ? tip_slip() : 0.0);
  }
  if (b.held == 0) return;
  const auto n = static_cast<Eigen::Index>(b.held);
  b.slack = kSlack * b.W.topLeftCorner(n, n).diagonal().mean() + kLeastMobility;
}

/// The same in a long step, at the end of which the tissue is on the bent needle; a row that goes from sticking to slip too often
/// slips.
void Needle::Solver::set_long(shaft::Block& b, const Vec3d& bevel) const {
  s.breaks.resize(s.nodes.size(), 0), s.stuck.resize(s.nodes.size(), 0);
  b.slack_share = kSlack;
  for (std::size_t j = 0; j < all.size(); ++j) {
    const bool is_tip = j >= node.size();
    if (j < b.held) {
      b.off.push_back(-across(all[j]->position - before, d));
      b.more.push_back(bevel * C(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(all.size() - 1)));
      if (b.held == all.size()) b.more.back() = {};
    }
    b.closing.push_back(is_tip ? tip_gap / h : 0.0);
    if (!is_tip && s.breaks[node[j]] >= kMostBreaks) b.limits[j].slips = true;
  }
}

/// What a step makes up for at a held row, beside velocities [m].
Vec3d Needle::Solver::off_by(std::size_t j) const {
  const bool is_node = j < node.size();
  const Vec3d bent = !is_node ? s.bend_tip : node[j] < s.bend.size() ? s.bend[node[j]] : Vec3d{};
  const Vec3d off = across(all[j]->position - before, d);
  return (off - bent) * (1.0 - kPullBack) - off;
}

/// By how much a force on the bevel moves row j against the needle: what it bends, and what it does to the tissue [m/N].
double Needle::Solver::bevel_moves(const shaft::Block& b, std::size_t j) const {
  const auto row = static_cast<Eigen::Index>(j), tip = static_cast<Eigen::Index>(b.held);
  return C(row, tip) + h * h * b.W(row, tip);
}

/// Where work goes along the needle: slip of the shaft is friction, a tip in tissue cuts.
WorkSink Needle::Solver::sink_along(bool is_tip) const {
  if (!is_tip) return WorkSink::friction;
  return s.stage == NeedleStage::inside ? WorkSink::fracture : WorkSink::contact;
}

/// y = −C p/h at each row; the bevel's own load is among p.
void Needle::Solver::bend(std::span<const Vec3d> impulse) {
  s.bend.assign(s.nodes.size(), Vec3d{});
  s.bend_tip = {};
  for (std::size_t j = 0; j < all.size(); ++j) {
    Vec3d y;
    for (std::size_t k = 0; k < all.size(); ++k) {
      y -= impulse[k] * (C(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)) / h);
    }
    (j < node.size() ? s.bend[node[j]] : s.bend_tip) = y;
  }
  if (!has_tip && !node.empty()) s.bend_tip = s.tip_out ? free_end(impulse) : s.bend[node.back()];
}

/// Deflection of a tip that nothing acts on.
Vec3d Needle::Solver::free_end(std::span<const Vec3d> impulse) const {
  Vec3d y;
  for (std::size_t k = 0; k < all.size(); ++k) {
    y -= impulse[k] * (cantilever(s.options.length, from_hand[k], s.bending_stiffness()) / h);
  }
  return y;
}

/// Of the tissue on a tip that cuts [N].
Vec3d Needle::Solver::bevel_force() const {
  const Vec3d side = across(s.options.bevel_side, d);
  if (!(norm(side) > 0.0)) return {};
  return side * (s.options.bevel_share * s.tip_along / (s.step_h * norm(side)));
}

/// A node stands for the shaft half way to its neighbours in the same stretch of tissue; the last one, where that reaches beyond the
/// tip, for all of it up to the tip.
double Needle::Solver::shaft_of(std::size_t row) const {
  const double here = from_hand[row];
  const std::size_t track = s.track_of(node[row]);
  const bool first = row == 0 || s.track_of(node[row - 1]) != track;
  const bool last = row + 1 == node.size() || s.track_of(node[row + 1]) != track;
  const bool has_far_end = s.tracks[track].through && node[row] + 1 == s.end_of(track);
  const bool up_to_tip = track + 1 == s.entered && !has_far_end;
  const double before_it = first ? here : from_hand[row - 1];
  const double after_it = !last ? from_hand[row + 1] : up_to_tip ? 2.0 * s.options.length - here : here;
  return std::max(0.0, 0.5 * (after_it - before_it));
}

shaft::AxialLimit Needle::Solver::limit_of(std::size_t row) const {
  if (row >= node.size()) return {.length = 0.0, .slips = false, .is_tip = true, .tip_limit = s.tip_limit()};
  return {.length = shaft_of(row), .slips = s.slips[node[row]] != 0, .is_tip = false, .tip_limit = 0.0};
}

/// Speed of the tip into the path's end after this step: with g = that overlap, g̈ = −2 ġ/τ − g/τ² [Baumgarte1972], ġ and g
/// taken at the end of the step. A tip that is still before it may go up to it.
double Needle::Solver::tip_slip() const {
  const double speed = dot(needle_velocity() - s.tip_velocity, d), tau = s.wave_time;
  const auto slowed = [&](double v, double time) { return v / ((1.0 + time / tau) * (1.0 + time / tau)); };
  if (tip_gap <= 0.0) return slowed(speed + h * tip_gap / (tau * tau), h);
  const double touching = speed > 0.0 ? std::max(0.0, h - tip_gap / speed) : 0.0;
  return std::max(tip_gap / h, slowed(speed, touching));
}

/// Keeps impulses along the needle, and what slips, for the next step.
void Needle::Solver::keep_along(std::span<const double> p, std::span<const char> slips) {
  std::fill(s.along.begin(), s.along.end(), 0.0);
  for (std::size_t j = 0; j < node.size(); ++j) {
    s.slips[node[j]] = slips[j];
    s.along[node[j]] = p[j];
  }
  s.tip_along = has_tip ? p.back() : 0.0;
  s.tip_cuts = has_tip && s.stage == NeedleStage::inside && slips.back() != 0;
}

/// Energy of the bent needle, ½ Σ f·C f = −½ Σ f·y; the bevel's own load is among f.
double Needle::Solver::bending_energy(std::span<const Vec3d> sideways) const {
  double sum = 0.0;
  for (std::size_t j = 0; j < all.size(); ++j) {
    sum -= 0.5 * dot(sideways[j], j >= node.size() ? s.bend_tip : s.bend[node[j]]) / h;
  }
  return sum;
}

double Needle::tool_energy() const { return state_->bending; }
Vec3d Needle::handle() const { return force_pose().position - direction() * state_->options.length; }

void Needle::add_forces(const InteractionStep& step) {
  State& s = *state_;
  if (s.stage != NeedleStage::outside && shaft::read(step, s.tip)) s.tip_velocity = s.tip.velocity;
}

void Needle::declare(const InteractionStep& step, StepRows& rows, int round) {
  if (round > 0) return;
  drive(step);
  State& s = *state_;
  ToolYield* const yields = rows.group().yields = find_end(step);
  s.solver = std::make_unique<Solver>(
      Solver{.s = s, .d = direction(), .before = before_.position, .after = pose_.position, .h = step.h});
  s.solver->find_rows(step);
  if (s.solver->all.empty()) return;
  rows.group().shaft = s.solver->block(step, velocity_at(before_.position));
  rows.group().shaft->yields = yields;
}

void Needle::solved(const InteractionStep& step, const StepRows& rows) {
  move_to_end();
  forces_ = {};
  State& s = *state_;
  const std::unique_ptr<Solver> solver = std::move(s.solver);
  if (solver->all.empty()) {
    s.forget_forces(step.h);
    return;
  }
  const shaft::Block& block = *rows.group().shaft;
  solver->after = pose_.position;
  solver->keep(step, block);
  if (step.interface_book != nullptr) s.bending = solver->bending_energy(block.across);
  s.step_h = step.h;
  for (std::size_t j = 0; j < solver->all.size(); ++j) {
    const Vec3d lengthways = direction() * block.along[j];
    const bool is_tip = j >= solver->node.size();
    forces_.normal += block.across[j] * (1.0 / step.h);
    (is_tip ? (s.stage == NeedleStage::inside ? forces_.cutting : forces_.normal) : forces_.friction) +=
        lengthways * (1.0 / step.h);
    const Vec3d at =
        forces_at_end() ? solver->all[j]->position + solver->all[j]->velocity * step.h : solver->all[j]->position;
    forces_.torque += cross(at - force_pose().position, (block.across[j] + lengthways) * (1.0 / step.h));
  }
}

/// Keeps what the block has found; of a long step how far the needle passes its nodes, too.
void Needle::Solver::keep(const InteractionStep& step, const shaft::Block& block) {
  bend(block.across);
  if (step.is_long) count_breaks(block);
  keep_along(block.along, block.slips);
  if (!step.is_long) return;
  s.ways.resize(s.nodes.size());
  for (const std::size_t j : node) {
    shaft::read(step, s.nodes[j]);
    s.ways[j].used = way_past(j);
    s.ways[j].take(dot(needle_velocity() - s.nodes[j].velocity, d) * h);
  }
  if (has_tip) shaft::read(step, s.tip);
}

/// How often rows come from sticking to slip between iterations of a step.
void Needle::Solver::count_breaks(const shaft::Block& block) {
  for (std::size_t j = 0; j < node.size(); ++j) {
    if (s.stuck[node[j]] != 0 && block.slips[j] != 0) ++s.breaks[node[j]];
    s.stuck[node[j]] = block.slips[j] == 0;
  }
}

int Needle::most_drag_stages() const { return kMostDragStagesBesideInstruments; }

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
