#include "dynamics/step/stiffness_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "dynamics/step/stable_step.h"
#include "dynamics/step/step_rules.h"

namespace glisson {
namespace {

constexpr double kLevelMargin = 1.05, kMostLevelMargin = 3.0;  ///< of a level above the stiffness seen

/// Σ s sᵀ/W with the shares W of the masses, W_a = m_a of_a/asked_a.
Sym3<double> over_shares(const Body& body, std::uint32_t element, const std::array<double, 4>& of,
                         const std::vector<double>& asked) {
  const std::array<Vec3d, 4> s = shape_gradients(body.rest[element]);
  Sym3<double> sum;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t v = body.elements[element][i];
    sum += outer_square(s[i]) * (asked[v] / (body.masses[v] * of[i]));
  }
  return sum;
}

}  // namespace

void StiffnessLevels::measure(Member& m) const {
  const std::array<Vec3d, 4> s = shape_gradients(body_.rest[m.element]);
  for (std::size_t i = 0; i < 4; ++i) m.squares[i] = dot(s[i], s[i]);
  m.volume = body_.rest[m.element].volume;
  m.elastic = modulus_bound(body_.blocks[m.block].elastic);
  m.viscous = modulus_bound(body_.blocks[m.block].viscous);
}

StiffnessLevels::Member& StiffnessLevels::member(std::uint32_t element) {
  if (place_.empty()) place_.assign(body_.elements.size(), 0);
  std::uint32_t& place = place_[element];
  if (place == 0) {
    members_.push_back({.element = element, .block = static_cast<std::uint32_t>(block_index(body_, element))});
    measure(members_.back());
    place = static_cast<std::uint32_t>(members_.size());
  }
  return members_[place - 1];
}

bool StiffnessLevels::is_above(const Member& m, double base) {
  return m.last > base && (m.last > m.ratio || m.seen_norm > m.norm);
}

/// Up to half of what the worst tet takes a level costs nothing.
double StiffnessLevels::room_of(const Member& m) { return std::clamp(0.5 / m.part, kLevelMargin, kMostLevelMargin); }

StiffnessLevels::Met StiffnessLevels::meet(std::span<const StiffElement> stiff, std::span<const double> base,
                                           std::span<const double> unseen) {
  Met met;
  ++meetings_;
  above_.clear();
  for (const StiffElement& s : stiff) {
    Member& m = member(s.element);
    m.before = meetings_ == 1 ? s.ratio : (m.met + 1 == meetings_ ? m.last : unseen[m.block]);
    m.last = s.ratio, m.met = meetings_;
    m.seen_ratio = std::max(m.seen_ratio, s.ratio), m.seen_norm = std::max(m.seen_norm, s.norm);
    if (!is_above(m, base[m.block])) continue;
    above_.push_back(s.element);
    met.above = true;
    met.rise = std::max(met.rise, s.ratio / std::max(1.0, m.before));
  }
  return met;
}

void StiffnessLevels::raise(double most_ahead) {
  for (const std::uint32_t e : above_) {
    Member& m = members_[place_[e] - 1];
    const double ahead = room_of(m) * std::clamp(m.last / std::max(1.0, m.before), 1.0, most_ahead);
    m.ratio = std::max(m.ratio, ahead * m.last), m.norm = std::max(m.norm, ahead * m.seen_norm);
  }
}

void StiffnessLevels::complete() {
  for (Member& m : members_) {
    if (m.met != meetings_) continue;
    if (m.ratio < m.last) m.ratio = kLevelMargin * m.last;
    if (m.norm < m.seen_norm) m.norm = kLevelMargin * m.seen_norm;
  }
}

std::vector<double> StiffnessLevels::largest(std::span<const double> base) const {
  std::vector<double> level(base.begin(), base.end());
  for (const Member& m : members_) {
    double& of_block = level[m.block];
    of_block = std::max(of_block, m.ratio);
  }
  return level;
}

/// Members by element, so that sums over them do not depend on who came first.
void StiffnessLevels::keep_ordered() {
  std::ranges::sort(members_, {}, &Member::element);
  for (std::size_t i = 0; i < members_.size(); ++i) place_[members_[i].element] = static_cast<std::uint32_t>(i + 1);
}

void StiffnessLevels::settle() {
  for (Member& m : members_) {
    const double room = room_of(m);
    m.ratio = std::min(m.ratio, room * m.seen_ratio), m.norm = std::min(m.norm, room * m.seen_norm);
    if (m.seen_ratio == 0.0) place_[m.element] = 0;
    m.seen_ratio = m.seen_norm = 0.0;
  }
  std::erase_if(members_, [&](const Member& m) { return place_[m.element] == 0; });
  keep_ordered();
}

void StiffnessLevels::forget_below(std::span<const double> base) {
  const std::size_t forgotten = std::erase_if(members_, [&](const Member& m) {
    const bool borne = !(m.ratio > base[m.block]);
    if (borne) place_[m.element] = 0;
    return borne;
  });
  if (forgotten > 0) keep_ordered();
}

std::size_t StiffnessLevels::count_above(std::span<const double> base) const {
  return static_cast<std::size_t>(
      std::count_if(members_.begin(), members_.end(), [&](const Member& m) { return m.ratio > base[m.block]; }));
}

/// What a member asks of its vertices' masses; k is 0 where the level of its block bears it.
StiffnessLevels::Asking StiffnessLevels::ask(std::uint32_t place, std::span<const double> base,
                                             const std::vector<char>& viscous) const {
  const Member& m = members_[place];
  const std::size_t b = m.block;
  if (!(m.ratio > base[b]) || !(m.volume > 0.0)) return {};
  const double more = m.ratio - base[b];
  Asking a{place, m.volume * std::min(more, m.norm) * m.elastic, 0.0, 0.0, {}};
  if (viscous[b] != 0) a.c = m.volume * more * m.viscous;
  for (std::size_t i = 0; i < 4; ++i) a.of[i] = a.k * m.squares[i];
  return a;
}

void StiffnessLevels::gather_asking(std::span<const double> base, const std::vector<char>& viscous) {
  asking_.clear();
  if (asked_.size() != body_.vertex_count) asked_.assign(body_.vertex_count, 0.0);
  for (std::uint32_t place = 0; place < members_.size(); ++place) {
    members_[place].part = 1.0;
    const Asking a = ask(place, base, viscous);
    if (!(a.k > 0.0)) continue;
    const Tet& t = body_.elements[members_[place].element];
    for (std::size_t i = 0; i < 4; ++i) asked_[t[i]] += a.of[i];
    asking_.push_back(a);
  }
  // The trace of Σ s sᵀ/W is above its λ_max, and simple: |s_a|²/W_a = asked_a/(m_a k).
  for (Asking& a : asking_) {
    for (const std::uint32_t v : body_.elements[members_[a.place].element]) a.upper += asked_[v] / body_.masses[v];
    a.upper /= a.k;
  }
}

AddedStiffness StiffnessLevels::added(std::span<const double> base, const std::vector<char>& viscous) {
  gather_asking(base, viscous);
  AddedStiffness most;
  const auto look = [&](const Asking& a) {
    if (a.k * a.upper <= most.k && a.c * a.upper <= most.c) return;
    const double per_mass = largest_eigenvalue(over_shares(body_, members_[a.place].element, a.of, asked_));
    most = {std::max(most.k, a.k * per_mass), std::max(most.c, a.c * per_mass)};
  };
  // the likely worst first: what lies below it is not looked at
  const auto worst = std::ranges::max_element(asking_, {}, [](const Asking& a) { return a.k * a.upper; });
  if (worst != asking_.end()) look(*worst);
  for (const Asking& a : asking_) look(a);
  for (const Asking& a : asking_) {
    members_[a.place].part = most.k > 0.0 ? a.k * a.upper / most.k : 1.0;
    for (const std::uint32_t v : body_.elements[members_[a.place].element]) asked_[v] = 0.0;
  }
  return most;
}

void StiffnessLevels::remove(std::span<const std::uint32_t> elements) {
  if (members_.empty()) return;
  for (const std::uint32_t e : elements) {
    if (place_[e] == 0) continue;
    members_[place_[e] - 1].ratio = -1.0;
    place_[e] = 0;
  }
  std::erase_if(members_, [](const Member& m) { return m.ratio < 0.0; });
  keep_ordered();
}

void StiffnessLevels::reshape(std::span<const std::uint32_t> elements) {
  if (members_.empty()) return;
  for (const std::uint32_t e : elements) {
    if (place_[e] != 0) measure(members_[place_[e] - 1]);
  }
}

void StiffnessLevels::clear() {
  for (const Member& m : members_) place_[m.element] = 0;
  members_.clear(), above_.clear();
  meetings_ = 0;
}

void StiffnessLevels::archive(Archive& ar) {
  std::vector<Member> members = members_;
  ar(members);
  if (ar.reads()) {
    clear();
    for (const Member& m : members) {
      ar.check(m.element < body_.elements.size() && (place_.empty() || place_[m.element] == 0));
      const Member fresh = member(m.element);
      Member& read = members_.back();
      read = m, read.block = fresh.block, read.squares = fresh.squares;
      read.volume = fresh.volume, read.elastic = fresh.elastic, read.viscous = fresh.viscous;
    }
  }
  ar(meetings_);
}

}  // namespace glisson
