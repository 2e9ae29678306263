// grab_spring.cpp — see grab_spring.h.
#include "view/engine/grab_spring.h"

#include <algorithm>
#include <cmath>

#include "glisson/simulation/simulation.h"

namespace glisson::view {
namespace {

constexpr double kDampingRatio = 0.5;
/// Change of velocity that a bond gives in a step at most [m/s]: where a container is bonded to the same vertex, both would tear
/// at it with all that a step allows.
constexpr double kMostKick = 5.0;
/// What damping of that ratio takes off the explicit step, as a share of frequency: (√(1 + ζ²) − ζ)⁻².
constexpr double kForDamping = 2.7;

}  // namespace

void GrabSpring::hold(std::vector<std::uint32_t> vertices, std::span<const Vec3d> displacement,
                      std::span<const double> masses, double stiffness, Hold how) {
  let_go();
  how_ = how;
  vertices_ = std::move(vertices);
  std::sort(vertices_.begin(), vertices_.end());
  for (const std::uint32_t v : vertices_) held_at_.push_back(displacement[v]);
  last_ = held_at_;
  stiffness_ = stiffness;
  share_out(masses);
}

void GrabSpring::share_out(std::span<const double> masses) {
  double mass = 0.0;
  for (const std::uint32_t v : vertices_) mass += masses[v];
  if (!(mass > 0.0)) return let_go();
  share_.clear();
  for (const std::uint32_t v : vertices_) share_.push_back(masses[v] / mass);
  squared_frequency_ = how_ == Hold::springs ? stiffness_ / mass : 0.0;
  damping_ = 2.0 * kDampingRatio * std::sqrt(stiffness_ * mass);
}

void GrabSpring::body_changed(const BodyView& body, std::span<const std::uint32_t> origins) {
  if (!holds()) return;
  const std::size_t first_new = body.masses.size() - origins.size();
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const auto at = std::lower_bound(vertices_.begin(), vertices_.end(), origins[i]);
    if (at == vertices_.end() || *at != origins[i]) continue;
    const auto place = at - vertices_.begin();
    vertices_.push_back(static_cast<std::uint32_t>(first_new + i));
    held_at_.push_back(Vec3d(held_at_[static_cast<std::size_t>(place)]));
    last_.push_back(Vec3d(last_[static_cast<std::size_t>(place)]));
  }
  for (std::size_t i = 0; i < vertices_.size(); ++i) {  // another point of the material is no pull
    const Vec3d& now = body.displacement[vertices_[i]];
    held_at_[i] += now - last_[i];
    last_[i] = now;
  }
  share_out(body.masses);
}

void GrabSpring::let_go() {
  vertices_.clear();
  held_at_.clear();
  last_.clear();
  share_.clear();
  way_ = force_ = gone_ = {};
  squared_frequency_ = 0.0;
}

int GrabSpring::most_drag_stages() const { return kMostDragStages; }

void GrabSpring::draw(const Vec3d& way, double within) {
  way_ = way;
  speed_ = norm(way_ - gone_) / within;
}

/// Each vertex to where the hand is at the end of the step; what a support holds stays.
void GrabSpring::declare(const InteractionStep& step, StepRows& rows, int round) {
  if (how_ != Hold::bonded || !holds() || round > 0) return;
  const Vec3d left = way_ - gone_;
  const double far = norm(left), reach = speed_ * step.h;
  gone_ = far <= reach ? way_ : gone_ + left * (reach / far);
  row_count_ = 0;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const std::uint32_t place = step.place_of[vertices_[i]];
    if (place == InteractionStep::kNowhere) continue;
    const ActiveVertex& v = step.vertices[place];
    Vec3d missing = (held_at_[i] + gone_ - v.displacement) * (1.0 / step.h) - v.velocity;
    if (const double kick = norm(missing); kick > kMostKick) missing = missing * (kMostKick / kick);
    rows.hold(place, v.velocity + missing);
    ++row_count_;
  }
}

void GrabSpring::solved(const InteractionStep& step, const StepRows& rows) {
  if (how_ != Hold::bonded || !holds()) return;
  force_ = {};
  for (std::size_t k = 0; k < row_count_; ++k) force_ += rows.holding_impulse(k) * (1.0 / step.h);
}

void GrabSpring::add_forces(const InteractionStep& step) {
  if (how_ == Hold::bonded) return;
  force_ = {};
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const std::uint32_t place = step.place_of[vertices_[i]];
    if (place == InteractionStep::kNowhere) continue;
    ActiveVertex& v = step.vertices[place];
    const Vec3d spring = (held_at_[i] + way_ - v.displacement) * (share_[i] * stiffness_);
    const Vec3d damper = v.velocity * (-share_[i] * damping_);
    v.elastic += spring;
    v.viscous += damper;
    force_ += spring + damper;
  }
}

void GrabSpring::moved(const InteractionStep& step) {
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const std::uint32_t place = step.place_of[vertices_[i]];
    if (place != InteractionStep::kNowhere) last_[i] = step.vertices[place].displacement;
  }
}

double GrabSpring::squared_frequency() const { return kForDamping * squared_frequency_; }

std::vector<std::uint32_t> patch_around(const TetMesh& mesh, const std::vector<Vec3d>& positions, std::uint32_t vertex,
                                        double radius) {
  std::vector<char> taken(positions.size(), 0);
  std::vector<std::uint32_t> patch{vertex};
  taken[vertex] = 1;
  const auto within = [&](std::uint32_t v) { return norm(positions[v] - positions[vertex]) <= radius; };
  for (std::size_t before = 0; before != patch.size();) {
    before = patch.size();
    for (const Tet& tet : mesh.tets) {
      if (std::none_of(tet.begin(), tet.end(), [&](std::uint32_t v) { return taken[v] != 0; })) continue;
      for (const std::uint32_t v : tet) {
        if (taken[v] != 0 || !within(v)) continue;
        taken[v] = 1;
        patch.push_back(v);
      }
    }
  }
  return patch;
}

}  // namespace glisson::view
