// part_fields.cpp — see glisson/simulation/part_fields.h.
#include "glisson/simulation/part_fields.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "dynamics/simulation_parts.h"
#include "element/tet_fields.h"

namespace glisson {

/// Of every block of the simulation's body, with the tet of each element.
struct BranchRecord::Copy {
  std::vector<BranchMemory> memory;
  std::vector<std::size_t> begin;
  std::vector<std::uint32_t> mesh_tet;
};

BranchRecord::BranchRecord(const Simulation& simulation) {
  const Scheme& scheme = SimulationParts::scheme(simulation);
  const Body& body = scheme.body();
  Copy copy;
  for (std::size_t b = 0; b < body.blocks.size(); ++b) {
    copy.memory.push_back(scheme.branch_memory(b));
    copy.begin.push_back(body.blocks[b].begin);
  }
  const auto holds = [](const BranchMemory& x) { return !x.empty() || !x.linear.empty(); };
  if (std::none_of(copy.memory.begin(), copy.memory.end(), holds)) return;
  copy.mesh_tet = body.mesh_tet;
  copy_ = std::make_shared<const Copy>(std::move(copy));
}

/// A body of the tets that fields are asked of, and after these of those that they take means with.
struct PartFields::Parts {
  static constexpr std::uint32_t kAbsent = ~0u;
  /// Where an element is in a record; absent where its tet was gone.
  struct Place {
    std::uint32_t block = kAbsent, element = 0;  ///< counted from the block's first
  };

  std::size_t asked = 0, vertices = 0;
  std::vector<std::uint32_t> own_tet;  ///< of each tet of the whole mesh: its number in this body's, or kAbsent
  std::size_t own_tets = 0;
  Body body;

  std::vector<Place> places_in(const BranchRecord::Copy& record) const;
  std::vector<BranchMemory> memory_in(const BranchRecord::Copy& record) const;
};

namespace {

void require_tets(std::span<const std::uint32_t> tets, std::size_t count) {
  std::vector<char> met(count, 0);
  for (const std::uint32_t t : tets) {
    if (t >= count) {
      throw std::invalid_argument("fields of tet " + std::to_string(t) + ": the mesh has " + std::to_string(count) +
                                  " tets, from 0 on");
    }
    if (met[t] != 0) throw std::invalid_argument("fields of tet " + std::to_string(t) + ": it is given twice");
    met[t] = 1;
  }
}

/// Those that touch some tets. A mean over a vertex needs all tets around it.
std::vector<std::uint32_t> touching(const TetMesh& mesh, std::span<const std::uint32_t> tets) {
  std::vector<char> met(mesh.tets.size(), 0), touched(mesh.vertices.size(), 0);
  for (const std::uint32_t t : tets) {
    met[t] = 1;
    for (const std::uint32_t v : mesh.tets[t]) touched[v] = 1;
  }
  std::vector<std::uint32_t> found;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& tet = mesh.tets[t];
    const bool touches = std::any_of(tet.begin(), tet.end(), [&](std::uint32_t v) { return touched[v] != 0; });
    if (met[t] == 0 && touches) found.push_back(t);
  }
  return found;
}

TetMesh part_of(const TetMesh& mesh, std::span<const std::uint32_t> tets) {
  TetMesh part;
  part.vertices = mesh.vertices;
  for (const std::uint32_t t : tets) {
    part.tets.push_back(mesh.tets[t]);
    part.regions.push_back(mesh.region_of(t));
    if (!mesh.fibres.empty()) part.fibres.push_back(Vec3d(mesh.fibres[t]));
  }
  return part;
}

/// Takes the numbers of element `from` of one memory as those of element `to` of another, of as many branches.
void copy_element(const BranchMemory& all, std::size_t from, BranchMemory& own, std::size_t to) {
  const std::size_t n = own.branches;
  std::copy_n(all.held.begin() + static_cast<std::ptrdiff_t>(from * n), n,
              own.held.begin() + static_cast<std::ptrdiff_t>(to * n));
  std::copy_n(all.left.begin() + static_cast<std::ptrdiff_t>(from * n), n,
              own.left.begin() + static_cast<std::ptrdiff_t>(to * n));
}

void require_size(const char* what, std::size_t size, std::size_t vertices) {
  if (size >= vertices) return;
  throw std::invalid_argument(std::string("fields: ") + what + " of " + std::to_string(size) +
                              " vertices; the mesh has " + std::to_string(vertices));
}

}  // namespace

/// Of each tet of the body's mesh.
auto PartFields::Parts::places_in(const BranchRecord::Copy& record) const -> std::vector<Place> {
  std::vector<Place> places(own_tets);
  for (std::uint32_t b = 0; b < record.memory.size(); ++b) {
    const std::size_t end = b + 1 < record.begin.size() ? record.begin[b + 1] : record.mesh_tet.size();
    for (std::size_t e = record.begin[b]; e < end; ++e) {
      const std::uint32_t tet = record.mesh_tet[e], own = tet < own_tet.size() ? own_tet[tet] : kAbsent;
      if (own != kAbsent) places[own] = {b, static_cast<std::uint32_t>(e - record.begin[b])};
    }
  }
  return places;
}

/// Of the blocks of the body. Zeros are branches that have relaxed.
std::vector<BranchMemory> PartFields::Parts::memory_in(const BranchRecord::Copy& record) const {
  const std::vector<Place> places = places_in(record);
  std::vector<BranchMemory> memory(body.blocks.size());
  for (std::size_t b = 0; b < memory.size(); ++b) {
    const TissueBlock& block = body.blocks[b];
    BranchMemory& own = memory[b];
    own.branches = block.tissue.maxwell.size();
    own.held.resize((block.end - block.begin) * own.branches), own.left.resize(own.held.size());
    own.linear.resize(block.end - block.begin);
    for (std::size_t e = block.begin; e < block.end; ++e) {
      const Place& at = places[body.mesh_tet[e]];
      if (at.block == kAbsent) continue;
      const BranchMemory& all = record.memory[at.block];
      own.linear[e - block.begin] = all.linear_share(at.element);
      if (all.branches == own.branches) copy_element(all, at.element, own, e - block.begin);
    }
  }
  return memory;
}

PartFields::PartFields(const TetMesh& mesh, const std::map<int, Tissue>& tissues, std::vector<std::uint32_t> tets) {
  require_tets(tets, mesh.tets.size());
  Parts parts{.asked = tets.size(), .vertices = mesh.vertices.size(), .own_tet = {}, .body = {}};
  const bool shares = std::any_of(tissues.begin(), tissues.end(), [](const auto& of_region) {
    return of_region.second.volume_change == VolumeChange::average_nodal;
  });
  if (shares) {
    const std::vector<std::uint32_t> more = touching(mesh, tets);
    tets.insert(tets.end(), more.begin(), more.end());
  }
  parts.own_tets = tets.size();
  parts.own_tet.assign(mesh.tets.size(), Parts::kAbsent);
  for (std::uint32_t i = 0; i < tets.size(); ++i) parts.own_tet[tets[i]] = i;
  parts.body = build_body(part_of(mesh, tets), tissues);
  parts_ = std::make_unique<const Parts>(std::move(parts));
}

PartFields::~PartFields() = default;
PartFields::PartFields(PartFields&&) noexcept = default;
PartFields& PartFields::operator=(PartFields&&) noexcept = default;

TetFields PartFields::fields(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity,
                             const BranchRecord& record) const {
  require_size("displacement", displacement.size(), parts_->vertices);
  require_size("velocity", velocity.size(), parts_->vertices);
  std::vector<BranchMemory> memory;
  if (record.copy_) memory = parts_->memory_in(*record.copy_);
  TetFields f = tet_fields(parts_->body, displacement, velocity, memory);
  const std::size_t n = parts_->asked;
  f.q.resize(n), f.s.resize(n), f.jacobian.resize(n), f.linear.resize(n), f.stress.resize(6 * n), f.piola.resize(9 * n);
  return f;
}

}  // namespace glisson
