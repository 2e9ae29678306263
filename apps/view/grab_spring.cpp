// grab_spring.cpp — see grab_spring.h.
#include "view/grab_spring.h"

#include <algorithm>
#include <cmath>

namespace glisson::view {
namespace {

constexpr double kDampingRatio = 0.5;
/// What damping of that ratio takes off the explicit step, as a share of frequency: (√(1 + ζ²) − ζ)⁻².
constexpr double kForDamping = 2.7;

}  // namespace

void GrabSpring::hold(std::vector<std::uint32_t> vertices, std::span<const Vec3d> displacement,
                      std::span<const double> masses, double stiffness) {
  let_go();
  double mass = 0.0;
  for (const std::uint32_t v : vertices) mass += masses[v];
  if (!(mass > 0.0)) return;
  vertices_ = std::move(vertices);
  std::sort(vertices_.begin(), vertices_.end());
  for (const std::uint32_t v : vertices_) {
    held_at_.push_back(displacement[v]);
    share_.push_back(masses[v] / mass);
  }
  stiffness_ = stiffness;
  squared_frequency_ = stiffness / mass;
  damping_ = 2.0 * kDampingRatio * std::sqrt(stiffness * mass);
}

void GrabSpring::let_go() {
  vertices_.clear();
  held_at_.clear();
  share_.clear();
  way_ = force_ = {};
  squared_frequency_ = 0.0;
}

void GrabSpring::add_forces(const InteractionStep& step) {
  force_ = {};
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const std::uint32_t place = step.place_of[vertices_[i]];
    if (place == InteractionStep::kNowhere) continue;
    WatchedVertex& v = step.vertices[place];
    const Vec3d spring = (held_at_[i] + way_ - v.displacement) * (share_[i] * stiffness_);
    const Vec3d damper = v.velocity * (-share_[i] * damping_);
    v.elastic += spring;
    v.viscous += damper;
    force_ += spring + damper;
  }
}

double GrabSpring::squared_frequency() const { return kForDamping * squared_frequency_; }

}  // namespace glisson::view
