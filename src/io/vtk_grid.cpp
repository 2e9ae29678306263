#include "io/vtk_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "io/vtk_names.h"

namespace glisson::detail {
namespace {

constexpr int kTetra = 10, kCurvedTetra = 24;

struct CellType {
  int type;
  std::size_t points;  ///< 0: as many as it likes
  const char* plural;
};

constexpr CellType kCellTypes[] = {{1, 1, "vertices"},
                                   {2, 0, "poly-vertices"},
                                   {3, 2, "lines"},
                                   {4, 0, "polylines"},
                                   {5, 3, "triangles"},
                                   {6, 0, "triangle strips"},
                                   {7, 0, "polygons"},
                                   {8, 4, "pixels"},
                                   {9, 4, "quadrangles"},
                                   {10, 4, "tetrahedra"},
                                   {11, 8, "voxels"},
                                   {12, 8, "hexahedra"},
                                   {13, 6, "prisms"},
                                   {14, 5, "pyramids"},
                                   {21, 3, "3-node lines"},
                                   {22, 6, "6-node triangles"},
                                   {24, 10, "10-node tetrahedra"},
                                   {42, 0, "polyhedra"}};

const CellType* find_cell_type(int type) {
  const auto* found =
      std::find_if(std::begin(kCellTypes), std::end(kCellTypes), [&](const auto& t) { return t.type == type; });
  return found == std::end(kCellTypes) ? nullptr : found;
}

std::optional<int> whole_number(double value) {
  const bool fits = value >= std::numeric_limits<int>::min() && value <= std::numeric_limits<int>::max();
  if (!fits || value != std::floor(value)) return std::nullopt;
  return static_cast<int>(value);
}

}  // namespace

void VtkGrid::add_cell(int type, std::span<const std::int64_t> vertices) {
  const std::size_t cell = cells_++;
  const auto where = [&] { return name_ + ", cell " + std::to_string(cell); };
  const CellType* known = find_cell_type(type);
  if (known != nullptr && known->points != 0 && known->points != vertices.size()) {
    fail(where(), "type " + std::to_string(type) + " (" + known->plural + ") takes " + std::to_string(known->points) +
                      " vertices; it has " + std::to_string(vertices.size()));
  }
  if (type != kTetra && type != kCurvedTetra) {
    ++raw_.skipped[known != nullptr ? known->plural : "cells of VTK type " + std::to_string(type)];
    return;
  }
  std::array<std::uint32_t, 10> at{};
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (vertices[i] < 0 || static_cast<std::uint64_t>(vertices[i]) >= raw_.mesh.vertices.size()) {
      fail(where(), "refers to vertex " + std::to_string(vertices[i]) + ", but the file has " +
                        std::to_string(raw_.mesh.vertices.size()) + " vertices, numbered from 0");
    }
    at[i] = static_cast<std::uint32_t>(vertices[i]);
  }
  raw_.mesh.tets.push_back({at[0], at[1], at[2], at[3]});
  if (type == kCurvedTetra) raw_.curved.push_back({raw_.mesh.tets.back(), {at[4], at[5], at[6], at[7], at[8], at[9]}});
  cell_of_tet_.push_back(cell);
}

bool VtkGrid::is_region_array(std::string_view array) {
  return std::find(std::begin(kRegionArrays), std::end(kRegionArrays), array) != std::end(kRegionArrays);
}

bool VtkGrid::is_set_array(std::string_view array) { return array.starts_with(kSetPrefix); }

bool VtkGrid::is_region_name_array(std::string_view array) { return array.starts_with(kRegionNamePrefix); }

void VtkGrid::add_region_array(std::string_view array, std::vector<double> values) {
  if (values.size() == cells_) region_arrays_[std::string(array)] = std::move(values);
}

void VtkGrid::add_set_array(std::string_view array, std::span<const double> values) {
  if (values.size() != raw_.mesh.vertices.size()) return;
  auto& set = raw_.mesh.vertex_sets[unescape_name(array.substr(kSetPrefix.size()))];
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (values[v] != 0.0) set.push_back(static_cast<std::uint32_t>(v));
  }
}

void VtkGrid::add_region_name_array(std::string_view array, std::span<const double> values) {
  for (const double value : values) {
    const std::optional<int> region = whole_number(value);
    if (region) raw_.mesh.region_names[*region] = unescape_name(array.substr(kRegionNamePrefix.size()));
  }
}

bool VtkGrid::is_fibre_array(std::string_view array) {
  return std::find(std::begin(kFibreArrays), std::end(kFibreArrays), array) != std::end(kFibreArrays);
}

void VtkGrid::add_fibre_array(std::string_view array, std::span<const double> values) {
  if (values.size() != 3 * cells_ || !raw_.mesh.fibres.empty()) return;
  if (!std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); })) {
    raw_.notes.push_back("Cell array \"" + std::string(array) +
                         "\" holds numbers that are not finite: it is not taken as the direction of fibres.");
    return;
  }
  for (const std::size_t c : cell_of_tet_) {
    raw_.mesh.fibres.push_back({values[3 * c], values[3 * c + 1], values[3 * c + 2]});
  }
}

void VtkGrid::take_regions(const std::string& array, std::span<const double> values) {
  std::vector<int> regions;
  regions.reserve(cell_of_tet_.size());
  for (const std::size_t cell : cell_of_tet_) {
    const std::optional<int> region = whole_number(values[cell]);
    if (!region) {
      raw_.notes.push_back("Cell array \"" + array +
                           "\" does not hold whole numbers: it is not taken as the region of each tet.");
      return;
    }
    regions.push_back(*region);
  }
  raw_.mesh.regions = std::move(regions);
}

RawMesh VtkGrid::finish() {
  for (const char* array : kRegionArrays) {
    const auto found = region_arrays_.find(array);
    if (found != region_arrays_.end() && raw_.mesh.regions.empty()) take_regions(array, found->second);
  }
  return std::move(raw_);
}

}  // namespace glisson::detail
