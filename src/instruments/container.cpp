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
#include "contact/contact_reach.h"
#include "contact/found_inside.h"
#include "contact/row_group.h"
#include "glisson/simulation/simulation.h"

namespace glisson {
namespace {

constexpr double kMostOut = 0.02;  ///< of the container's size: how far a body may stand out of it at the start
constexpr double kTouch = 1e-6;    ///< of the vessel's size: tissue so near to a wall that holds it touches
constexpr double kRim =
    1e-9;  ///< of the vessel's height: tissue up to so far above its rim is beside the wall, whatever rounding says
/// Of the vessel's size: tissue that moves no more than that in a step has come to rest.
constexpr double kStill = 1e-12;
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
  std::map<Place, Vec3d> last_forces;  ///< of rows in the last long step, to begin the next with [N]
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
  WorkAccount account;
  bool is_long = false;     ///< acts in long steps: bonds rest from the start, and no step lets go of what it has found
  std::set<Place> has_row;  ///< where points are looked for again in a step
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
  void bond(const std::map<std::uint32_t, Bond>& fresh);
  void list_bonds();
  void wake();
  std::span<const std::uint32_t> without_still(std::span<const std::uint32_t> vertices,
                                               std::vector<std::uint32_t>& left) const;
  void look_for_rest(const InteractionStep& step);
  void add_rows(const InteractionStep& step, RowGroup& rows, bool again);
  void declare_short(const InteractionStep& step, RowGroup& rows, int round);
  void declare_long(const InteractionStep& step, RowGroup& rows, int round);
  Place place_of(const ContactRow& row, const InteractionStep& step) const;
  void begin_row(ContactRow& row, const InteractionStep& step) const;
  void remember(const InteractionStep& step, const RowGroup& rows);
  void rest_bonds();
  void bear_rest(const InteractionStep& step);
  void add_holds(const InteractionStep& step, RowGroup& rows) const;
  void bear_bonds(const InteractionStep& step, const RowGroup& rows);
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
  s.still = true;
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

/// Takes in what has touched. What bonds exert stays as it is.
void Container::State::bond(const std::map<std::uint32_t, Bond>& fresh) {
  std::map<std::uint32_t, Vec3d> forces;
  for (const Hold& hold : holds) forces[hold.vertex] = hold.force;
  for (const auto& [vertex, place] : fresh) bonds[vertex] = place;
  list_bonds();
  for (Hold& hold : holds) {
    if (const auto known = forces.find(hold.vertex); known != forces.end()) hold.force = known->second;
  }
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

/// @param again  points that have a row are left out
void Container::State::add_rows(const InteractionStep& step, RowGroup& rows, bool again) {
  for (const std::uint32_t v : reach.vertices()) {
    if (bonded[v] != 0) continue;
    const std::uint32_t place = step.place_of[v];
    const Vec3d x = step.position(place), way = step.vertices[place].velocity * step.h;
    if (!holds_at(x)) continue;
    for (std::uint32_t k = 0; k < solids.size(); ++k) {
      const Vec3d start = solids[k].before.to_own(x);
      if (distance_to(shapes[k], start).distance > norm(way) + solids[k].grip) continue;
      if (again && has_row.count({v, k}) != 0) continue;
      ContactRow row;
      row.places[0] = place, row.solid = &solids[k];
      found_inside.mark(row, v, k, start, begun);
      if (prepare(row, step)) rows.points.push_back(row);
      found_inside.settle(row, v, k);
    }
  }
  begun = true;
}

Container::State::Place Container::State::place_of(const ContactRow& row, const InteractionStep& step) const {
  return {step.vertices[row.places[0]].vertex, static_cast<std::uint32_t>(row.solid - solids.data())};
}

void Container::State::declare_short(const InteractionStep& step, RowGroup& rows, int round) {
  if (round > 0 && !rows.others_act) return;
  if (round > 0) {
    has_row.clear();
    for (const ContactRow& row : rows.points) has_row.insert(place_of(row, step));
  } else {
    rows.account = &account;
    add_holds(step, rows);
  }
  add_rows(step, rows, round > 0);
}

/// Points move one another, so that those that come outside by it are looked for until there are none.
void Container::State::declare_long(const InteractionStep& step, RowGroup& rows, int round) {
  if (round == 0) has_row.clear();
  const std::size_t known = rows.points.size();
  add_rows(step, rows, true);
  for (ContactRow& row : std::span(rows.points).subspan(known)) {
    has_row.insert(place_of(row, step));
    begin_row(row, step);
  }
}

/// Begins with what the row had in the last iteration, or with the force of the last step.
void Container::State::begin_row(ContactRow& row, const InteractionStep& step) const {
  const Place place = place_of(row, step);
  if (!trial.empty()) {
    if (const auto at = trial.find(place); at != trial.end())
      row.pressing = at->second.first, row.rubbing = at->second.second;
  } else if (const auto at = last_forces.find(place); at != last_forces.end()) {
    row.take(at->second * step.h);
  }
}

/// Keeps what the rows of an iteration had for the next, and for the next step.
void Container::State::remember(const InteractionStep& step, const RowGroup& rows) {
  trial.clear(), last_forces.clear();
  for (const ContactRow& row : rows.points) {
    trial[place_of(row, step)] = {row.pressing, row.rubbing};
    if (row.pressing != 0.0) last_forces[place_of(row, step)] = row.impulse() * (1.0 / step.h);
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

/// Bonds that do not rest are stopped by impulses.
void Container::State::add_holds(const InteractionStep& step, RowGroup& rows) const {
  for (const Hold& hold : holds) {
    const std::uint32_t place = step.place_of[hold.vertex];
    if (place == InteractionStep::kNowhere) continue;
    rows.holds.push_back(
        {.place = place, .velocity = (hold.there - step.position(place)) * (1.0 / step.h), .tool = ToolVelocity{}});
  }
}

/// A bond at rest bears what its tissue exerts, others what stops them.
void Container::State::bear_bonds(const InteractionStep& step, const RowGroup& rows) {
  if (is_long) {  // they rest, but for those that have come to be in this step, which have rows
    for (Hold& hold : holds) hold.force = {};
    return;
  }
  auto resting = step.resting.begin();
  auto held_row = rows.holds.begin();
  for (Hold& hold : holds) {
    const std::uint32_t place = step.place_of[hold.vertex];
    hold.force = {};
    if (place != InteractionStep::kNowhere) {
      hold.force = (held_row++)->impulse * (1.0 / step.h);
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

void Container::declare(const InteractionStep& step, StepRows& rows, int round) {
  State& s = *state_;
  s.is_long ? s.declare_long(step, rows.group(), round) : s.declare_short(step, rows.group(), round);
}

void Container::solved(const InteractionStep& step, const StepRows& found) {
  State& s = *state_;
  const RowGroup& rows = found.group();
  s.loads = {}, s.bearing.clear();
  if (s.is_long) s.remember(step, rows);
  std::map<std::uint32_t, ContainerKept::Bond> fresh;
  for (const ContactRow& row : rows.points) {
    if (row.impulse() == Vec3d{}) continue;
    const std::uint32_t vertex = step.vertices[row.places[0]].vertex;
    const Vec3d force = row.impulse() * (1.0 / step.h);
    s.bearing.push_back({vertex, force, dot(force, row.normal)});
    s.load(*row.solid, row.normal, force);
    const auto solid = static_cast<std::uint32_t>(row.solid - s.solids.data());
    if (s.options.bonded) fresh[vertex] = {solid, end_of(row, step)};
  }
  s.bear_bonds(step, rows);
  if (!fresh.empty()) s.bond(fresh);
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
  ar(s.begun, s.account, s.bonds, s.found_inside, s.reach, s.still_changed, s.last_forces);
  ar.same_size(s.still);
  for (const auto& [v, bond] : s.bonds) ar.check(v < s.reach.surface().body_vertices() && bond.solid < s.solids.size());
  if (ar.reads()) s.list_bonds();
}

std::shared_ptr<const void> Container::save_state() const {
  const State& s = *state_;
  std::vector<Vec3d> forces;
  for (const State::Hold& hold : s.holds) forces.push_back(hold.force);
  return std::make_shared<const SavedContainer>(
      SavedContainer{s, std::move(forces), s.reach.seen(), s.account.taken()});
}

void Container::load_state(const std::shared_ptr<const void>& state, const BodyView* other_body) {
  const SavedContainer& saved = *std::static_pointer_cast<const SavedContainer>(state);
  State& s = *state_;
  static_cast<ContainerKept&>(s) = saved.kept;
  if (other_body != nullptr) s.reach.set_body(*other_body);
  s.reach.set_seen(saved.seen);
  s.account.set_taken(saved.taken);
  s.list_bonds();
  for (std::size_t k = 0; k < s.holds.size(); ++k) s.holds[k].force = saved.hold_forces[k];
}

}  // namespace glisson
