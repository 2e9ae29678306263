// gmsh_cells.h — the element types of Gmsh and where their nodes and groups go in a TetMesh.
#pragma once

#include <map>
#include <span>
#include <utility>

#include "io/raw_mesh.h"

namespace glisson::detail {

struct GmshCellType {
  int type = 0;
  std::size_t nodes = 0;
  int dimension = 0;
  const char* plural = "";
};

inline constexpr int kGmshLinearTet = 4, kGmshCurvedTet = 11;

/// @return the type, or null if Gmsh has none of that number
const GmshCellType* gmsh_cell_type(std::int64_t type);

/// Node tags of the file (any positive numbers, in any order) → vertex numbers in the order of the file.
class GmshNodeIndex {
 public:
  void add(std::uint64_t tag) { tags_.push_back({tag, static_cast<std::uint32_t>(tags_.size())}); }
  /// Call once, after the last add. @return a tag that was added twice, or null
  const std::uint64_t* finish();
  /// @return the vertex, or null for an unknown tag
  const std::uint32_t* find(std::uint64_t tag) const;
  std::size_t size() const { return tags_.size(); }

 private:
  struct Entry {
    std::uint64_t tag;
    std::uint32_t vertex;
  };
  std::vector<Entry> tags_;
};

/// Elements on their way into the mesh: tets with their region, groups of lower dimension as vertex sets.
class GmshCells {
 public:
  using Group = std::pair<int, std::int64_t>;  ///< dimension, physical tag

  void name_group(Group group, std::string name) { names_[group] = std::move(name); }
  /// @param groups    physical tags, none of them 0
  /// @param vertices  as many as the type has nodes
  void add(const GmshCellType& type, std::span<const std::int64_t> groups, std::span<const std::uint32_t> vertices);
  /// Hands regions, names and sets over to the mesh, whose vertices are there. A tet in several volumes has the first of these as
  /// its region, and all of them become vertex sets too.
  /// @param copied  whether an element is written once for each of its groups, as version 2 does
  void finish(RawMesh& raw, bool copied);

 private:
  std::string name_of(Group group) const;
  std::string set_name_of(Group group, const TetMesh& mesh) const;
  void join_copies(std::size_t vertices);
  void add_shared_volumes();

  std::vector<Tet> tets_;
  std::vector<CurvedTet> curved_;
  std::vector<int> regions_;
  std::map<Group, std::string> names_;
  std::map<Group, std::vector<std::uint32_t>> sets_;
  std::map<std::string, std::size_t> skipped_;
  std::vector<std::pair<std::size_t, std::int64_t>>
      other_volumes_;  ///< tets and volumes they are in besides their region
};

}  // namespace glisson::detail
