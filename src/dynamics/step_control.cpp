#include "dynamics/step_control.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace glisson {
namespace {

constexpr double kRoom = 1.2;  ///< stiffening that a new h* allows for beyond the present one
constexpr std::uint64_t kLongestWindow = 64000, kShortWindow = 16;  ///< [steps]
constexpr double kLeastCaution = 1e-3;                              ///< least factor on a step while stiffness rises
constexpr double kRecovery = 1.05;                                  ///< of that factor, a step
constexpr double kViolent = 3.0;       ///< stiffening of large strain from which shape changes limit the step
constexpr double kShapeChange = 0.01;  ///< of a tet within such a step [-]
constexpr double kWorthALook = 2.0;    ///< how much shorter a scaled step is that single elements may better
constexpr double kMostAhead = 4.0;     ///< how far a level runs ahead of a rise

bool is_small(const TissueBlock& block) {
  return !block.tissue.hyperelastic && block.tissue.kinematics == Kinematics::small;
}

bool is_linear(const TissueBlock& block) {
  const Tissue& t = block.tissue;
  return is_small(block) && std::holds_alternative<ConstantLaw>(t.law) && !t.lambda_law && !t.mu_law;
}

/// Softened tissue keeps the h* of its rest stiffness.
std::vector<double> at_least_one(std::span<const double> stiffening) {
  std::vector<double> level(stiffening.begin(), stiffening.end());
  for (double& r : level) r = std::max(r, 1.0);
  return level;
}

}  // namespace

StepControl::StepControl(const Body& body, std::span<const double> nodal_damping, Drag drag,
                         const SimulationOptions& options, std::span<const double> stiffening)
    : body_(body), nodal_damping_(nodal_damping), drag_(drag), automatic_(!options.step),
      enforce_(options.enforce_stability), exact_asked_(options.exact_steps),
      scales_masses_(options.mass_scaling_step.has_value()) {
  if (!automatic_ && !(*options.step > 0.0 && std::isfinite(*options.step))) {
    throw std::invalid_argument("step = " + std::to_string(*options.step) +
                                " s is outside the allowed range, > 0 and finite, or \"auto\"");
  }
  exact_ = search_is_needed();
  seen_.assign(body.blocks.size(), 0.0);
  lately_ = seen_;
  last_.assign(stiffening.begin(), stiffening.end());
  validated_ = rest_level_ = at_least_one(stiffening);
  limits_ = rest_limits_ = limits_at(validated_);
  searched_ = {rest_limits_, rest_level_, block_numbers()};
  step_ = options.step.value_or(kSafety * limits_.pace);
  if (enforce_ && step_ > limits_.stable) refuse_above(limits_.stable);
}

/// The bound from an earlier h* holds only where C stays what it is.
bool StepControl::search_is_needed() const {
  const bool small = std::all_of(body_.blocks.begin(), body_.blocks.end(), is_small);
  return exact_asked_ || (drag_ == Drag::at_once && !small);
}

/// What is left of a step h of the tissue alone when stiffness of frequency ω acts beside it. φ(h) of the tissue is at most
/// 4 h/h₁ below a step h₁ it bears, (h/h₁)² where nothing drags, and φ(h) + ω² h² ≤ 4 must hold.
double StepControl::with_beside(double step, double squared_frequency) const {
  if (!(squared_frequency > 0.0)) return step;
  const bool drags = std::any_of(body_.blocks.begin(), body_.blocks.end(), [](const TissueBlock& b) {
    return b.viscous.mu != 0.0 || b.viscous.lambda != 0.0 || !b.tissue.maxwell.empty();
  });
  if (!drags) return 1.0 / std::sqrt(1.0 / (step * step) + 0.25 * squared_frequency);
  return 2.0 * (std::sqrt(1.0 / (step * step) + squared_frequency) - 1.0 / step) / squared_frequency;
}

void StepControl::refuse_above(double stable) const {
  std::ostringstream text;
  text << "step = " << step_ << " s is above the stable step h* = " << stable
       << " s of this mesh and tissue, and the run would blow up. Ways out: a smaller step, or \"auto\", which takes "
       << kSafety << " h*; the integrator ";
  if (drag_ == Drag::lags) text << "\"semi_implicit\" where viscosity is what limits h*, or ";
  text << "\"implicit\", which is stable at any step; less viscosity or more nodal damping, which raise h*; a larger "
       << "density, or mass scaling of the smallest tets, where the inertia of the tissue does not matter, h* growing "
       << "with its square root";
  throw std::invalid_argument(text.str());
}

/// Factors of C in φ (stable_step.h). A tissue of small strain keeps its viscous matrix; any other may have one up to
/// its stiffening times as large.
std::vector<double> StepControl::viscosity_at(std::span<const double> stiffening) const {
  std::vector<double> factor(body_.blocks.size(), 1.0);
  for (std::size_t b = 0; drag_ == Drag::at_once && b < factor.size(); ++b) {
    factor[b] = is_small(body_.blocks[b]) ? -1.0 : stiffening[b] - 2.0;
  }
  return factor;
}

StepControl::Limits StepControl::limits_at(std::span<const double> stiffening) {
  const double h = glisson::stable_step(body_, stiffening, nodal_damping_, {}, &guess_, viscosity_at(stiffening)).step;
  if (drag_ == Drag::lags) return {h, h};
  const std::vector<double> none(body_.blocks.size(), 0.0);
  return {h, std::min(h, glisson::stable_step(body_, stiffening, nodal_damping_, {}, &pace_guess_, none).step)};
}

/// h* at this level from that at the validated one or at rest, whichever gives more; from below.
StepControl::Limits StepControl::bound_at(std::span<const double> stiffening) const {
  const bool damped = std::any_of(nodal_damping_.begin(), nodal_damping_.end(), [](double g) { return g > 0.0; });
  const auto from = [&](const Limits& limits, const std::vector<double>& level) {
    double r = 1.0;
    for (std::size_t b = 0; b < level.size(); ++b) r = std::max(r, stiffening[b] / level[b]);
    return limits.pace / (damped ? r : std::sqrt(r));
  };
  const double h = std::max(from(limits_, validated_), from(rest_limits_, rest_level_));
  return {h, h};
}

void StepControl::prepare_changes(const detail::VertexStars& stars) {
  const std::vector<double> one(body_.blocks.size(), 1.0);
  part_bound_ = std::make_unique<PartBound>(body_, stars, viscosity_at(one));
}

void StepControl::mesh_changed(std::span<const double> nodal_damping, const BodyChange& change,
                               const detail::VertexStars& stars) {
  if (nodal_damping.size() != nodal_damping_.size()) guess_ = pace_guess_ = {};
  nodal_damping_ = nodal_damping;
  if (part_bound_ == nullptr) prepare_changes(stars);
  part_bound_->change(change);
  const double part = part_bound_->step();
  // with stiffness r times that at rest: (h/√r)² r K + 2 (h/√r) C ≤ h² K + 2 h C
  const auto bound = [&](Limits& limits, const std::vector<double>& level) {
    const double h = part / std::sqrt(*std::max_element(level.begin(), level.end()));
    limits = {std::min(limits.stable, h), std::min(limits.pace, h)};
  };
  bound(limits_, validated_);
  bound(rest_limits_, rest_level_);
  searched_ = {rest_limits_, rest_level_, block_numbers()};
  if (automatic_) step_ = std::min(step_, kSafety * limits_.pace);
  unchecked_ = enforce_ && step_ > limits_.stable;
}

std::vector<double> StepControl::block_numbers() const {
  std::vector<double> numbers;
  for (const TissueBlock& b : body_.blocks) {
    const auto bulk = [](const LameParameters& l) { return l.lambda + 2.0 / 3.0 * l.mu; };
    numbers.insert(numbers.end(), {b.elastic.mu, bulk(b.elastic), b.viscous.mu, bulk(b.viscous), b.tissue.density});
  }
  return numbers;
}

/// h* of the present tissues at a level of stiffness, from the last search and from below; 0 where that says nothing.
StepControl::Limits StepControl::scaled_from_search(std::span<const double> level) const {
  const std::vector<double> now = block_numbers();
  const auto ratio = [](double a, double b) { return a > 0.0 ? a / b : 0.0; };  // ∞ where there was none
  double r = 0.0, c = 0.0, d = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < level.size(); ++b) {
    const double *to = &now[5 * b], *from = &searched_.numbers[5 * b];
    r = std::max(r, level[b] / searched_.level[b] * std::max(ratio(to[0], from[0]), ratio(to[1], from[1])));
    if (drag_ == Drag::lags) c = std::max({c, ratio(to[2], from[2]), ratio(to[3], from[3])});
    d = std::min(d, to[4] / from[4]);
  }
  double s = std::max(std::sqrt(r / d), c / d);
  const double g = std::min(1.0, d);
  const bool damped = std::any_of(nodal_damping_.begin(), nodal_damping_.end(), [](double x) { return x > 0.0; });
  if (damped && s * d > g) s = c <= g ? std::max(s, r / g) : std::numeric_limits<double>::infinity();
  const double h = scales_masses_ || !std::isfinite(s) ? 0.0 : searched_.limits.pace / s;
  return {h, h};
}

void StepControl::choose_limits(std::span<const double> stiffening, bool undeformed) {
  const std::vector<double> now = at_least_one(stiffening), one(body_.blocks.size(), 1.0);
  rest_level_ = undeformed ? now : one;
  validated_ = now == rest_level_ ? now : level_of(stiffening, 1.0);
  if (exact_) {
    guess_ = pace_guess_ = {};
    rest_limits_ = limits_at(rest_level_);
    limits_ = validated_ == rest_level_ ? rest_limits_ : limits_at(validated_);
    searched_ = {rest_limits_, rest_level_, block_numbers()};
    return;
  }
  const auto bound = [&](const std::vector<double>& level) {
    Limits limits = scaled_from_search(level);
    if (limits.pace * kWorthALook > searched_.limits.pace) return limits;
    const double h = std::max(limits.pace, element_bound_step(body_, level, viscosity_at(level)));
    return Limits{h, h};
  };
  rest_limits_ = bound(rest_level_);
  limits_ = bound(validated_);
}

StepControl::Chosen StepControl::chosen() const {
  return {guess_, pace_guess_, limits_, rest_limits_, validated_, rest_level_, searched_, exact_};
}

void StepControl::restore(Chosen c) {
  guess_ = std::move(c.guess), pace_guess_ = std::move(c.pace_guess);
  limits_ = c.limits, rest_limits_ = c.rest_limits;
  validated_ = std::move(c.validated), rest_level_ = std::move(c.rest_level);
  searched_ = std::move(c.searched), exact_ = c.exact;
}

void StepControl::tissues_changed(std::span<const double> stiffening, bool undeformed) {
  Chosen before = chosen();
  exact_ = search_is_needed();
  choose_limits(stiffening, undeformed);
  if (!automatic_ && enforce_ && step_ > stable_step()) {
    validated_ = at_least_one(stiffening);  // without room
    limits_ = limits_at(validated_);
    const double h = stable_step();
    if (step_ > h) {
      restore(std::move(before));
      refuse_above(h);
    }
  }
  if (automatic_) step_ = kSafety * limits_.pace;
  part_bound_.reset();
  unchecked_ = false;
  std::fill(seen_.begin(), seen_.end(), 0.0);
  lately_ = seen_;
  last_.assign(stiffening.begin(), stiffening.end());
  window_ = kFirstWindow, in_window_ = 0;
  caution_ = 1.0;
  shape_step_ = std::numeric_limits<double>::infinity();
}

/// How many times as stiff the tissue has become within the last step; holds an automatic step back while that is more
/// than the room.
double StepControl::watch_rise(std::span<const double> stiffening) {
  double rise = 1.0;
  for (std::size_t b = 0; b < last_.size(); ++b) {
    rise = std::max(rise, std::max(1.0, stiffening[b]) / std::max(1.0, last_[b]));
    last_[b] = stiffening[b];
  }
  if (!automatic_ || !std::isfinite(rise)) return 1.0;
  caution_ = rise > kRoom ? std::max(kLeastCaution, caution_ * std::log(kRoom) / std::log(rise))
                          : std::min(1.0, kRecovery * caution_);
  return std::min(rise, kMostAhead);
}

bool StepControl::is_violent(std::span<const double> stiffening) const {
  if (!automatic_ || !enforce_) return false;
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    if (!is_small(body_.blocks[b]) && stiffening[b] > kViolent) return true;
  }
  return false;
}

void StepControl::limit_shape_change(double rate) {
  shape_step_ = rate > 0.0 ? kShapeChange / rate : std::numeric_limits<double>::infinity();
}

/// What a step is to be found for: the seen stiffness with room, not below that at rest.
std::vector<double> StepControl::level_of(std::span<const double> seen, double ahead) const {
  std::vector<double> level = at_least_one(seen);
  for (std::size_t b = 0; b < level.size(); ++b) {
    if (!is_linear(body_.blocks[b])) level[b] = std::max(rest_level_[b], kRoom * ahead * level[b]);
  }
  return level;
}

/// Takes in a level above the validated one; false where a given step does not bear it.
bool StepControl::rises(std::span<const double> stiffening, double rise) {
  std::vector<double> level = level_of(stiffening, rise);
  for (std::size_t b = 0; b < level.size(); ++b) {
    if (!std::isfinite(level[b])) return true;  // the state is beyond repair; the step reports that it is not finite
    if (!is_linear(body_.blocks[b])) level[b] = std::max(validated_[b], level[b]);
  }
  limits_ = automatic_ && !exact_ ? bound_at(level) : limits_at(level);
  if (automatic_) {
    step_ = std::min(step_, kSafety * limits_.pace);
  } else if (step_ > limits_.stable) {
    level = at_least_one(stiffening);
    limits_ = limits_at(level);
    if (step_ > limits_.stable) return false;
  }
  validated_ = std::move(level);
  unchecked_ = false;
  return true;
}

/// After a short peak: where the bound alone allows twice the step, it is taken, without a search.
void StepControl::come_back() {
  const bool bounded = drag_ == Drag::lags || std::all_of(body_.blocks.begin(), body_.blocks.end(), is_small);
  std::vector<double> level = level_of(lately_, 1.0);
  std::fill(lately_.begin(), lately_.end(), 0.0);
  const Limits bound = bound_at(level);
  if (!bounded || kSafety * bound.pace < 2.0 * step_) return;
  limits_ = bound;
  step_ = kSafety * bound.pace;
  validated_ = std::move(level);
}

/// Lets an automatic step grow at the end of a window in which the tissue was well softer than the validated level.
void StepControl::relax(std::span<const double> stiffening) {
  for (std::size_t b = 0; b < seen_.size(); ++b) {
    seen_[b] = std::max(seen_[b], stiffening[b]);
    lately_[b] = std::max(lately_[b], stiffening[b]);
  }
  ++in_window_;
  if (in_window_ % kShortWindow == 0) come_back();
  if (in_window_ < window_) return;
  std::vector<double> level = level_of(seen_, 1.0);
  bool softer = false;
  for (std::size_t b = 0; b < level.size(); ++b) {
    level[b] = std::min(validated_[b], level[b]);
    softer = softer || level[b] * kRoom < validated_[b];
  }
  in_window_ = 0;
  std::fill(seen_.begin(), seen_.end(), 0.0);
  if (!softer) return;
  limits_ = exact_ ? limits_at(level) : bound_at(level);
  step_ = std::max(step_, kSafety * limits_.pace);
  validated_ = std::move(level);
  window_ = std::min<std::uint64_t>(2 * window_, kLongestWindow);
}

void StepControl::save(CheckpointWriter& out) const {
  out.put(step_), out.put(window_), out.put(in_window_), out.put(unchecked_), out.put(caution_);
  out.put(shape_step_);
  for (const Limits& l : {limits_, rest_limits_, searched_.limits}) out.put_doubles(l);
  for (const auto* list : {&validated_, &rest_level_, &seen_, &lately_, &last_, &searched_.level, &searched_.numbers}) {
    out.put(*list);
  }
  out.put(guess_.mode), out.put(pace_guess_.mode);
  out.put(guess_.step), out.put(pace_guess_.step);
}

void StepControl::load(CheckpointReader& in) {
  in.get(step_), in.get(window_), in.get(in_window_), in.get(unchecked_), in.get(caution_);
  in.get(shape_step_);
  for (Limits* l : {&limits_, &rest_limits_, &searched_.limits}) in.get_doubles(*l);
  for (auto* list : {&validated_, &rest_level_, &seen_, &lately_, &last_, &searched_.level, &searched_.numbers}) {
    in.get_same_size(*list);
  }
  in.get(guess_.mode), in.get(pace_guess_.mode);
  in.get(guess_.step), in.get(pace_guess_.step);
}

bool StepControl::accept(std::span<const double> stiffening) {
  if (!enforce_) return true;
  const double rise = watch_rise(stiffening);
  bool within = !unchecked_;
  for (std::size_t b = 0; b < validated_.size(); ++b) within = within && stiffening[b] <= validated_[b];
  if (!within && !rises(stiffening, rise)) return false;
  if (within && automatic_) relax(stiffening);
  return automatic_ || step_ <= stable_step();
}

}  // namespace glisson
