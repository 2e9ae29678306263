// membrane.h — a thin sheet of triangles that bears tension and folds away under compression.
//
// With the deformation gradient F of a triangle from its natural shape, E = ½ (FᵀF − 1) and its principal values
// e₁ ≥ e₂, the sheet stores per natural area
//
//   W = E_Y t · (e^{αQ} − 1) / (2α),   α = 0: ½ E_Y t Q,
//        ⎧ (e₁² + e₂² + 2ν e₁ e₂) / (1 − ν²)   taut:      e₂ + ν e₁ > 0
//   Q =  ⎨ e₁²                                 wrinkled:  e₁ > 0 and not taut
//        ⎩ 0                                   slack:     e₁ ≤ 0
//
// Q is the least of the taut form over all E + S with S ≥ 0: fine folds take S up [LeDretRaoult1995]; [Pipkin1986]. So S = ∂W/∂E has no
// compression, W rises with E, and it is convex in F: the tangent is never negative, folded or not (docs/capsule.md).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "glisson/math.h"
#include "glisson/mesh.h"
#include "instruments/capsule/membrane_lanes.h"

namespace glisson {

struct MembraneLaw {
  double stiffness = 0.0;      ///< Young's modulus times thickness, E_Y t [N/m]
  double poisson_ratio = 0.0;  ///< ν [-], 0 … 0.5
  double stiffening = 0.0;     ///< α [-], ≥ 0
  double prestretch = 1.0;     ///< λ₀ of the rest shape from the natural one, both ways [-]
};

enum class MembraneState { taut, wrinkled, slack };

/// What the sheet stores under the Green strain E from the natural shape.
struct MembraneResponse {
  double energy = 0.0;  ///< W [J/m²]
  MembraneState state = MembraneState::slack;
};
MembraneResponse membrane_response(const MembraneLaw& law, double e11, double e12, double e22);

/// Triangles over vertices, numbered among themselves.
class Membrane {
 public:
  Membrane() = default;
  /// @param triangles  over `rest` @param rest  [m]; triangles without area bear nothing
  Membrane(std::span<const Triangle> triangles, std::span<const Vec3d> rest, const MembraneLaw& law);

  std::size_t size() const { return kept_.size(); }
  const MembraneLaw& law() const { return law_; }
  double rest_area(std::size_t triangle) const { return area_[triangle]; }
  /// Share of its stiffness that a triangle still has [-], 0 … 1.
  double kept(std::size_t triangle) const { return kept_[triangle]; }
  void keep(std::size_t triangle, double share);

  /// Adds −∂(Σ W)/∂x to forces; takes the present tensions and the frequency bound.
  /// @param positions, forces  per vertex [m], [N]
  void add_forces(std::span<const Vec3d> positions, std::span<Vec3d> forces);
  double energy(std::span<const Vec3d> positions) const;                        ///< [J]
  double energy(std::span<const Vec3d> positions, std::size_t triangle) const;  ///< as if whole: kept = 1 [J]
  /// ∂²(kept W)/∂x² of a triangle, by pairs of its corners [N/m]; at rest that of a taut sheet.
  std::array<std::array<Mat3d, 3>, 3> stiffness(std::span<const Vec3d> positions, std::size_t triangle) const;
  MembraneState state(std::span<const Vec3d> positions, std::size_t triangle) const;

  /// Of the last add_forces: force across a line per length of it at rest, in the direction where it is largest [N/m].
  double tension(std::size_t triangle) const;
  double largest_tension() const;

  /// Sets the masses that squared_frequency is about. @param masses  per vertex [kg]
  void set_masses(std::span<const double> masses);
  /// Finds ω² over the modulus for the taut sheet at rest, by Lanczos with its residual added; holds until set_masses.
  /// Cost: some 80 add_forces.
  void sharpen(std::span<const Vec3d> rest);
  /// ω² of the last add_forces on the masses, from above [1/s²]: the smaller of
  ///   max over triangles k R,  R = max over corners i of (1/mᵢ) Σ over triangles Dᵢ, D diagonal and ≥ A ∇Nᵢ·∇Nⱼ, and
  ///   max over triangles k times what sharpen() has found.
  double squared_frequency() const { return std::min(seen_.frequency, sharp_rate_ * seen_.modulus); }
  /// Adds stiffnesses d that bound the tangent K of the last add_forces, xᵀ K x ≤ Σ dᵢ |xᵢ|²: dᵢ = Σ over triangles k Dᵢ.
  /// @param per_vertex  [N/m]
  void add_stiffness_bound(std::span<double> per_vertex) const;

 private:
  static constexpr std::size_t kSize = MembraneBlock::kSize;
  struct Strain {
    double e11, e12, e22;
  };
  Strain strain(std::span<const Vec3d> positions, std::size_t triangle) const;
  double natural_area(std::size_t triangle) const { return area_[triangle] / (law_.prestretch * law_.prestretch); }

  static constexpr double kNone = std::numeric_limits<double>::infinity();

  MembraneLaw law_;
  std::vector<double> area_, kept_;  ///< per triangle
  std::vector<MembraneBlock> blocks_;
  MembraneForces forces_ = nullptr;
  std::vector<double> masses_;
  double sharp_rate_ = kNone;  ///< ω² over the largest modulus [1/kg]
  MembraneSums seen_;          ///< by the last add_forces
};

}  // namespace glisson
