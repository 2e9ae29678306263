// tet_fields.h — what a tetrahedron looks like from outside: shape, equivalent shear strain, stress, stored energy.
#pragma once

#include <span>

#include "element/body.h"
#include "element/branch_memory.h"
#include "glisson/simulation/tet_fields.h"

namespace glisson {

/// Fields in the order of the mesh's tets, in double whatever the operator computes in.
/// @param memory  of each tissue block; empty: all branches have relaxed
TetFields tet_fields(const Body& body, std::span<const Vec3d> u, std::span<const Vec3d> v,
                     std::span<const BranchMemory> memory);
/// The same of some tets, in their order. @param tets  numbers of the mesh
/// Cost: theirs, with shared volume change that of their neighbours, and a look at every tet of the body.
TetFields tet_fields(const Body& body, std::span<const std::uint32_t> tets, std::span<const Vec3d> u,
                     std::span<const Vec3d> v, std::span<const BranchMemory> memory);

/// √(½ [(σx−σy)² + (σy−σz)² + (σz−σx)²] + 3 (τxy² + τyz² + τzx²)) [Pa]. @param s  xx, yy, zz, xy, yz, zx
double von_mises(std::span<const double, 6> s);

/// Σ V (½ λ tr(ε)² + μ ε:ε) with the moduli of the present shape [J]: the stored energy of a linear tissue.
double secant_energy(const Body& body, std::span<const Vec3d> u);

/// The same for one element with the displacements of its four vertices [m].
double element_energy(const Body& body, const TissueBlock& block, std::size_t e, const std::array<Vec3d, 4>& u);

}  // namespace glisson
