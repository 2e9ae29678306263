// step_rules.h — what the parts of the step's control have in common.
#pragma once

#include <algorithm>
#include <span>
#include <variant>
#include <vector>

#include "element/body.h"

namespace glisson {

inline constexpr double kSafety = 0.9;            ///< automatic step over h*
inline constexpr double kStiffeningMargin = 1.2;  ///< stiffening that a new h* allows for beyond the present one
inline constexpr double kRegrowth = 1.015;        ///< a step, of one that tools held short

inline std::size_t block_index(const Body& body, std::size_t element) {
  return static_cast<std::size_t>(&body.block_of(element) - body.blocks.data());
}

/// s sᵀ
inline Sym3<double> outer_square(const Vec3d& s) {
  return {s.x * s.x, s.y * s.y, s.z * s.z, s.x * s.y, s.y * s.z, s.z * s.x};
}

inline bool is_small(const Tissue& tissue) { return tissue.has_small_strain(); }
inline bool is_small(const TissueBlock& block) { return is_small(block.tissue); }

inline bool is_linear(const TissueBlock& block) { return is_small(block) && block.tissue.has_constant_moduli(); }

/// Whether its viscous matrix grows with what it is stretched by: its level of stiffness is above that, too.
inline bool thickens(const TissueBlock& block) {
  return !is_small(block) && (block.viscous.mu > 0.0 || block.viscous.lambda > 0.0);
}

/// Softened tissue keeps the h* of its rest stiffness.
inline std::vector<double> at_least_one(std::span<const double> stiffening) {
  std::vector<double> level(stiffening.begin(), stiffening.end());
  for (double& r : level) r = std::max(r, 1.0);
  return level;
}

}  // namespace glisson
