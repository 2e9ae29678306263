#include "dynamics/schemes/explicit_scheme.h"

#include <algorithm>
#include <cmath>

#include "dynamics/make_body.h"
#include "element/tet_fields.h"

namespace glisson {
namespace {

void add(KickPower& sum, const KickPower& p) {
  sum.elastic += p.elastic, sum.viscous += p.viscous, sum.damping += p.damping;
  sum.tools += p.tools, sum.loads += p.loads;
}

}  // namespace

ExplicitScheme::ExplicitScheme(Body body, const SimulationOptions& options, Drag drag)
    : Scheme(std::move(body), options), moving_(make_moving_body(body_, gamma_, options, info_)),
      stiffening_(moving_->advance(0.0, {}, false).stiffening),
      control_(std::make_unique<StepControl>(body_, gamma_, drag, options, stiffening_)) {
  moving_->list_above(control_->list_above());
  if (!options.mesh_changes) return;
  moving_->apply({}, changer().stars(), gamma_);
  control_->prepare_changes(changer().stars());
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

void ExplicitScheme::watch(std::span<const std::uint32_t> vertices) {
  std::vector<Kicked> of_vertex(body_.vertex_count);
  for (std::size_t k = 0; k < kicked_.size(); ++k) of_vertex[moving_->watched()[k].vertex] = kicked_[k];
  moving_->watch(vertices);
  kicked_.clear();
  for (const WatchedVertex& w : moving_->watched()) kicked_.push_back(of_vertex[w.vertex]);
  find_places();
  interactions_.find_places(moving_->watched(), body_.vertex_count);
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

void ExplicitScheme::take_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  moving_->set_state(displacement, velocity);
  control_->state_set();
  moving_->list_above(control_->list_above());
  take_stiffness(moving_->advance(0.0, {}, false));
  copy_.current = false;
  if (!options_.track_energies) return;
  double kinetic = 0.0;
  for (std::size_t i = 0; i < velocity.size(); ++i) kinetic += 0.5 * body_.masses[i] * dot(velocity[i], velocity[i]);
  ledger_.reset(kinetic, secant_energy(body_, displacement));
}

/// v₊ = (m v₋ + h F)/(m + γh) of the watched vertices as if they were free [Schwartz2002, eq. 3 and 4]; massless ones
/// (in no tet) stay.
void ExplicitScheme::kick_watched(double h) {
  const std::span<WatchedVertex> watched = moving_->watched();
  const std::span<const Vec3d> loads = loads_.at(time_);
  for (std::size_t k = 0; k < watched.size(); ++k) {
    WatchedVertex& w = watched[k];
    const double m = body_.masses[w.vertex], gamma = gamma_[w.vertex];
    const Vec3d load = m > 0.0 ? loads[w.vertex] : Vec3d{};
    kicked_[k] = {m, gamma, w.velocity, load, {}};
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

/// Brings the vertices that interactions may act on in this step to hand, before the body moves the others.
void ExplicitScheme::begin_interactions(double h) {
  if (interactions_.empty()) return;
  const std::span<const std::uint32_t> newcomers = interactions_.newcomers(time_, h, body_.vertex_count);
  if (!newcomers.empty()) watch(newcomers);
}

/// Lets interactions correct v₊, and keeps what they exerted.
void ExplicitScheme::constrain_interactions(double h) {
  if (interactions_.empty()) return;
  mobility_.clear();
  for (const Kicked& k : kicked_) {
    const double a = k.mass > 0.0 ? 1.0 / (k.mass + k.damping * h) : 0.0;
    mobility_.push_back({a, a, a});
  }
  for (std::size_t c = 0; c < places_.size(); ++c) {
    if (!holds(c)) continue;
    for (const std::uint32_t place : places_[c]) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (has_axis(constraints_.all()[c].axes, axis)) mobility_[place][axis] = 0.0;
      }
    }
  }
  interactions_.constrain(mobility_);
  for (std::size_t k = 0; k < kicked_.size(); ++k) kicked_[k].contact = interactions_.impulses()[k] * (1.0 / h);
}

void ExplicitScheme::attach(std::shared_ptr<Interaction> interaction, const BodyView& body) {
  interaction->attached(body, time_);
  interactions_.add(std::move(interaction));
  interactions_.find_places(moving_->watched(), body_.vertex_count);
  control_->set_beside(interactions_.squared_frequency());
}

void ExplicitScheme::tell_change(const BodyView& body, std::span<const std::uint32_t> origins) {
  if (interactions_.empty()) return;
  interactions_.find_places(moving_->watched(), body_.vertex_count);
  interactions_.body_changed(body, origins);
  control_->set_beside(interactions_.squared_frequency());
}

/// What holds or drives a vertex, in the components it holds, at the last kick.
ForceParts ExplicitScheme::watched_force(std::size_t place, const Axes& axes) const {
  const WatchedVertex& w = moving_->watched()[place];
  const Kicked& k = kicked_[place];
  const Vec3d inertial = kick_step_ > 0.0 ? (w.velocity - k.velocity_before) * (k.mass / kick_step_) : Vec3d{};
  return {masked(-w.elastic, axes), masked(-w.viscous, axes),         masked(w.velocity * k.damping, axes),
          masked(inertial, axes),   masked(gravity_ * -k.mass, axes), masked(-k.load - k.contact, axes)};
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
                       .tools = dot(at.contact, v),
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

void ExplicitScheme::take_stiffness(const Advance& seen) {
  stiffening_ = seen.stiffening;
  stiff_ = seen.stiff;
}

/// How fast tets change shape whose changes count.
std::span<const ShapeRate> ExplicitScheme::shape_rates() {
  shape_rates_.clear();
  for (const StiffElement& stiff : stiff_) {
    if (!control_->is_violent(stiff)) continue;
    const Tet& t = body_.elements[stiff.element];
    const Vec3d origin = moving_->velocity_of(t[0]);
    std::array<Vec3d, 3> difference;
    for (std::size_t a = 0; a < 3; ++a) difference[a] = moving_->velocity_of(t[a + 1]) - origin;
    const double squared = squared_norm(displacement_gradient(body_.rest[stiff.element].s, difference));
    shape_rates_.push_back({stiff, std::sqrt(squared)});
  }
  return shape_rates_;
}

void ExplicitScheme::kick(double h) {
  kick_watched(h);
  impose_motions(h);
}

StepResult ExplicitScheme::step() {
  if (!control_->accept(stiffening_, stiff_)) {
    message_ = "tissue or tools have stiffened, and " + control_->too_large();
    return {StepStatus::step_too_large, {}, message_};
  }
  control_->limit_shape_change(shape_rates());
  moving_->list_above(control_->list_above());
  const double h = control_->step();
  if (!(time_ + h > time_)) {
    return {StepStatus::step_too_large,
            {},
            "the tissue has become so stiff that a stable step does not advance time; press "
            "less deep, soften the law, or take the implicit integrator"};
  }
  gravity_ = gravity_at(time_);
  take_hold(h);
  begin_interactions(h);
  const Advance& seen = moving_->advance(h, gravity_, options_.track_energies);
  take_stiffness(seen);
  copy_.current = false;
  if (!seen.finite) {
    message_ = not_finite_at(time_);
    return {StepStatus::not_finite, seen.inverted, message_};
  }

  kick_step_ = h;
  kick_time_ = time_;
  interactions_.begin(time_, h, moving_->watched(), body_.rest_positions);
  interactions_.add_forces();
  kick(h);
  constrain_interactions(h);
  if (options_.track_energies) book(h, seen.work);
  for (WatchedVertex& w : moving_->watched()) w.displacement += w.velocity * h;
  moving_->place_watched();
  time_ += h;
  ++steps_;
  if (!interactions_.empty()) {
    interactions_.moved();
    control_->follow_beside(interactions_.squared_frequency());
  }
  return {seen.inverted.empty() ? StepStatus::ok : StepStatus::inverted, seen.inverted, {}};
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

void ExplicitScheme::save(CheckpointWriter& out) const {
  Scheme::save(out);
  std::vector<std::uint32_t> watched;
  for (const WatchedVertex& w : moving_->watched()) watched.push_back(w.vertex);
  out.put(watched);
  out.put(read_state().displacement), out.put(read_state().velocity), out.put(moving_->past());
  for (const WatchedVertex& w : moving_->watched()) out.put(w.elastic), out.put(w.viscous);
  for (const Kicked& k : kicked_) out.put_doubles(k);
  out.put(kick_step_), out.put(kick_time_), out.put(gravity_), out.put(stiffening_);
  out.put(static_cast<std::uint64_t>(stiff_.size()));
  for (const StiffElement& s : stiff_) out.put(s.element), out.put(s.ratio), out.put(s.norm);
  out.put_doubles(ledger_);
  control_->save(out);
  interactions_.save(out);
}

void ExplicitScheme::load_stiff(CheckpointReader& in) {
  const auto n = in.get<std::uint64_t>();
  if (n > body_.elements.size()) CheckpointReader::fail();
  stiff_.assign(n, {});
  for (StiffElement& s : stiff_) {
    in.get(s.element), in.get(s.ratio), in.get(s.norm);
    if (s.element >= body_.elements.size()) CheckpointReader::fail();
  }
}

void ExplicitScheme::load(CheckpointReader& in) {
  Scheme::load(in);
  std::vector<std::uint32_t> watched;
  in.get(watched);
  for (const std::uint32_t w : watched) {
    if (w >= body_.vertex_count) CheckpointReader::fail();
  }
  watch(watched);
  if (moving_->watched().size() != watched.size()) CheckpointReader::fail();
  std::vector<Vec3d> u(body_.vertex_count), v(body_.vertex_count);
  std::vector<double> past;
  in.get_same_size(u), in.get_same_size(v), in.get(past);
  moving_->set_state(u, v);
  if (!moving_->set_past(past)) CheckpointReader::fail();
  for (WatchedVertex& w : moving_->watched()) in.get(w.elastic), in.get(w.viscous);
  for (Kicked& k : kicked_) in.get_doubles(k);
  in.get(kick_step_), in.get(kick_time_), in.get(gravity_), in.get_same_size(stiffening_);
  load_stiff(in);
  in.get_doubles(ledger_);
  control_->load(in);
  moving_->list_above(control_->list_above());
  interactions_.load(in);
  control_->set_beside(interactions_.squared_frequency());
  copy_.current = false;
}

void ExplicitScheme::take_over(const BodyChange& change) {
  moving_->apply(change, changer_->stars(), gamma_);
  control_->mesh_changed(gamma_, change, changer_->stars());
  copy_.current = false;
}

/// The same state in a body of another kind, for tissues that the present kind does not have.
void ExplicitScheme::build_anew(const TissueChange& change) {
  std::vector<std::pair<std::size_t, std::vector<Sym3<double>>>> kept;
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    const bool changes = std::find(change.blocks.begin(), change.blocks.end(), b) != change.blocks.end();
    if (!changes && !body_.blocks[b].tissue.maxwell.empty()) kept.emplace_back(b, moving_->branch_stresses(b));
  }
  const StateCopy state = read_state();
  std::vector<std::uint32_t> watched;
  for (const WatchedVertex& w : moving_->watched()) watched.push_back(w.vertex);
  moving_ = make_moving_body(body_, gamma_, options_, info_);
  moving_->set_state(state.displacement, state.velocity);
  moving_->watch(watched);
  for (const auto& [b, stresses] : kept) moving_->set_branch_stresses(b, stresses);
}

/// Brings other tissues into the body; what is told of the last kick stays.
void ExplicitScheme::follow_tissues(const TissueChange& change) {
  const std::vector<WatchedVertex> told(moving_->watched().begin(), moving_->watched().end());
  if (moving_->bears_tissues()) {
    moving_->tissues_changed(change.blocks, gamma_);
    info_ = info_of(*moving_, body_);
  } else {
    build_anew(change);
  }
  for (std::size_t i = 0; i < change.blocks.size(); ++i) {
    moving_->set_branch_stresses(change.blocks[i], change.branch_stresses[i]);
  }
  if (!change.past.empty()) moving_->set_past(change.past);
  moving_->list_above(control_->list_above());
  take_stiffness(moving_->advance(0.0, {}, false));
  std::copy(told.begin(), told.end(), moving_->watched().begin());
  copy_.current = false;
}

void ExplicitScheme::take_tissues(const TissueChange& change) {
  follow_tissues(change);
  const std::span<const Vec3d> u = displacement();
  const bool undeformed = std::all_of(u.begin(), u.end(), [](const Vec3d& d) { return d == Vec3d{}; });
  control_->tissues_changed(stiffening_, undeformed);
  stiff_.clear();  // the level of the blocks is above all of them now
  moving_->list_above(control_->list_above());
}

void ExplicitScheme::follow(std::span<const std::uint32_t> origins, std::uint32_t first_new) {
  std::vector<std::uint32_t> followers;
  for (std::uint32_t i = 0; i < origins.size(); ++i) {
    const auto is_origin = [&](const WatchedVertex& w) { return w.vertex == origins[i]; };
    const std::span<const WatchedVertex> watched = moving_->watched();
    if (std::any_of(watched.begin(), watched.end(), is_origin)) followers.push_back(first_new + i);
  }
  if (!followers.empty()) watch(followers);
}

}  // namespace glisson
