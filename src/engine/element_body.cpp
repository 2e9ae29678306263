#include "engine/element_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "element/drag_stages.h"
#include "element/flush_denormals.h"
#include "engine/kernels/response_kernels.h"
#include "engine/stage_holds.h"

namespace glisson::engine {
namespace {

bool all_tensor_masses(const Body& body) {
  return std::all_of(body.blocks.begin(), body.blocks.end(),
                     [](const TissueBlock& block) { return block.tissue.is_tensor_mass(); });
}

}  // namespace

ElementBody::ElementBody(const Body& body, std::span<const double> nodal_damping, Precision precision, int drag_stages)
    : body_(body), precision_(precision), damping_(nodal_damping.begin(), nodal_damping.end()),
      stages_(glisson::drag_stages(drag_stages)), is_active_(body.vertex_count, 0), rests_(body.vertex_count, 0) {
  for (auto* field : {&u_, &v_, &elastic_, &viscous_}) field->assign(body.vertex_count, Vec3d{});
  make_operator();
}

void ElementBody::make_operator() {
  const bool tensor_masses = all_tensor_masses(body_);
  tissue_ = tensor_masses ? make_element_operator(body_) : nullptr;
  any_ = tensor_masses ? nullptr : std::make_unique<TissueOperator>(body_, StepKind::central_difference);
}

void ElementBody::bring_memory_up_to_date(double since) {
  if (any_ == nullptr) return;
  any_->advance_memory({u_, v_, since});
  since_memory_ = 0.0;
}

/// Forces of the present state; a step that moves leaves this state behind as the tissue's past.
void ElementBody::evaluate(bool moves) {
  if (tissue_ != nullptr) {
    tissue_->evaluate(u_, v_, elastic_, viscous_, watch_);
    return;
  }
  const TissueState state{u_, v_, since_memory_};
  any_->forces(state, elastic_, viscous_, watch_);
  if (!moves) return;
  any_->advance_memory(state);
  since_memory_ = 0.0;
}

/// Takes what instruments hold from the changes of a stage.
void ElementBody::hold_rows() {
  if (holds_ == nullptr) return;
  held_changes_.clear();
  for (const std::uint32_t place : holds_->places()) held_changes_.push_back(stage_change_[active_[place].vertex]);
  holds_->project(held_changes_);
  std::size_t k = 0;
  for (const std::uint32_t place : holds_->places()) stage_change_[active_[place].vertex] = held_changes_[k++];
}

/// The viscous force in stages (element/drag_stages.h), from that at v₋.
void ElementBody::run_drag_stages(double h, const Vec3d& gravity) {
  drag_.clear();
  for (const TissueBlock& block : body_.blocks) drag_.push_back(block.viscous);
  std::vector<Vec3d> pushed(u_.size());
  for (std::size_t k = 0; k < std::min(active_.size(), outer_.size()); ++k) pushed[active_[k].vertex] = outer_[k];
  stage_sum_.assign(u_.size(), Vec3d{}), stage_change_.assign(u_.size(), Vec3d{});
  pull_.resize(u_.size());
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    if (k > 0) apply_linear(body_, drag_, stage_change_, pull_);
    for (std::size_t i = 0; i < u_.size(); ++i) {
      const double m = body_.inertia(i);
      if (k > 0) viscous_[i] -= pull_[i];
      stage_sum_[i] += viscous_[i] * stages_[k];
      const Vec3d force = elastic_[i] + viscous_[i] + pushed[i] + gravity * body_.masses[i] - v_[i] * damping_[i];
      const bool moves = m > 0.0 && rests_[i] == 0;
      stage_change_[i] = moves ? force * (stages_[k] * h / (m + damping_[i] * h)) : Vec3d{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (3 * i < held_.size() && held_[3 * i + axis] != 0) stage_change_[i][axis] = 0.0;
      }
    }
    hold_rows();
  }
  viscous_.swap(stage_sum_);
}

void ElementBody::set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  u_.assign(displacement.begin(), displacement.end());
  v_.assign(velocity.begin(), velocity.end());
  for (ActiveVertex& w : active_) w.displacement = u_[w.vertex], w.velocity = v_[w.vertex];
  bring_memory_up_to_date(std::numeric_limits<double>::infinity());  // a state that is set has relaxed
}

void ElementBody::read_state(std::span<Vec3d> displacement, std::span<Vec3d> velocity) const {
  std::copy(u_.begin(), u_.end(), displacement.begin());
  std::copy(v_.begin(), v_.end(), velocity.begin());
}

void ElementBody::archive_past(Archive& ar) {
  if (any_ != nullptr) ar(since_memory_, *any_);
}

void ElementBody::archive_layout(Archive& ar, std::span<const double> nodal_damping) {
  if (!ar.reads()) return;
  const std::vector<ActiveVertex> active = active_;
  load_layout({}, nodal_damping);
  active_ = active;
  for (const ActiveVertex& w : active_) is_active_[w.vertex] = 1;
}

/// It lies as the Body does.
void ElementBody::load_layout(const std::shared_ptr<const void>&, std::span<const double> nodal_damping) {
  for (auto* field : {&u_, &v_, &elastic_, &viscous_}) field->resize(body_.vertex_count);
  active_.clear();
  is_active_.assign(body_.vertex_count, 0);
  rest({});
  damping_.assign(nodal_damping.begin(), nodal_damping.end());
  make_operator();
}

void ElementBody::apply(const BodyChange& change, const detail::VertexStars&, std::span<const double> nodal_damping) {
  for (const MovedVertex& m : change.moved) {
    u_[m.vertex] = m.displacement;
    v_[m.vertex] = m.velocity;
    for (ActiveVertex& w : active_) {
      if (w.vertex == m.vertex) w.displacement = m.displacement, w.velocity = m.velocity;
    }
  }
  for (const std::uint32_t origin : change.origins) {
    u_.push_back(Vec3d(u_[origin]));
    v_.push_back(Vec3d(v_[origin]));
  }
  elastic_.resize(u_.size());
  viscous_.resize(u_.size());
  is_active_.resize(u_.size(), 0);
  rests_.resize(u_.size(), 0);
  damping_.assign(nodal_damping.begin(), nodal_damping.end());
  if (tissue_ != nullptr) tissue_ = make_element_operator(body_);
  if (any_ != nullptr) any_->body_changed();
}

/// In single precision it is for tissues that lanes do not have.
bool ElementBody::supports_tissues() const {
  const auto in_lanes = [](const TissueBlock& block) { return has_lanes(block.tissue); };
  return precision_ == Precision::double_precision || !std::all_of(body_.blocks.begin(), body_.blocks.end(), in_lanes);
}

void ElementBody::tissues_changed(std::span<const std::size_t> blocks, std::span<const double> nodal_damping) {
  damping_.assign(nodal_damping.begin(), nodal_damping.end());
  if (all_tensor_masses(body_)) {
    any_.reset();
    tissue_ = make_element_operator(body_);
    return;
  }
  tissue_.reset();
  if (any_ == nullptr) {
    any_ = std::make_unique<TissueOperator>(body_, StepKind::central_difference);
    bring_memory_up_to_date(std::numeric_limits<double>::infinity());
  } else {
    any_->tissues_changed(blocks, u_);
  }
}

BranchMemory ElementBody::branch_memory(std::size_t block) const {
  return any_ != nullptr ? any_->branch_memory(block, since_memory_, u_) : BranchMemory{};
}

std::vector<Sym3<double>> ElementBody::branch_stresses(std::size_t block) {
  bring_memory_up_to_date(since_memory_);
  return any_ != nullptr ? any_->branch_stresses(block, u_) : std::vector<Sym3<double>>{};
}

void ElementBody::set_branch_stresses(std::size_t block, std::span<const Sym3<double>> stresses) {
  if (any_ != nullptr) any_->set_branch_stresses(block, stresses, u_);
}

void ElementBody::watch(std::span<const std::uint32_t> vertices, std::span<const std::uint32_t> /*apart*/) {
  for (const std::uint32_t v : vertices) is_active_[v] = 1;
  std::vector<ActiveVertex> now;
  std::size_t known = 0;
  for (std::uint32_t v = 0; v < is_active_.size(); ++v) {
    if (is_active_[v] == 0) continue;
    const bool was = known < active_.size() && active_[known].vertex == v;
    now.push_back(was ? active_[known++] : ActiveVertex{v, elastic_[v], viscous_[v], u_[v], v_[v]});
  }
  active_ = std::move(now);
}

void ElementBody::watch_only(std::span<const std::uint32_t> vertices) {
  std::fill(is_active_.begin(), is_active_.end(), 0);
  for (const std::uint32_t v : vertices) is_active_[v] = 1;
  std::erase_if(active_, [&](const ActiveVertex& w) { return is_active_[w.vertex] == 0; });
}

void ElementBody::rest(std::span<const std::uint32_t> vertices) {
  rests_.assign(body_.vertex_count, 0);
  resting_.clear();
  for (const std::uint32_t v : vertices) {
    rests_[v] = 1, v_[v] = {};
    resting_.push_back({v, elastic_[v] + viscous_[v]});
  }
}

void ElementBody::place_active() {
  for (const ActiveVertex& w : active_) u_[w.vertex] = w.displacement, v_[w.vertex] = w.velocity;
}

void ElementBody::book(std::size_t i, const Vec3d& before, const Vec3d& weight) {
  KickWork& work = advance_.work;
  const Vec3d drag = v_[i] * -damping_[i];
  work.before.elastic += dot(elastic_[i], before), work.after.elastic += dot(elastic_[i], v_[i]);
  work.before.viscous += dot(viscous_[i], before), work.after.viscous += dot(viscous_[i], v_[i]);
  work.before.damping += dot(drag, before), work.after.damping += dot(drag, v_[i]);
  work.before.loads += dot(weight, before), work.after.loads += dot(weight, v_[i]);
  work.kinetic += 0.5 * body_.inertia(i) * dot(before, v_[i]);
}

void ElementBody::list_above(std::span<const double> stiffening, std::span<const StiffLimit> single) {
  watch_.list_above.assign(stiffening.begin(), stiffening.end());
  single_limits_ = single;
}

const Advance& ElementBody::advance(double h, const Vec3d& gravity, bool accounted) {
  const FlushDenormals flush;
  evaluate(h > 0.0);
  if (stages_.size() > 1) run_drag_stages(h, gravity);
  advance_.stiffening = watch_.stiffening;
  advance_.stiff = watch_.stiff;
  if (!single_limits_.empty()) {
    std::erase_if(advance_.stiff, [&](const StiffElement& s) { return single_limits_[s.element].covers(s); });
  }
  advance_.inverted = watch_.inverted;
  advance_.work = {};
  double sum = 0.0;
  for (std::size_t i = 0; i < u_.size(); ++i) sum += norm(elastic_[i]) + norm(viscous_[i]);
  advance_.finite = std::isfinite(sum);
  for (ActiveVertex& w : active_) {
    w = {w.vertex, elastic_[w.vertex], viscous_[w.vertex], u_[w.vertex], v_[w.vertex]};
  }
  for (RestingVertex& r : resting_) r.force = elastic_[r.vertex] + viscous_[r.vertex];
  if (!advance_.finite || h == 0.0) return advance_;
  for (std::size_t i = 0; i < u_.size(); ++i) {
    if (is_active_[i] != 0 || rests_[i] != 0) continue;
    const double m = body_.inertia(i);
    const Vec3d before = v_[i], weight = gravity * body_.masses[i];
    const Vec3d force = elastic_[i] + viscous_[i] + weight;
    v_[i] = m > 0.0 ? (before * m + force * h) * (1.0 / (m + damping_[i] * h)) : Vec3d{};
    if (accounted) book(i, before, weight);
    u_[i] += v_[i] * h;
  }
  since_memory_ += h;
  return advance_;
}

}  // namespace glisson::engine
