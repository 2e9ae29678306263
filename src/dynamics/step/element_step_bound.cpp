#include "dynamics/step/element_step_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dynamics/step/stable_step.h"
#include "dynamics/step/step_rules.h"

namespace glisson {
namespace {

constexpr std::size_t kRun = 32;      ///< elements of which the least step is kept
constexpr double kMassMargin = 1.05;  ///< of asked over mass that a bound is made for
constexpr double kSlack = 0.8;        ///< below this share of what was allowed for a better bound is worth a look

}  // namespace

ElementStepBound::ElementStepBound(const Body& body, const detail::VertexStars& stars, std::vector<double> viscosity)
    : body_(body), stars_(stars), asks_(body.elements.size()), asked_(body.vertex_count, 0.0), allowed_(asked_),
      steps_(body.elements.size()), least_((steps_.size() + kRun - 1) / kRun) {
  for (std::size_t b = 0; b < body.blocks.size(); ++b) {
    elastic_.push_back(modulus_bound(body.blocks[b].elastic));
    viscous_.push_back(std::max(0.0, viscosity[b]) * modulus_bound(body.blocks[b].viscous));
  }
  for (std::uint32_t e = 0; e < asks_.size(); ++e) ask(e);
  for (std::uint32_t v = 0; v < asked_.size(); ++v) weigh(v);
  bound_all();
}

void ElementStepBound::bound_all() {
  for (std::uint32_t e = 0; e < steps_.size(); ++e) bound(e);
  std::vector<std::uint32_t> all(steps_.size());
  std::iota(all.begin(), all.end(), 0U);
  find_least(all);
}

void ElementStepBound::ask(std::uint32_t e) {
  const std::array<Vec3d, 4> s = shape_gradients(body_.rest[e]);
  const double scale = body_.rest[e].volume * elastic_[block_index(body_, e)];
  for (std::size_t c = 0; c < 4; ++c) asks_[e][c] = static_cast<float>(scale * dot(s[c], s[c]));
}

void ElementStepBound::weigh(std::uint32_t vertex) {
  double sum = 0.0;
  for (const std::uint32_t e : stars_.tets_at(vertex)) {
    const auto corner = static_cast<std::size_t>(std::find(body_.elements[e].begin(), body_.elements[e].end(), vertex) -
                                                 body_.elements[e].begin());
    sum += asks_[e][corner];
  }
  asked_[vertex] = sum;
  allowed_[vertex] = body_.masses[vertex] > 0.0 ? kMassMargin * sum / body_.masses[vertex] : 0.0;
}

void ElementStepBound::bound(std::uint32_t e) {
  Steps& steps = steps_[e];
  steps.shared = kNever;
  const ElementRest& rest = body_.rest[e];
  if (!(rest.volume > 0.0)) return;
  const std::size_t b = block_index(body_, e);
  const std::array<Vec3d, 4> s = shape_gradients(rest);
  Sym3<double> shared, own;  // Σ s sᵀ/W
  for (std::size_t c = 0; c < 4; ++c) {
    const Sym3<double> square = outer_square(s[c]);
    shared += square * (allowed_[body_.elements[e][c]] / asks_[e][c]);
    if (steps.own == kNever) own += square * (1.0 / body_.quarter_mass(body_.blocks[b], e));
  }
  const auto step = [&](const Sym3<double>& sum) {
    const double per_modulus = rest.volume * largest_eigenvalue(sum);
    return damped_step(elastic_[b] * per_modulus, viscous_[b] * per_modulus);
  };
  steps.shared = step(shared);
  if (steps.own == kNever) steps.own = step(own);
}

/// Least steps of runs of elements that hold some of these, ascending.
void ElementStepBound::find_least(std::span<const std::uint32_t> elements) {
  std::size_t done = std::numeric_limits<std::size_t>::max();
  for (const std::uint32_t e : elements) {
    const std::size_t run = e / kRun, begin = run * kRun;
    if (run == done) continue;
    done = run;
    least_[run] = least(std::span(steps_).subspan(begin, std::min(kRun, steps_.size() - begin)));
  }
}

void ElementStepBound::look_around(std::uint32_t vertex, std::vector<std::uint32_t>& around) {
  const auto star = stars_.tets_at(vertex);
  around.insert(around.end(), star.begin(), star.end());
}

/// Elements are gone: their vertices have less mass, and less is asked of it.
void ElementStepBound::take_out(const BodyChange& change, std::vector<std::uint32_t>& around) {
  for (const std::uint32_t e : change.removed) {
    for (std::size_t c = 0; c < 4; ++c) asked_[body_.elements[e][c]] -= asks_[e][c];
  }
  for (const std::uint32_t v : change.touched) {
    const double mass = body_.masses[v];
    if (!(mass > 0.0) || (asked_[v] <= allowed_[v] * mass && asked_[v] >= kSlack * allowed_[v] * mass)) continue;
    allowed_[v] = kMassMargin * asked_[v] / mass;
    look_around(v, around);
  }
}

void ElementStepBound::change(const BodyChange& change) {
  asked_.resize(body_.vertex_count, 0.0);
  allowed_.resize(body_.vertex_count, 0.0);
  std::vector<std::uint32_t> around = change.removed;
  for (const auto* list : {&change.removed, &change.reshaped}) {
    for (const std::uint32_t e : *list) steps_[e].own = kNever;
  }
  if (change.corners.empty() && change.reshaped.empty()) {
    take_out(change, around);
  } else {
    for (const std::uint32_t e : change.reshaped) ask(e);
    for (const std::uint32_t v : change.touched) {
      weigh(v);
      look_around(v, around);
    }
  }
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  for (const std::uint32_t e : around) bound(e);
  find_least(around);
}

void ElementStepBound::archive(Archive& ar) {
  ar.same_size(asked_), ar.same_size(allowed_);
  if (ar.reads()) bound_all();
}

ElementStepBound::Steps ElementStepBound::least(std::span<const Steps> of) {
  Steps least;
  for (const Steps& s : of) least = {std::min(least.shared, s.shared), std::min(least.own, s.own)};
  return least;
}

double ElementStepBound::step() const {
  const Steps all = least(least_);
  return std::max(all.shared, all.own);
}

}  // namespace glisson
