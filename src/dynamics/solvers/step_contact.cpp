#include "dynamics/solvers/step_contact.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace glisson {

void StepContact::add(std::shared_ptr<Interaction> interaction) {
  interactions_.add(std::move(interaction));
  interactions_.keep_all();
  forces_.resize(state_.body.vertex_count);
  activate({});
}

void StepContact::body_changed(const BodyView& body, std::span<const std::uint32_t> origins) {
  forces_.assign(state_.body.vertex_count, Vec3d{});
  activate({});
  interactions_.body_changed(body, origins);
}

void StepContact::state_set() {
  std::fill(forces_.begin(), forces_.end(), Vec3d{});
  interactions_.state_set();
}

/// Takes vertices to those that are at hand.
void StepContact::activate(std::span<const std::uint32_t> vertices) {
  const auto take = [&](const auto& list) {
    for (const std::uint32_t v : list) {
      active_.push_back({.vertex = v, .elastic = {}, .viscous = {}, .displacement = {}, .velocity = {}});
    }
  };
  take(vertices), take(interactions_.named());
  const auto before = [](const ActiveVertex& a, const ActiveVertex& b) { return a.vertex < b.vertex; };
  const auto same = [](const ActiveVertex& a, const ActiveVertex& b) { return a.vertex == b.vertex; };
  std::sort(active_.begin(), active_.end(), before);
  active_.erase(std::unique(active_.begin(), active_.end(), same), active_.end());
  interactions_.find_places(active_, state_.body.vertex_count);
  at_places_.clear();
}

StepContact::Backup StepContact::backup() {
  Backup b{.interactions = {}, .forces = forces_};
  for (const std::shared_ptr<Interaction>& x : interactions_.all()) {
    Archive ar;
    x->archive(ar);
    b.interactions.push_back(ar.bytes());
  }
  return b;
}

void StepContact::restore(const Backup& backup) {
  for (std::size_t k = 0; k < backup.interactions.size(); ++k) {
    Archive ar(backup.interactions[k]);
    interactions_.all()[k]->archive(ar);
  }
  forces_ = backup.forces;
}

void StepContact::put_at_start(std::span<const Vec3d> u) {
  for (ActiveVertex& w : active_) {
    w.displacement = start_[w.vertex];
    w.velocity = (u[w.vertex] - start_[w.vertex]) * (1.0 / h_);
  }
}

void StepContact::begin(double h, std::span<const Vec3d> u, bool mass_matters) {
  before_ = backup();
  h_ = h;
  start_.assign(u.begin(), u.end());
  const std::span<const std::uint32_t> newcomers = interactions_.newcomers(state_.time, h, state_.body.vertex_count);
  if (!newcomers.empty()) activate(newcomers);
  reached_ = backup();
  at_places_.clear();  // the order in which columns come is that of this step, whatever was before
  if (mass_matters && h != factor_h_) system_.renew();
  factor_h_ = h;
  if (constrains()) return;  // correct() begins the step
  interactions_.begin(state_.time, h_, active_, {}, state_.body.rest_positions, state_.options.track_energies);
}

bool StepContact::constrains() const {
  const std::span<const std::shared_ptr<Interaction>> all = interactions_.all();
  return std::any_of(all.begin(), all.end(), [](const auto& x) { return x->constrains_long_steps(); });
}

void StepContact::add_forces_at(std::span<const Vec3d> u, std::span<Vec3d> forces) const {
  for (const std::shared_ptr<Interaction>& x : interactions_.all()) x->add_forces_at(u, forces);
}

double StepContact::energy_at(std::span<const Vec3d> u) const {
  std::vector<Vec3d> unused(state_.body.vertex_count);
  double sum = 0.0;
  for (const std::shared_ptr<Interaction>& x : interactions_.all()) {
    x->add_forces_at(u, unused);
    sum += x->energy() + x->released_energy();
  }
  return sum;
}

std::span<const TriangleStiffness> StepContact::stiffness() {
  stiffness_.clear();
  for (const std::shared_ptr<Interaction>& x : interactions_.all()) x->add_stiffness(stiffness_);
  return stiffness_;
}

bool StepContact::correct(std::span<Vec3d> u) {
  if (system_.factor_number() == 0) return false;
  if (system_.factor_number() != factor_) {
    factor_ = system_.factor_number();
    columns_.clear(), at_places_.clear();
  }
  if (at_places_.empty()) {
    at_places_.resize(active_.size());
    near_.clear(), far_.resize(active_.size());
    std::iota(far_.begin(), far_.end(), 0U);
  }
  unsettled_.assign(active_.size(), Vec3d{});
  const std::vector<Vec3d> known = forces_;
  restore(reached_);
  put_at_start(u);
  interactions_.begin(state_.time, h_, active_, {}, state_.body.rest_positions, state_.options.track_energies);
  interactions_.add_forces();
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const Vec3d& f = known[active_[k].vertex];
    if (f != Vec3d{}) spread(k, f * -h_, active_);
  }
  settle(active_);
  interactions_.constrain(*this);
  settle(active_);
  std::fill(forces_.begin(), forces_.end(), Vec3d{});
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const std::uint32_t v = active_[k].vertex;
    forces_[v] = interactions_.impulses()[k] * (1.0 / h_);
    const Vec3d more = forces_[v] - known[v];
    if (more == Vec3d{}) continue;
    flat(u) += column(v) * Eigen::Vector3d(more.x, more.y, more.z);
  }
  return true;
}

void StepContact::put_at_end(std::span<const Vec3d> u, std::span<const Vec3d> v) {
  for (ActiveVertex& w : active_) w.displacement = u[w.vertex], w.velocity = v[w.vertex];
}

bool StepContact::overshoots(std::span<const Vec3d> u, std::span<const Vec3d> v) {
  put_at_end(u, v);
  return interactions_.overshoot();
}

void StepContact::made(std::span<const Vec3d> u, std::span<const Vec3d> v) {
  put_at_end(u, v);
  interactions_.moved();
}

std::array<double, 3> StepContact::lost() const {
  std::array<double, 3> sinks{};
  for (std::size_t sink = 0; sink < sinks.size(); ++sink) {
    const InterfaceBook::Page& page = interactions_.book().pages[sink];
    sinks[sink] = page.tools_after;
    for (std::size_t k = 0; k < page.impulses.size(); ++k) {
      const std::uint32_t v = active_[k].vertex;
      sinks[sink] -= dot(page.impulses[k], (active_[k].displacement - start_[v]) * (1.0 / h_));
    }
  }
  return sinks;
}

/// Displacements by unit forces at a vertex, 0 where it is held.
const StepContact::Column& StepContact::column(std::uint32_t vertex) {
  const auto [at, fresh] = columns_.try_emplace(vertex);
  if (!fresh) return at->second;
  const auto rows = static_cast<Eigen::Index>(3 * state_.body.vertex_count);
  at->second = Column::Zero(rows, 3);
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(rows), moved;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Index c = 3 * static_cast<Eigen::Index>(vertex) + axis;
    if (!system_.is_free(static_cast<std::size_t>(c))) continue;
    unit[c] = 1.0;
    system_.factor_solve(unit, moved);
    at->second.col(axis) = moved;
    unit[c] = 0.0;
  }
  return at->second;
}

const StepContact::Column& StepContact::column_at(std::size_t place) {
  Column& own = at_places_[place];
  if (own.rows() > 0) return own;
  settle(active_);
  const Column& whole = column(active_[place].vertex);
  own.resize(static_cast<Eigen::Index>(3 * active_.size()), 3);
  for (std::size_t k = 0; k < active_.size(); ++k) {
    own.middleRows<3>(static_cast<Eigen::Index>(3 * k)) =
        whole.middleRows<3>(3 * static_cast<Eigen::Index>(active_[k].vertex));
  }
  near_.push_back(static_cast<std::uint32_t>(place));
  std::erase(far_, place);
  return own;
}

/// Moves the vertex at a place by an impulse at another one.
void StepContact::move(std::size_t by, const Vec3d& impulse, std::size_t place, ActiveVertex& vertex) const {
  const Column& c = at_places_[by];
  const auto i = static_cast<Eigen::Index>(3 * place);
  const double scale = 1.0 / (h_ * h_), x = impulse.x * scale, y = impulse.y * scale, z = impulse.z * scale;
  Vec3d& v = vertex.velocity;
  v.x += c(i, 0) * x + c(i, 1) * y + c(i, 2) * z;
  v.y += c(i + 1, 0) * x + c(i + 1, 1) * y + c(i + 1, 2) * z;
  v.z += c(i + 2, 0) * x + c(i + 2, 1) * y + c(i + 2, 2) * z;
}

void StepContact::spread(std::size_t place, const Vec3d& impulse, std::span<ActiveVertex> vertices) {
  static_cast<void>(column_at(place));
  unsettled_[place] += impulse;
  for (const std::uint32_t k : near_) move(place, impulse, k, vertices[k]);
}

void StepContact::settle(std::span<ActiveVertex> vertices) {
  for (const std::uint32_t by : near_) {
    if (unsettled_[by] == Vec3d{}) continue;
    for (const std::uint32_t k : far_) move(by, unsettled_[by], k, vertices[k]);
    unsettled_[by] = {};
  }
}

Vec3d StepContact::mobility(std::size_t place) {
  const Eigen::Matrix3d own = column_at(place).middleRows<3>(static_cast<Eigen::Index>(3 * place));
  const double most = own.cwiseAbs().rowwise().sum().maxCoeff() / (h_ * h_);  // no eigenvalue is above it
  Vec3d mobility;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mobility[axis] = system_.is_free(3 * active_[place].vertex + axis) ? most : 0.0;
  }
  return mobility;
}

void StepContact::archive(Archive& ar) {
  std::vector<std::uint32_t> vertices;
  for (const ActiveVertex& w : active_) vertices.push_back(w.vertex);
  ar.all_below(vertices, state_.body.vertex_count);
  if (ar.reads()) activate(vertices);
  interactions_.archive(ar);
  ar.same_size(forces_);
  ar(factor_h_);
}

}  // namespace glisson
