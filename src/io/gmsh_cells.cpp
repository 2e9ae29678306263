#include "io/gmsh_cells.h"

#include <algorithm>
#include <set>

#include "base/text.h"
#include "mesh/topology/repeated_tets.h"

namespace glisson::detail {
namespace {

constexpr GmshCellType kTypes[] = {
    {1, 2, 1, "lines"},
    {2, 3, 2, "triangles"},
    {3, 4, 2, "quadrangles"},
    {4, 4, 3, "tetrahedra"},
    {5, 8, 3, "hexahedra"},
    {6, 6, 3, "prisms"},
    {7, 5, 3, "pyramids"},
    {8, 3, 1, "3-node lines"},
    {9, 6, 2, "6-node triangles"},
    {10, 9, 2, "9-node quadrangles"},
    {11, 10, 3, "10-node tetrahedra"},
    {12, 27, 3, "27-node hexahedra"},
    {13, 18, 3, "18-node prisms"},
    {14, 14, 3, "14-node pyramids"},
    {15, 1, 0, "points"},
    {16, 8, 2, "8-node quadrangles"},
    {17, 20, 3, "20-node hexahedra"},
    {18, 15, 3, "15-node prisms"},
    {19, 13, 3, "13-node pyramids"},
    {20, 9, 2, "9-node triangles"},
    {21, 10, 2, "10-node triangles"},
    {22, 12, 2, "12-node triangles"},
    {23, 15, 2, "15-node triangles"},
    {24, 15, 2, "incomplete 15-node triangles"},
    {25, 21, 2, "21-node triangles"},
    {26, 4, 1, "4-node lines"},
    {27, 5, 1, "5-node lines"},
    {28, 6, 1, "6-node lines"},
    {29, 20, 3, "20-node tetrahedra"},
    {30, 35, 3, "35-node tetrahedra"},
    {31, 56, 3, "56-node tetrahedra"},
    {92, 64, 3, "64-node hexahedra"},
    {93, 125, 3, "125-node hexahedra"},
};

}  // namespace

const GmshCellType* gmsh_cell_type(std::int64_t type) {
  const auto* found = std::find_if(std::begin(kTypes), std::end(kTypes), [&](const auto& t) { return t.type == type; });
  return found == std::end(kTypes) ? nullptr : found;
}

const std::uint64_t* GmshNodeIndex::finish() {
  const auto by_tag = [](const Entry& a, const Entry& b) { return a.tag < b.tag; };
  if (!std::is_sorted(tags_.begin(), tags_.end(), by_tag)) std::sort(tags_.begin(), tags_.end(), by_tag);
  const auto twice =
      std::adjacent_find(tags_.begin(), tags_.end(), [](const Entry& a, const Entry& b) { return a.tag == b.tag; });
  return twice == tags_.end() ? nullptr : &twice->tag;
}

const std::uint32_t* GmshNodeIndex::find(std::uint64_t tag) const {
  if (tags_.empty() || tag < tags_.front().tag) return nullptr;
  // Without gaps, the usual case, the tag tells the place.
  const std::uint64_t guess = tag - tags_.front().tag;
  if (guess < tags_.size() && tags_[guess].tag == tag) return &tags_[guess].vertex;
  const auto found = std::lower_bound(tags_.begin(), tags_.end(), tag,
                                      [](const Entry& entry, std::uint64_t t) { return entry.tag < t; });
  return found == tags_.end() || found->tag != tag ? nullptr : &found->vertex;
}

void GmshCells::add(const GmshCellType& type, std::span<const std::int64_t> groups,
                    std::span<const std::uint32_t> vertices) {
  if (type.type == kGmshLinearTet || type.type == kGmshCurvedTet) {
    const auto& v = vertices;
    tets_.push_back({v[0], v[1], v[2], v[3]});
    if (type.type == kGmshCurvedTet) curved_.push_back({tets_.back(), {v[4], v[5], v[6], v[7], v[9], v[8]}});
    regions_.push_back(groups.empty() ? 0 : static_cast<int>(groups[0]));
    for (std::size_t i = 1; i < groups.size(); ++i)
      other_volumes_.emplace_back(tets_.size() - 1, std::int64_t(groups[i]));
    return;
  }
  if (type.dimension == 3 || groups.empty()) ++skipped_[type.plural];
  if (type.dimension == 3) return;
  for (const std::int64_t group : groups) {
    auto& set = sets_[{type.dimension, group}];
    set.insert(set.end(), vertices.begin(), vertices.end());
  }
}

std::string GmshCells::name_of(Group group) const {
  const auto named = names_.find(group);
  if (named != names_.end() && !named->second.empty()) return named->second;
  const char* kinds[] = {"point_", "curve_", "surface_", "volume_"};
  return kinds[group.first] + std::to_string(group.second);
}

/// The name of a volume's set is that of the volume, unless a set of lower dimension has it.
std::string GmshCells::set_name_of(Group group, const TetMesh& mesh) const {
  std::string name = name_of(group);
  if (group.first == 3 && mesh.vertex_sets.contains(name)) name = "volume_" + std::to_string(group.second);
  return name;
}

/// Makes one tet of those that stand in the file once for each of their volumes. Copies in the same volume are a fault of the mesh,
/// which its report names.
void GmshCells::join_copies(std::size_t vertices) {
  std::vector<char> is_copy(tets_.size(), 0);
  for_each_repeated_tet(tets_, vertices, [&](std::uint32_t first, std::uint32_t again) {
    if (regions_[again] == regions_[first]) return;
    is_copy[again] = 1;
    if (regions_[again] == 0) return;
    if (regions_[first] == 0) regions_[first] = regions_[again];
    if (regions_[again] != regions_[first]) other_volumes_.emplace_back(first, regions_[again]);
  });
  std::vector<std::size_t> place(tets_.size());
  std::size_t kept = 0;
  for (std::size_t t = 0; t < tets_.size(); ++t) {
    place[t] = kept;
    if (is_copy[t] != 0) continue;
    tets_[kept] = tets_[t], regions_[kept++] = regions_[t];
  }
  tets_.resize(kept), regions_.resize(kept);
  for (auto& other : other_volumes_) other.first = place[other.first];
}

/// Makes vertex sets of the volumes that have tets in common with others.
void GmshCells::add_shared_volumes() {
  std::set<std::int64_t> shared;
  for (const auto& [tet, volume] : other_volumes_) shared.insert({volume, regions_[tet]});
  const auto add_tet = [this](std::int64_t volume, std::size_t tet) {
    auto& set = sets_[{3, volume}];
    set.insert(set.end(), tets_[tet].begin(), tets_[tet].end());
  };
  for (std::size_t t = 0; t < tets_.size() && !shared.empty(); ++t) {
    if (shared.contains(regions_[t])) add_tet(regions_[t], t);
  }
  for (const auto& [tet, volume] : other_volumes_) add_tet(volume, tet);
}

void GmshCells::finish(RawMesh& raw, bool copied) {
  const bool several = std::any_of(regions_.begin(), regions_.end(), [&](int region) { return region != regions_[0]; });
  if (copied && several) join_copies(raw.mesh.vertices.size());
  add_shared_volumes();
  raw.mesh.tets = std::move(tets_);
  raw.curved = std::move(curved_);
  if (std::any_of(regions_.begin(), regions_.end(), [](int region) { return region != 0; })) {
    raw.mesh.regions = std::move(regions_);
  }
  for (const auto& [group, name] : names_) {
    if (group.first == 3) raw.mesh.region_names[static_cast<int>(group.second)] = name;
  }
  std::string volumes;
  for (auto& [group, vertices] : sets_) {
    const std::string name = set_name_of(group, raw.mesh);
    auto& set = raw.mesh.vertex_sets[name];
    set.insert(set.end(), vertices.begin(), vertices.end());
    if (group.first == 3) volumes += (volumes.empty() ? "\"" : ", \"") + name + '"';
  }
  raw.skipped = std::move(skipped_);
  if (other_volumes_.empty()) return;
  std::set<std::size_t> tets;
  for (const auto& [tet, volume] : other_volumes_) tets.insert(tet);
  raw.notes.push_back(count_text(tets.size(), "tet is", "tets are") +
                      " in more than one physical volume: the first one of each counts as its region, and all of them "
                      "are vertex sets: " +
                      volumes + ".");
}

}  // namespace glisson::detail
