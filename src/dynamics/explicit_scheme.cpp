#include "dynamics/explicit_scheme.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "dynamics/make_body.h"
#include "mechanics/tet_fields.h"

namespace glisson {
namespace {

std::vector<double> nodal_damping(const Body& body, const SimulationOptions& o) {
  std::vector<double> gamma;
  for (const double m : body.masses) gamma.push_back(o.damping_rate * m + o.nodal_damping);
  return gamma;
}

void add(KickPower& sum, const KickPower& p) {
  sum.elastic += p.elastic, sum.viscous += p.viscous, sum.damping += p.damping;
  sum.tools += p.tools, sum.loads += p.loads;
}

}  // namespace

ExplicitScheme::ExplicitScheme(Body body, const SimulationOptions& options)
    : options_(options), body_(std::move(body)), gamma_(nodal_damping(body_, options)),
      moving_(make_moving_body(body_, gamma_, options, info_)), constraints_(body_.vertex_count),
      loads_(body_.vertex_count), stiffening_(moving_->advance(0.0, {}, false).stiffening),
      control_(std::make_unique<StepControl>(body_, gamma_, options.step, options.enforce_stability,
                                             options.exact_steps, stiffening_)) {
  if (options.mesh_changes) moving_->apply({}, changer().stars(), gamma_);
}

BodyChanger& ExplicitScheme::changer() {
  if (changer_ == nullptr) changer_ = std::make_unique<BodyChanger>(body_);
  return *changer_;
}

const ExplicitScheme::StateCopy& ExplicitScheme::read_state() const {
  if (!copy_.current) {
    copy_.displacement.resize(body_.vertex_count);
    copy_.velocity.resize(body_.vertex_count);
    moving_->read_state(copy_.displacement, copy_.velocity);
    copy_.current = true;
  }
  return copy_;
}

ConstraintId ExplicitScheme::add_constraint(Constraint constraint) {
  const ConstraintId id = constraints_.add(std::move(constraint));
  base_.emplace_back();
  watch(constraints_.at(id).vertices);
  if (constraints_.at(id).from <= time_) rebase(id.index);
  return id;
}

void ExplicitScheme::add_load(std::span<const std::uint32_t> vertices, Vec3d force,
                              std::function<double(double)> scale) {
  loads_.add(vertices, force, std::move(scale));
  watch(vertices);
}

void ExplicitScheme::watch(std::span<const std::uint32_t> vertices) {
  std::vector<Kicked> of_vertex(body_.vertex_count);
  for (std::size_t k = 0; k < kicked_.size(); ++k) of_vertex[moving_->watched()[k].vertex] = kicked_[k];
  moving_->watch(vertices);
  kicked_.clear();
  for (const WatchedVertex& w : moving_->watched()) kicked_.push_back(of_vertex[w.vertex]);
  find_places();
}

void ExplicitScheme::find_places() {
  const std::span<const WatchedVertex> watched = moving_->watched();
  places_.assign(constraints_.all().size(), {});
  for (std::size_t c = 0; c < places_.size(); ++c) {
    for (const std::uint32_t v : constraints_.all()[c].vertices) {
      const auto at = std::lower_bound(watched.begin(), watched.end(), v,
                                       [](const WatchedVertex& w, std::uint32_t vertex) { return w.vertex < vertex; });
      places_[c].push_back(static_cast<std::uint32_t>(at - watched.begin()));
    }
  }
}

/// Lets those constraints take hold whose time has come by the middle of the step.
void ExplicitScheme::take_hold(double h) {
  for (std::size_t c = 0; c < base_.size(); ++c) {
    if (!holds(c) && constraints_.all()[c].from <= time_ + 0.5 * h) rebase(c);
  }
}

/// Lets a constraint's motion count from where its vertices are now.
void ExplicitScheme::rebase(std::size_t constraint) {
  const Constraint& c = constraints_.all()[constraint];
  const Vec3d moved = c.motion ? c.motion(time_) : Vec3d{};
  base_[constraint].clear();
  for (const std::uint32_t p : places_[constraint]) {
    base_[constraint].push_back(moving_->watched()[p].displacement - moved);
  }
}

void ExplicitScheme::set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  if (displacement.size() != body_.vertex_count || velocity.size() != body_.vertex_count) {
    throw std::invalid_argument("set_state: " + std::to_string(displacement.size()) + " displacements and " +
                                std::to_string(velocity.size()) + " velocities given, the mesh has " +
                                std::to_string(body_.vertex_count) + " vertices");
  }
  moving_->set_state(displacement, velocity);
  stiffening_ = moving_->advance(0.0, {}, false).stiffening;
  copy_.current = false;
  for (std::size_t c = 0; c < base_.size(); ++c) {
    if (holds(c)) rebase(c);
  }
  if (!options_.track_energies) return;
  double kinetic = 0.0;
  for (std::size_t i = 0; i < velocity.size(); ++i) kinetic += 0.5 * body_.masses[i] * dot(velocity[i], velocity[i]);
  ledger_.reset(kinetic, secant_energy(body_, displacement));
}

Vec3d ExplicitScheme::gravity_at(double time) const {
  return options_.gravity * (time < options_.gravity_ramp ? time / options_.gravity_ramp : 1.0);
}

/// v₊ of the watched vertices as if they were free; massless ones (in no tet) stay.
void ExplicitScheme::kick_watched(double h) {
  const std::span<WatchedVertex> watched = moving_->watched();
  const std::span<const Vec3d> loads = loads_.at(time_);
  for (std::size_t k = 0; k < watched.size(); ++k) {
    WatchedVertex& w = watched[k];
    const double m = body_.masses[w.vertex], gamma = gamma_[w.vertex];
    const Vec3d load = m > 0.0 ? loads[w.vertex] : Vec3d{};
    kicked_[k] = {m, gamma, w.velocity, load};
    const Vec3d force = w.elastic + w.viscous + gravity_ * m + load;
    w.velocity = m > 0.0 ? (w.velocity * m + force * h) * (1.0 / (m + gamma * h)) : Vec3d{};
  }
}

/// Replaces v₊ of held and driven components by what their motion asks for.
void ExplicitScheme::impose_motions(double h) {
  const std::span<WatchedVertex> watched = moving_->watched();
  for (std::size_t c = 0; c < constraints_.all().size(); ++c) {
    if (!holds(c)) continue;
    const Constraint& constraint = constraints_.all()[c];
    const Vec3d target = constraint.motion ? constraint.motion(time_ + h) : Vec3d{};
    for (std::size_t k = 0; k < places_[c].size(); ++k) {
      WatchedVertex& w = watched[places_[c][k]];
      const Vec3d wanted = constraint.motion ? (base_[c][k] + target - w.displacement) * (1.0 / h) : Vec3d{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (has_axis(constraint.axes, axis)) w.velocity[axis] = wanted[axis];
      }
    }
  }
}

/// What holds or drives a vertex, in the components it holds, at the last kick.
ForceParts ExplicitScheme::watched_force(std::size_t place, const Axes& axes) const {
  const WatchedVertex& w = moving_->watched()[place];
  const Kicked& k = kicked_[place];
  const Vec3d inertial = kick_step_ > 0.0 ? (w.velocity - k.velocity_before) * (k.mass / kick_step_) : Vec3d{};
  return {masked(-w.elastic, axes), masked(-w.viscous, axes),         masked(w.velocity * k.damping, axes),
          masked(inertial, axes),   masked(gravity_ * -k.mass, axes), masked(-k.load, axes)};
}

/// Work of the forces on the watched vertices, that of the constraints included.
KickWork ExplicitScheme::watched_work() const {
  const std::span<const WatchedVertex> watched = moving_->watched();
  KickWork work;
  for (std::size_t k = 0; k < watched.size(); ++k) {
    const WatchedVertex& w = watched[k];
    const Kicked& at = kicked_[k];
    const auto power = [&](const Vec3d& v) {
      return KickPower{.elastic = dot(w.elastic, v),
                       .viscous = dot(w.viscous, v),
                       .damping = -at.damping * dot(w.velocity, v),
                       .loads = dot(gravity_ * at.mass + at.load, v)};
    };
    add(work.before, power(at.velocity_before));
    add(work.after, power(w.velocity));
    work.kinetic += 0.5 * at.mass * dot(at.velocity_before, w.velocity);
  }
  for (std::size_t c = 0; c < places_.size(); ++c) {
    if (!holds(c)) continue;
    for (const std::uint32_t place : places_[c]) {
      const Vec3d f = watched_force(place, constraints_.all()[c].axes).total();
      work.before.tools += dot(f, kicked_[place].velocity_before);
      work.after.tools += dot(f, watched[place].velocity);
    }
  }
  return work;
}

void ExplicitScheme::book(double h, const KickWork& free) {
  KickWork work = watched_work();
  add(work.before, free.before);
  add(work.after, free.after);
  ledger_.book(h, work.before, work.after, work.kinetic + free.kinetic);
}

StepResult ExplicitScheme::step() {
  if (!control_->accept(stiffening_)) return {StepStatus::step_too_large, {}};
  const double h = control_->step();
  gravity_ = gravity_at(time_);
  take_hold(h);
  const Advance& seen = moving_->advance(h, gravity_, options_.track_energies);
  stiffening_ = seen.stiffening;
  copy_.current = false;
  if (!seen.finite) return {StepStatus::not_finite, seen.inverted};

  kick_step_ = h;
  kick_watched(h);
  impose_motions(h);
  if (options_.track_energies) book(h, seen.work);
  for (WatchedVertex& w : moving_->watched()) w.displacement += w.velocity * h;
  moving_->place_watched();
  time_ += h;
  ++steps_;
  return {seen.inverted.empty() ? StepStatus::ok : StepStatus::inverted, seen.inverted};
}

ForceParts ExplicitScheme::force(ConstraintId constraint) const {
  const Constraint& c = constraints_.at(constraint);
  ForceParts sum;
  if (!holds(constraint.index)) return sum;
  for (const std::uint32_t place : places_[constraint.index]) {
    const ForceParts f = watched_force(place, c.axes);
    sum.elastic += f.elastic, sum.viscous += f.viscous, sum.damping += f.damping;
    sum.inertial += f.inertial, sum.gravity += f.gravity, sum.load += f.load;
  }
  return sum;
}

/// Mass, momentum and energy of elements that are about to go.
void ExplicitScheme::weigh_energy(std::span<const std::uint32_t> elements, RemovalReport& report) {
  double kinetic = 0.0, elastic = 0.0;
  for (const std::uint32_t e : elements) {
    const TissueBlock& block = body_.block_of(e);
    const double quarter = 0.25 * block.tissue.density * body_.rest[e].volume;
    std::array<Vec3d, 4> u;
    for (std::size_t a = 0; a < 4; ++a) {
      const std::uint32_t vertex = body_.elements[e][a];
      const Vec3d v = moving_->velocity_of(vertex);
      u[a] = moving_->displacement_of(vertex);
      report.mass += quarter;
      report.momentum += v * quarter;
      kinetic += 0.5 * quarter * dot(v, v);
    }
    elastic += element_energy(body_, block, e, u);
  }
  report.tets += elements.size();
  report.energy = kinetic + elastic;
  if (options_.track_energies) ledger_.take_out(kinetic, elastic);
}

void ExplicitScheme::take_over(const BodyChange& change) {
  if (change.touched.empty()) return;
  gamma_.resize(body_.vertex_count);
  for (const std::uint32_t v : change.touched) {
    gamma_[v] = options_.damping_rate * body_.masses[v] + options_.nodal_damping;
  }
  moving_->apply(change, changer_->stars(), gamma_);
  control_->mesh_changed(gamma_);
  copy_.current = false;
}

RemovalReport ExplicitScheme::remove(std::span<const std::uint32_t> tets) {
  RemovalReport report;
  const std::vector<std::uint32_t> elements = changer().living_elements(tets);
  weigh_energy(elements, report);
  const BodyChange change = changer_->remove(elements);
  take_over(change);
  for (const std::uint32_t v : change.touched) {
    if (changer_->stars().tets_at(v).empty()) report.loose_vertices.push_back(v);
  }
  return report;
}

SplitReport ExplicitScheme::split(std::span<const Triangle> faces) {
  SplitReport report{.first_new = static_cast<std::uint32_t>(body_.vertex_count), .origins = {}, .closed_faces = 0};
  BodyChange change = changer().split(faces);
  take_over(change);
  const std::vector<std::vector<std::size_t>> copied = constraints_.add_copies(change.origins);
  loads_.add_copies(change.origins);
  for (std::size_t c = 0; c < copied.size(); ++c) {
    for (const std::size_t k : copied[c]) {
      if (holds(c)) base_[c].push_back(Vec3d(base_[c][k]));
    }
  }
  std::vector<std::uint32_t> followers;
  for (std::uint32_t i = 0; i < change.origins.size(); ++i) {
    const auto is_origin = [&](const WatchedVertex& w) { return w.vertex == change.origins[i]; };
    const std::span<const WatchedVertex> watched = moving_->watched();
    if (std::any_of(watched.begin(), watched.end(), is_origin)) followers.push_back(report.first_new + i);
  }
  if (!followers.empty()) watch(followers);
  last_changed_.clear();
  for (const detail::CornerChange& c : change.corners) last_changed_.push_back(c.tet);
  report.closed_faces = changer_->closed_faces();
  report.origins = std::move(change.origins);
  return report;
}

}  // namespace glisson
