#include "dynamics/step/mass_levels.h"

#include <algorithm>

#include "dynamics/step/stable_step.h"
#include "dynamics/step/step_rules.h"

namespace glisson {
namespace {

constexpr float kRoom = 1.1F;     ///< of a level over the stiffness seen
constexpr float kEnough = 1.05F;  ///< of it, from which a level stays as it is
constexpr float kTold = 0.98F;    ///< of a level, from which a tet has to be told

/// Gives a level room over what was seen.
void give_room(float& level, float seen) {
  if (level < kEnough * seen) level = kRoom * seen;
}

}  // namespace

void MassLevels::body_changed() {
  tets_.assign(body_.elements.size(), {});
  limits_.assign(tets_.size(), {});
  fresh_ = true;
  weights_.resize(tets_.size());
  rates_.clear();
  for (std::uint32_t e = 0; e < tets_.size(); ++e) measure(e);
}

void MassLevels::measure(std::uint32_t element) {
  const ElementRest& rest = body_.rest[element];
  std::array<double, 4>& weight = weights_[element];
  weight = {};
  if (!(rest.volume > 0.0)) return;
  const std::array<Vec3d, 4> s = shape_gradients(rest);
  Sym3<double> sum;
  for (const Vec3d& gradient : s) sum += outer_square(gradient) * (1.0 / dot(gradient, gradient));
  const double per_square = 0.25 * rest.volume * largest_eigenvalue(sum);
  for (std::size_t a = 0; a < 4; ++a) weight[a] = per_square * dot(s[a], s[a]);
}

void MassLevels::limit(std::uint32_t element) {
  const StiffLimit& level = tets_[element].level;
  limits_[element] = {kTold * level.ratio, kTold * level.norm};
}

bool MassLevels::bear(std::span<const StiffElement> stiff, std::span<const double> base) const {
  const bool one = base.size() == 1;
  return std::ranges::all_of(stiff, [&](const StiffElement& s) {
    return tets_[s.element].level.covers(s) || !(s.ratio > base[one ? 0 : block_index(body_, s.element)]);
  });
}

double MassLevels::raise(std::span<const StiffElement> stiff, std::span<const double> base,
                         std::span<const double> unseen) {
  double rise = 1.0;
  const bool one = base.size() == 1;
  for (const StiffElement& s : stiff) {
    Tet& tet = tets_[s.element];
    const std::size_t block = one ? 0 : block_index(body_, s.element);
    const double before = fresh_ ? s.ratio : (tet.last > 0.0F ? double(tet.last) : unseen[block]);
    if (s.ratio > base[block] && !tet.level.covers(s)) rise = std::max(rise, s.ratio / std::max(1.0, before));
    tet.last = static_cast<float>(s.ratio);
    tet.seen = {std::max(tet.seen.ratio, tet.last), std::max(tet.seen.norm, static_cast<float>(s.norm))};
    give_room(tet.level.ratio, tet.seen.ratio);
    give_room(tet.level.norm, tet.seen.norm);
    limit(s.element);
  }
  fresh_ = false;
  return rise;
}

void MassLevels::tell(std::uint32_t part) {
  std::fill(limits_.begin() + begin_of(part), limits_.begin() + begin_of(part + 1), StiffLimit{});
}

void MassLevels::settle(std::uint32_t part) {
  for (std::uint32_t e = begin_of(part); e < begin_of(part + 1); ++e) {
    Tet& tet = tets_[e];
    tet.level = {std::min(tet.level.ratio, kRoom * tet.seen.ratio), std::min(tet.level.norm, kRoom * tet.seen.norm)};
    if (tet.seen.ratio == 0.0F) tet.last = 0.0F;
    tet.seen = {};
    limit(e);
  }
}

void MassLevels::find_rates() {
  rates_.resize(tets_.size());
  for (const TissueBlock& block : body_.blocks) {
    for (std::size_t e = block.begin; e < block.end; ++e) {
      if (!(body_.rest[e].volume > 0.0)) continue;
      const double k = element_step(body_, block, e, 1.0, 0.0), c = element_step(body_, block, e, 0.0, 1.0),
                   mass = body_.quarter_mass(block, e);
      rates_[e] = {mass, mass * 4.0 / (k * k), mass * 2.0 / c};
    }
  }
}

/// What elements need at the level of their block beyond their own mass; known, unless the step or a level is another one.
void MassLevels::ask_for_blocks(std::span<const double> base, const std::vector<char>& viscous, const MassNeed& need) {
  if (!rates_.empty() && need.asks_the_same(known_) && std::ranges::equal(base, known_base_)) return;
  if (rates_.empty()) find_rates();
  known_ = need, known_.beside = nullptr;
  known_base_.assign(base.begin(), base.end());
  asked_for_blocks_.assign(body_.vertex_count, 0.0);
  const double h = need.step, staged = need.drag_end > 0.0 ? h / need.drag_end : 0.0;
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    const double stiff = need.at_level ? 0.25 * need.weight * h * h * base[b] : 0.0,
                 drag = need.at_level && need.drags ? 0.5 * h * (viscous[b] != 0 ? base[b] : 1.0) : 0.0;
    for (std::size_t e = body_.blocks[b].begin; e < body_.blocks[b].end; ++e) {
      const Rates& own = rates_[e];
      const double more = std::max(stiff * own.stiff + drag * own.drag, staged * own.drag) - own.mass;
      if (!(more > 0.0)) continue;
      for (const std::uint32_t v : body_.elements[e]) asked_for_blocks_[v] += more;
    }
  }
}

void MassLevels::find_masses(std::span<const double> base, const std::vector<char>& viscous, const MassNeed& need,
                             std::vector<VertexMass>& masses) {
  if (need.at_level || need.drag_end > 0.0) {
    ask_for_blocks(base, viscous, need);
    asked_ = asked_for_blocks_;
  } else {
    asked_.assign(body_.vertex_count, 0.0);
  }
  const double h = need.step;
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    const TissueBlock& block = body_.blocks[b];
    const double stiff = need.weight * h * h * modulus_bound(block.elastic),
                 drag = viscous[b] != 0 ? 2.0 * h * modulus_bound(block.viscous) : 0.0;
    for (std::size_t e = block.begin; e < block.end; ++e) {
      const double more = double(tets_[e].level.ratio) - base[b];
      if (!(more > 0.0)) continue;
      const double per_weight = stiff * std::min(more, double(tets_[e].level.norm)) + drag * more;
      for (std::size_t a = 0; a < 4; ++a) asked_[body_.elements[e][a]] += per_weight * weights_[e][a];
    }
  }
  if (need.beside != nullptr) need.beside->add_masses(0.25 * need.weight * h * h, asked_);
  masses.clear();
  for (std::uint32_t v = 0; v < asked_.size(); ++v) {
    if (asked_[v] > 0.0) masses.push_back({v, asked_[v]});
  }
}

void MassLevels::clear() {
  std::ranges::fill(tets_, Tet{});
  std::ranges::fill(limits_, StiffLimit{});
  fresh_ = true;
}

void MassLevels::remove(std::span<const std::uint32_t> elements) {
  // The next pass may still tell of them, as they were: they ask for no mass.
  for (const std::uint32_t e : elements) tets_[e] = {}, limits_[e] = {}, weights_[e] = {};
  rates_.clear();
}

void MassLevels::reshape(std::span<const std::uint32_t> elements) {
  rates_.clear();
  for (const std::uint32_t e : elements) measure(e);
}

void MassLevels::archive(Archive& ar) {
  ar.same_size(tets_);
  ar(fresh_);
  if (!ar.reads()) return;
  for (std::uint32_t e = 0; e < tets_.size(); ++e) limit(e);
}

}  // namespace glisson
