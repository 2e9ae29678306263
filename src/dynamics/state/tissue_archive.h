// tissue_archive.h — a tissue in a checkpoint.
#pragma once

#include "glisson/archive.h"
#include "glisson/material/tissue.h"

namespace glisson {

/// What is read need not be valid: that is for the caller to ask.
void archive(Archive& ar, Tissue& tissue);

}  // namespace glisson
