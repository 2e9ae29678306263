#include "by_region.h"

namespace glisson::python {

int region_number(const TetMesh& mesh, const Region& region) {
  if (const int* number = std::get_if<int>(&region)) return *number;
  std::string known;
  for (const auto& [number, name] : mesh.region_names) {
    if (name == std::get<std::string>(region)) return number;
    known += (known.empty() ? "" : ", ") + name;
  }
  throw nb::value_error(("the mesh has no region \"" + std::get<std::string>(region) + "\"; " +
                         (known.empty() ? "its regions have no names" : "it has: " + known))
                            .c_str());
}

}  // namespace glisson::python
