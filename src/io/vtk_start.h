// vtk_start.h — what VTK makes on its first use, made once, before threads can meet over it.
//
// VTK makes its list of object factories when the first object asks for it, and takes no lock: of two threads that
// write their first file at the same time each makes a list, one is lost, and a thread may walk a list that the other
// is still filling from VTK_AUTOLOAD_PATH. Variants run side by side do meet there.
#pragma once

namespace glisson::detail {

/// Makes the list; a second call only looks, and one that comes meanwhile waits. Comes before the first object of VTK
/// in every function of this room that others call.
void start_vtk();

}  // namespace glisson::detail
