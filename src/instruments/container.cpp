// container.cpp — the floor and the wall as solids that stand still, and what presses on each.
#include "glisson/instruments/container.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

#include "base/require_fields.h"
#include "base/two_across.h"
#include "glisson/simulation/simulation.h"
#include "instruments/contact/contact_books.h"
#include "instruments/contact/contact_reach.h"

namespace glisson {
namespace {

constexpr double kMostOut = 0.02;  ///< of the container's size: how far a body may stand out of it at the start
constexpr double kTouch = 1e-6;    ///< of the vessel's size: tissue so near to a wall that holds it touches
constexpr double kRim =
    1e-9;  ///< of the vessel's height: tissue up to so far above its rim is beside the wall, whatever rounding says
/// Of the vessel's size: tissue that moves no more than that in a step has come to rest.
constexpr double kStill = 1e-12;
constexpr int kMostLooks = 12;  ///< for points that come outside in a long step
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A plate whose outward normal is n, through a point; all in the frame of the vessel.
Pose plate(const Pose& vessel, const Vec3d& point, const Vec3d& n) {
  const auto [x, y] = two_across(-n);
  const Vec3d columns[] = {vessel.axes * x, vessel.axes * y, vessel.axes * -n};
  Pose pose{vessel.to_space(point), {}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) pose.axes(i, j) = columns[j][i];
  }
  return pose;
}

}  // namespace

/// What a container keeps from step to step, beside what its reach has seen.
struct ContainerKept {
  /// A vertex that is bonded, by which part of the vessel, and where in its frame.
  struct Bond {
    std::uint32_t solid = 0;
    Vec3d place;
    void archive(Archive& ar) { ar(solid, place); }
  };
  using Place = std::pair<std::uint32_t, std::uint32_t>;  ///< vertex and solid

  FoundInside found_inside;
  bool begun = false;
  std::map<Place, double> last_pressing;  ///< forces of the last long step, to begin the next with [N]
  std::map<std::uint32_t, Bond> bonds;
  std::vector<char> still;  ///< per vertex of the body: a bond at rest
  bool still_changed = false;
  ContainerLoads loads;
  struct Bearing {
    std::uint32_t vertex;
    Vec3d force;
    double normal;
  };
  std::vector<Bearing> bearing;  ///< of what is not bonded, in the last step [N]
};

struct SavedContainer {
  ContainerKept kept;
  std::vector<Vec3d> hold_forces;  ///< of all bonds, by vertex [N]
  ContactReach::Seen seen;
  double taken = 0.0;
};

struct Container::State : ContainerKept {
  ContainerOptions options;
  std::vector<Shape> shapes;
  std::vector<ContactSolid> solids;  ///< the floor first
  double height = kInfinite, size = 0.0;
  ContactReach reach;
  ContactBooks books;
  bool is_long = false;  ///< acts in long steps: bonds rest from the start, and no step lets go of what it has found
  std::vector<ContactRow> rows;
  std::set<Place> has_row;                          ///< in a long step
  std::map<Place, std::pair<double, Vec3d>> trial;  ///< of a long step: impulses of the last iteration [N s]
  /// What a step needs of a bond. The vessel stands still.
  struct Hold {
    std::uint32_t vertex = 0;
    const ContactSolid* solid = nullptr;
    Vec3d there, normal;  ///< in space
    Vec3d force;          ///< on the tissue, of the last step [N]
  };
  std::vector<Hold> holds;   ///< of all bonds, by vertex
  std::vector<char> bonded;  ///< per vertex of the body
  std::vector<std::uint32_t> asked, kept, rests;

  void build();
  void add_solid(const Shape& shape, const Pose& pose);
  bool holds_at(const Vec3d& x) const { return options.pose.to_own(x).z <= height * (1.0 + kRim); }
  void require_inside(const BodyView& body) const;
  void bond_first(const BodyView& body);
  void list_bonds();
  void wake();
  std::span<const std::uint32_t> without_still(std::span<const std::uint32_t> vertices,
                                               std::vector<std::uint32_t>& left) const;
  void look_for_rest(const InteractionStep& step);
  void add_rows(const InteractionStep& step);
  Place place_of(const ContactRow& row, const InteractionStep& step) const;
  void begin_row(ContactRow& row, const InteractionStep& step) const;
  void solve_long(const InteractionStep& step);
  void rest_bonds();
  void bear_rest(const InteractionStep& step);
  void hold_bonds(const InteractionStep& step);
  void load(const ContactSolid& solid, const Vec3d& normal, const Vec3d& force);
};

void Container::State::add_solid(const Shape& shape, const Pose& pose) {
  shapes.push_back(shape);
  ContactSolid s;
  s.traits = traits_of(shape);
  s.before = s.after = s.earlier = pose;
  s.friction = options.bonded ? kInfinite : options.friction;
  s.push_out_speed = options.push_out_speed;
  s.holds = solids.empty() ? options.holds_floor : options.holds_wall;
  s.grip = kTouch * size;
  solids.push_back(s);
}

void Container::State::build() {
  const Pose& at = options.pose;
  if (const auto* c = std::get_if<CylinderVessel>(&options.vessel)) {
    size = c->radius, height = c->height;
    add_solid(Plate{}, plate(at, {}, {0.0, 0.0, 1.0}));
    add_solid(CylinderWall{c->radius}, at);
  } else {
    const BoxVessel& b = std::get<BoxVessel>(options.vessel);
    size = std::min(b.width, b.length), height = b.height;
    add_solid(Plate{}, plate(at, {}, {0.0, 0.0, 1.0}));
    for (const double side : {-1.0, 1.0}) {
      add_solid(Plate{}, plate(at, {0.5 * side * b.width, 0.0, 0.0}, {-side, 0.0, 0.0}));
      add_solid(Plate{}, plate(at, {0.0, 0.5 * side * b.length, 0.0}, {0.0, -side, 0.0}));
    }
  }
  for (std::size_t i = 0; i < solids.size(); ++i) solids[i].shape = &shapes[i];
}

/// A body that is poured in fits: what stands out by more than meshes are rough is a mistake of sizes or places.
void Container::State::require_inside(const BodyView& body) const {
  double most = kMostOut * size;
  Vec3d where;
  bool out = false;
  for (const std::uint32_t v : reach.surface().vertices()) {
    const Vec3d x = body.mesh.vertices[v] + body.displacement[v];
    if (!holds_at(x)) continue;
    for (std::size_t k = 0; k < solids.size(); ++k) {
      const double beyond = -distance_to(shapes[k], solids[k].after.to_own(x)).distance;
      if (beyond <= most) continue;
      most = beyond, where = x, out = true;
    }
  }
  if (!out) return;
  std::ostringstream text;
  text << "container " << options.name << ": the body stands out of it by " << 1e3 * most << " mm at (" << where.x
       << ", " << where.y << ", " << where.z << ") m; make the container larger, or move it to where the body is";
  throw std::invalid_argument(text.str());
}

/// Bonds what touches at the start; where floor and wall meet, to the floor.
void Container::State::bond_first(const BodyView& body) {
  for (const std::uint32_t v : reach.surface().vertices()) {
    const Vec3d x = body.mesh.vertices[v] + body.displacement[v];
    if (!holds_at(x)) continue;
    for (std::uint32_t k = 0; k < solids.size() && bonds.count(v) == 0; ++k) {
      const Vec3d y = solids[k].after.to_own(x);
      if (distance_to(shapes[k], y).distance <= solids[k].grip) bonds[v] = {k, y};
    }
  }
}

void Container::State::list_bonds() {
  holds.clear();
  bonded.assign(reach.surface().body_vertices(), 0);
  for (const auto& [v, bond] : bonds) {
    const ContactSolid& solid = solids[bond.solid];
    const Vec3d normal = solid.after.axes * distance_to(*solid.shape, bond.place).normal;
    holds.push_back({v, &solid, solid.after.to_space(bond.place), normal, {}});
    bonded[v] = 1;
  }
  still.resize(bonded.size(), 0);
}

/// Bonds are held by impulses until they are seen to rest.
void Container::State::wake() {
  if (is_long) return rest_bonds();
  still.assign(reach.surface().body_vertices(), 0);
  still_changed = true;
}

/// In long steps bonds are supports, from where they are on.
void Container::State::rest_bonds() {
  still.assign(reach.surface().body_vertices(), 0);
  for (const Hold& hold : holds) still[hold.vertex] = 1;
  still_changed = true;
}

std::span<const std::uint32_t> Container::State::without_still(std::span<const std::uint32_t> vertices,
                                                               std::vector<std::uint32_t>& left) const {
  left.clear();
  std::copy_if(vertices.begin(), vertices.end(), std::back_inserter(left),
               [&](std::uint32_t v) { return still[v] == 0; });
  return left;
}

/// Bonds that have not moved in this step need not be looked at again.
void Container::State::look_for_rest(const InteractionStep& step) {
  for (const Hold& hold : holds) {
    if (still[hold.vertex] != 0) continue;
    const std::uint32_t place = step.place_of[hold.vertex];
    if (place == InteractionStep::kNowhere) continue;
    if (norm(step.vertices[place].velocity) * step.h > kStill * size) continue;
    if (norm(step.position(place) - hold.there) > kTouch * size) continue;  // something else holds it off its place
    still[hold.vertex] = 1;
    still_changed = true;
  }
}

void Container::State::add_rows(const InteractionStep& step) {
  for (const std::uint32_t v : reach.vertices()) {
    if (bonded[v] != 0) continue;
    const std::uint32_t place = step.place_of[v];
    const Vec3d x = step.position(place), way = step.vertices[place].velocity * step.h;
    if (!holds_at(x)) continue;
    for (std::uint32_t k = 0; k < solids.size(); ++k) {
      const Vec3d start = solids[k].before.to_own(x);
      if (distance_to(shapes[k], start).distance > norm(way) + solids[k].grip) continue;
      if (is_long && has_row.count({v, k}) != 0) continue;
      ContactRow row;
      row.places[0] = place, row.solid = &solids[k];
      found_inside.mark(row, v, k, start, begun);
      if (prepare(row, step)) {
        rows.push_back(row);
        if (is_long) has_row.insert({v, k});
      }
      found_inside.settle(row, v, k);
    }
  }
  begun = true;
}

Container::State::Place Container::State::place_of(const ContactRow& row, const InteractionStep& step) const {
  return {step.vertices[row.places[0]].vertex, static_cast<std::uint32_t>(row.solid - solids.data())};
}

/// Begins with what the row had in the last iteration, or with the force of the last step.
void Container::State::begin_row(ContactRow& row, const InteractionStep& step) const {
  const Place place = place_of(row, step);
  if (!trial.empty()) {
    if (const auto at = trial.find(place); at != trial.end())
      row.pressing = at->second.first, row.rubbing = at->second.second;
  } else if (const auto at = last_pressing.find(place); at != last_pressing.end()) {
    row.pressing = at->second * step.h;
  }
  if (row.pressing != 0.0) push(row, step, row.impulse());
}

/// Points move one another, so that those that come outside by it are looked for until there are none.
void Container::State::solve_long(const InteractionStep& step) {
  has_row.clear();
  for (int look = 0; look < kMostLooks; ++look) {
    const std::size_t known = rows.size();
    add_rows(step);
    if (rows.size() == known) break;
    for (std::size_t k = known; k < rows.size(); ++k) begin_row(rows[k], step);
    glisson::solve(rows, step);
    step.compliance->settle(step.vertices);
  }
  trial.clear(), last_pressing.clear();
  for (const ContactRow& row : rows) {
    trial[place_of(row, step)] = {row.pressing, row.rubbing};
    if (row.pressing != 0.0) last_pressing[place_of(row, step)] = row.pressing / step.h;
  }
}

void Container::State::load(const ContactSolid& solid, const Vec3d& normal, const Vec3d& force) {
  if (&solid == solids.data()) {
    loads.bottom -= force;
  } else {
    loads.side -= force;
    loads.side_radial += dot(force, normal);
  }
}

/// In long steps: what bonds stand against at the end of the step.
void Container::State::bear_rest(const InteractionStep& step) {
  auto hold = holds.begin();
  for (const RestingVertex& rest : step.resting) {
    while (hold != holds.end() && hold->vertex < rest.vertex) ++hold;
    if (hold == holds.end() || hold->vertex != rest.vertex) continue;
    hold->force = -rest.force;
    load(*hold->solid, hold->normal, hold->force);
  }
}

/// A bond at rest bears what its tissue exerts; others are stopped by impulses.
void Container::State::hold_bonds(const InteractionStep& step) {
  if (is_long) {  // they rest, but for those that have come to be in this step, which have rows
    for (Hold& hold : holds) hold.force = {};
    return;
  }
  auto resting = step.resting.begin();
  for (Hold& hold : holds) {
    const std::uint32_t place = step.place_of[hold.vertex];
    hold.force = {};
    if (place != InteractionStep::kNowhere) {
      const Vec3d impulse = stopping(step, place, (hold.there - step.position(place)) * (1.0 / step.h));
      step.push(place, impulse);
      step.book(WorkSink::contact, place, impulse);
      hold.force = impulse * (1.0 / step.h);
    } else {
      while (resting != step.resting.end() && resting->vertex < hold.vertex) ++resting;
      if (resting == step.resting.end() || resting->vertex != hold.vertex) continue;
      hold.force = -resting->force;
    }
    load(*hold.solid, hold.normal, hold.force);
  }
}

Container::Container(const ContainerOptions& options) : state_(std::make_unique<State>()) {
  detail::require_fields("container \"" + options.name + "\"", options);
  state_->options = options;
  state_->build();
}

Container::~Container() = default;

const ContainerLoads& Container::sensor_loads() const { return state_->loads; }
const ContainerOptions& Container::options() const { return state_->options; }
Vec3d Container::up() const { return state_->options.pose.axes * Vec3d{0.0, 0.0, 1.0}; }

void Container::attached(const BodyView& body, double) {
  state_->reach.attach(body);
  state_->require_inside(body);
  if (state_->options.bonded) state_->bond_first(body);
  state_->list_bonds();
  if (state_->is_long) state_->rest_bonds();
}

void Container::set_long_steps(bool are_long) { state_->is_long = are_long; }

void Container::body_changed(const BodyView& body, std::span<const std::uint32_t> origins) {
  give_to_copies(state_->bonds, body.mesh.vertices.size(), origins);
  state_->reach.attach(body);
  state_->list_bonds();
  state_->wake();
}

void Container::state_set(std::span<const Vec3d>) { state_->wake(); }

/// All bonds that do not rest are to be active.
std::span<const std::uint32_t> Container::reach(double, double h) {
  State& s = *state_;
  s.trial.clear();
  const std::span<const std::uint32_t> asked = s.without_still(s.reach.ask(s.solids, h), s.asked);
  if (!s.still_changed) return asked;
  for (const State::Hold& hold : s.holds) {
    if (s.still[hold.vertex] == 0) s.asked.push_back(hold.vertex);
  }
  return s.asked;
}

std::optional<std::span<const std::uint32_t>> Container::keeps() {
  State& s = *state_;
  if (!s.reach.has_left() && !s.still_changed) return {};
  s.without_still(s.reach.kept(), s.kept);
  for (const State::Hold& hold : s.holds) {
    if (s.still[hold.vertex] == 0) s.kept.push_back(hold.vertex);
  }
  return s.kept;
}

std::optional<std::span<const std::uint32_t>> Container::rests() {
  State& s = *state_;
  if (!s.still_changed) return {};
  s.still_changed = false;
  s.rests.clear();
  for (const State::Hold& hold : s.holds) {
    if (s.still[hold.vertex] != 0) s.rests.push_back(hold.vertex);
  }
  return s.rests;
}

void Container::add_forces(const InteractionStep& step) { state_->books.begin(step); }

void Container::constrain(const InteractionStep& step) {
  State& s = *state_;
  s.loads = {}, s.bearing.clear();
  s.rows.clear();
  if (s.is_long) {
    s.solve_long(step);
  } else {
    s.add_rows(step);
    if (!s.rows.empty()) s.books.solve(s.rows, step);
    s.books.close(s.rows, step);
  }
  const std::size_t bonds_before = s.bonds.size();
  for (const ContactRow& row : s.rows) {
    if (row.impulse() == Vec3d{}) continue;
    const Vec3d force = row.impulse() * (1.0 / step.h);
    s.bearing.push_back({step.vertices[row.places[0]].vertex, force, dot(force, row.normal)});
    s.load(*row.solid, row.normal, force);
    step.book(WorkSink::contact, row.places[0], row.normal * row.pressing);
    step.book(WorkSink::friction, row.places[0], row.rubbing);
    const auto solid = static_cast<std::uint32_t>(row.solid - s.solids.data());
    if (s.options.bonded) s.bonds[step.vertices[row.places[0]].vertex] = {solid, end_of(row, step)};
  }
  if (s.bonds.size() > bonds_before) s.list_bonds();
  s.hold_bonds(step);
}

void Container::tell_held(const InteractionStep& step, HeldRows& held) const {
  const State& s = *state_;
  for (const ContactRow& row : s.rows) glisson::tell_held(row, step, held);
  for (const State::Hold& hold : s.holds) {
    const std::uint32_t place = step.place_of[hold.vertex];
    if (place == InteractionStep::kNowhere) continue;
    const Vec3d off = step.position(place) + step.vertices[place].velocity * step.h - hold.there;
    if (norm(off) <= kStill * s.size) held.add_vertex(hold.vertex);
  }
}

int Container::most_drag_stages() const {
  return state_->options.bonded ? kMostDragStages : kMostDragStagesBesideInstruments;
}

bool Container::add_contact(std::span<Vec3d> force, std::span<double> pressing) const {
  for (const State::Bearing& b : state_->bearing) force[b.vertex] += b.force, pressing[b.vertex] += b.normal;
  for (const State::Hold& h : state_->holds) force[h.vertex] += h.force, pressing[h.vertex] += dot(h.force, h.normal);
  return true;
}

void Container::moved(const InteractionStep& step) {
  State& s = *state_;
  s.reach.look(step);
  if (!s.is_long) return s.look_for_rest(step);
  s.bear_rest(step);
  if (std::any_of(s.holds.begin(), s.holds.end(), [&](const auto& hold) { return s.still[hold.vertex] == 0; }))
    s.rest_bonds();
}

void Container::archive(Archive& ar) {
  State& s = *state_;
  ar(s.begun, s.books, s.bonds, s.found_inside, s.reach, s.still_changed, s.last_pressing);
  ar.same_size(s.still);
  for (const auto& [v, bond] : s.bonds) ar.check(v < s.reach.surface().body_vertices() && bond.solid < s.solids.size());
  if (ar.reads()) s.list_bonds();
}

std::shared_ptr<const void> Container::save_state() const {
  const State& s = *state_;
  std::vector<Vec3d> forces;
  for (const State::Hold& hold : s.holds) forces.push_back(hold.force);
  return std::make_shared<const SavedContainer>(SavedContainer{s, std::move(forces), s.reach.seen(), s.books.taken()});
}

void Container::load_state(const std::shared_ptr<const void>& state, const BodyView* other_body) {
  const SavedContainer& saved = *std::static_pointer_cast<const SavedContainer>(state);
  State& s = *state_;
  static_cast<ContainerKept&>(s) = saved.kept;
  if (other_body != nullptr) s.reach.set_body(*other_body);
  s.reach.set_seen(saved.seen);
  s.books.set_taken(saved.taken);
  s.list_bonds();
  for (std::size_t k = 0; k < s.holds.size(); ++k) s.holds[k].force = saved.hold_forces[k];
}

}  // namespace glisson
