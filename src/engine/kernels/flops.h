// flops.h — the useful floating-point operations of a step: those of elements and responses counted by running their
// arithmetic, those of the vertices and of exponentials by hand (docs/engine.md).
#pragma once

#include <array>
#include <cstddef>

#include "engine/layout/submesh.h"

namespace glisson::engine {

/// Operations of the element's parts, from running its arithmetic on numbers that count.
struct ElementFlops {
  std::size_t gradient = 0, stress = 0, force = 0;
  std::array<std::size_t, 3> measure{};  ///< by DeformationMeasure, for volume changes below 30 %
};
/// In kernels.cpp, next to the arithmetic.
ElementFlops count_element_flops();

/// Operations between a tet's gradients and its stress, where tissues deform much.
struct ResponseFlops {
  std::size_t tet = 0;     ///< P from H, and what fibres, branches and viscosity add, for volume changes below 30 %
  std::size_t volume = 0;  ///< of the volume change that tets share; 0 where they do not
};
/// In response_flops.cpp, from running the stages on numbers that are traced.
ResponseFlops count_response_flops(const Tissue& tissue);
/// The same of the value of one law at one argument; slopes serve the stable step only.
std::size_t count_law_flops(const StiffnessLaw& law);

/// Per tet and step: elements or edges as each submesh has them, and its share of the vertices. Lanes that are
/// padding, w components, moving data and the bounds of the stable step are not counted.
double flops_per_tet(const Body& body, const Submeshes& submeshes);

}  // namespace glisson::engine
