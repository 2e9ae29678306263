// require_valid.h — the checks without which a mesh cannot even be walked over.
#pragma once

#include "glisson/mesh.h"

namespace glisson::detail {

/// @throws std::invalid_argument if a tet refers to a vertex that does not exist, or `regions` has another
///         length than `tets`
void require_indices(const TetMesh& mesh);

}  // namespace glisson::detail
