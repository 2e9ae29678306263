// gmsh_reader.cpp — the .msh format of Gmsh, versions 2.2 and 4.1, text and binary.
//
// Why our own parser: Gmsh's library is GPL, and no C++ reader of its format under a permissive licence is
// packaged for the systems we build on. VTK, which reads our other formats, does not know this one.
//
// What is read: nodes (tags may have gaps and any order, parameters on their entity are dropped), linear
// tetrahedra, physical groups, those of partitions too. A physical volume is a region, a physical surface,
// curve or point a vertex set of its name. Everything else of the format (periodicity, results) is passed over.
#include <algorithm>
#include <array>
#include <cmath>

#include "io/gmsh_cells.h"
#include "io/gmsh_source.h"

namespace glisson::detail {
namespace {

class GmshReader {
 public:
  GmshReader(std::string_view bytes, const std::string& name) : source_(bytes, name) {}

  RawMesh read() {
    std::string section;
    if (!source_.next_section(section) || section != "MeshFormat") {
      source_.fail(
          "a Gmsh file begins with $MeshFormat; this is another format, or version 1: convert it in Python with "
          "glisson.convert(FILE, \"mesh.vtu\"), or by gmsh FILE -save -format msh41");
    }
    read_format();
    while (source_.next_section(section)) read_section(section);
    if (!has_nodes_) source_.fail("the file ends without a $Nodes section: it is cut off");
    if (!has_elements_) source_.fail("the file ends without an $Elements section: it is cut off");
    cells_.finish(raw_, !version_4_);
    return std::move(raw_);
  }

 private:
  void read_format();
  void read_section(const std::string& section);
  void read_physical_names();
  void read_nodes_22(bool parametric);
  void read_parameters_22();
  void read_elements_22();
  void read_element_22(const GmshCellType& type, std::uint64_t number, std::int64_t tags);
  void read_entities(bool partitioned);
  void read_ghosts();
  void read_entity(int dimension, bool partitioned);
  void read_groups(std::pair<int, std::int64_t> entity, std::pair<int, std::int64_t> parent);
  void read_nodes_41();
  void read_node_block(std::uint64_t& number);
  void read_elements_41();
  void read_element_block(std::uint64_t& number);
  void read_position();
  void finish_nodes(std::uint64_t said);
  void begin_elements();
  const GmshCellType& cell_type(std::int64_t type);
  std::uint32_t vertex(std::uint64_t tag);
  std::span<const std::uint32_t> read_vertices(const GmshCellType& type, bool tags_are_sizes);

  GmshSource source_;
  RawMesh raw_;
  GmshNodeIndex nodes_;
  GmshCells cells_;
  std::map<std::pair<int, std::int64_t>, std::vector<std::int64_t>> entity_groups_;
  std::array<std::uint32_t, 125> vertices_{};
  bool version_4_ = false, has_nodes_ = false, has_elements_ = false;
};

void GmshReader::read_format() {
  source_.text_record("format");
  const double version = source_.text_real("the version");
  const std::int64_t type = source_.text_integer("the file type");
  const std::int64_t size = source_.text_integer("the data size");
  version_4_ = version == 4.1;
  if (!version_4_ && !(version >= 2.0 && version < 3.0)) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", version);
    source_.fail(std::string("Gmsh format ") + text +
                 " is not read, only 2.2 and 4.1; convert it in Python with glisson.convert(FILE, \"mesh.vtu\"), or by "
                 "gmsh FILE "
                 "-save -format msh41");
  }
  if (type != 0 && type != 1) source_.fail("file type " + std::to_string(type) + "; it must be 0 (text) or 1 (binary)");
  if (size != 8 && !(size == 4 && version_4_)) source_.fail("data size " + std::to_string(size) + "; it must be 8");
  source_.end_of_text_line();
  if (type == 1) {
    source_.set_binary(static_cast<std::size_t>(size));
    source_.byte_order_mark();
  }
  source_.end_section();
}

void GmshReader::read_section(const std::string& section) {
  if (section == "PhysicalNames") {
    read_physical_names();
  } else if (section == "Entities" && version_4_) {
    read_entities(false);
  } else if (section == "PartitionedEntities" && version_4_) {
    read_entities(true);
  } else if (section == "Nodes") {
    version_4_ ? read_nodes_41() : read_nodes_22(false);
  } else if (section == "ParametricNodes" && !version_4_) {
    read_nodes_22(true);
  } else if (section == "Elements") {
    version_4_ ? read_elements_41() : read_elements_22();
  } else {
    source_.skip_section();
    return;
  }
  source_.end_section();
}

void GmshReader::read_physical_names() {
  source_.text_record("count");
  const std::uint64_t count = source_.text_size("the number of names");
  for (std::uint64_t i = 1; i <= count; ++i) {
    source_.text_record("name", i);
    const std::int64_t dimension = source_.text_integer("the dimension");
    const std::int64_t tag = source_.text_integer("the physical tag");
    if (dimension < 0 || dimension > 3) {
      source_.fail("dimension " + std::to_string(dimension) + " of a physical group; it must be from 0 to 3");
    }
    cells_.name_group({static_cast<int>(dimension), tag}, source_.quoted("the name"));
  }
}

void GmshReader::read_position() {
  const double x = source_.real("x"), y = source_.real("y"), z = source_.real("z");
  if (!(std::isfinite(x) && std::isfinite(y) && std::isfinite(z))) {
    source_.fail("the coordinates are not finite numbers");
  }
  raw_.mesh.vertices.push_back({x, y, z});
}

void GmshReader::finish_nodes(std::uint64_t said) {
  if (nodes_.size() != said) {
    source_.fail("the header says " + std::to_string(said) + " nodes, the blocks hold " +
                 std::to_string(nodes_.size()));
  }
  if (const std::uint64_t* twice = nodes_.finish()) {
    source_.fail("node " + std::to_string(*twice) + " is given twice; every node needs a number of its own");
  }
  has_nodes_ = true;
}

/// The entity that a node lies on, and its parameters there.
void GmshReader::read_parameters_22() {
  const std::int64_t dimension = source_.integer("the entity's dimension");
  if (dimension < 0 || dimension > 3) source_.fail("entity dimension " + std::to_string(dimension) + "; from 0 to 3");
  source_.integer("the entity's tag");
  for (std::int64_t p = 0; p < dimension % 3; ++p) source_.real("a parametric coordinate");  // none in volumes
}

void GmshReader::read_nodes_22(bool parametric) {
  if (has_nodes_) source_.fail("a second $Nodes section");
  source_.text_record("count");
  const std::uint64_t count = source_.text_size("the number of nodes");
  source_.end_of_text_line();
  source_.require_room(count, 8, 28, "nodes");
  for (std::uint64_t i = 1; i <= count; ++i) {
    source_.record("node", i);
    const std::int64_t tag = source_.integer("the node number");
    if (tag < 0) source_.fail("node number " + std::to_string(tag) + "; it must not be negative");
    nodes_.add(static_cast<std::uint64_t>(tag));
    read_position();
    if (parametric) read_parameters_22();
  }
  finish_nodes(count);
}

void GmshReader::begin_elements() {
  if (has_elements_) source_.fail("a second $Elements section");
  if (!has_nodes_) source_.fail("$Elements stands before $Nodes; it must follow");
  has_elements_ = true;
}

const GmshCellType& GmshReader::cell_type(std::int64_t type) {
  const GmshCellType* found = gmsh_cell_type(type);
  if (found == nullptr) source_.fail("unknown element type " + std::to_string(type));
  return *found;
}

std::uint32_t GmshReader::vertex(std::uint64_t tag) {
  const std::uint32_t* found = nodes_.find(tag);
  if (found == nullptr) source_.fail("refers to node " + std::to_string(tag) + ", which $Nodes does not hold");
  return *found;
}

std::span<const std::uint32_t> GmshReader::read_vertices(const GmshCellType& type, bool tags_are_sizes) {
  for (std::size_t n = 0; n < type.nodes; ++n) {
    if (tags_are_sizes) {
      vertices_[n] = vertex(source_.size("a node number"));
      continue;
    }
    const std::int64_t tag = source_.integer("a node number");
    if (tag < 0) source_.fail("refers to node " + std::to_string(tag) + ", which $Nodes does not hold");
    vertices_[n] = vertex(static_cast<std::uint64_t>(tag));
  }
  return std::span(vertices_).first(type.nodes);
}

void GmshReader::read_element_22(const GmshCellType& type, std::uint64_t number, std::int64_t tags) {
  if (tags < 0 || tags > 1000) {
    source_.fail(std::to_string(tags) + " tags of element " + std::to_string(number) + "; expected from 0 to 1000");
  }
  std::int64_t physical = 0;
  for (std::int64_t i = 0; i < tags; ++i) {
    const std::int64_t tag = source_.integer("a tag");
    if (i == 0) physical = tag;
  }
  const auto vertices = read_vertices(type, false);
  cells_.add(type, {&physical, physical != 0 ? 1u : 0u}, vertices);
}

void GmshReader::read_elements_22() {
  begin_elements();
  source_.text_record("count");
  const std::uint64_t count = source_.text_size("the number of elements");
  source_.end_of_text_line();
  source_.require_room(count, 8, 8, "elements");
  for (std::uint64_t i = 1; i <= count;) {
    source_.record("element", i);
    if (!source_.binary()) {
      source_.integer("the element number");
      const GmshCellType& type = cell_type(source_.integer("the element type"));
      read_element_22(type, i++, source_.integer("the number of tags"));
      continue;
    }
    const GmshCellType& type = cell_type(source_.integer("the element type"));
    const std::int64_t in_block = source_.integer("the number of elements of this type");
    const std::int64_t tags = source_.integer("the number of tags");
    if (in_block < 1 || static_cast<std::uint64_t>(in_block) > count - (i - 1)) {
      source_.fail("a block of " + std::to_string(in_block) + " elements where " + std::to_string(count - (i - 1)) +
                   " are left of the count");
    }
    for (std::int64_t e = 0; e < in_block; ++e) {
      source_.record("element", i);
      source_.integer("the element number");
      read_element_22(type, i++, tags);
    }
  }
}

/// The physical groups of an entity; a part of another of its dimension is in the groups of that one where it has none of its own.
void GmshReader::read_groups(std::pair<int, std::int64_t> entity, std::pair<int, std::int64_t> parent) {
  std::vector<std::int64_t> own;
  const std::uint64_t groups = source_.size("the number of physical tags");
  source_.require_room(groups, 2, 4, "physical tags");
  for (std::uint64_t i = 0; i < groups; ++i) {
    // A negative tag means the entity is in the group with its orientation reversed.
    const std::int64_t group = std::abs(source_.integer("a physical tag"));
    if (group != 0 && std::find(own.begin(), own.end(), group) == own.end()) own.push_back(group);
  }
  if (own.empty() && parent.first == entity.first) own = entity_groups_[parent];
  entity_groups_[entity] = std::move(own);
}

void GmshReader::read_entity(int dimension, bool partitioned) {
  const std::int64_t tag = source_.integer("the entity's tag");
  std::pair<int, std::int64_t> parent{-1, 0};
  if (partitioned) {
    parent.first = static_cast<int>(source_.integer("the parent's dimension"));
    parent.second = source_.integer("the parent's tag");
    const std::uint64_t partitions = source_.size("the number of partitions");
    source_.require_room(partitions, 2, 4, "partitions");
    for (std::uint64_t i = 0; i < partitions; ++i) source_.integer("a partition");
  }
  for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) source_.real("a bound");
  read_groups({dimension, tag}, parent);
  if (dimension == 0) return;
  const std::uint64_t bounding = source_.size("the number of bounding entities");
  source_.require_room(bounding, 2, 4, "bounding entities");
  for (std::uint64_t i = 0; i < bounding; ++i) source_.integer("a bounding entity");
}

/// The head of partitioned entities: how many partitions, and which entities hold copies of others' elements.
void GmshReader::read_ghosts() {
  source_.record("head");
  source_.size("the number of partitions");
  source_.record("number of ghost entities");
  const std::uint64_t ghosts = source_.size("the number of ghost entities");
  source_.require_room(ghosts, 4, 8, "ghost entities");
  for (std::uint64_t i = 1; i <= ghosts; ++i) {
    source_.record("ghost entity", i);
    source_.integer("the ghost entity's tag");
    source_.integer("its partition");
  }
}

void GmshReader::read_entities(bool partitioned) {
  if (has_elements_) source_.fail("entities stand after $Elements; they must come before");
  if (partitioned) read_ghosts();
  source_.record("counts");
  std::array<std::uint64_t, 4> counts{};
  for (std::uint64_t& count : counts) {
    count = source_.size("a number of entities");
    source_.require_room(count, 8, 32, "entities");
  }
  const char* kinds[] = {"point", "curve", "surface", "volume"};
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (std::uint64_t i = 1; i <= counts[static_cast<std::size_t>(dimension)]; ++i) {
      source_.record(kinds[dimension], i);
      read_entity(dimension, partitioned);
    }
  }
}

void GmshReader::read_node_block(std::uint64_t& number) {
  const std::int64_t dimension = source_.integer("the entity's dimension");
  source_.integer("the entity's tag");
  const std::int64_t parametric = source_.integer("the flag for parametric coordinates");
  const std::uint64_t count = source_.size("the number of nodes in the block");
  if (dimension < 0 || dimension > 3) source_.fail("entity dimension " + std::to_string(dimension) + "; from 0 to 3");
  if (parametric != 0 && parametric != 1) source_.fail("parametric flag " + std::to_string(parametric) + "; 0 or 1");
  source_.require_room(count, 8, 28, "nodes");
  const std::uint64_t first = number;
  for (std::uint64_t i = 0; i < count; ++i) {
    source_.record("node", first + i);
    nodes_.add(source_.size("the node number"));
  }
  for (std::uint64_t i = 0; i < count; ++i, ++number) {
    source_.record("node", number);
    read_position();
    for (std::int64_t p = 0; p < parametric * dimension; ++p) source_.real("a parametric coordinate");
  }
}

void GmshReader::read_nodes_41() {
  if (has_nodes_) source_.fail("a second $Nodes section");
  source_.record("header");
  const std::uint64_t blocks = source_.size("the number of blocks");
  const std::uint64_t count = source_.size("the number of nodes");
  source_.size("the lowest node number");
  source_.size("the highest node number");
  source_.require_room(blocks, 8, 16, "blocks");
  source_.require_room(count, 8, 28, "nodes");
  std::uint64_t number = 1;
  for (std::uint64_t b = 1; b <= blocks; ++b) {
    source_.record("block", b);
    read_node_block(number);
  }
  source_.record("header");
  finish_nodes(count);
}

void GmshReader::read_element_block(std::uint64_t& number) {
  source_.integer("the entity's dimension");
  const std::int64_t entity = source_.integer("the entity's tag");
  const GmshCellType& type = cell_type(source_.integer("the element type"));
  const std::uint64_t count = source_.size("the number of elements in the block");
  source_.require_room(count, 4, 8, "elements");
  const auto found = entity_groups_.find({type.dimension, entity});
  const std::span<const std::int64_t> groups =
      found == entity_groups_.end() ? std::span<const std::int64_t>() : std::span(found->second);
  for (std::uint64_t i = 0; i < count; ++i, ++number) {
    source_.record("element", number);
    source_.size("the element number");
    cells_.add(type, groups, read_vertices(type, true));
  }
}

void GmshReader::read_elements_41() {
  begin_elements();
  source_.record("header");
  const std::uint64_t blocks = source_.size("the number of blocks");
  const std::uint64_t count = source_.size("the number of elements");
  source_.size("the lowest element number");
  source_.size("the highest element number");
  source_.require_room(blocks, 8, 16, "blocks");
  source_.require_room(count, 4, 8, "elements");
  std::uint64_t number = 1;
  for (std::uint64_t b = 1; b <= blocks; ++b) {
    source_.record("block", b);
    read_element_block(number);
  }
  source_.record("header");
  if (number - 1 != count) {
    source_.fail("the header says " + std::to_string(count) + " elements, the blocks hold " +
                 std::to_string(number - 1));
  }
}

}  // namespace

RawMesh read_gmsh(std::string_view bytes, const std::string& name) { return GmshReader(bytes, name).read(); }

}  // namespace glisson::detail
