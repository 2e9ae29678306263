#include "dynamics/step_control.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace glisson {
namespace {

constexpr double kSafety = 0.9;  ///< automatic step over h*
constexpr double kRoom = 1.2;    ///< stiffening that a new h* allows for beyond the present one

bool is_linear(const TissueBlock& block) {
  return std::holds_alternative<ConstantLaw>(block.tissue.law) && !block.tissue.lambda_law && !block.tissue.mu_law;
}

/// Softened tissue keeps the h* of its rest stiffness.
std::vector<double> at_least_one(std::span<const double> stiffening) {
  std::vector<double> level(stiffening.begin(), stiffening.end());
  for (double& r : level) r = std::max(r, 1.0);
  return level;
}

[[noreturn]] void refuse(double given, double stable) {
  std::ostringstream text;
  text << "step = " << given << " s is above the stable step h* = " << stable
       << " s of this mesh and tissue, and the run would blow up. Ways out: a smaller step, or \"auto\", which takes "
       << kSafety << " h*; less viscosity or more nodal damping, which raise h*; a larger density (mass scaling) "
       << "where the inertia of the tissue does not matter, h* growing with its square root";
  throw std::invalid_argument(text.str());
}

}  // namespace

StepControl::StepControl(const Body& body, std::span<const double> nodal_damping, std::optional<double> given,
                         bool enforce, bool exact, std::span<const double> stiffening)
    : body_(body), nodal_damping_(nodal_damping), automatic_(!given), enforce_(enforce), exact_(exact) {
  if (given && !(*given > 0.0 && std::isfinite(*given))) {
    throw std::invalid_argument("step = " + std::to_string(*given) +
                                " s is outside the allowed range, > 0 and finite, or \"auto\"");
  }
  validated_ = at_least_one(stiffening);
  any_part_ = element_bound_step(body, std::vector<double>(body.blocks.size(), 1.0));
  stable_ = stable_at(validated_);
  if (given && enforce && *given > stable_) refuse(*given, stable_);
  step_ = given.value_or(kSafety * stable_);
}

double StepControl::stable_at(std::span<const double> stiffening) {
  return glisson::stable_step(body_, stiffening, nodal_damping_, {}, &guess_).step;
}

/// h* at this level from that at the validated one, from below.
double StepControl::bound_at(std::span<const double> stiffening) const {
  double r = 1.0;
  for (std::size_t b = 0; b < validated_.size(); ++b) r = std::max(r, stiffening[b] / validated_[b]);
  const bool damped = std::any_of(nodal_damping_.begin(), nodal_damping_.end(), [](double g) { return g > 0.0; });
  return stable_ / (damped ? r : std::sqrt(r));
}

void StepControl::mesh_changed(std::span<const double> nodal_damping) {
  if (nodal_damping.size() != nodal_damping_.size()) guess_ = {};
  nodal_damping_ = nodal_damping;
  // with stiffness r times that at rest: (h/√r)² r K + 2 (h/√r) C ≤ h² K + 2 h C
  const double bound = any_part_ / std::sqrt(*std::max_element(validated_.begin(), validated_.end()));
  stable_ = std::min(stable_, bound);
  if (automatic_) step_ = std::min(step_, kSafety * stable_);
  unchecked_ = enforce_ && step_ > stable_;
}

bool StepControl::accept(std::span<const double> stiffening) {
  bool within = !unchecked_;
  for (std::size_t b = 0; b < validated_.size(); ++b) within = within && stiffening[b] <= validated_[b];
  if (within || !enforce_) return true;

  std::vector<double> level = at_least_one(stiffening);
  for (std::size_t b = 0; b < level.size(); ++b) {
    const bool finite = std::isfinite(level[b]);
    if (!finite) return true;  // the state is beyond repair; the step reports that it is not finite
    level[b] = is_linear(body_.blocks[b]) ? level[b] : std::max(validated_[b], kRoom * level[b]);
  }
  stable_ = automatic_ && !exact_ ? bound_at(level) : stable_at(level);
  if (automatic_) {
    step_ = std::min(step_, kSafety * stable_);
  } else if (step_ > stable_) {
    level = at_least_one(stiffening);
    stable_ = stable_at(level);
    if (step_ > stable_) return false;
  }
  validated_ = std::move(level);
  unchecked_ = false;
  return true;
}

}  // namespace glisson
