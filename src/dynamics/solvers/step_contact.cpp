#include "dynamics/solvers/step_contact.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dynamics/solvers/most_trials.h"
#include "dynamics/solvers/tangent_system.h"

namespace glisson {
namespace {

constexpr int kMostRounds = 10;      ///< of several interactions, each with the forces of the others
constexpr std::size_t kAtATime = 8;  ///< vertices or means whose columns are found in one go
constexpr double kAgreed = 1e-5;     ///< change of a force in a round, of the largest, at which they agree

/// What a mean is known by.
auto key_of(const std::vector<VertexWeight>& mean) {
  std::vector<std::pair<std::uint32_t, double>> key;
  for (const VertexWeight& w : mean) key.emplace_back(w.vertex, w.weight);
  return key;
}

}  // namespace

void ExertedForces::set_zero(std::size_t vertices) {
  total.assign(vertices, Vec3d{});
  for (std::vector<Vec3d>& of_one : own) of_one.assign(vertices, Vec3d{});
}

ExertedForces ExertedForces::towards(const ExertedForces& others, double share) const {
  ExertedForces between = others;
  const auto mix = [share](std::vector<Vec3d>& to, const std::vector<Vec3d>& from) {
    for (std::size_t v = 0; v < to.size(); ++v) to[v] = from[v] + (to[v] - from[v]) * share;
  };
  mix(between.total, total);
  for (std::size_t i = 0; i < own.size(); ++i) mix(between.own[i], own[i]);
  return between;
}

void ExertedForces::archive(Archive& ar) {
  ar.same_size(total);
  for (std::vector<Vec3d>& of_one : own) ar.same_size(of_one);
}

void StepContact::add(std::shared_ptr<Interaction> interaction) {
  interactions_.add(std::move(interaction));
  interactions_.keep_all();
  forces_.own.emplace_back();
  pushes_means_.push_back(0);
  order_.resize(forces_.own.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return interactions_.all()[a]->label() < interactions_.all()[b]->label();
  });
  forces_.total.resize(state_.body.vertex_count);
  for (std::vector<Vec3d>& of_one : forces_.own) of_one.resize(state_.body.vertex_count);
  interactions_.ask_rests();
  activate({});
}

void StepContact::body_changed(const BodyView& body, std::span<const std::uint32_t> origins) {
  forces_.set_zero(state_.body.vertex_count);
  activate({});
  interactions_.body_changed(body, origins);
  interactions_.ask_rests();
}

void StepContact::state_set(std::span<const Vec3d> displacement) {
  forces_.set_zero(state_.body.vertex_count);
  interactions_.state_set(displacement);
  interactions_.ask_rests();
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
  return {.interactions = interactions_.save(), .rests = interactions_.rests(), .forces = forces_};
}

void StepContact::restore(const Backup& backup) {
  interactions_.load(backup.interactions);
  interactions_.set_rests(backup.rests);
  forces_ = backup.forces;
}

void StepContact::put_at_start(std::span<const Vec3d> u) {
  for (ActiveVertex& w : active_) {
    w.displacement = start_[w.vertex];
    w.velocity = (u[w.vertex] - start_[w.vertex]) * (1.0 / h_);
  }
}

bool StepContact::begin(double h, std::span<const Vec3d> u, bool mass_matters) {
  before_ = backup();
  h_ = h;
  start_.assign(u.begin(), u.end());
  const std::span<const std::uint32_t> newcomers = interactions_.newcomers(state_.time, h, state_.body.vertex_count);
  const bool others_rest = interactions_.rest_changed();
  if (!newcomers.empty()) activate(newcomers);
  reached_ = backup();
  at_places_.clear();  // the order in which columns come is that of this step, whatever was before
  asked_before_.swap(asked_), asked_.clear();
  std::erase_if(solved().means, [](const auto& mean) { return !mean.second.used; });
  for (auto& [key, mean] : solved().means) mean.used = false;
  if (mass_matters && h != factor_h_) system_.renew();
  factor_h_ = h;
  agrees_ = true;
  if (!constrains()) {  // correct() begins the step otherwise
    interactions_.begin(state_.time, h_, active_, {}, state_.body.rest_positions, state_.options.track_energies);
  }
  return others_rest;
}

bool StepContact::constrains() const {
  const std::span<const std::shared_ptr<Interaction>> all = interactions_.all();
  return std::any_of(all.begin(), all.end(), [](const auto& x) { return x->constrains_long_steps(); });
}

void StepContact::add_forces_at(std::span<const Vec3d> u, std::span<Vec3d> forces) const {
  for (const std::shared_ptr<Interaction>& x : interactions_.all()) x->add_forces_at(u, forces);
}

void StepContact::add_viscous_forces_at(std::span<const Vec3d> u, std::span<const Vec3d> v,
                                        std::span<Vec3d> forces) const {
  for (const std::shared_ptr<Interaction>& x : interactions_.all()) x->add_viscous_forces_at(u, v, forces);
}

double StepContact::energy_at(std::span<const Vec3d> u) const {
  std::vector<Vec3d> unused(state_.body.vertex_count);
  double sum = 0.0;
  for (const std::shared_ptr<Interaction>& x : interactions_.all()) {
    x->add_forces_at(u, unused);
    sum += x->energy() + x->released_energy() - x->changed_energy();
  }
  return sum;
}

std::span<const TriangleStiffness> StepContact::stiffness() {
  stiffness_.clear();
  for (const std::shared_ptr<Interaction>& x : interactions_.all()) x->add_stiffness(stiffness_);
  return stiffness_;
}

std::span<const TetStiffness> StepContact::tet_stiffness(double rate) {
  tet_stiffness_.clear();
  for (const std::shared_ptr<Interaction>& x : interactions_.all()) x->add_tet_stiffness(tet_stiffness_, rate);
  return tet_stiffness_;
}

/// What is known of the present factor.
StepContact::Solved& StepContact::solved() {
  std::shared_ptr<void>& known = system_.solved();
  if (known == nullptr) {
    known = std::make_shared<Solved>();
    asked_before_.swap(asked_), asked_.clear();
  }
  Solved& all = *static_cast<Solved*>(known.get());
  all.responses.resize(forces_.own.size());
  return all;
}

/// P⁻¹ of forces that an interaction exerts. A correction takes off what the last one has put on: one solve serves both.
const Eigen::VectorXd& StepContact::response(std::size_t interaction, const std::vector<Vec3d>& forces) {
  Response& last = solved().responses[interaction];
  if (last.forces != forces) {
    Eigen::MatrixXd moved = flat(std::span<const Vec3d>(forces));
    system_.factor_solve(moved);
    last = {forces, moved};
  }
  return last.moved;
}

/// Moves the active vertices as if the forces of an interaction were not there.
void StepContact::take_off(std::size_t interaction) {
  const std::vector<Vec3d>& own = forces_.own[interaction];
  if (pushes_means_[interaction] != 0) {
    const Eigen::VectorXd& moved = response(interaction, own);
    for (ActiveVertex& w : active_) {
      const Eigen::Index at = 3 * static_cast<Eigen::Index>(w.vertex);
      w.velocity -= Vec3d{moved[at], moved[at + 1], moved[at + 2]} * (1.0 / h_);
    }
  } else {
    for (std::size_t k = 0; k < active_.size(); ++k) {
      const Vec3d& f = own[active_[k].vertex];
      if (f != Vec3d{}) spread(k, f * -h_, active_);
    }
  }
  settle(active_);
}

/// Looks at the work that has been done. @param tries_again  that of a trial after which another follows  @param trial  its number
/// @return whether there may be more
bool StepContact::count_work(bool tries_again, int trial) {
  const auto places = static_cast<double>(std::max<std::size_t>(near_.size(), 1));
  const bool interrupted = interrupt_ != nullptr && interrupt_->wanted();
  const bool lost = tries_again && trial == kMostTrials && is_last_;
  exhausted_ = interrupted || lost || pushes_ > most_sweeps_ * places;
  return !exhausted_ && trial < kMostTrials;
}

/// @return by how much a force has changed at most [N]
double StepContact::find_forces_of(std::size_t interaction) {
  acting_ = interaction;
  take_off(interaction);
  const Interactions::Found others = interactions_.found();
  const std::vector<Vec3d>& before = others.impulses;
  const std::vector<ActiveVertex> free = active_;
  interactions_.constrain(interaction, *this);
  for (int trial = 1;; ++trial) {
    const bool again = interactions_.all()[interaction]->tries_again();
    if (!count_work(again, trial) || !again) break;
    active_ = free;
    unsettled_.assign(active_.size(), Vec3d{});
    interactions_.go_back(others);
    interactions_.load(interaction, reached_.interactions[interaction]);
    interactions_.constrain(interaction, *this);
  }
  settle(active_);
  std::vector<Vec3d>& own = forces_.own[interaction];
  double change = 0.0;
  std::vector<Vec3d> found(own.size());
  for (std::size_t k = 0; k < active_.size(); ++k) {
    found[active_[k].vertex] = (interactions_.impulses()[k] - before[k]) * (1.0 / h_);
  }
  for (std::size_t v = 0; v < own.size(); ++v) change = std::max(change, norm(found[v] - own[v]));
  own = std::move(found);
  return change;
}

/// All interactions in turn, by their names: the order in which they were attached does not matter. @return by how much a force has changed at most, of the largest; 0 where one alone exerts any
double StepContact::find_forces() {
  interactions_.clear_impulses();
  double change = 0.0, largest = 0.0;
  int exerting = 0;
  for (std::size_t k = 0; k < order_.size() && !exhausted_; ++k) {
    const std::size_t i = order_[k];
    if (interactions_.all()[i]->constrains_long_steps()) change = std::max(change, find_forces_of(i));
    double own = 0.0;
    for (const Vec3d& f : forces_.own[i]) own = std::max(own, norm(f));
    largest = std::max(largest, own), exerting += own > 0.0 ? 1 : 0;
  }
  return exerting > 1 ? change / largest : 0.0;
}

/// Moves u⁺ by what the forces have changed. @param moved  per interaction: P⁻¹ of the forces known; empty: not asked for
void StepContact::move_by_change(std::span<Vec3d> u, const ExertedForces& known, std::span<Eigen::VectorXd> moved) {
  for (const std::size_t i : order_) {
    if (pushes_means_[i] != 0) {
      if (moved[i].size() == 0) moved[i] = response(i, known.own[i]);
      flat(u) += response(i, forces_.own[i]) - moved[i];
      continue;
    }
    for (const ActiveVertex& w : active_) {
      const Vec3d more = forces_.own[i][w.vertex] - known.own[i][w.vertex];
      if (more != Vec3d{}) flat(u) += column(w.vertex) * Eigen::Vector3d(more.x, more.y, more.z);
    }
  }
}

bool StepContact::correct(std::span<Vec3d> u) {
  if (system_.factor_number() == 0) return false;
  if (system_.factor_number() != factor_) {
    factor_ = system_.factor_number();
    at_places_.clear();
  }
  if (at_places_.empty()) {
    at_places_.resize(active_.size());
    near_.clear(), far_.resize(active_.size());
    std::iota(far_.begin(), far_.end(), 0U);
  }
  unsettled_.assign(active_.size(), Vec3d{});
  const ExertedForces known = forces_;
  std::vector<Eigen::VectorXd> moved(known.own.size());
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (pushes_means_[i] != 0) moved[i] = response(i, known.own[i]);
  }
  put_at_start(u);
  interactions_.begin(state_.time, h_, active_, {}, state_.body.rest_positions, state_.options.track_energies);
  agrees_ = exhausted_ = false;
  pushes_ = 0.0;
  for (int round = 0; round < kMostRounds && !agrees_ && !exhausted_; ++round) {
    interactions_.load(reached_.interactions);
    if (round == 0) interactions_.add_forces();
    agrees_ = find_forces() <= kAgreed;
  }
  if (exhausted_) return false;
  forces_.total.assign(u.size(), Vec3d{});
  for (const ActiveVertex& w : active_) {
    for (const std::size_t i : order_) forces_.total[w.vertex] += forces_.own[i][w.vertex];
  }
  move_by_change(u, known, moved);
  return true;
}

void StepContact::put_at_end(std::span<const Vec3d> u, std::span<const Vec3d> v) {
  for (ActiveVertex& w : active_) w.displacement = u[w.vertex], w.velocity = v[w.vertex];
}

bool StepContact::overshoots(std::span<const Vec3d> u, std::span<const Vec3d> v) {
  put_at_end(u, v);
  return interactions_.overshoot();
}

void StepContact::made(std::span<const Vec3d> u, std::span<const Vec3d> v, std::span<const RestingVertex> resting) {
  put_at_end(u, v);
  interactions_.set_resting(resting);
  interactions_.moved();
  interactions_.set_resting({});
}

/// @param velocity  (k): of the k-th active vertex
template <class Velocity>
std::array<double, 3> StepContact::lost_by(double InterfaceBook::Page::*tools, const Velocity& velocity) const {
  std::array<double, 3> sinks{};
  for (std::size_t sink = 0; sink < sinks.size(); ++sink) {
    const InterfaceBook::Page& page = interactions_.book().pages[sink];
    sinks[sink] = page.*tools;
    for (std::size_t k = 0; k < page.impulses.size(); ++k) sinks[sink] -= dot(page.impulses[k], velocity(k));
  }
  return sinks;
}

std::array<double, 3> StepContact::lost() const {
  return lost_by(&InterfaceBook::Page::tools_after,
                 [&](std::size_t k) { return (active_[k].displacement - start_[active_[k].vertex]) * (1.0 / h_); });
}

std::array<double, 3> StepContact::lost_at(std::span<const Vec3d> v, double InterfaceBook::Page::*tools) const {
  return lost_by(tools, [&](std::size_t k) { return v[active_[k].vertex]; });
}

/// Displacements by unit forces at a vertex, 0 where it is held. With one that is not known others are found that the last factor
/// was asked for: a pass over the factor then serves several.
const StepContact::Column& StepContact::column(std::uint32_t vertex) {
  asked_.insert(vertex);
  std::map<std::uint32_t, Column>& columns = solved().columns;
  if (const auto at = columns.find(vertex); at != columns.end()) return at->second;
  std::vector<std::uint32_t> fresh{vertex};
  for (const std::uint32_t v : asked_before_) {
    if (fresh.size() == kAtATime) break;
    if (v != vertex && columns.count(v) == 0) fresh.push_back(v);
  }
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * state_.body.vertex_count),
                                                static_cast<Eigen::Index>(3 * fresh.size()));
  for (std::size_t k = 0; k < 3 * fresh.size(); ++k) {
    moved(static_cast<Eigen::Index>(3 * fresh[k / 3] + k % 3), static_cast<Eigen::Index>(k)) = 1.0;
  }
  system_.factor_solve(moved);
  for (std::size_t k = 0; k < fresh.size(); ++k)
    columns[fresh[k]] = moved.middleCols<3>(static_cast<Eigen::Index>(3 * k));
  return columns[vertex];
}

/// Displacements by unit forces on a mean of vertices, once find_columns() has them.
const StepContact::Column& StepContact::column_of(const std::vector<VertexWeight>& mean) {
  return solved().means.at(key_of(mean)).moved;
}

/// Finds those of means that are not known yet, several at a time: a pass over the factor then serves them all.
void StepContact::find_columns(std::span<const std::vector<VertexWeight>> means) {
  std::vector<std::pair<const std::vector<VertexWeight>*, Column*>> fresh;
  for (const std::vector<VertexWeight>& mean : means) {
    const auto [at, is_fresh] = solved().means.try_emplace(key_of(mean));
    at->second.used = true;
    if (is_fresh) fresh.emplace_back(&mean, &at->second.moved);
  }
  Eigen::MatrixXd moved;
  for (std::size_t first = 0; first < fresh.size(); first += kAtATime) {
    const std::size_t n = std::min(kAtATime, fresh.size() - first);
    moved.setZero(static_cast<Eigen::Index>(3 * state_.body.vertex_count), static_cast<Eigen::Index>(3 * n));
    const auto column = [&](std::size_t k, Eigen::Index axis) { return static_cast<Eigen::Index>(3 * k) + axis; };
    for (std::size_t k = 0; k < n; ++k) {
      for (const VertexWeight& w : *fresh[first + k].first) {
        const Eigen::Index row = 3 * static_cast<Eigen::Index>(w.vertex);
        for (Eigen::Index axis = 0; axis < 3; ++axis) moved(row + axis, column(k, axis)) = w.weight;
      }
    }
    system_.factor_solve(moved);
    for (std::size_t k = 0; k < n; ++k) *fresh[first + k].second = moved.middleCols<3>(column(k, 0));
  }
}

std::vector<Mat3d> StepContact::couple(std::span<const std::vector<VertexWeight>> means) {
  pushes_means_[acting_] = 1;
  find_columns(means);
  std::vector<Mat3d> W(means.size() * means.size());
  const double scale = 1.0 / (h_ * h_);
  for (std::size_t k = 0; k < means.size(); ++k) {
    const Column& c = column_of(means[k]);
    for (std::size_t j = 0; j < means.size(); ++j) {
      Mat3d& block = W[j * means.size() + k];
      for (const VertexWeight& w : means[j]) {
        for (std::size_t entry = 0; entry < 9; ++entry) {
          block(entry / 3, entry % 3) +=
              w.weight * scale *
              c(static_cast<Eigen::Index>(3 * w.vertex + entry / 3), static_cast<Eigen::Index>(entry % 3));
        }
      }
    }
  }
  return W;
}

void StepContact::spread_means(std::span<const std::vector<VertexWeight>> means, std::span<const Vec3d> impulses,
                               std::span<ActiveVertex> vertices) {
  find_columns(means);
  for (std::size_t k = 0; k < means.size(); ++k) {
    if (impulses[k] == Vec3d{}) continue;
    const Column& c = column_of(means[k]);
    const Eigen::Vector3d f = Eigen::Vector3d(impulses[k].x, impulses[k].y, impulses[k].z) * (1.0 / (h_ * h_));
    for (ActiveVertex& w : vertices) {
      const Eigen::Vector3d v = c.middleRows<3>(3 * static_cast<Eigen::Index>(w.vertex)) * f;
      w.velocity += Vec3d{v.x(), v.y(), v.z()};
    }
  }
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
  ++pushes_;
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
  if (ar.reads()) {
    active_.clear();
    interactions_.forget_named();
    activate(vertices);
  }
  interactions_.archive(ar);
  if (ar.reads()) forces_.set_zero(state_.body.vertex_count);
  ar(forces_);
  ar.same_size(pushes_means_);
  ar(factor_h_);
}

}  // namespace glisson
