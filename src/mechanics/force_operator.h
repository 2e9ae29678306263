// force_operator.h — the seam between motion and elements: displacements and velocities in, forces out.
//
// One element at a time: what runs in double precision, and what the submesh engine (src/engine), which has its
// own way in float, is compared with.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "glisson/precision.h"
#include "mechanics/body.h"

namespace glisson {

/// What the element loop sees on its way, reset at each evaluation.
struct ElementWatch {
  std::vector<std::uint32_t> inverted;  ///< tets of the mesh with J ≤ 0, in body order
  std::vector<double> stiffening;       ///< per tissue block: bound of tangent over rest stiffness [-]
};

class ForceOperator {
 public:
  virtual ~ForceOperator() = default;

  /// Overwrites `elastic` and `viscous` [N] by the forces of the tissue on the vertices.
  /// @param u  displacement [m], @param v  velocity [m/s], one per vertex
  /// Cost: one pass over the elements.
  virtual void evaluate(std::span<const Vec3d> u, std::span<const Vec3d> v, std::span<Vec3d> elastic,
                        std::span<Vec3d> viscous, ElementWatch& watch) const = 0;
};

/// The deformation-gradient form of [Schwartz2002, eq. 6 and 7]: f_a = −V σ s_a, no tensors stored.
/// @param body  must outlive the operator
std::unique_ptr<ForceOperator> make_element_operator(const Body& body, Precision precision);

/// y = Σ_e of the linear element with moduli `lame` (one pair per tissue block) applied to x: K x, not −K x.
void apply_linear(const Body& body, std::span<const LameParameters> lame, std::span<const Vec3d> x, std::span<Vec3d> y);

}  // namespace glisson
