// meridian_solid.h — a round body of one law in static equilibrium: its forces and tangent for Newton's method.
//
// The pressures of the elements are unknowns beside the displacements, eliminated element by element: take() follows the
// displacements' step with them. What holds and loads the body adds its own forces and rows before the tangent is factored.
#pragma once

#include <memory>
#include <vector>

#include "lab/meridian_mesh.h"
#include "lab/tangent_matrix.h"

namespace glisson::lab {

/// Where a body is.
struct MeridianState {
  std::vector<double> u;                           ///< u_r, u_z of each vertex [m]
  std::vector<MeridianElement::Linear> pressures;  ///< of each element [Pa]

  /// Goes on from `before` and `last` along their secant. @param ahead  in their distances
  void extrapolate(const MeridianState& last, const MeridianState& before, double ahead);
};

class MeridianSolid {
 public:
  MeridianSolid(std::shared_ptr<const MeridianMesh> mesh, const HyperelasticLaw& law);

  MeridianState at_rest() const;
  /// Fills `force` and `tangent`. @return false where an element is folded
  bool assemble(const MeridianState& state);
  /// Takes a step of Newton's method off a state, that of the last assembly.
  void take(const std::vector<double>& step, MeridianState& state) const;

  std::size_t unknowns() const { return force.size(); }
  const MeridianMesh& mesh() const { return *mesh_; }
  const HyperelasticLaw& law() const { return law_; }

  std::vector<double> force;  ///< ∂W/∂u [N]
  TangentMatrix tangent;

 private:
  std::shared_ptr<const MeridianMesh> mesh_;
  HyperelasticLaw law_;
  std::vector<MeridianElement::Pressure> pressures_;  ///< of the last assembly
};

}  // namespace glisson::lab
