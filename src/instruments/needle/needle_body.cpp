// needle_body.cpp — what a needle knows of the body: its surface, where points lie, which vertices it may act on.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "base/sort_out.h"
#include "glisson/simulation/simulation.h"
#include "instruments/needle/needle_state.h"

namespace glisson {
namespace {

/// The mesh without what was removed, for its surface.
TetMesh living(const BodyView& body) {
  TetMesh mesh;
  mesh.vertices = body.mesh.vertices;
  for (std::size_t t = 0; t < body.mesh.tets.size(); ++t) {
    if (!body.is_removed(t)) mesh.tets.push_back(body.mesh.tets[t]);
  }
  return mesh;
}

constexpr double kAtSurface = 1e-6;  ///< how far in a tip may start [m]
constexpr double kLeastAside = 0.5;  ///< of the zone: so far sideways a surface is taken to have gone at least

double longest_edge(const TetMesh& mesh, const Triangle& t) {
  const auto edge = [&](std::size_t a, std::size_t b) { return norm(mesh.vertices[t[a]] - mesh.vertices[t[b]]); };
  return std::max({edge(0, 1), edge(1, 2), edge(2, 0)});
}

}  // namespace

double Needle::State::bending_stiffness() const {
  if (!options.youngs_modulus) return 0.0;
  const double outer = options.diameter, inner = options.inner_diameter;
  return *options.youngs_modulus * std::numbers::pi / 64.0 * (std::pow(outer, 4) - std::pow(inner, 4));
}

TipResistance Needle::State::resistance(int region_number) const {
  const auto found = options.regions.find(region_number);
  return found != options.regions.end() ? found->second : TipResistance{options.tip.cutting, 0.0};
}

double Needle::State::tip_limit() const {
  if (stage != NeedleStage::inside) return std::numeric_limits<double>::infinity();
  if (at_membrane) return std::max(membranes[broken].puncture, cutting());
  return next_region ? std::max(resistance(*next_region).puncture, cutting()) : cutting();
}

double Needle::State::cutting() const { return cutting_beyond.value_or(resistance(region).cutting); }

bool Needle::State::place(shaft::Row& row, const Vec3d& rest) const {
  std::vector<VertexWeight> weights = zones->weights(rest);
  if (weights.empty()) return false;
  row.rest = rest;
  row.weights = std::move(weights);
  return true;
}

void Needle::State::forget_forces(double h) {
  std::fill(along.begin(), along.end(), 0.0);
  tip_along = 0.0;
  tip_cuts = false;
  bending = 0.0;
  step_h = h;
}

/// The needle comes from outside: between the hand and the tip there is no tissue yet.
void Needle::attached(const BodyView& body, double) {
  set_bounds(body);
  state_->zone_axes = zone_axes(body.mesh, direction());
  body_changed(body, {});
  const Vec3d& tip = pose_.position;
  const double length = state_->options.length;
  double first = length;
  for (const Triangle& t : state_->surface) {
    std::array<Vec3d, 3> present;
    for (std::size_t a = 0; a < 3; ++a) present[a] = body.mesh.vertices[t[a]] + body.displacement[t[a]];
    const auto hit = meet(tip - direction() * length, direction(), present, present);
    if (hit && hit->way >= 0.0) first = std::min(first, hit->way);
  }
  if (length - first <= kAtSurface) return;
  std::ostringstream text;
  text << "needle " << name() << ": its tip, at (" << tip.x << ", " << tip.y << ", " << tip.z << ") m, starts "
       << 1e3 * (length - first) << " mm behind the surface; let it start outside, and the motion take it in";
  throw std::invalid_argument(text.str());
}

/// What follows from the body alone.
void Needle::State::look_at(const BodyView& body) {
  mesh = &body.mesh;
  zones = std::make_unique<TissueZones>(body.mesh, body.removed, options.zone, zone_axes);
  surface = body.removed.empty() ? boundary_triangles(body.mesh) : boundary_triangles(living(body));
  surface_edges.clear();
  for (const Triangle& t : surface) surface_edges.push_back(longest_edge(body.mesh, t));
  mobility.forget();
}

void Needle::body_changed(const BodyView& body, std::span<const std::uint32_t>) {
  State& s = *state_;
  s.look_at(body);
  s.look = true;
  s.near_triangles.clear(), s.entry_vertices.clear();  // numbers of the surface that was
  for (shaft::Row& node : s.nodes) {
    if (!s.place(node, Vec3d(node.rest))) node.weights.clear();  // the tissue there is gone: the node no longer acts
  }
  s.cross_anew(body, pose_.position, direction());
  if (s.has_tip_row() && !s.place(s.tip, Vec3d(s.tip.rest))) s.tip.weights.clear();
}

/// Of a tip in air: the surface around the needle's line. In tissue: that around it. And the tissue that the path acts on.
std::span<const std::uint32_t> Needle::reach(double, double) {
  begin_step();
  State& s = *state_;
  s.breaks.clear(), s.stuck.clear(), s.ways.clear();
  const bool in_air = s.tip_is_in_air();
  const Vec3d around = in_air ? pose_.position : s.tip.rest;
  const double moved = in_air ? norm(across(around - s.named_around, direction())) : norm(around - s.named_around);
  s.wanted.clear();
  if (!s.look && moved < s.options.zone) return s.wanted;
  s.look = false;
  s.named_around = around;
  in_air ? s.name_surface(direction()) : s.name_around_tip();
  if (s.stage != NeedleStage::outside) s.name_path();
  return s.wanted;
}

void Needle::State::name_around_tip() {
  const double ahead = 2.0 * options.zone + 2.0 * options.spacing;
  for (std::uint32_t v = 0; v < mesh->vertices.size(); ++v) {
    if (squared(mesh->vertices[v] - named_around) < ahead * ahead) wanted.push_back(v);
  }
  near_triangles.clear();
  for (std::size_t t = 0; t < surface.size(); ++t) {
    const double most = ahead + surface_edges[t];
    if (squared(mesh->vertices[surface[t][0]] - named_around) < most * most) near_triangles.push_back(t);
  }
  entry_vertices.clear();
}

void Needle::State::name_path() {
  for (const VertexWeight& w : tip.weights) wanted.push_back(w.vertex);
  for (const shaft::Row& node : nodes) {
    for (const VertexWeight& w : node.weights) wanted.push_back(w.vertex);
  }
}

/// Of the surface at rest, what the line may meet: it moves by a zone before it is looked at anew, and tissue beside the
/// vertices that are watched may have gone aside twice as far as they. What is nearest is watched at any distance: a body may
/// be carried under the needle.
void Needle::State::name_surface(const Vec3d& direction) {
  const auto squared_distance = [&](const Triangle& t) {
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t v : t) {
      least = std::min(least, squared(across(mesh->vertices[v] - named_around, direction)));
    }
    return least;
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : surface) nearest = std::min(nearest, squared_distance(t));
  aside_named = std::max(kLeastAside * options.zone, 2.0 * aside);
  const double around = std::max(options.zone + 2.0 * aside_named, std::sqrt(nearest));
  near_triangles.clear();
  for (std::size_t t = 0; t < surface.size(); ++t) {
    const double most = around + surface_edges[t];
    if (squared_distance(surface[t]) <= most * most) near_triangles.push_back(t);
  }
  take_entry_vertices();
  wanted = entry_vertices;
}

void Needle::State::take_entry_vertices() {
  entry_vertices.clear();
  for (const std::size_t t : near_triangles) {
    entry_vertices.insert(entry_vertices.end(), surface[t].begin(), surface[t].end());
  }
  detail::sort_out(entry_vertices);
}

/// Each list is complete: what path and tip have left is not in it.
std::optional<std::span<const std::uint32_t>> Needle::keeps() {
  if (state_->wanted.empty()) return {};
  return state_->wanted;
}

/// The tissue that the tip meets may change at any time, and with it how fast it takes up a motion.
void Needle::between_steps(Simulation& simulation) {
  State& s = *state_;
  if (s.stage == NeedleStage::outside) return;
  const Tissue& tissue = simulation.tissue(s.region);
  s.wave_time = s.options.zone * std::sqrt(tissue.density / tissue.lame().mu);
}

void Needle::archive(Archive& ar) {
  State& s = *state_;
  archive_motion(ar);
  const Vec3d tip_was = s.tip.rest;
  ar(s.stage, s.look, s.named_around, s.aside, s.aside_named, s.tip.rest, s.tip_along, s.bend_tip, s.tip_cuts,
     s.tip_out, s.withdraws);
  ar(s.region, s.next_region, s.step_h, s.wave_time, s.pressing, s.drop);
  ar(s.broken, s.at_membrane, s.cutting_beyond, s.bending);
  ar.check(s.broken + (s.at_membrane ? 1 : 0) <= s.membranes.size());
  std::vector<Vec3d> path;
  for (const shaft::Row& node : s.nodes) path.push_back(node.rest);
  ar(path, s.slips, s.along, s.bend, s.tracks, s.entered);
  ar.all_below(s.near_triangles, s.surface.size());
  if (!ar.reads()) return;
  ar.check(s.tracks_fit(path.size()));
  s.take_entry_vertices();
  const std::vector<int>& regions = s.mesh->regions;
  const bool known =
      regions.empty() ? s.region == 0 : std::find(regions.begin(), regions.end(), s.region) != regions.end();
  ar.check(s.stage == NeedleStage::outside || (known && (s.wave_time > 0.0 || forces_at_end())));
  ar.check(s.slips.size() == path.size() && s.along.size() == path.size() && s.bend.size() <= path.size());
  s.mobility.forget();
  s.nodes.resize(path.size());
  for (std::size_t j = 0; j < path.size(); ++j) {  // weights follow from the place: those known stay
    if (s.nodes[j].rest == path[j] && !s.nodes[j].weights.empty()) continue;
    s.nodes[j] = {};
    if (!s.place(s.nodes[j], path[j])) s.nodes[j].rest = path[j];
  }
  const bool known_tip = s.tip.rest == tip_was && !s.tip.weights.empty();
  if (s.has_tip_row() && !known_tip) s.place(s.tip, Vec3d(s.tip.rest));
}

namespace {

struct SavedNeedle {
  std::shared_ptr<const void> motion;
  NeedleKept kept;
};

}  // namespace

std::shared_ptr<const void> Needle::save_state() const {
  return std::make_shared<const SavedNeedle>(SavedNeedle{save_motion(), *state_});
}

void Needle::load_state(const std::shared_ptr<const void>& state, const BodyView* other_body) {
  const SavedNeedle& saved = *std::static_pointer_cast<const SavedNeedle>(state);
  State& s = *state_;
  load_motion(*std::static_pointer_cast<const SavedMotion>(saved.motion));
  if (other_body != nullptr) s.look_at(*other_body);
  static_cast<NeedleKept&>(s) = saved.kept;
  s.take_entry_vertices();
  s.mobility.forget();
}

}  // namespace glisson
