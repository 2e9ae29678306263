// branches_note.h — that statics forgets the past of a tissue, where nobody has said that it is to.
#pragma once

#include <string>

#include "glisson/scene/variant.h"

namespace glisson::app {

/// What quasi_static does with Maxwell branches and viscosity where the scene has them and no `branches`; else empty.
std::string branches_note(const Variant& variant);

}  // namespace glisson::app
