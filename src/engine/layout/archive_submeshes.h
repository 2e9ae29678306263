// archive_submeshes.h — how a body lies in submeshes, in a checkpoint.
//
// Changes leave the tets of a submesh in other lanes than building it would, and sums over them in another order: a run that
// goes on has the same bytes only with the same layout. So a layout that has come from changes is written: which elements a
// submesh has, which vertices are inside, and its batches. What follows from these is made anew. Kernels of another width lay
// the body out by themselves, and the run goes on with other rounding.
#pragma once

#include "engine/layout/submesh.h"
#include "glisson/archive.h"

namespace glisson::engine {

/// @param lanes  for which they are laid out
void write_submeshes(Archive& ar, Submeshes& submeshes, const Body& body, std::size_t lanes);
/// What write_submeshes() has written, checked against the body.
/// @param written  lanes for which they were laid out @param lanes  of the kernels that will run on them
/// @throws std::runtime_error where they do not fit the body
Submeshes read_submeshes(Archive& ar, const Body& body, std::size_t written, std::size_t lanes);

}  // namespace glisson::engine
