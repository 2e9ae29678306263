// by_region.h — tissues as Python gives them: one for the whole mesh, or one for each region, by number or by name.
#pragma once

#include <map>
#include <string>
#include <variant>

#include "bind.h"
#include "glisson/mesh.h"

namespace glisson::python {

using Region = std::variant<int, std::string>;
template <class T>
using ByRegion = std::variant<T, std::map<Region, T>>;

/// @throws nb::value_error naming the regions there are, where the name is none of them
int region_number(const TetMesh& mesh, const Region& region);

template <class T>
std::map<int, T> of_regions(const TetMesh& mesh, const ByRegion<T>& given) {
  std::map<int, T> tissues;
  if (const T* one = std::get_if<T>(&given)) {
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) tissues.emplace(mesh.region_of(t), *one);
    return tissues;
  }
  for (const auto& [region, tissue] : std::get<1>(given)) tissues[region_number(mesh, region)] = tissue;
  return tissues;
}

}  // namespace glisson::python
