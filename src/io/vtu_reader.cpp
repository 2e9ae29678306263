// vtu_reader.cpp — unstructured grids in VTK's XML format: the elements of the file and what they mean here.
#include <vtkNew.h>
#include <vtkXMLDataElement.h>

#include <algorithm>
#include <new>
#include <sstream>
#include <stdexcept>

#include "io/shallow_xml.h"
#include "io/vtk_grid.h"
#include "io/vtk_log.h"
#include "io/vtk_start.h"
#include "io/vtu_array.h"

namespace glisson::detail {
namespace {

constexpr std::string_view kDataArray = "DataArray";
constexpr const char* kFrameNote =
    "This is a frame of a run, not a mesh: its points are those at rest, and the displacement, velocity and stress in "
    "it are "
    "left out. Play the run with `glisson view DIR`; for the deformed shape as a body without stress, apply ParaView's "
    "warp by displacement_m and save that without the array.";

std::string attribute(vtkXMLDataElement& element, const char* key) {
  const char* value = element.GetAttribute(key);
  return value != nullptr ? value : "";
}

template <class Use>
void for_nested(vtkXMLDataElement* parent, std::string_view name, const Use& use) {
  for (int i = 0; parent != nullptr && i < parent->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement& element = *parent->GetNestedElement(i);
    if (element.GetName() == name) use(element);
  }
}

class VtuReader {
 public:
  VtuReader(vtkXMLDataElement& root, VtuArrays& arrays, const std::string& name, std::span<const std::string> fields)
      : root_(root), arrays_(arrays), name_(name), fields_(fields), grid_(name) {}

  RawMesh read() {
    vtkXMLDataElement* unstructured = root_.FindNestedElementWithName("UnstructuredGrid");
    if (unstructured == nullptr) fail(name_, "no <UnstructuredGrid> element in it");
    // All vertices of all pieces come first: cells are checked against them.
    for_nested(unstructured, "Piece", [&](vtkXMLDataElement& piece) { add_vertices(piece); });
    for_nested(unstructured, "Piece", [&](vtkXMLDataElement& piece) { add_piece(piece); });
    for_nested(unstructured->FindNestedElementWithName("FieldData"), kDataArray,
               [&](vtkXMLDataElement& array) { add_field(array); });
    for (auto& [array, values] : regions_) grid_.add_region_array(array, std::move(values));
    for (const auto& [array, values] : sets_) grid_.add_set_array(array, values);
    for (const auto& [array, values] : fibres_) grid_.add_fibre_array(array, values);
    RawMesh raw = grid_.finish();
    raw.vertex_fields = std::move(vertex_fields_);
    raw.tet_fields = std::move(tet_fields_);
    raw.arrays = std::move(names_);
    if (is_frame_) raw.notes.emplace_back(kFrameNote);
    return raw;
  }

 private:
  void add_vertices(vtkXMLDataElement& piece);
  void add_piece(vtkXMLDataElement& piece);
  void add_cells(vtkXMLDataElement& piece, std::uint64_t cells);
  void add_field(vtkXMLDataElement& array);
  void take_field(vtkXMLDataElement& array, std::uint64_t count, std::vector<Field>& fields);
  vtkXMLDataElement& cell_array(vtkXMLDataElement& piece, const char* name) const;

  vtkXMLDataElement& root_;
  VtuArrays& arrays_;
  std::string name_;
  std::span<const std::string> fields_;
  VtkGrid grid_;
  std::int64_t first_vertex_ = 0;  ///< of the piece
  std::map<std::string, std::vector<double>> regions_, sets_, fibres_;
  std::vector<Field> vertex_fields_, tet_fields_;
  std::vector<std::string> names_;
  bool is_frame_ = false;
};

void VtuReader::add_vertices(vtkXMLDataElement& piece) {
  const std::uint64_t count = arrays_.count(piece, "NumberOfPoints", 0);
  if (count == 0) return;
  vtkXMLDataElement* points = piece.FindNestedElementWithName("Points");
  vtkXMLDataElement* array = points != nullptr ? points->FindNestedElementWithName("DataArray") : nullptr;
  if (array == nullptr) fail(name_, "a piece without <Points>: the file is damaged or cut off");
  if (arrays_.count(*array, "NumberOfComponents", 1) != 3) arrays_.refuse(*array, "points must have 3 components");
  const std::vector<double> x = arrays_.read(*array, 3 * count);
  for (std::size_t v = 0; v < count; ++v) grid_.add_vertex({x[3 * v], x[3 * v + 1], x[3 * v + 2]});
}

vtkXMLDataElement& VtuReader::cell_array(vtkXMLDataElement& piece, const char* name) const {
  vtkXMLDataElement* found = nullptr;
  for_nested(piece.FindNestedElementWithName("Cells"), kDataArray, [&](vtkXMLDataElement& array) {
    if (attribute(array, "Name") == name) found = &array;
  });
  if (found == nullptr) fail(name_, std::string("a piece without the array \"") + name + "\" of its cells");
  return *found;
}

void VtuReader::add_cells(vtkXMLDataElement& piece, std::uint64_t cells) {
  vtkXMLDataElement& offset_array = cell_array(piece, "offsets");
  const std::vector<std::int64_t> ends = arrays_.read_integers(offset_array, cells);
  if (!std::is_sorted(ends.begin(), ends.end()) || ends.front() < 0) {
    arrays_.refuse(offset_array, "the offsets of the cells must rise from 0");
  }
  const std::vector<std::int64_t> types = arrays_.read_integers(cell_array(piece, "types"), cells);
  std::vector<std::int64_t> list =
      arrays_.read_integers(cell_array(piece, "connectivity"), static_cast<std::uint64_t>(ends.back()));
  for (std::int64_t& vertex : list) vertex = vertex < 0 ? vertex : vertex + first_vertex_;
  std::size_t begin = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    const auto end = static_cast<std::size_t>(ends[c]);
    const int type = types[c] >= 0 && types[c] <= 255 ? static_cast<int>(types[c]) : -1;
    grid_.add_cell(type, std::span(list).subspan(begin, end - begin));
    begin = end;
  }
}

void VtuReader::add_piece(vtkXMLDataElement& piece) {
  const std::uint64_t points = arrays_.count(piece, "NumberOfPoints", 0);
  const std::uint64_t cells = arrays_.count(piece, "NumberOfCells", 0);
  if (cells > 0) add_cells(piece, cells);
  first_vertex_ += static_cast<std::int64_t>(points);
  const auto collect = [&](auto wanted, std::uint64_t count, auto& arrays, std::uint64_t components = 1) {
    return [this, wanted, count, components, &arrays](vtkXMLDataElement& array) {
      const std::string name = attribute(array, "Name");
      if (!wanted(name) || arrays_.count(array, "NumberOfComponents", 1) != components) return;
      const std::vector<double> values = arrays_.read(array, components * count);
      arrays[name].insert(arrays[name].end(), values.begin(), values.end());
    };
  };
  for_nested(piece.FindNestedElementWithName("CellData"), kDataArray,
             collect(VtkGrid::is_region_array, cells, regions_));
  for_nested(piece.FindNestedElementWithName("CellData"), kDataArray,
             collect(VtkGrid::is_fibre_array, cells, fibres_, 3));
  for_nested(piece.FindNestedElementWithName("PointData"), kDataArray, collect(VtkGrid::is_set_array, points, sets_));
  for_nested(piece.FindNestedElementWithName("PointData"), kDataArray, [&](vtkXMLDataElement& array) {
    is_frame_ = is_frame_ || attribute(array, "Name") == kDisplacementArray;
    take_field(array, points, vertex_fields_);
  });
  for_nested(piece.FindNestedElementWithName("CellData"), kDataArray,
             [&](vtkXMLDataElement& array) { take_field(array, cells, tet_fields_); });
}

/// Pieces follow each other.
void VtuReader::take_field(vtkXMLDataElement& array, std::uint64_t count, std::vector<Field>& fields) {
  const std::string name = attribute(array, "Name");
  if (!VtkGrid::is_set_array(name) && std::find(names_.begin(), names_.end(), name) == names_.end())
    names_.push_back(name);
  if (std::find(fields_.begin(), fields_.end(), name) == fields_.end()) return;
  const std::uint64_t components = arrays_.count(array, "NumberOfComponents", 1);
  if (components != 1 && components != 3 && components != 9) return;
  const std::vector<double> values = arrays_.read(array, components * count);
  const auto known = std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name; });
  if (known == fields.end()) {
    fields.push_back({name, static_cast<int>(components), values});
  } else {
    known->values.insert(known->values.end(), values.begin(), values.end());
  }
}

void VtuReader::add_field(vtkXMLDataElement& array) {
  const std::string name = attribute(array, "Name");
  if (!VtkGrid::is_region_name_array(name)) return;
  grid_.add_region_name_array(name, arrays_.read(array, arrays_.count(array, "NumberOfTuples", 1)));
}

/// @throws FileError unless the root is that of an unstructured grid
void check_root(vtkXMLDataElement* root, const std::string& name) {
  if (root == nullptr || std::string_view(root->GetName()) != "VTKFile") {
    fail(name, "no <VTKFile> element: this is not a .vtu file");
  }
  const std::string type = attribute(*root, "type");
  if (type == "UnstructuredGrid") return;
  fail(name, "a VTK file of type \"" + type.substr(0, 40) + "\"; tetrahedra come in files of type UnstructuredGrid");
}

RawMesh parse_and_read(std::string_view bytes, const std::string& name, std::span<const std::string> fields) {
  std::istringstream stream{std::string(bytes)};
  vtkNew<VtkErrorLog> log;
  vtkNew<ShallowXml> parser;
  log->observe(*parser);
  parser->SetStream(&stream);
  const bool parsed = parser->Parse() != 0;
  if (!parsed || !log->first().empty()) fail(name, parser->trouble(*log.Get()));
  check_root(parser->GetRootElement(), name);
  VtuArrays arrays(*parser, bytes, name);
  RawMesh raw = VtuReader(*parser->GetRootElement(), arrays, name, fields).read();
  if (!log->first().empty()) fail(name, "VTK cannot read it: " + log->first());
  return raw;
}

}  // namespace

RawMesh read_vtu(std::string_view bytes, const std::string& name) { return read_vtu_with(bytes, name, {}); }

RawMesh read_vtu_with(std::string_view bytes, const std::string& name, std::span<const std::string> fields) {
  start_vtk();
  try {
    return parse_and_read(bytes, name, fields);
  } catch (const std::bad_alloc&) {
    fail(name, "its counts need more memory than there is: they are wrong, or the file is too large");
  } catch (const std::length_error&) {
    fail(name, "its counts are larger than any memory: they are wrong");
  }
}

}  // namespace glisson::detail
