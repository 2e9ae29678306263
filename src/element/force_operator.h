// force_operator.h — the seam between motion and elements: displacements and velocities in, forces out.
//
// One element at a time: what runs in double precision, and what the submesh engine (src/engine), which has its
// own way in float, is compared with.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "element/body.h"
#include "element/stiff_element.h"

namespace glisson {

/// What the element loop sees on its way, reset at each evaluation but for what it is to list.
struct ElementWatch {
  std::vector<std::uint32_t> inverted;  ///< tets of the mesh with J ≤ 0, in body order
  std::vector<double> stiffening;       ///< per tissue block: bound of tangent over rest stiffness [-]
  std::vector<double> list_above;       ///< per tissue block: stiffening from which elements are listed; empty: none is
  std::vector<StiffElement> stiff;      ///< those, in body order

  /// Takes in the stiffening of an element and its norm.
  void see(std::size_t block, std::size_t element, double ratio, double norm) {
    if (std::isnan(ratio)) ratio = std::numeric_limits<double>::infinity();
    stiffening[block] = std::max(stiffening[block], ratio);
    if (!list_above.empty() && ratio > list_above[block]) {
      stiff.push_back({static_cast<std::uint32_t>(element), ratio, std::isnan(norm) ? ratio : norm});
    }
  }
  void reset(std::size_t blocks) {
    inverted.clear(), stiff.clear();
    stiffening.assign(blocks, 0.0);
  }
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
std::unique_ptr<ForceOperator> make_element_operator(const Body& body);

/// y = Σ_e of the linear element with moduli `lame` (one pair per tissue block) applied to x: K x, not −K x.
void apply_linear(const Body& body, std::span<const LameParameters> lame, std::span<const Vec3d> x, std::span<Vec3d> y);

}  // namespace glisson
