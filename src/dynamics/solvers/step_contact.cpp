#include "dynamics/solvers/step_contact.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dynamics/solvers/tangent_system.h"

namespace glisson {
namespace {

constexpr std::size_t kAtATime = 8;  ///< means whose columns are found in one go
constexpr int kMostEnds = 8;         ///< of tools that a force moves, tried in a correction that is the last
constexpr double kEndFound = 1e-5;   ///< of what the tissue holds a tool back: so exactly its end is found …
constexpr double kEndLost = 0.1;     ///< … and so far off it is none
constexpr int kMostUnsettled = 5;    ///< corrections of a step whose rows did not settle: forces stay from then on
constexpr int kNoLimit = std::numeric_limits<int>::max();

/// What a mean is known by.
auto key_of(const StepMobility::Mean& mean) {
  std::vector<std::pair<std::uint32_t, double>> key;
  for (const VertexWeight& w : mean) key.emplace_back(w.vertex, w.weight);
  return key;
}

}  // namespace

void StepContact::add(std::shared_ptr<Interaction> interaction) {
  interactions_.add(std::move(interaction));
  interactions_.keep_all();
  forces_.resize(state_.body.vertex_count);
  interactions_.ask_rests();
  activate({});
}

void StepContact::body_changed(const BodyView& body, std::span<const std::uint32_t> origins) {
  forces_.assign(state_.body.vertex_count, Vec3d{});
  activate({});
  interactions_.body_changed(body, origins);
  interactions_.ask_rests();
}

void StepContact::state_set(std::span<const Vec3d> displacement) {
  forces_.assign(state_.body.vertex_count, Vec3d{});
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
}

StepContact::Backup StepContact::backup() {
  return {.interactions = interactions_.save(), .rests = interactions_.rests(), .forces = forces_};
}

void StepContact::restore(const Backup& backup) {
  interactions_.load(backup.interactions);
  interactions_.set_rests(backup.rests);
  forces_ = backup.forces;
}

/// Begins at u(t), with the velocities that lead to u⁺ less what forces have moved.
void StepContact::set_start(std::span<const Vec3d> u, const Eigen::VectorXd& moved) {
  velocities_.resize(active_.size()), free_.resize(active_.size());
  for (std::size_t k = 0; k < active_.size(); ++k) {
    ActiveVertex& w = active_[k];
    const auto at = 3 * static_cast<Eigen::Index>(w.vertex);
    w.displacement = start_[w.vertex];
    velocities_[k] = (u[w.vertex] - Vec3d{moved[at], moved[at + 1], moved[at + 2]} - w.displacement) * (1.0 / h_);
    w.velocity = velocities_[k];
    for (std::size_t axis = 0; axis < 3; ++axis) free_[k][axis] = system_.is_free(3 * w.vertex + axis) ? 1.0 : 0.0;
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
  asked_before_.swap(asked_), asked_.clear();
  std::erase_if(solved().means, [](const auto& mean) { return !mean.second.used && mean.first.size() > 1; });
  for (auto& [key, mean] : solved().means) mean.used = false;
  if (mass_matters && h != factor_h_) system_.renew();
  factor_h_ = h;
  agrees_ = taken_ = true;
  unsettled_ = 0;
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
  return *static_cast<Solved*>(known.get());
}

/// P⁻¹ of forces. A correction takes off what the last one has put on: one solve serves both.
const Eigen::VectorXd& StepContact::response(const std::vector<Vec3d>& forces) {
  Solved& last = solved();
  if (last.forces != forces) {
    Eigen::MatrixXd moved = flat(std::span<const Vec3d>(forces));
    system_.factor_solve(moved);
    last.forces = forces, last.moved = moved;
  }
  return last.moved;
}

void StepContact::set_velocities(std::span<const Vec3d> impulses, std::span<ActiveVertex> vertices) {
  std::vector<Vec3d> forces(state_.body.vertex_count);
  for (std::size_t k = 0; k < vertices.size(); ++k) forces[vertices[k].vertex] = impulses[k] * (1.0 / h_);
  const Eigen::VectorXd& moved = response(forces);
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const auto at = 3 * static_cast<Eigen::Index>(vertices[k].vertex);
    vertices[k].velocity = velocities_[k] + Vec3d{moved[at], moved[at + 1], moved[at + 2]} * (1.0 / h_);
  }
}

/// The rows of all interactions, from the state after reach(). Where a correction is the last, again until tools that a force moves
/// end where their rows were declared for. @return false where these were not found in time
bool StepContact::find_forces() {
  int sweeps = 0;
  const int most = most_sweeps_ > 0 ? most_sweeps_ : kNoLimit;
  for (int ends = 1;; ++ends) {
    interactions_.load(reached_.interactions);
    interactions_.begin(state_.time, h_, active_, {}, state_.body.rest_positions, state_.options.track_energies);
    interactions_.add_forces();
    sweeps += interactions_.constrain(free_, *this, most - sweeps);
    agrees_ = interactions_.has_settled();
    if (!is_last_ || !interactions_.moves_on(kEndFound) || ends == kMostEnds || sweeps >= most || stops()) break;
    for (std::size_t k = 0; k < active_.size(); ++k) active_[k].velocity = velocities_[k];
  }
  agrees_ = agrees_ && !interactions_.moves_on(kEndFound);
  return sweeps < most && interactions_.is_found() && !interactions_.moves_on(kEndLost) && !stops();
}

bool StepContact::correct(std::span<Vec3d> u) {
  if (system_.factor_number() == 0) return false;
  if (unsettled_ >= kMostUnsettled &&
      taken_) {  // points close to each other may go on giving their load to one another
    agrees_ = true;
    return true;
  }
  const Eigen::VectorXd known = response(forces_);
  set_start(u, known);
  const bool found = find_forces();
  if (stops() || (is_last_ && !found)) return false;
  if (!interactions_.has_settled()) ++unsettled_;
  forces_.assign(u.size(), Vec3d{});
  for (std::size_t k = 0; k < active_.size(); ++k) {
    forces_[active_[k].vertex] = interactions_.impulses()[k] * (1.0 / h_);
  }
  flat(u) += response(forces_) - known;
  return true;
}

void StepContact::set_end(std::span<const Vec3d> u, std::span<const Vec3d> v) {
  for (ActiveVertex& w : active_) w.displacement = u[w.vertex], w.velocity = v[w.vertex];
}

bool StepContact::overshoots(std::span<const Vec3d> u, std::span<const Vec3d> v) {
  set_end(u, v);
  return interactions_.overshoot();
}

void StepContact::made(std::span<const Vec3d> u, std::span<const Vec3d> v, std::span<const RestingVertex> resting) {
  set_end(u, v);
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

/// With means that are not known others are found that the last factor was asked for: a pass over the factor then serves several.
std::vector<const StepMobility::Column*> StepContact::columns(std::span<const Mean> means) {
  std::map<MeanKey, MeanColumn>& known = solved().means;
  std::vector<const Column*> all;
  std::vector<std::pair<MeanKey, Column*>> fresh;
  const auto ask = [&](const MeanKey& key) {
    const auto [at, is_fresh] = known.try_emplace(key);
    if (is_fresh) fresh.emplace_back(key, &at->second.moved);
    return at;
  };
  for (const Mean& mean : means) {
    const auto at = ask(key_of(mean));
    at->second.used = true;
    asked_.insert(at->first);
    all.push_back(&at->second.moved);
  }
  for (const MeanKey& key : asked_before_) {
    if (fresh.size() % kAtATime == 0) break;
    ask(key);
  }
  Eigen::MatrixXd moved;
  for (std::size_t first = 0; first < fresh.size(); first += kAtATime) {
    const std::size_t n = std::min(kAtATime, fresh.size() - first);
    moved.setZero(static_cast<Eigen::Index>(3 * state_.body.vertex_count), static_cast<Eigen::Index>(3 * n));
    const auto column = [&](std::size_t k, Eigen::Index axis) { return static_cast<Eigen::Index>(3 * k) + axis; };
    for (std::size_t k = 0; k < n; ++k) {
      for (const auto& [vertex, weight] : fresh[first + k].first) {
        const Eigen::Index row = 3 * static_cast<Eigen::Index>(vertex);
        for (Eigen::Index axis = 0; axis < 3; ++axis) moved(row + axis, column(k, axis)) = weight;
      }
    }
    system_.factor_solve(moved);
    for (std::size_t k = 0; k < n; ++k) *fresh[first + k].second = moved.middleCols<3>(column(k, 0));
  }
  return all;
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
  forces_.resize(state_.body.vertex_count);
  ar.same_size(forces_);
  ar(factor_h_);
}

}  // namespace glisson
