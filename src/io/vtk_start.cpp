// vtk_start.cpp — see vtk_start.h.
#include "io/vtk_start.h"

#include <vtkObjectFactory.h>

namespace glisson::detail {

void start_vtk() {
  // The language makes a local static once and lets the other threads wait. VTK frees the list at the end.
  [[maybe_unused]] static const auto* const factories = vtkObjectFactory::GetRegisteredFactories();
}

}  // namespace glisson::detail
