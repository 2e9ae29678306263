// legacy_vtk_reader.cpp — legacy .vtk files, text and binary, in both layouts of cells (before and from 5.0).
//
// Why not VTK's own reader: fed by a fuzzer, that of VTK 9.1 dereferences null pointers within a minute (a
// METADATA block with a wrong count is enough), and the walk over the file that would be needed to keep it
// from doing so is already a reader. The format is small, public and closed.
#include <algorithm>
#include <charconv>

#include "base/text.h"
#include "io/legacy_vtk_source.h"
#include "io/vtk_grid.h"
#include "io/vtk_names.h"

namespace glisson::detail {
namespace {

class LegacyVtkReader {
 public:
  LegacyVtkReader(std::string_view bytes, const std::string& name) : source_(bytes, name), grid_(name) {}
  RawMesh read();

 private:
  enum class Owner { file, cells, vertices };  ///< of the arrays that follow

  void read_header();
  void read_section(const std::string& keyword);
  void read_points();
  void read_cells();
  void read_old_cells(std::uint64_t count, std::uint64_t numbers);
  void read_new_cells(std::uint64_t count, std::uint64_t numbers);
  void read_cell_types();
  void begin_data(Owner owner, std::uint64_t expected);
  void read_field();
  void read_array(const std::string& array, std::uint64_t components, std::uint64_t tuples, const std::string& type);
  bool read_attribute(const std::string& keyword);
  void read_scalars();
  void skip_metadata();
  std::string array_name() { return unescape_name(source_.word("the name of an array")); }

  LegacyVtkSource source_;
  VtkGrid grid_;
  double version_ = 0.0;
  Owner owner_ = Owner::file;
  std::uint64_t items_ = 0, vertices_ = 0;
  bool has_points_ = false, has_cells_ = false, has_types_ = false;
  std::vector<std::int64_t> list_;   ///< vertices of all cells, one after the other
  std::vector<std::size_t> begins_;  ///< where each cell begins in it, and its end
};

void LegacyVtkReader::read_header() {
  constexpr std::string_view kHead = "# vtk DataFile Version ";
  const std::string_view first = source_.line();
  if (!lower_case(first).starts_with(lower_case(kHead))) {
    source_.refuse("a legacy VTK file begins with \"" + std::string(kHead) + "…\"");
  }
  const std::string_view number = first.substr(kHead.size());
  std::from_chars(number.data(), number.data() + number.size(), version_);
  if (!(version_ >= 1.0 && version_ < 6.0)) {
    source_.refuse("version \"" + std::string(number.substr(0, 20)) + "\" is not read, only 1.0 to 5.1");
  }
  source_.line();  // the title
  const std::string encoding = lower_case(source_.word("ASCII or BINARY"));
  if (encoding != "ascii" && encoding != "binary") {
    source_.refuse("expected ASCII or BINARY, found \"" + encoding.substr(0, 40) + "\"");
  }
  if (lower_case(source_.word("DATASET")) != "dataset") source_.refuse("expected DATASET after the encoding");
  const std::string dataset = lower_case(source_.word("UNSTRUCTURED_GRID"));
  if (dataset != "unstructured_grid") {
    source_.refuse("a data set of type \"" + dataset.substr(0, 40) + "\"; tetrahedra come in an UNSTRUCTURED_GRID");
  }
  if (encoding == "binary") source_.set_binary();
}

void LegacyVtkReader::read_points() {
  if (has_points_) source_.refuse("a second list of points");
  has_points_ = true;
  vertices_ = source_.count("the number of points");
  std::vector<double> x;
  source_.values(3 * vertices_, source_.type(), &x);
  if (x.size() != 3 * vertices_) source_.refuse("the points are no numbers");
  grid_.reserve(vertices_);
  for (std::size_t v = 0; v < vertices_; ++v) grid_.add_vertex({x[3 * v], x[3 * v + 1], x[3 * v + 2]});
}

/// Before version 5: for each cell the number of its vertices, then these.
void LegacyVtkReader::read_old_cells(std::uint64_t count, std::uint64_t numbers) {
  const std::vector<std::int64_t> list = source_.integers(numbers, "int");
  begins_.push_back(0);
  for (std::size_t i = 0; i < list.size();) {
    const std::int64_t size = list[i++];
    if (size < 0 || static_cast<std::uint64_t>(size) > list.size() - i) {
      source_.refuse("cell " + std::to_string(begins_.size() - 1) + " says " + std::to_string(size) +
                     " vertices where the list has " + std::to_string(list.size() - i) + " numbers left");
    }
    const auto begin = list.begin() + static_cast<std::ptrdiff_t>(i);
    list_.insert(list_.end(), begin, begin + size);
    begins_.push_back(list_.size());
    i += static_cast<std::size_t>(size);
  }
  if (begins_.size() - 1 != count) {
    source_.refuse("the list holds " + std::to_string(begins_.size() - 1) + " cells, not " + std::to_string(count));
  }
}

/// From version 5: where each cell begins in the list of vertices, then the list.
void LegacyVtkReader::read_new_cells(std::uint64_t count, std::uint64_t numbers) {
  if (lower_case(source_.word("OFFSETS")) != "offsets") source_.refuse("expected OFFSETS after CELLS");
  const std::string offset_type = source_.type();
  const std::vector<std::int64_t> offsets = source_.integers(count, offset_type);
  if (lower_case(source_.word("CONNECTIVITY")) != "connectivity") {
    source_.refuse("expected CONNECTIVITY after the offsets");
  }
  const std::string list_type = source_.type();
  list_ = source_.integers(numbers, list_type);
  const bool ordered = std::is_sorted(offsets.begin(), offsets.end());
  if (offsets.empty() || !ordered || offsets.front() != 0 || offsets.back() != static_cast<std::int64_t>(numbers)) {
    source_.refuse("the offsets must rise from 0 to the length of the connectivity, " + std::to_string(numbers));
  }
  begins_.assign(offsets.begin(), offsets.end());
}

void LegacyVtkReader::read_cells() {
  if (has_cells_) source_.refuse("a second list of cells");
  has_cells_ = true;
  const std::uint64_t count = source_.count("the number of cells");
  const std::uint64_t numbers = source_.count("the length of the list");
  version_ >= 5.0 ? read_new_cells(count, numbers) : read_old_cells(count, numbers);
}

void LegacyVtkReader::read_cell_types() {
  if (has_types_) source_.refuse("a second list of cell types");
  if (!has_points_ || !has_cells_) source_.refuse("CELL_TYPES stands before POINTS or CELLS; it must follow both");
  has_types_ = true;
  const std::uint64_t count = source_.count("the number of cells"), cells = begins_.size() - 1;
  if (count != cells) source_.refuse(std::to_string(count) + " cell types for " + std::to_string(cells) + " cells");
  const std::vector<std::int64_t> types = source_.integers(count, "int");
  for (std::size_t c = 0; c < types.size(); ++c) {
    if (types[c] < 0 || types[c] > 255) {
      source_.refuse("cell " + std::to_string(c) + " has type " + std::to_string(types[c]) +
                     "; it must be from 0 to 255");
    }
    const auto vertices = std::span<const std::int64_t>(list_).subspan(begins_[c], begins_[c + 1] - begins_[c]);
    grid_.add_cell(static_cast<int>(types[c]), vertices);
  }
}

void LegacyVtkReader::begin_data(Owner owner, std::uint64_t expected) {
  if (!has_types_) source_.refuse("data stand before POINTS, CELLS and CELL_TYPES; they must follow");
  owner_ = owner;
  items_ = source_.count("the number of items");
  if (items_ == expected) return;
  source_.refuse(std::to_string(items_) + " items where the mesh has " + std::to_string(expected));
}

void LegacyVtkReader::read_array(const std::string& array, std::uint64_t components, std::uint64_t tuples,
                                 const std::string& type) {
  const bool fibres = components == 3 && owner_ == Owner::cells && VtkGrid::is_fibre_array(array);
  const bool plain = components == 1 && ((owner_ == Owner::cells && VtkGrid::is_region_array(array)) ||
                                         (owner_ == Owner::vertices && VtkGrid::is_set_array(array)) ||
                                         (owner_ == Owner::file && VtkGrid::is_region_name_array(array)));
  std::vector<double> values;
  source_.values(components * tuples, type, plain || fibres ? &values : nullptr);
  if (fibres) grid_.add_fibre_array(array, values);
  if (!plain) return;
  if (owner_ == Owner::cells) {
    grid_.add_region_array(array, std::move(values));
  } else if (owner_ == Owner::vertices) {
    grid_.add_set_array(array, values);
  } else {
    grid_.add_region_name_array(array, values);
  }
}

void LegacyVtkReader::read_field() {
  source_.word("the name of the field");
  const std::uint64_t arrays = source_.count("the number of arrays");
  for (std::uint64_t i = 0; i < arrays; ++i) {
    std::string array = array_name();
    if (lower_case(array) == "metadata") {
      skip_metadata();
      array = array_name();
    }
    const std::uint64_t components = source_.count("the number of components");
    const std::uint64_t tuples = source_.count("the number of tuples");
    if (components > 0 && tuples > std::uint64_t{1} << 40) source_.refuse("more tuples than any file has room for");
    if (components > std::uint64_t{1} << 20) source_.refuse("more components than any array has");
    const std::string type = source_.type();
    read_array(array, components, tuples, type);
  }
}

void LegacyVtkReader::read_scalars() {
  const std::string array = array_name();
  const std::string type = source_.type();
  std::string next = lower_case(source_.word("LOOKUP_TABLE"));
  std::uint64_t components = 1;
  if (next != "lookup_table") {
    if (next.size() != 1 || next[0] < '1' || next[0] > '4') {
      source_.refuse("expected 1 to 4 components, found \"" + next.substr(0, 40) + "\"");
    }
    components = static_cast<std::uint64_t>(next[0] - '0');
    next = lower_case(source_.word("LOOKUP_TABLE"));
  }
  if (next != "lookup_table") source_.refuse("expected LOOKUP_TABLE, found \"" + next.substr(0, 40) + "\"");
  source_.word("the name of the lookup table");
  read_array(array, components, items_, type);
}

/// Attributes that hold a fixed number of values an item, or say it; false for another keyword.
bool LegacyVtkReader::read_attribute(const std::string& keyword) {
  constexpr std::pair<const char*, std::uint64_t> kFixed[] = {{"vectors", 3},   {"normals", 3},    {"tensors", 9},
                                                              {"tensors6", 6},  {"global_ids", 1}, {"pedigree_ids", 1},
                                                              {"edge_flags", 1}};
  for (const auto& [name, components] : kFixed) {
    if (keyword != name) continue;
    const std::string array = array_name();
    read_array(array, components, items_, source_.type());
    return true;
  }
  if (keyword == "scalars") {
    read_scalars();
  } else if (keyword == "lookup_table") {
    source_.word("a name");
    source_.values(4 * source_.count("the size of the table"), "unsigned_char");
  } else if (keyword == "color_scalars" || keyword == "texture_coordinates") {
    source_.word("a name");
    const std::uint64_t components = source_.count("the number of components");
    if (components > 4) source_.refuse(std::to_string(components) + " components; at most 4");
    source_.values(components * items_, keyword == "color_scalars" ? "unsigned_char" : source_.type());
  } else {
    return false;
  }
  return true;
}

/// Lines up to an empty one.
void LegacyVtkReader::skip_metadata() {
  source_.line();
  while (!source_.at_end() && !source_.line().empty()) {
  }
}

void LegacyVtkReader::read_section(const std::string& keyword) {
  if (keyword == "points") {
    read_points();
  } else if (keyword == "cells") {
    read_cells();
  } else if (keyword == "cell_types") {
    read_cell_types();
  } else if (keyword == "cell_data") {
    begin_data(Owner::cells, has_cells_ ? begins_.size() - 1 : 0);
  } else if (keyword == "point_data") {
    begin_data(Owner::vertices, vertices_);
  } else if (keyword == "field") {
    read_field();
  } else if (keyword == "metadata") {
    skip_metadata();
  } else if (!read_attribute(keyword)) {
    source_.refuse("unknown keyword");
  }
}

RawMesh LegacyVtkReader::read() {
  read_header();
  while (const auto keyword = source_.next_keyword()) read_section(*keyword);
  if (!has_points_) source_.refuse("the file ends without POINTS: it is cut off");
  if (!has_cells_) source_.refuse("the file ends without CELLS: it is cut off");
  if (!has_types_) source_.refuse("the file ends without CELL_TYPES: it is cut off");
  return grid_.finish();
}

}  // namespace

RawMesh read_legacy_vtk(std::string_view bytes, const std::string& name) { return LegacyVtkReader(bytes, name).read(); }

}  // namespace glisson::detail
