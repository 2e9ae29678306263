#include "dynamics/step/step_control.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
#include <sstream>
#include <stdexcept>

#include "dynamics/step/step_rules.h"
#include "element/drag_stages.h"

namespace glisson {
namespace {

constexpr double kWorthALook = 2.0;       ///< how much shorter a scaled step is that single elements may better
constexpr std::size_t kSearchesKept = 4;  ///< since steps were chosen anew

}  // namespace

StepControl::StepControl(const Body& body, const std::vector<double>& nodal_damping, Drag drag,
                         const SimulationOptions& options, std::span<const double> stiffening)
    : body_(body), nodal_damping_(nodal_damping), drag_(drag), drag_stages_(options.drag_stages),
      weight_(drag == Drag::in_stages ? 2.0 / drag_stage_room(options.drag_stages) : 1.0), automatic_(!options.step),
      enforce_(options.enforce_stability), exact_asked_(options.exact_steps),
      scales_masses_(options.mass_scaling_step && options.mass_scaling == MassScalingKind::fixed), levels_(body),
      bearable_inertia_(options.mass_scaling_inertia) {
  if (options.mass_scaling == MassScalingKind::variable) heavy_step_ = options.mass_scaling_step;
  if (heavy_step_) mass_levels_.emplace(body);
  look_at_body();
  search_drag_limit();
  rest_.level = at_least_one(stiffening);
  rest_.limits = limits_at(rest_.level);
  undragged_ = undragged_step(rest_.level);
  now_ = rest_;
  remember_search();
  step_ = options.step.value_or(kSafety * now_.limits.pace);
  if (heavy_step_) choose_heavy(*heavy_step_);
  const double stable = std::min(now_.limits.stable, drag_limit());
  if (enforce_ && !automatic_ && step_ > stable) refuse_above(stable);
  forget_searches();
  start_anew();
}

/// Whether limits at a level follow from those at another: where C stays what it is, or its force lags.
bool StepControl::is_bounded() const {
  return drag_ != Drag::at_once ||
         std::ranges::all_of(body_.blocks, [](const TissueBlock& block) { return is_small(block); });
}

/// Largest γ/m of a vertex [1/s].
double StepControl::largest_damping_rate() const {
  double rate = 0.0;
  for (std::size_t i = 0; i < nodal_damping_.size(); ++i) {
    if (body_.masses[i] > 0.0) rate = std::max(rate, nodal_damping_[i] / body_.masses[i]);
  }
  return rate;
}

/// Masses, damping or tissues are new.
void StepControl::look_at_body() {
  damping_rate_ = largest_damping_rate();
  exact_ = exact_asked_ || !is_bounded();
  forget_searches();
}

/// The search at rest was the last one.
void StepControl::remember_search() {
  rest_guess_ = guess_;
  searched_ = {rest_, block_numbers()};
}

/// What is left of a step h of the tissue alone when stiffness k and viscosity c act beside it. φ(h) of the tissue is at most
/// 4 h/h₁ below a step h₁ it bears, 4 (h/h₁)² where nothing drags, and φ(h) + k h² + 2 c h ≤ 4 must hold.
double StepControl::with_added(double step, const AddedStiffness& added) const {
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

std::string StepControl::too_large(double stable) const {
  std::ostringstream text;
  text << "step = " << step_ << " s is above the stable step h* = " << stable
       << " s of this mesh and tissue, and the run would be unstable. Ways out: a smaller step, or \"auto\", which "
          "takes "
       << kSafety << " h*; the integrator ";
  if (drag_ == Drag::lags) {
    text << "\"semi_implicit\", or drag_stages of 2 to " << kMostDragStages << " (beside needles and containers "
         << kMostDragStagesBesideInstruments << ", beside tools in contact and blades " << kMostDragStagesBesideOthers
         << " at most), where viscosity is what limits "
         << "h*; ";
  }
  text << "\"implicit\", which is stable at any step; less viscosity or more nodal damping, which raise h*; a larger "
       << "density, or mass scaling of the smallest tets, where the inertia of the tissue does not matter, h* growing "
       << "with its square root";
  return text.str();
}

/// Factors of C in φ (stable_step.h). A tissue of small strain keeps its viscous matrix; any other may have one up to
/// its stiffening times as large.
std::vector<double> StepControl::viscosity_at(std::span<const double> stiffening) const {
  std::vector<double> factor(body_.blocks.size(), 1.0);
  for (std::size_t b = 0; b < factor.size(); ++b) {
    if (!is_small(body_.blocks[b])) factor[b] = stiffening[b];
    if (drag_ == Drag::at_once) factor[b] -= 2.0;
    if (drag_ == Drag::in_stages) factor[b] = 0.0;
  }
  return factor;
}

/// The stiffness that φ counts: with drag in stages h² K ≤ 2 room M is what φ ≤ 4 says of K times 2/room.
std::vector<double> StepControl::weighed(std::span<const double> stiffening) const {
  std::vector<double> level(stiffening.begin(), stiffening.end());
  for (double& r : level) r *= weight_;
  return level;
}

/// n stages bear eigenvalues of h M⁻¹ C up to nearly n², where the explicit step of drag alone is that of 2.
double StepControl::drag_limit_of(double explicit_step) const {
  return 0.5 * DragPolynomial(drag_stages_).end() * explicit_step;
}

/// It leaves no guess, since it looks for another mode than the searches after it.
void StepControl::search_drag_limit() {
  if (drag_ != Drag::in_stages) return;
  const std::vector<double> none(body_.blocks.size(), 0.0), whole(none.size(), 1.0),
      undamped(nodal_damping_.size(), 0.0);
  drag_limit_ = drag_limit_of(glisson::stable_step(body_, none, undamped, {}, nullptr, whole).step);
  drag_searched_ = {drag_limit_, block_numbers()};
}

/// After a change of tissues, where a search takes too long: viscosities at most c and densities at least d times those of the search
/// leave d/c of its limit.
void StepControl::scale_drag_limit() {
  if (drag_ != Drag::in_stages) return;
  const std::vector<double> now = block_numbers();
  const auto ratio = [](double a, double b) { return a > 0.0 ? a / b : 0.0; };  // ∞ where there was none
  double c = 0.0, d = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    const double *to = &now[5 * b], *from = &drag_searched_.numbers[5 * b];
    c = std::max({c, ratio(to[2], from[2]), ratio(to[3], from[3])});
    d = std::min(d, to[4] / from[4]);
  }
  const std::vector<double> none(body_.blocks.size(), 0.0), whole(none.size(), 1.0);
  const double scaled = scales_masses_ ? 0.0 : drag_searched_.limit * d / c;
  drag_limit_ = std::max(std::isfinite(c) ? scaled : 0.0, drag_limit_of(element_bound_step(body_, none, whole)));
}

/// Whether viscosity that lags grows with the level of some block.
bool StepControl::drag_thickens() const {
  return drag_ == Drag::lags && std::any_of(body_.blocks.begin(), body_.blocks.end(), thickens);
}

/// h* of a stiffness where nothing drags; 0 where that says no more than h* itself: no viscosity lags, or it grows with K, or K
/// stays what it is. From single elements where a search takes too long.
double StepControl::undragged_step(std::span<const double> level) const {
  const auto drags = [](const TissueBlock& b) { return b.viscous.mu > 0.0 || b.viscous.lambda > 0.0; };
  if (drag_ != Drag::lags || drag_thickens() || std::ranges::none_of(body_.blocks, drags) ||
      std::ranges::all_of(body_.blocks, is_linear))
    return 0.0;
  const std::vector<double> none(body_.blocks.size(), 0.0), undamped(nodal_damping_.size(), 0.0);
  return exact_ ? glisson::stable_step(body_, level, undamped, {}, nullptr, none).step
                : element_bound_step(body_, level, none);
}

/// The same searches follow from the same start: those that were made then need not be made again.
StepControl::Limits StepControl::limits_at(std::span<const double> stiffening) {
  const std::size_t i = searches_made_++;
  if (i < searches_.size() && std::ranges::equal(searches_[i].level, stiffening)) {
    guess_ = searches_[i].ended;
    return searches_[i].limits;
  }
  const Limits limits = search(stiffening);
  searches_.resize(std::min(i, searches_.size()));
  if (i < kSearchesKept) searches_.push_back({{limits, {stiffening.begin(), stiffening.end()}}, guess_});
  return limits;
}

StepControl::Limits StepControl::search(std::span<const double> stiffening) {
  const auto h = [&](StabilityGuess& guess, std::span<const double> viscosity) {
    // in stages damping is left out: it gives less room than φ counts for it
    const std::vector<double> undamped(drag_ == Drag::in_stages ? nodal_damping_.size() : 0, 0.0);
    const std::span<const double> damping = undamped.empty() ? std::span<const double>(nodal_damping_) : undamped;
    return glisson::stable_step(body_, weighed(stiffening), damping, {}, &guess, viscosity).step;
  };
  const double stable = h(guess_.stable, viscosity_at(stiffening));
  if (drag_ != Drag::at_once) return {stable, stable};
  return {stable, std::min(stable, h(guess_.pace, std::vector<double>(body_.blocks.size(), 0.0)))};
}

/// h* at this level from that at a known one, from below. With G ≤ g M a step h that
/// the damped body bears has φ(h) of the undamped one ≤ 4 + 2 h g, which is shortened away; where g is large, h/r says more.
/// Where C grows as K does, (h/r)² r K + 2 (h/r) r C ≤ h² K + 2 h C of the undamped one.
double StepControl::pace_from(const Known& known, std::span<const double> stiffening) const {
  double r = 1.0;
  for (std::size_t b = 0; b < known.level.size(); ++b) r = std::max(r, stiffening[b] / known.level[b]);
  const double pace = known.limits.pace, undamped = 1.0 + 0.5 * pace * damping_rate_;
  if (drag_thickens()) return r > 1.0 ? pace / (r * undamped) : pace;
  const double h = pace * std::max(1.0 / r, 1.0 / (std::sqrt(r) * undamped));
  return undragged_ > 0.0 ? std::max(h, beside_drag(pace / undamped, r, known.level)) : h;
}

/// From the validated level or that at rest, whichever gives more.
StepControl::Limits StepControl::bound_at(std::span<const double> stiffening) const {
  const double h = std::max(pace_from(now_, stiffening), pace_from(rest_, stiffening));
  return {h, h};
}

/// What is left of a step h that is borne at a level when stiffness grows by r from there and viscosity does not.
double StepControl::beside_drag(double h, double r, std::span<const double> level) const {
  double most = 1.0;
  for (std::size_t b = 0; b < level.size(); ++b) most = std::max(most, level[b] / rest_.level[b]);
  const double part = std::min(1.0, most * (h / undragged_) * (h / undragged_)), rest = 1.0 - part;
  return h * 2.0 / (rest + std::sqrt(rest * rest + 4.0 * part * r));
}

/// Single elements hold for any part of the body, by their own mass. @param shapes  elements that have changed theirs
void StepControl::limit_drag_by_elements(std::span<const std::uint32_t> shapes) {
  if (drag_ != Drag::in_stages) return;
  if (!(drag_part_ > 0.0)) {
    const std::vector<double> none(body_.blocks.size(), 0.0), whole(none.size(), 1.0);
    drag_part_ = drag_limit_of(element_bound_step(body_, none, whole));
  }
  for (const std::uint32_t e : shapes) {
    drag_part_ = std::min(drag_part_, drag_limit_of(element_step(body_, body_.block_of(e), e, 0.0, 1.0)));
  }
  drag_limit_ = std::min(drag_limit_, drag_part_);
}

void StepControl::prepare_changes(const detail::VertexStars& stars) {
  const std::vector<double> one(body_.blocks.size(), 1.0);
  element_bound_ = std::make_unique<ElementStepBound>(body_, stars, viscosity_at(one));
}

void StepControl::mesh_changed(const BodyChange& change, const detail::VertexStars& stars) {
  undragged_ = 0.0;
  if (!change.origins.empty()) guess_ = rest_guess_ = {};
  if (damping_rate_ > 0.0) damping_rate_ = largest_damping_rate();  // a body without damping gets none by a cut
  forget_searches();
  if (element_bound_ == nullptr) prepare_changes(stars);
  element_bound_->change(change);
  const double part = element_bound_->step() / std::sqrt(weight_);
  limit_drag_by_elements(change.reshaped);
  // with stiffness r times that at rest: (h/√r)² r K + 2 (h/√r) C ≤ h² K + 2 h C, and h/r where C is r times as large, too
  for (Known* known : {&now_, &rest_}) {
    const double r = *std::max_element(known->level.begin(), known->level.end());
    const double h = part / (drag_thickens() ? r : std::sqrt(r));
    known->limits = {std::min(known->limits.stable, h), std::min(known->limits.pace, h)};
  }
  searched_ = {rest_, block_numbers()};
  if (automatic_ && !heavy_step_) step_ = std::min(step_, kSafety * now_.limits.pace);
  levels_.remove(change.removed);
  levels_.reshape(change.reshaped);
  if (mass_levels_) {
    mass_levels_->remove(change.removed), mass_levels_->reshape(change.reshaped);
    choose_heavy(step_);
  }
  take_stiff();
  unchecked_ = enforce_ && step_ > (automatic_ ? now_.limits.stable : std::min(now_.limits.stable, drag_limit()));
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
    const double rise = level[b] / searched_.level[b], thicker = is_small(body_.blocks[b]) ? 1.0 : rise;
    r = std::max(r, rise * std::max(ratio(to[0], from[0]), ratio(to[1], from[1])));
    if (drag_ == Drag::lags) c = std::max({c, thicker * ratio(to[2], from[2]), thicker * ratio(to[3], from[3])});
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
  const std::vector<double> now = at_least_one(stiffening);
  rest_.level = undeformed ? now : std::vector<double>(body_.blocks.size(), 1.0);
  now_.level = now == rest_.level ? now : level_of(stiffening, 1.0);
  const auto bound = [&](const std::vector<double>& level) {
    Limits limits = scaled_from_search(level);
    if (limits.pace * kWorthALook > searched_.limits.pace) return limits;
    const double h = std::max(limits.pace, element_bound_step(body_, weighed(level), viscosity_at(level)));
    return Limits{h, h};
  };
  if (exact_) guess_ = {};
  exact_ ? search_drag_limit() : scale_drag_limit();
  rest_.limits = exact_ ? limits_at(rest_.level) : bound(rest_.level);
  undragged_ = undragged_step(rest_.level);
  if (exact_) remember_search();
  now_.limits = exact_ ? (now_.level == rest_.level ? rest_.limits : limits_at(now_.level)) : bound(now_.level);
}

void StepControl::tissues_changed(std::span<const double> stiffening, bool undeformed) {
  const StepChoice before = *this;
  stiff_ = {};  // the level of the blocks is chosen for all tets
  look_at_body();
  choose_limits(stiffening, undeformed);
  if (!automatic_ && enforce_ && step_ > stable_step()) {
    now_.level = at_least_one(stiffening);  // without a safety factor
    now_.limits = limits_at(now_.level);
    const double h = stable_step();
    if (step_ > h) {
      static_cast<StepChoice&>(*this) = before;
      refuse_above(h);
    }
  }
  if (automatic_) step_ = kSafety * now_.limits.pace;
  if (heavy_step_) mass_levels_->tissues_changed(), choose_heavy(*heavy_step_);
  element_bound_.reset();
  drag_part_ = 0.0;
  unchecked_ = false;
  forget_searches();
  start_anew();
}

void StepControl::body_read(const detail::VertexStars* stars) {
  look_at_body();
  if (mass_levels_) mass_levels_->body_changed();
  element_bound_.reset();
  if (stars != nullptr) prepare_changes(*stars);
}

void StepControl::archive(Archive& ar) {
  ar(step_, window_, in_window_, unchecked_, caution_, shape_step_, held_, undragged_, drag_limit_, now_.limits,
     rest_.limits, searched_.limits);
  for (auto* list : {&now_.level, &rest_.level, &seen_, &lately_, &searched_.level, &searched_.numbers}) {
    ar.same_size(*list);
  }
  for (StabilityGuess* g : {&guess_.stable, &guess_.pace, &rest_guess_.stable, &rest_guess_.pace}) {
    ar(g->mode, g->step);
    ar.check(g->mode.empty() || g->mode.size() == 3 * body_.vertex_count);
  }
  ar(probe_, since_probe_, probes_, levels_, drag_part_, drag_searched_.limit);
  ar.same_size(drag_searched_.numbers);
  if (mass_levels_) {
    ar(*mass_levels_, masses_are_new_, bears_added_, heavy_growth_, pause_, since_came_, since_gone_),
        ar.same_size(listed_before_);
    added_levels_.archive(ar, body_.vertex_count);
  }
  if (element_bound_ != nullptr) ar(*element_bound_);
  if (!ar.reads()) return;
  searches_made_ = kSearchesKept;
  tell_heavy();
  if (heavy_step_ && !masses_are_new_)
    return list_from();  // the masses are the body's, from levels that have come down since
  take_stiff();
}

bool StepControl::accept(std::span<const double> stiffening, std::span<const StiffElement> stiff) {
  if (!enforce_) return true;
  for (const double r : stiffening) {
    if (!std::isfinite(r)) return true;  // the state is beyond repair; the step reports that it is not finite
  }
  if (heavy_step_) {
    bear(stiffening, stiff);
    return true;
  }
  const std::span<const StiffElement> few = without_crowd(stiff);
  const StiffnessLevels::Met met = levels_.meet(few, now_.level, crowd_.empty() ? usual_ : crowd_);
  if (met.above || is_crowded() || unchecked_) {
    if (!rises(stiffening, met.rise)) return false;
  } else {
    be_cautious(1.0);
  }
  if (automatic_) {
    probe();
    relax(stiffening);
  }
  return automatic_ || step_ <= stable_step();
}

}  // namespace glisson
