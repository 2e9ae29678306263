// vertex_set.h — a vertex set that a mesh does not have, and those it has.
#pragma once

#include <span>
#include <string>

namespace glisson {

/// `no vertex set "zmin"; did you mean "z_min"? the sets are: …`.
std::string no_vertex_set(const std::string& name, std::span<const std::string> known);

}  // namespace glisson
