// needle_path.cpp — what a needle does with its path: it meets, begins, ends and leaves stretches of tissue, and finds what is left of them.
#include <algorithm>
#include <numeric>

#include "glisson/simulation/simulation.h"
#include "instruments/needle/needle_state.h"

namespace glisson {
namespace {

constexpr double kPlaces = 1e-6;     ///< of the zone: rest positions nearer to each other count as one
constexpr double kAtEnd = 1e-7;      ///< [m]: so near to an end of a track its tissue ends there
constexpr double kRounding = 1e-12;  ///< [m]: so far past the ends of a line triangles are met, and count once
constexpr double kBehind = 0.05;     ///< of the zone: a tip that far before a track is not in it
constexpr double kMerged = 0.5;      ///< of the spacing: a last point that is nearer to the far end moves there

}  // namespace

std::size_t NeedlePath::track_of(std::size_t node) const {
  std::size_t track = 0;
  while (track + 1 < tracks.size() && tracks[track + 1].begin <= node) ++track;
  return track;
}

void NeedlePath::add_node(shaft::Row node, const Vec3d& bent) {
  bend.resize(nodes.size());
  nodes.push_back(std::move(node));
  slips.push_back(1);
  along.push_back(0.0);
  bend.push_back(bent);
}

void NeedlePath::forget_from(std::size_t track) {
  const std::size_t left = tracks[track].begin;
  nodes.resize(left), slips.resize(left), along.resize(left), bend.resize(std::min(bend.size(), left));
  tracks.resize(track);
}

/// Brings the ends of the tracks behind the one that the tip is in to the end of the step.
void Needle::State::read_ends(const InteractionStep& step) {
  for (std::size_t k = 0; k < entered; ++k) {
    if (stage == NeedleStage::inside && k + 1 == entered) continue;  // go_on reads them
    shaft::read(step, nodes[tracks[k].begin]);
    shaft::read(step, nodes[end_of(k) - 1]);
  }
}

/// @param at  of the tip [m]
std::vector<TissueInterval> Needle::State::crossing(const Vec3d& at, const Vec3d& direction) const {
  std::vector<TissueInterval> all;
  for (std::size_t k = 0; k < entered; ++k) {
    const auto from_hand_to = [&](std::size_t node) {
      return options.length + dot(nodes[node].position - at, direction);
    };
    const double from = from_hand_to(tracks[k].begin);
    const double to = tracks[k].through ? std::min(from_hand_to(end_of(k) - 1), options.length) : options.length;
    if (to > from) all.push_back({from, to});
  }
  return all;
}

std::vector<SurfaceHit> Needle::State::hits_at_rest(const Vec3d& from, const Vec3d& to,
                                                    std::span<const std::size_t> triangles, double beyond) const {
  std::vector<SurfaceHit> hits;
  const double length = norm(to - from);
  if (!(length > 0.0)) return hits;
  const Vec3d direction = (to - from) * (1.0 / length);
  for (const std::size_t t : triangles) {
    const double reach = length + beyond + surface_edges[t] + kRounding;
    if (squared(mesh->vertices[surface[t][0]] - from) > reach * reach) continue;
    std::array<Vec3d, 3> rest;
    for (std::size_t a = 0; a < 3; ++a) rest[a] = mesh->vertices[surface[t][a]];
    const auto hit = meet(from, direction, rest, rest);
    if (hit && hit->way >= -kRounding && hit->way <= length + beyond + kRounding) hits.push_back(*hit);
  }
  put_in_order(hits);
  return hits;
}

/// Whether the tip may go in there: outside, at the first surface from the hand; beyond a track, at one ahead of its far end. Tissue
/// that was pushed aside may overlap: there the place at rest counts.
bool Needle::State::is_next_entry(const SurfaceHit& hit, const Vec3d& from, const Vec3d& direction) const {
  if (entered == 0) return true;
  if (!hit.goes_in) return false;
  const shaft::Row &first = nodes[tracks[entered - 1].begin], &last = nodes[end_of(entered - 1) - 1];
  if (hit.way > dot(last.position - from, direction)) return true;
  return hit.way > dot(first.position - from, direction) &&
         dot(hit.rest - last.rest, direction) > -kPlaces * options.zone;
}

/// Whether the tip is at the next of the holes that it made before.
bool Needle::State::meets_hole(const Vec3d& rest) const {
  return entered < tracks.size() && norm(nodes[tracks[entered].begin].rest - rest) < options.diameter;
}

void Needle::State::enter_hole() {
  ++entered;
  stage = NeedleStage::inside;
  tip_out = withdraws = false;
}

/// The tip on an unbroken surface. Holes that lay ahead of it are forgotten.
void Needle::State::touch(shaft::Row met, const Vec3d& direction) {
  if (entered < tracks.size()) {
    forget_from(entered);
    mobility.forget();
  }
  if (entered == 0) bend_tip = {};
  tip = std::move(met);
  stage = NeedleStage::pressing;
  tip_out = withdraws = at_membrane = false;
  next_region.reset();
  cutting_beyond.reset();
  const double depth = nodes.empty() ? 0.0 : rest_depth(direction);
  const auto below = std::ranges::find_if(membranes, [&](const InnerMembrane& m) { return m.depth >= depth; });
  broken = static_cast<std::size_t>(below - membranes.begin());
  pressing = {};
  const auto under = zones->locator().locate(tip.rest + direction * (1e-3 * options.zone));
  region = mesh->region_of(under ? under->tet : 0);
}

/// The tip is off the surface that it pressed on; the path ends again where it came out before that.
void Needle::State::let_go() {
  look = true;
  tip_out = entered > 0;
  stage = entered > 0 ? NeedleStage::inside : NeedleStage::outside;
  if (entered > 0) tip = far_end();
}

/// The surface under the tip is broken: tissue begins there.
void Needle::State::begin_track() {
  stage = NeedleStage::inside;
  tracks.push_back({.begin = nodes.size()});
  add_node(tip, entered == 0 ? Vec3d{} : bend_tip);
  entered = tracks.size();
}

/// The path ends at the far side of the tissue.
void Needle::State::come_out() {
  const bool inner = nodes.size() - tracks.back().begin > 1;
  if (inner && norm(tip.rest - nodes.back().rest) < kMerged * options.spacing) {
    nodes.back() = tip;
    mobility.forget();
  } else {
    add_node(tip, bend_tip);
  }
  tracks.back().through = tip_out = look = true;
}

/// The tip has come back out of the tissue where it went in.
void Needle::State::leave_track() {
  --entered;
  tip_out = entered > 0;
  look = true;
  stage = entered > 0 ? NeedleStage::inside : NeedleStage::outside;
}

/// Whether tracks and stage are those of a path of so many points.
bool Needle::State::tracks_fit(std::size_t points) const {
  if (tracks.empty() != (points == 0) || entered > tracks.size()) return false;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    const bool last = k + 1 == tracks.size();
    const std::size_t end = last ? points : tracks[k + 1].begin;
    if ((k == 0 && tracks[k].begin != 0) || tracks[k].begin >= end || (!last && !tracks[k].through)) return false;
  }
  if (tip_out && (!is_through() || stage != NeedleStage::inside)) return false;
  if (stage == NeedleStage::pressing) return entered == tracks.size() && (entered == 0 || is_through());
  return (stage == NeedleStage::inside) == (entered > 0);
}

/// Where the tissue ends on the way from the end of the path; none: not before `to`.
std::optional<Vec3d> Needle::State::way_out(const Vec3d& to) const {
  const double length = norm(to - tip.rest);
  const auto intervals = find_intervals(hits_at_rest(tip.rest, to, near_triangles, kAtEnd), length + kAtEnd, true);
  if (intervals.empty() || intervals.front().from > 0.0) return tip.rest;
  if (intervals.front().to <= length) return tip.rest + (to - tip.rest) * (intervals.front().to / length);
  if (!zones->locator().locate(to)) return tip.rest;  // past an edge of the surface, by rounding
  return {};
}

/// What of a line of points lies in the present body at rest. @param way  of each: its distance from the first, along the line
std::vector<TissueInterval> Needle::State::intervals_left(std::span<const Vec3d> points,
                                                          std::span<const double> way) const {
  const bool inside = zones->locator().locate(points.front()).has_value();
  const double length = way.back();
  if (length < kAtEnd) return inside ? std::vector{TissueInterval{0.0, length}} : std::vector<TissueInterval>{};
  std::vector<std::size_t> all(surface.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<SurfaceHit> hits;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    for (SurfaceHit hit : hits_at_rest(points[i], points[i + 1], all)) {
      hit.way += way[i];
      hits.push_back(hit);
    }
  }
  put_in_order(hits);
  std::vector<TissueInterval> left = find_intervals(hits, length, inside);
  for (TissueInterval& i : left) {
    if (i.from < kAtEnd) i.from = 0.0;
    if (i.to > length - kAtEnd) i.to = length;
  }
  return left;
}

/// Adds what is left of a track, in none, one or several. @return whether it is as it was
bool Needle::State::keep_what_is_left(std::size_t track, NeedlePath& kept) const {
  const std::size_t begin = tracks[track].begin, end = end_of(track);
  std::vector<Vec3d> points;
  for (std::size_t j = begin; j < end; ++j) points.push_back(nodes[j].rest);
  if (!tracks[track].through) points.push_back(tip.rest);
  std::vector<double> way{0.0};
  for (std::size_t i = 1; i < points.size(); ++i) way.push_back(way.back() + norm(points[i] - points[i - 1]));
  const auto bent = [&](std::size_t j) { return j < bend.size() ? bend[j] : Vec3d{}; };
  const auto add_at = [&](double here) {
    std::size_t i = 0;
    while (i + 2 < way.size() && way[i + 1] < here) ++i;
    shaft::Row row;
    const double share = (here - way[i]) / (way[i + 1] - way[i]);
    if (place(row, points[i] + (points[i + 1] - points[i]) * share)) kept.add_node(std::move(row), bent(begin + i));
  };
  const std::vector<TissueInterval> left = intervals_left(points, way);
  for (const auto& [from, to] : left) {
    const bool whole_to = to == way.back();
    kept.tracks.push_back({.begin = kept.nodes.size(), .through = tracks[track].through || !whole_to});
    if (from > 0.0) add_at(from);
    for (std::size_t j = begin; j < end; ++j) {
      const double here = way[j - begin];
      if (here < (from > 0.0 ? from + kAtEnd : 0.0) || here > (whole_to ? to : to - kAtEnd)) continue;
      kept.add_node(nodes[j], bent(j));
      kept.slips.back() = slips[j], kept.along.back() = along[j];
    }
    if (!whole_to) add_at(to);
    if (kept.nodes.size() == kept.tracks.back().begin) kept.tracks.pop_back();
  }
  return left.size() == 1 && left[0].from == 0.0 && left[0].to == way.back();
}

/// After a change of the body: the path keeps what of it is still in tissue.
/// @param at  of the tip [m]
void Needle::State::cross_anew(const BodyView& body, const Vec3d& at, const Vec3d& direction) {
  NeedlePath kept;
  std::size_t before_tip = 0;
  bool same = true;
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    same = keep_what_is_left(k, kept) && same;
    if (k + 1 == entered) before_tip = kept.tracks.size();
  }
  if (same) return;
  const bool was_blind = !tracks.back().through;
  static_cast<NeedlePath&>(*this) = std::move(kept);
  entered = before_tip;
  if (was_blind && !tracks.empty() && tracks.back().through) tip = nodes.back();
  for (shaft::Row& node : nodes) {
    node.position = node.rest;
    for (const VertexWeight& w : node.weights) node.position += body.displacement[w.vertex] * w.weight;
  }
  if (stage != NeedleStage::inside) return;
  while (entered > 0 && dot(entry().position - at, direction) > kBehind * options.zone) --entered;
  if (entered == 0) stage = NeedleStage::outside;
  tip_out = is_through() && dot(far_end().position - at, direction) < 0.0;
}

}  // namespace glisson
