#include "glisson/instruments/blade.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/require_fields.h"
#include "contact/row_group.h"
#include "glisson/archive.h"

namespace glisson {
namespace {

constexpr double kMostChange = 0.5;  ///< of the longer: by how much the length in tissue changes in a long step

double length_of(std::span<const EdgePiece> pieces) {
  double sum = 0.0;
  for (const EdgePiece& piece : pieces) sum += piece.length;
  return sum;
}

}  // namespace

Fault BladeOptions::check() const {
  if (norm(edge_to - edge_from) > 0.0) return {};
  return {"is the other end, too: the edge has no length; give two ends", "edge_to"};
}

Blade::Blade(const BladeOptions& options, std::shared_ptr<ToolDriver> driver)
    : Instrument(options.name, std::move(driver), options.direction), options_(options) {
  detail::require_fields("blade \"" + name() + "\"", options);
}

BladeEdge Blade::edge() const {
  const Pose& p = pose();
  return {p.position + p.axes * options_.edge_from, p.position + p.axes * options_.edge_to};
}

void Blade::attached(const BodyView& body, double) {
  set_bounds(body);
  mesh_ = &body.mesh, removed_ = body.removed;
}

void Blade::body_changed(const BodyView& body, std::span<const std::uint32_t>) {
  removed_ = body.removed;
  std::erase_if(pieces_, [&](const EdgePiece& piece) { return body.is_removed(piece.tet); });
}

void Blade::between_steps(Simulation& simulation) {
  const BladeEdge now = edge();
  if (!cutter_) {
    cutter_.emplace(simulation, options_.cutting).place(now);
  } else {
    if (simulation.time() < next_cut_) return;
    next_cut_ = simulation.time() + options_.cut_every;
    cut(simulation.time(), now);
  }
  pieces_ = cutter_->contact();
}

/// A step never throws: where the body refuses to be split, another cut begins here.
void Blade::cut(double time, const BladeEdge& to) {
  try {
    area_ += cutter_->advance(to).area;
  } catch (const std::invalid_argument&) {
    cutter_->place(to);
    add_event(time, depth(), "cut refused");
  }
}

double Blade::length_in_tissue() const { return length_of(pieces_); }

std::span<const std::uint32_t> Blade::reach(double, double) {
  begin_step();
  const BladeEdge now = edge();
  const bool has_gone_on = cutter_ && (now.from != cutter_->edge().from || now.to != cutter_->edge().to);
  if (forces_at_end() && has_gone_on) pieces_ = cutter_->contact(now);  // a part of a long step
  reached_.clear(), found_.clear();
  for (const EdgePiece& piece : pieces_) {
    reached_.insert(reached_.end(), vertices_of(piece).begin(), vertices_of(piece).end());
  }
  return reached_;
}

/// A piece gives its tissue up to G l h along the edge's path through it, or as much less as takes it along.
void Blade::add_disc(const InteractionStep& step, const EdgePiece& piece, const BladeEdge& before,
                     const BladeEdge& after, RowGroup& rows) const {
  if (!is_active(step, piece)) return;
  DiscRow row;
  Vec3d at{};
  for (std::size_t c = 0; c < 4; ++c) {
    row.places[c] = step.place_of[vertices_of(piece)[c]];
    const double w = row.weights[c] = piece.weights[c];
    at += step.position(row.places[c]) * w;
    const Vec3d& a = step.mobility[row.places[c]];
    row.mobility += w * w * std::max({a.x, a.y, a.z});
    row.tool[c] = velocity_at(step.position(row.places[c]));
  }
  row.line = after.to - after.from;
  const Vec3d was = step.is_long ? before.to - before.from : row.line;
  const double share = std::clamp(dot(at - before.from, was) / dot(was, was), 0.0, 1.0);
  row.velocity = ((after.from - before.from) * (1.0 - share) + (after.to - before.to) * share) * (1.0 / step.h);
  row.most = options_.toughness * piece.length * step.h;
  if (step.is_long) {
    row.last = row.impulse = last_force(piece) * step.h;
    row.yields = rows.yields;
    row.tool.fill(velocity_at(at + row.velocity * step.h));
  }
  rows.discs.push_back(row);
}

void Blade::declare(const InteractionStep& step, StepRows& rows, int round) {
  if (round > 0) return;
  const BladeEdge before = edge();
  drive(step);
  rows.group().yields = find_end(step);
  const BladeEdge after = edge();
  for (const EdgePiece& piece : pieces_) add_disc(step, piece, before, after, rows.group());
}

void Blade::solved(const InteractionStep& step, const StepRows& rows) {
  move_to_end();
  forces_ = {};
  const double on = step.is_long ? step.h : 0.0;  // to where tissue is at the time of the forces
  for (const DiscRow& row : rows.group().discs) {
    for (std::size_t c = 0; c < 4; ++c) {
      const Vec3d push = row.impulse * row.weights[c];
      const Vec3d at = step.position(row.places[c]) + step.vertices[row.places[c]].velocity * on;
      forces_.cutting += push * (1.0 / step.h);
      forces_.torque += cross(at - pose_.position, push) * (1.0 / step.h);
    }
  }
  if (!step.is_long) return;
  found_.assign(pieces_.size(), Vec3d{});
  std::size_t next = 0;
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    if (is_active(step, pieces_[k])) found_[k] = rows.group().discs[next++].impulse;
  }
}

bool Blade::is_active(const InteractionStep& step, const EdgePiece& piece) const {
  const Tet& t = vertices_of(piece);
  return std::all_of(t.begin(), t.end(),
                     [&](std::uint32_t v) { return step.place_of[v] != InteractionStep::kNowhere; });
}

/// Force on the same piece in the step before [N].
Vec3d Blade::last_force(const EdgePiece& piece) const {
  const auto at =
      std::lower_bound(last_.begin(), last_.end(), piece.tet, [](const auto& a, auto t) { return a.first < t; });
  return at != last_.end() && at->first == piece.tet ? at->second : Vec3d{};
}

void Blade::moved(const InteractionStep& step) {
  if (!step.is_long) return;
  last_.clear();
  for (std::size_t k = 0; k < found_.size(); ++k) last_.emplace_back(pieces_[k].tet, found_[k] * (1.0 / step.h));
  std::sort(last_.begin(), last_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
}

std::string Blade::refuses_long_steps() const { return driver_refuses_long_steps(); }

/// The edge enters tissue or leaves it: G l holds from there on.
bool Blade::overshoots(const InteractionStep& step) {
  if (!cutter_ || !(options_.toughness > 0.0)) return false;
  const double before = length_in_tissue(), after = length_of(cutter_->contact(edge(), step.vertices));
  return std::abs(after - before) > kMostChange * std::max(after, before);
}

void EdgePiece::archive(Archive& ar) { ar(tet, length, weights); }

void Blade::archive(Archive& ar) {
  archive_motion(ar);
  std::vector<EdgePiece> pieces = pieces_;
  ar(area_, next_cut_, pieces);
  if (forces_at_end()) ar(last_);
  for (const EdgePiece& piece : pieces) {
    ar.check(mesh_ != nullptr && piece.tet < mesh_->tets.size() && (removed_.empty() || removed_[piece.tet] == 0));
  }
  if (ar.reads()) pieces_ = std::move(pieces);
  if (cutter_) cutter_->archive(ar);
}

struct Blade::Saved {
  std::shared_ptr<const SavedMotion> motion;
  std::shared_ptr<const void> cutter;
  double area = 0.0, next_cut = 0.0;
  std::vector<EdgePiece> pieces;
  std::vector<std::pair<std::uint32_t, Vec3d>> last;
};

std::shared_ptr<const void> Blade::save_state() const {
  return std::make_shared<const Saved>(
      Saved{save_motion(), cutter_ ? cutter_->save_state() : nullptr, area_, next_cut_, pieces_, last_});
}

void Blade::load_state(const std::shared_ptr<const void>& state, const BodyView* other_body) {
  const Saved& saved = *std::static_pointer_cast<const Saved>(state);
  load_motion(*saved.motion);
  area_ = saved.area, next_cut_ = saved.next_cut, pieces_ = saved.pieces, last_ = saved.last;
  if (cutter_ && saved.cutter != nullptr) cutter_->load_state(saved.cutter);
  if (saved.cutter == nullptr) cutter_.reset();
  if (other_body != nullptr) removed_ = other_body->removed;
}

}  // namespace glisson
