#include "dynamics/step/step_limits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>

#include "dynamics/step/step_rules.h"
#include "element/drag_stages.h"

namespace glisson {
namespace {

constexpr double kWorthALook = 2.0;       ///< how much shorter a scaled step is that single elements may better
constexpr std::size_t kSearchesKept = 4;  ///< since steps were chosen anew

}  // namespace

StepLimits::StepLimits(const Body& body, const std::vector<double>& nodal_damping, Drag drag,
                       const SimulationOptions& options, std::span<const double> stiffening)
    : body_(body), nodal_damping_(nodal_damping), drag_(drag), drag_stages_(options.drag_stages),
      weight_(drag == Drag::in_stages ? 2.0 / drag_stage_room(options.drag_stages) : 1.0),
      exact_asked_(options.exact_steps),
      scales_masses_(options.mass_scaling_step && options.mass_scaling == MassScalingKind::fixed) {
  look_at_body();
  search_drag_limit();
  known_.rest.level = at_least_one(stiffening);
  known_.rest.limits = search(known_.rest.level);
  known_.undragged = undragged_step(known_.rest.level);
  remember_search();
  forget_searches();
}

bool StepLimits::is_bounded() const {
  return drag_ != Drag::at_once ||
         std::ranges::all_of(body_.blocks, [](const TissueBlock& block) { return is_small(block); });
}

/// Largest γ/m of a vertex [1/s].
double StepLimits::largest_damping_rate() const {
  double rate = 0.0;
  for (std::size_t i = 0; i < nodal_damping_.size(); ++i) {
    if (body_.masses[i] > 0.0) rate = std::max(rate, nodal_damping_[i] / body_.masses[i]);
  }
  return rate;
}

/// Masses, damping or tissues are new.
void StepLimits::look_at_body() {
  damping_rate_ = largest_damping_rate();
  known_.exact = exact_asked_ || !is_bounded();
  forget_searches();
}

/// The search at rest was the last one.
void StepLimits::remember_search() {
  known_.rest_guess = known_.guess;
  known_.searched = {known_.rest, block_numbers()};
}

/// φ(h) of the tissue is at most
/// 4 h/h₁ below a step h₁ it bears, 4 (h/h₁)² where nothing drags, and φ(h) + k h² + 2 c h ≤ 4 must hold.
double StepLimits::with_added(double step, const AddedStiffness& added) const {
  if (!(added.k > 0.0) && !(added.c > 0.0)) return step;
  const double k = weight_ * added.k;
  const bool drags = std::any_of(body_.blocks.begin(), body_.blocks.end(), [&](const TissueBlock& b) {
    const bool viscous = b.viscous.mu != 0.0 || b.viscous.lambda != 0.0;
    return (viscous && drag_ != Drag::in_stages) || !b.tissue.maxwell.empty();
  });
  if (!drags) return 1.0 / std::sqrt(1.0 / (step * step) + 0.25 * k);
  const double c = added.c + 2.0 / step;  // of k h² + 2 c h = 4
  return 4.0 / (c + std::sqrt(c * c + 4.0 * k));
}

/// Factors of C in φ (stable_step.h). A tissue of small strain keeps its viscous matrix; any other may have one up to
/// its stiffening times as large.
std::vector<double> StepLimits::viscosity_at(std::span<const double> level) const {
  std::vector<double> factor(body_.blocks.size(), 1.0);
  for (std::size_t b = 0; b < factor.size(); ++b) {
    if (!is_small(body_.blocks[b])) factor[b] = level[b];
    if (drag_ == Drag::at_once) factor[b] -= 2.0;
    if (drag_ == Drag::in_stages) factor[b] = 0.0;
  }
  return factor;
}

/// The stiffness that φ counts: with drag in stages h² K ≤ 2 room M is what φ ≤ 4 says of K times 2/room.
std::vector<double> StepLimits::weighed(std::span<const double> level) const {
  std::vector<double> counted(level.begin(), level.end());
  for (double& r : counted) r *= weight_;
  return counted;
}

/// n stages bear eigenvalues of h M⁻¹ C up to nearly n², where the explicit step of drag alone is that of 2.
double StepLimits::drag_limit_of(double explicit_step) const {
  return 0.5 * DragPolynomial(drag_stages_).end() * explicit_step;
}

/// It leaves no guess, since it looks for another mode than the searches after it.
void StepLimits::search_drag_limit() {
  if (drag_ != Drag::in_stages) return;
  const std::vector<double> none(body_.blocks.size(), 0.0), whole(none.size(), 1.0),
      undamped(nodal_damping_.size(), 0.0);
  known_.drag_limit = drag_limit_of(stable_step(body_, none, undamped, {}, nullptr, whole).step);
  known_.drag_searched = {known_.drag_limit, block_numbers()};
}

/// After a change of tissues, where a search takes too long: viscosities at most c and densities at least d times those of the search
/// leave d/c of its limit.
void StepLimits::scale_drag_limit() {
  if (drag_ != Drag::in_stages) return;
  const std::vector<double> now = block_numbers();
  const auto ratio = [](double a, double b) { return a > 0.0 ? a / b : 0.0; };  // ∞ where there was none
  double c = 0.0, d = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    const double *to = &now[5 * b], *from = &known_.drag_searched.numbers[5 * b];
    c = std::max({c, ratio(to[2], from[2]), ratio(to[3], from[3])});
    d = std::min(d, to[4] / from[4]);
  }
  const std::vector<double> none(body_.blocks.size(), 0.0), whole(none.size(), 1.0);
  const double scaled = scales_masses_ ? 0.0 : known_.drag_searched.limit * d / c;
  known_.drag_limit = std::max(std::isfinite(c) ? scaled : 0.0, drag_limit_of(element_bound_step(body_, none, whole)));
}

/// Whether viscosity that lags grows with the level of some block.
bool StepLimits::drag_thickens() const {
  return drag_ == Drag::lags && std::any_of(body_.blocks.begin(), body_.blocks.end(), thickens);
}

/// h* of a stiffness where nothing drags; 0 where that says no more than h* itself: no viscosity lags, or it grows with K, or K
/// stays what it is. From single elements where a search takes too long.
double StepLimits::undragged_step(std::span<const double> level) const {
  const auto drags = [](const TissueBlock& b) { return b.viscous.mu > 0.0 || b.viscous.lambda > 0.0; };
  if (drag_ != Drag::lags || drag_thickens() || std::ranges::none_of(body_.blocks, drags) ||
      std::ranges::all_of(body_.blocks, is_linear))
    return 0.0;
  const std::vector<double> none(body_.blocks.size(), 0.0), undamped(nodal_damping_.size(), 0.0);
  return known_.exact ? stable_step(body_, level, undamped, {}, nullptr, none).step
                      : element_bound_step(body_, level, none);
}

StepLimits::Limits StepLimits::search(std::span<const double> level) {
  const std::size_t i = searches_made_++;
  if (i < searches_.size() && std::ranges::equal(searches_[i].level, level)) {
    known_.guess = searches_[i].ended;
    return searches_[i].limits;
  }
  const Limits limits = search_anew(level);
  searches_.resize(std::min(i, searches_.size()));
  if (i < kSearchesKept) searches_.push_back({{limits, {level.begin(), level.end()}}, known_.guess});
  return limits;
}

StepLimits::Limits StepLimits::search_anew(std::span<const double> level) {
  const auto h = [&](StabilityGuess& guess, std::span<const double> viscosity) {
    // in stages damping is left out: it gives less room than φ counts for it
    const std::vector<double> undamped(drag_ == Drag::in_stages ? nodal_damping_.size() : 0, 0.0);
    const std::span<const double> damping = undamped.empty() ? std::span<const double>(nodal_damping_) : undamped;
    return stable_step(body_, weighed(level), damping, {}, &guess, viscosity).step;
  };
  const double stable = h(known_.guess.stable, viscosity_at(level));
  if (drag_ != Drag::at_once) return {stable, stable};
  return {stable, std::min(stable, h(known_.guess.pace, std::vector<double>(body_.blocks.size(), 0.0)))};
}

/// h* at this level from that at a known one, from below. With G ≤ g M a step h that
/// the damped body bears has φ(h) of the undamped one ≤ 4 + 2 h g, which is shortened away; where g is large, h/r says more.
/// Where C grows as K does, (h/r)² r K + 2 (h/r) r C ≤ h² K + 2 h C of the undamped one.
double StepLimits::pace_from(const Known& known, std::span<const double> level) const {
  double r = 1.0;
  for (std::size_t b = 0; b < known.level.size(); ++b) r = std::max(r, level[b] / known.level[b]);
  const double pace = known.limits.pace, undamped = 1.0 + 0.5 * pace * damping_rate_;
  if (drag_thickens()) return r > 1.0 ? pace / (r * undamped) : pace;
  const double h = pace * std::max(1.0 / r, 1.0 / (std::sqrt(r) * undamped));
  return known_.undragged > 0.0 ? std::max(h, beside_drag(pace / undamped, r, known.level)) : h;
}

StepLimits::Limits StepLimits::bound(const Known& now, std::span<const double> level) const {
  const double h = std::max(pace_from(now, level), pace_from(known_.rest, level));
  return {h, h};
}

/// What is left of a step h that is borne at a level when stiffness grows by r from there and viscosity does not.
double StepLimits::beside_drag(double h, double r, std::span<const double> level) const {
  double most = 1.0;
  for (std::size_t b = 0; b < level.size(); ++b) most = std::max(most, level[b] / known_.rest.level[b]);
  const double part = std::min(1.0, most * (h / known_.undragged) * (h / known_.undragged)), rest = 1.0 - part;
  return h * 2.0 / (rest + std::sqrt(rest * rest + 4.0 * part * r));
}

/// Single elements hold for any part of the body, by their own mass. @param shapes  elements that have changed theirs
void StepLimits::limit_drag_by_elements(std::span<const std::uint32_t> shapes) {
  if (drag_ != Drag::in_stages) return;
  if (!(drag_part_ > 0.0)) {
    const std::vector<double> none(body_.blocks.size(), 0.0), whole(none.size(), 1.0);
    drag_part_ = drag_limit_of(element_bound_step(body_, none, whole));
  }
  for (const std::uint32_t e : shapes) {
    drag_part_ = std::min(drag_part_, drag_limit_of(element_step(body_, body_.block_of(e), e, 0.0, 1.0)));
  }
  known_.drag_limit = std::min(known_.drag_limit, drag_part_);
}

void StepLimits::prepare_changes(const detail::VertexStars& stars) {
  const std::vector<double> one(body_.blocks.size(), 1.0);
  element_bound_ = std::make_unique<ElementStepBound>(body_, stars, viscosity_at(one));
}

void StepLimits::mesh_changed(const BodyChange& change, const detail::VertexStars& stars, Known& now) {
  known_.undragged = 0.0;
  if (!change.origins.empty()) known_.guess = known_.rest_guess = {};
  if (damping_rate_ > 0.0) damping_rate_ = largest_damping_rate();  // a body without damping gets none by a cut
  forget_searches();
  if (element_bound_ == nullptr) prepare_changes(stars);
  element_bound_->change(change);
  const double part = element_bound_->step() / std::sqrt(weight_);
  limit_drag_by_elements(change.reshaped);
  // with stiffness r times that at rest: (h/√r)² r K + 2 (h/√r) C ≤ h² K + 2 h C, and h/r where C is r times as large, too
  for (Known* known : {&now, &known_.rest}) {
    const double r = *std::max_element(known->level.begin(), known->level.end());
    const double h = part / (drag_thickens() ? r : std::sqrt(r));
    known->limits = {std::min(known->limits.stable, h), std::min(known->limits.pace, h)};
  }
  known_.searched = {known_.rest, block_numbers()};
}

std::vector<double> StepLimits::block_numbers() const {
  std::vector<double> numbers;
  for (const TissueBlock& b : body_.blocks) {
    const auto bulk = [](const LameParameters& l) { return l.lambda + 2.0 / 3.0 * l.mu; };
    numbers.insert(numbers.end(), {b.elastic.mu, bulk(b.elastic), b.viscous.mu, bulk(b.viscous), b.tissue.density});
  }
  return numbers;
}

/// h* of the present tissues at a level of stiffness, from the last search and from below; 0 where that says nothing.
StepLimits::Limits StepLimits::scaled_from_search(std::span<const double> level) const {
  const std::vector<double> now = block_numbers();
  const auto ratio = [](double a, double b) { return a > 0.0 ? a / b : 0.0; };  // ∞ where there was none
  double r = 0.0, c = 0.0, d = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < level.size(); ++b) {
    const double *to = &now[5 * b], *from = &known_.searched.numbers[5 * b];
    const double rise = level[b] / known_.searched.level[b], thicker = is_small(body_.blocks[b]) ? 1.0 : rise;
    r = std::max(r, rise * std::max(ratio(to[0], from[0]), ratio(to[1], from[1])));
    if (drag_ == Drag::lags) c = std::max({c, thicker * ratio(to[2], from[2]), thicker * ratio(to[3], from[3])});
    d = std::min(d, to[4] / from[4]);
  }
  double s = std::max(std::sqrt(r / d), c / d);
  const double g = std::min(1.0, d);
  const bool damped = std::any_of(nodal_damping_.begin(), nodal_damping_.end(), [](double x) { return x > 0.0; });
  if (damped && s * d > g) s = c <= g ? std::max(s, r / g) : std::numeric_limits<double>::infinity();
  const double h = scales_masses_ || !std::isfinite(s) ? 0.0 : known_.searched.limits.pace / s;
  return {h, h};
}

StepLimits::Known StepLimits::choose(std::span<const double> stiffening, bool undeformed) {
  look_at_body();
  const std::vector<double> present = at_least_one(stiffening);
  Known& rest = known_.rest;
  rest.level = undeformed ? present : std::vector<double>(body_.blocks.size(), 1.0);
  Known now{{}, present == rest.level ? present : with_room(stiffening, 1.0)};
  const auto scaled = [&](const std::vector<double>& level) {
    Limits limits = scaled_from_search(level);
    if (limits.pace * kWorthALook > known_.searched.limits.pace) return limits;
    const double h = std::max(limits.pace, element_bound_step(body_, weighed(level), viscosity_at(level)));
    return Limits{h, h};
  };
  if (known_.exact) known_.guess = {};
  known_.exact ? search_drag_limit() : scale_drag_limit();
  rest.limits = known_.exact ? search(rest.level) : scaled(rest.level);
  known_.undragged = undragged_step(rest.level);
  if (known_.exact) remember_search();
  now.limits = known_.exact ? (now.level == rest.level ? rest.limits : search(now.level)) : scaled(now.level);
  return now;
}

std::vector<double> StepLimits::with_room(std::span<const double> seen, double ahead) const {
  std::vector<double> level = at_least_one(seen);
  for (std::size_t b = 0; b < level.size(); ++b) {
    if (!is_linear(body_.blocks[b])) level[b] = std::max(known_.rest.level[b], kStiffeningMargin * ahead * level[b]);
  }
  return level;
}

std::vector<char> StepLimits::thickening() const {
  std::vector<char> viscous;
  for (const TissueBlock& block : body_.blocks) viscous.push_back(thickens(block) ? 1 : 0);
  return viscous;
}

void StepLimits::tissues_taken() {
  element_bound_.reset();
  drag_part_ = 0.0;
  forget_searches();
}

void StepLimits::start_anew() {
  known_.guess = known_.rest_guess;
  searches_made_ = 0;
}

void StepLimits::body_read(const detail::VertexStars* stars) {
  look_at_body();
  element_bound_.reset();
  if (stars != nullptr) prepare_changes(*stars);
}

void StepLimits::archive(Archive& ar) {
  ar(known_.undragged, known_.drag_limit, known_.rest, known_.searched);
  ar.same_size(known_.searched.numbers);
  for (StabilityGuess* g :
       {&known_.guess.stable, &known_.guess.pace, &known_.rest_guess.stable, &known_.rest_guess.pace}) {
    ar(g->mode, g->step);
    ar.check(g->mode.empty() || g->mode.size() == 3 * body_.vertex_count);
  }
  ar(drag_part_, known_.drag_searched.limit);
  ar.same_size(known_.drag_searched.numbers);
  if (element_bound_ != nullptr) ar(*element_bound_);
  if (ar.reads()) searches_made_ = kSearchesKept;
}

}  // namespace glisson
