// improve.h — makes the tets of a labelled mesh good, worst first.
#pragma once

#include <functional>

#include "mesher/lattice/workspace.h"

namespace glisson::lattice {

/// Improves until all tets have quality `aim` or no operation helps. The least quality never falls.
/// @param go_on  told the part that is done, 0 to 1; false ends the work
/// @return whether it came to its end
bool improve(Workspace& w, double aim, const std::function<bool(double)>& go_on);

}  // namespace glisson::lattice
