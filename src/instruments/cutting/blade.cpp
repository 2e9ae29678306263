#include "glisson/instruments/blade.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "glisson/archive.h"

namespace glisson {
namespace {

constexpr int kSweeps = 3;  ///< over the pieces of the edge, which share vertices

void require(bool ok, const std::string& name, const char* option, double value, const char* range) {
  if (ok) return;
  std::ostringstream text;
  text << "blade " << name << ": " << option << " = " << value << " is outside the allowed range, " << range;
  throw std::invalid_argument(text.str());
}

/// The part of a vector across a line.
Vec3d across(const Vec3d& v, const Vec3d& line) { return v - line * (dot(line, v) / dot(line, line)); }

}  // namespace

Blade::Blade(Simulation& simulation, std::string name, std::shared_ptr<ToolDriver> driver, const Vec3d& direction,
             const BladeOptions& options)
    : Instrument(std::move(name), std::move(driver), direction), simulation_(simulation),
      cutter_(simulation, options.cutting), from_(options.edge_from), to_(options.edge_to),
      toughness_(options.toughness) {
  require(toughness_ >= 0.0 && std::isfinite(toughness_), this->name(), "toughness [J/m^2]", toughness_,
          ">= 0 and finite");
  const double length = norm(to_ - from_);
  require(length > 0.0 && std::isfinite(length), this->name(), "length of the edge [m]", length, "> 0 and finite");
  cutter_.place(edge());
}

BladeEdge Blade::edge() const {
  const Pose& p = pose();
  return {p.position + p.axes * from_, p.position + p.axes * to_};
}

void Blade::attached(const BodyView& body, double) {
  if (&body.mesh != &simulation_.mesh()) {
    throw std::invalid_argument("attach: " + label() + " was made for another simulation, which it cuts");
  }
  find_pieces();
}

void Blade::body_changed(const BodyView& body, std::span<const std::uint32_t>) {
  std::erase_if(pieces_, [&](const Piece& piece) { return body.is_removed(piece.at.tet); });
  for (Piece& piece : pieces_) piece.vertices = body.mesh.tets[piece.at.tet];
}

void Blade::find_pieces() {
  pieces_.clear();
  for (const EdgePiece& piece : cutter_.contact()) {
    pieces_.push_back({piece, simulation_.mesh().tets[piece.tet]});
  }
}

CutReport Blade::cut() {
  const CutReport report = cutter_.advance(edge());
  area_ += report.area;
  find_pieces();
  return report;
}

double Blade::length_in_tissue() const {
  double sum = 0.0;
  for (const Piece& piece : pieces_) sum += piece.at.length;
  return sum;
}

std::span<const std::uint32_t> Blade::reach(double, double) {
  reached_.clear();
  for (const Piece& piece : pieces_) reached_.insert(reached_.end(), piece.vertices.begin(), piece.vertices.end());
  return reached_;
}

/// Gives the tissue at a piece G l h along the edge's way through it, or as much less as takes it along.
/// @param velocity  of the edge there
void Blade::resist(const InteractionStep& step, const Piece& piece, const Vec3d& velocity, const Vec3d& along) {
  std::array<std::uint32_t, 4> places;
  Vec3d tissue{};
  double mobility = 0.0;
  for (std::size_t c = 0; c < 4; ++c) {
    places[c] = step.place_of[piece.vertices[c]];
    if (places[c] == InteractionStep::kNowhere) return;
    const double w = piece.at.weights[c];
    tissue += step.vertices[places[c]].velocity * w;
    const Vec3d& a = step.mobility[places[c]];
    mobility += w * w * std::max({a.x, a.y, a.z});
  }
  const Vec3d through = across(velocity - tissue, along);
  const double speed = norm(through), most = toughness_ * piece.at.length * step.h / kSweeps;
  if (!(speed > 0.0)) return;
  const double impulse = mobility > 0.0 ? std::min(most, speed / mobility) : most;
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3d push = through * (impulse * piece.at.weights[c] / speed);
    step.push(places[c], push);
    forces_.cutting += push * (1.0 / step.h);
    forces_.torque += cross(step.position(places[c]) - pose_.position, push) * (1.0 / step.h);
  }
}

void Blade::constrain(const InteractionStep& step) {
  const BladeEdge before = edge();
  drive(step);
  const BladeEdge after = edge();
  forces_ = {};
  const Vec3d along = after.to - after.from;
  const Vec3d from = (after.from - before.from) * (1.0 / step.h), to = (after.to - before.to) * (1.0 / step.h);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const Piece& piece : pieces_) {
      Vec3d at{};
      for (std::size_t c = 0; c < 4; ++c) {
        const std::uint32_t place = step.place_of[piece.vertices[c]];
        if (place != InteractionStep::kNowhere) at += step.position(place) * piece.at.weights[c];
      }
      const double share = std::clamp(dot(at - before.from, along) / dot(along, along), 0.0, 1.0);
      resist(step, piece, from * (1.0 - share) + to * share, along);
    }
  }
}

void Blade::Piece::archive(Archive& ar) { ar(at.tet, at.length, at.weights, vertices); }

void Blade::archive(Archive& ar) {
  archive_motion(ar);
  ar(area_, pieces_);
  const TetMesh& mesh = simulation_.mesh();
  for (const Piece& piece : pieces_) {
    const std::uint32_t t = piece.at.tet;
    ar.check(t < mesh.tets.size() && !simulation_.is_removed(t) && piece.vertices == mesh.tets[t]);
  }
}

}  // namespace glisson
