// vtk_writer.cpp — .vtu files: a mesh with its regions and sets, deformed or not, and fields on it.
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <type_traits>

#include "io/atomic_file.h"
#include "io/quick_zlib.h"
#include "io/raw_mesh.h"
#include "io/vtk_log.h"
#include "io/vtk_names.h"
#include "io/vtk_start.h"
#include "mesh/topology/require_valid.h"

namespace glisson {
namespace {

vtkIdType id(std::size_t i) { return static_cast<vtkIdType>(i); }

void require_field(const Field& field, std::size_t items, const char* kind) {
  if (field.components >= 1 && field.values.size() == items * static_cast<std::size_t>(field.components)) return;
  throw std::invalid_argument("write_vtu: field \"" + field.name + "\" has " + std::to_string(field.values.size()) +
                              " values of " + std::to_string(field.components) +
                              " components; it needs one for each of the " + std::to_string(items) + " " + kind);
}

void check(const TetMesh& mesh, std::span<const Vec3d> positions, std::span<const Field> vertex_fields,
           std::span<const Field> tet_fields) {
  detail::require_indices(mesh);
  if (!positions.empty() && positions.size() != mesh.vertices.size()) {
    throw std::invalid_argument("write_vtu: " + std::to_string(positions.size()) + " positions for " +
                                std::to_string(mesh.vertices.size()) + " vertices");
  }
  for (const Field& field : vertex_fields) require_field(field, mesh.vertices.size(), "vertices");
  for (const Field& field : tet_fields) require_field(field, mesh.tets.size(), "tets");
}

void set_points(std::span<const Vec3d> positions, vtkUnstructuredGrid& grid) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(id(positions.size()));
  for (std::size_t v = 0; v < positions.size(); ++v) {
    points->SetPoint(id(v), positions[v].x, positions[v].y, positions[v].z);
  }
  grid.SetPoints(points);
}

void set_tets(const TetMesh& mesh, vtkUnstructuredGrid& grid) {
  vtkNew<vtkIdTypeArray> offsets, connectivity;
  offsets->SetNumberOfValues(id(mesh.tets.size() + 1));
  connectivity->SetNumberOfValues(id(4 * mesh.tets.size()));
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    offsets->SetValue(id(t), id(4 * t));
    for (std::size_t i = 0; i < 4; ++i) connectivity->SetValue(id(4 * t + i), id(mesh.tets[t][i]));
  }
  offsets->SetValue(id(mesh.tets.size()), id(4 * mesh.tets.size()));
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, connectivity);
  grid.SetCells(VTK_TETRA, cells);
}

void add_regions(const TetMesh& mesh, vtkUnstructuredGrid& grid) {
  if (!mesh.regions.empty()) {
    vtkNew<vtkIntArray> regions;
    regions->SetName(detail::kRegionArrays[0]);
    regions->SetNumberOfValues(id(mesh.regions.size()));
    for (std::size_t t = 0; t < mesh.regions.size(); ++t) regions->SetValue(id(t), mesh.regions[t]);
    grid.GetCellData()->AddArray(regions);
  }
  for (const auto& [region, name] : mesh.region_names) {
    const std::string array_name = std::string(detail::kRegionNamePrefix) + detail::escape_name(name);
    vtkFieldData* data = grid.GetFieldData();
    if (data->GetArray(array_name.c_str()) == nullptr) {
      vtkNew<vtkIntArray> numbers;
      numbers->SetName(array_name.c_str());
      data->AddArray(numbers);
    }
    vtkIntArray::SafeDownCast(data->GetArray(array_name.c_str()))->InsertNextValue(region);
  }
}

void add_fibres(const TetMesh& mesh, vtkUnstructuredGrid& grid) {
  if (mesh.fibres.empty()) return;
  vtkNew<vtkDoubleArray> fibres;
  fibres->SetName(detail::kFibreArrays[0]);
  fibres->SetNumberOfComponents(3);
  fibres->SetNumberOfTuples(id(mesh.fibres.size()));
  for (std::size_t t = 0; t < mesh.fibres.size(); ++t) {
    fibres->SetTuple3(id(t), mesh.fibres[t].x, mesh.fibres[t].y, mesh.fibres[t].z);
  }
  grid.GetCellData()->AddArray(fibres);
}

void add_sets(const TetMesh& mesh, vtkUnstructuredGrid& grid) {
  for (const auto& [name, vertices] : mesh.vertex_sets) {
    vtkNew<vtkUnsignedCharArray> members;
    members->SetName((std::string(detail::kSetPrefix) + detail::escape_name(name)).c_str());
    members->SetNumberOfValues(id(mesh.vertices.size()));
    members->FillValue(0);
    for (const std::uint32_t v : vertices) members->SetValue(id(v), 1);
    grid.GetPointData()->AddArray(members);
  }
}

/// @tparam Array  vtkDoubleArray or vtkFloatArray
template <class Array>
void add_field(const Field& field, vtkFieldData& data) {
  vtkNew<Array> array;
  array->SetName(field.name.c_str());
  array->SetNumberOfComponents(field.components);
  array->SetNumberOfTuples(id(field.values.size()) / field.components);
  using Number = std::remove_pointer_t<decltype(array->GetPointer(0))>;
  std::ranges::transform(field.values, array->GetPointer(0), [](double x) { return static_cast<Number>(x); });
  data.AddArray(array);
}

void add_fields(std::span<const Field> fields, vtkFieldData& data) {
  for (const Field& field : fields) {
    field.single ? add_field<vtkFloatArray>(field, data) : add_field<vtkDoubleArray>(field, data);
  }
}

/// Base64 instead of raw bytes: the file stays well-formed XML for readers other than VTK's.
/// Into memory: what VTK says of a disk that refuses is a dump of its pipeline, without the reason.
std::string file_text(vtkUnstructuredGrid& grid, const std::filesystem::path& file) {
  vtkNew<detail::VtkErrorLog> log;
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  log->observe_pipeline(*writer);
  writer->WriteToOutputStringOn();
  writer->SetInputData(&grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOn();
  writer->SetCompressor(vtkNew<detail::QuickZlib>());
  writer->SetHeaderTypeToUInt64();
  if (writer->Write() == 1 && writer->GetErrorCode() == 0 && log->first().empty()) return writer->GetOutputString();
  detail::fail(file.string(), "VTK cannot put it together: " + log->first());
}

}  // namespace

void write_vtu(const std::filesystem::path& file, const TetMesh& mesh, std::span<const Vec3d> positions,
               std::span<const Field> vertex_fields, std::span<const Field> tet_fields) {
  check(mesh, positions, vertex_fields, tet_fields);
  detail::start_vtk();
  vtkNew<vtkUnstructuredGrid> grid;
  set_points(positions.empty() ? std::span<const Vec3d>(mesh.vertices) : positions, *grid);
  set_tets(mesh, *grid);
  add_regions(mesh, *grid);
  add_fibres(mesh, *grid);
  add_sets(mesh, *grid);
  add_fields(vertex_fields, *grid->GetPointData());
  add_fields(tet_fields, *grid->GetCellData());
  detail::replace_file(file, file_text(*grid, file));
}

}  // namespace glisson
