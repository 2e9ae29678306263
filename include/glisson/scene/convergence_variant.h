// convergence_variant.h — a variant on a finer mesh of the same body.
#pragma once

#include <optional>

#include "glisson/scene/scene.h"

namespace glisson {

/// A variant and what reads its mesh.
struct RefinedVariant {
  Variant variant;
  MeshLoader load;
  bool split = false;  ///< whether tets were split: regions are then those of the given mesh
};

/// The variant on a mesh whose tets come from those of its own by splitting (refined()). Sets that places choose are chosen anew, as the
/// scene would choose them on any mesh; those of a file, of numbers and of the nearest to a point, and regions, are the mesh's.
RefinedVariant on_split_mesh(const Variant& variant, TetMesh mesh);

/// Gives a mesh made of cells so many times as many along every direction, at least one, and one of shapes edges so many times
/// shorter. @return whether it is one of these
bool multiply_cells(MeshSource& mesh, double factor);

/// The variant with its mesh `times` times twice as fine.
///
/// A generated mesh gets twice the cells along every direction, and sets and regions are chosen anew by their places. A
/// mesh from a file is split, every tet in eight (on_split_mesh()); so is a generated one with sets chosen
/// by numbers or as the nearest to a point, which would mean something else on a finer mesh.
/// An explicit step that the scene gives is left to the program, as a finer mesh needs a shorter one.
/// @throws SceneError as build_mesh
RefinedVariant refined_variant(const Variant& variant, int times, const MeshLoader& load);

/// The variant with a quarter of its mass under the same weight, and half of the step: a value that differs contains inertia or
/// damping in proportion to mass, or the error of the step. None for an integrator without inertia.
std::optional<Variant> lighter_variant(const Variant& variant);

/// Area of the surface's triangles within the set of each tool, 0 where it has none [m²].
double tool_area(const Variant& variant, const TetMesh& mesh);

/// Edge of the cubes of six tets each that would fill the body with as many tets [m].
double cell_size(const TetMesh& mesh);

}  // namespace glisson
