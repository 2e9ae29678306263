// body.h — a body at rest: what is computed from mesh and tissues. A step never changes it; a change of the mesh or of a
// tissue between two steps does (body_change.h).
//
// Tetrahedra are sorted by tissue into blocks, so that moduli and law are constants of a block and the
// element loop carries none of them per tet. Element e of the body is tet `mesh_tet[e]` of the mesh.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "glisson/material/tissue.h"
#include "glisson/math.h"
#include "glisson/mesh.h"
#include "glisson/tet_gradient.h"
#include "material/strain.h"

namespace glisson {

/// A run of elements of one tissue.
struct TissueBlock {
  Tissue tissue;
  LameParameters elastic;          ///< λ, μ at rest [Pa]
  LameParameters viscous;          ///< (a, b) of σ_v = a tr(ε̇) I + 2 b ε̇ [Pa·s]
  std::size_t begin = 0, end = 0;  ///< elements
};

struct Body {
  std::size_t vertex_count = 0;
  std::vector<Tet> elements;            ///< vertex numbers of the mesh
  std::vector<std::uint32_t> mesh_tet;  ///< tet of the mesh for each element
  std::vector<ElementRest> rest;
  std::vector<TissueBlock> blocks;
  std::vector<double> masses;         ///< lumped: a quarter of ρV to each vertex [kg]
  std::vector<Vec3d> rest_positions;  ///< [m]
  std::vector<double> mass_factor;    ///< of each element, ≥ 1: mass that was added; empty: none
  std::vector<double> stiff_mass;     ///< per vertex, while tets around it do not bear the step [kg]; empty: none
  std::vector<Vec3d> fibres;          ///< of each tet of the mesh, any length; empty: those of the tissues

  const TissueBlock& block_of(std::size_t element) const;
  /// What an element gives each of its vertices [kg].
  double quarter_mass(const TissueBlock& block, std::size_t element) const;
  /// What forces accelerate at a vertex: its mass and `stiff_mass` [kg].
  double inertia(std::size_t vertex) const {
    const double m = masses[vertex];
    return vertex < stiff_mass.size() && m > 0.0 ? m + stiff_mass[vertex] : m;
  }
};

/// A block of a valid tissue. @throws std::invalid_argument where it is not
TissueBlock make_block(const Tissue& tissue, std::size_t begin, std::size_t end);
/// Whether the tissue's fibres, if it has any, have a direction in every tet of a block. @throws std::invalid_argument
void require_fibres(const Body& body, const TissueBlock& block, const Tissue& tissue);
/// Whether viscous forces are those of Maxwell branches alone.
bool only_relaxes(const Body& body);
/// Sums what elements give to their vertices, in their order.
void lump_masses(Body& body);

/// @param tissues  by region number; every region of the mesh needs one
/// @throws std::invalid_argument naming the region without a tissue, or what is wrong with mesh or tissue
Body build_body(const TetMesh& mesh, const std::map<int, Tissue>& tissues);

/// H of element e for vertex values u (displacement: [-]; velocity: [1/s]).
Mat3d element_gradient(const Body& body, std::size_t e, std::span<const Vec3d> u);

}  // namespace glisson
