// vtk_grid.h — the unstructured grid of VTK's formats on its way into a TetMesh: which cells and arrays count.
#pragma once

#include <span>

#include "io/raw_mesh.h"

namespace glisson::detail {

/// Takes vertices, cells and arrays in the order of the file; nothing is believed before it has been checked.
class VtkGrid {
 public:
  explicit VtkGrid(std::string name) : name_(std::move(name)) {}

  void reserve(std::size_t vertices) { raw_.mesh.vertices.reserve(vertices); }
  void add_vertex(const Vec3d& x) { raw_.mesh.vertices.push_back(x); }
  /// After the last vertex. @throws FileError for a cell that its type or the vertices do not allow
  void add_cell(int type, std::span<const std::int64_t> vertices);

  /// Whether the array of that name holds regions, sets or names of regions; others need not be given.
  static bool is_region_array(std::string_view array);
  static bool is_set_array(std::string_view array);
  static bool is_region_name_array(std::string_view array);
  static bool is_fibre_array(std::string_view array);

  /// Arrays of one component, after the last cell; another number of values than cells or vertices is passed over.
  void add_region_array(std::string_view array, std::vector<double> values);
  void add_set_array(std::string_view array, std::span<const double> values);
  void add_region_name_array(std::string_view array, std::span<const double> values);
  /// Of three components a cell.
  void add_fibre_array(std::string_view array, std::span<const double> values);

  RawMesh finish();

 private:
  void take_regions(const std::string& array, std::span<const double> values);

  std::string name_;
  RawMesh raw_;
  std::vector<std::size_t> cell_of_tet_;
  std::size_t cells_ = 0;
  std::map<std::string, std::vector<double>> region_arrays_;
};

}  // namespace glisson::detail
