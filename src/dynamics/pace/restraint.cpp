#include "dynamics/pace/restraint.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamics/step/stable_step.h"
#include "dynamics/step/step_rules.h"
#include "element/tet_fields.h"

namespace glisson {
namespace {

constexpr double kLeastCaution = 0.01;   ///< least factor on a step while stiffness rises
constexpr double kRecovery = 1.1;        ///< of that factor, a step
constexpr double kViolent = 3.0;         ///< stiffening of large strain from which shape changes limit the step
constexpr double kShapeChange = 0.01;    ///< of a tet within such a step [-]
constexpr double kChangeOfSlack = 0.04;  ///< more of it for one that could be e times as stiff
constexpr double kCloseToLevel = 0.5;    ///< of its block's level, from which a tet's change of shape counts

/// Norm of the velocity gradient of an element [1/s].
double shape_rate(const Body& body, const MovingBody& moving, std::uint32_t element) {
  const Tet& t = body.elements[element];
  const Vec3d origin = moving.velocity_of(t[0]);
  std::array<Vec3d, 3> difference;
  for (std::size_t a = 0; a < 3; ++a) difference[a] = moving.velocity_of(t[a + 1]) - origin;
  return std::sqrt(squared_norm(displacement_gradient(body.rest[element].s, difference)));
}

bool has_large_strain(const Body& body) {
  return std::ranges::any_of(body.blocks, [](const TissueBlock& b) { return !is_small(b); });
}

}  // namespace

Restraint::Restraint(const Body& body, bool enforces) : body_(body), enforces_(enforces) {}

double Restraint::hold_back(double step, const StepLimits& limits, const AddedStiffness& stiff,
                            double drag_limit) const {
  const double room = 1.0 / (kSafety * kSafety);
  const double h = caution_ * limits.with_added(step, {room * (stiff.k + held_), stiff.c / kSafety});
  return std::min(std::min(h, shape_step_), kSafety * drag_limit);
}

void Restraint::rise(double rise) {
  caution_ = rise > kStiffeningMargin ? std::max(kLeastCaution, caution_ * std::log(kStiffeningMargin) / std::log(rise))
                                      : std::min(1.0, kRecovery * caution_);
}

/// Whether the changes of its shape count for the step.
bool Restraint::is_violent(const StiffElement& element) const {
  return enforces_ && element.ratio > kViolent && !is_small(body_.block_of(element.element));
}

void Restraint::list_violent(std::vector<double>& levels) const {
  for (std::size_t b = 0; b < levels.size(); ++b) {
    if (!is_small(body_.blocks[b])) levels[b] = std::min(levels[b], std::max(kViolent, kCloseToLevel * levels[b]));
  }
}

/// How many times as stiff an element could be before it alone asked for a shorter step.
double Restraint::slack(const StiffElement& stiff, double step) const {
  const ElementRest& rest = body_.rest[stiff.element];
  const std::array<Vec3d, 4> s = shape_gradients(rest);
  double per_mass = 0.0;
  for (std::size_t a = 0; a < 4; ++a) per_mass += dot(s[a], s[a]) / body_.masses[body_.elements[stiff.element][a]];
  const double modulus = stiff.norm * modulus_bound(body_.block_of(stiff.element).elastic);
  return 4.0 / (step * step * rest.volume * modulus * per_mass);
}

void Restraint::limit_shape_change(std::span<const StiffElement> stiff, const MovingBody& moving, double h) {
  if (!enforces_ || !has_large_strain(body_)) return;
  for (const StiffElement& s : stiff) {
    if (!is_violent(s)) continue;
    const double rate = shape_rate(body_, moving, s.element);
    if (rate * h <= kShapeChange) continue;
    const double most = kShapeChange + kChangeOfSlack * std::log(std::max(1.0, slack(s, h)));
    shape_step_ = std::min(shape_step_, most / rate);
  }
}

void Restraint::add(double tools) { held_ = std::max(held_, tools); }

void Restraint::let_go_of_added() { held_ /= kRegrowth * kRegrowth; }

void Restraint::start_anew(double tools) {
  caution_ = 1.0;
  held_ = tools;
  forget_shape_change();
}

}  // namespace glisson
