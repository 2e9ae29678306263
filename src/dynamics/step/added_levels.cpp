#include "dynamics/step/added_levels.h"

#include <algorithm>

#include "dynamics/step/step_rules.h"

namespace glisson {
namespace {

constexpr double kRoomAbove = 1.2;       ///< of a level over the stiffness that lately was
constexpr double kMostRiseBeside = 2.0;  ///< how much stiffer than in the last step a vertex is taken to become at most

}  // namespace

/// Takes in that the vertices are others: those that stay keep their levels.
bool AddedLevels::follow(std::span<const VertexStiffness> now) {
  if (std::ranges::equal(now, levels_, {}, &VertexStiffness::vertex, &Level::vertex)) return false;
  std::vector<Level> known = std::move(levels_);
  std::ranges::sort(known, {}, &Level::vertex);
  levels_.clear();
  for (const VertexStiffness& s : now) {
    const auto found = std::ranges::lower_bound(known, s.vertex, {}, &Level::vertex);
    const bool stays = found != known.end() && found->vertex == s.vertex;
    levels_.push_back(stays ? *found : Level{s.vertex, s.stiffness, 0.0, 0.0});
  }
  return true;
}

bool AddedLevels::meet(std::span<const VertexStiffness> now) {
  bool bears = !follow(now);
  for (std::size_t k = 0; k < now.size(); ++k) {
    Level& l = levels_[k];
    const double stiffness = now[k].stiffness,
                 rise = l.before > 0.0 ? std::clamp(stiffness / l.before, 1.0, kMostRiseBeside) : 1.0;
    l.before = stiffness;
    l.lately = std::max(stiffness * rise * rise, l.lately / (kRegrowth * kRegrowth));
    bears = bears && l.lately <= l.level;
  }
  return bears;
}

void AddedLevels::settle() {
  for (Level& l : levels_) l.level = kRoomAbove * l.lately;
}

void AddedLevels::add_masses(double per_stiffness, std::span<double> masses) const {
  for (const Level& l : levels_) masses[l.vertex] += per_stiffness * l.level;
}

void AddedLevels::archive(Archive& ar, std::size_t vertex_count) {
  ar(levels_);
  for (const Level& l : levels_) ar.check(l.vertex < vertex_count);
}

}  // namespace glisson
