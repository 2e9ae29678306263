// submesh_volume.cpp — volume changes shared over vertices: a pass over the submeshes before that of the forces.
//
//   task per submesh:  gather → V ϑ → its vertices     inner ones: over the volume around them, done
//                                                      shared ones: into the slot of its copy
//   then, in the pass of the forces, each submesh adds up the slots of its shared vertices that are of its tissue.
//
// Tissues do not share with each other: a vertex between two of them has a mean in each.
#include <algorithm>

#include "engine/submesh_scratch.h"

namespace glisson::engine {

bool SubmeshBody::shares_volume(const Submesh& part) const {
  return body_.blocks[part.block].tissue.volume_change == VolumeChange::average_nodal;
}

/// Volumes around the vertices of each submesh, of its tissue. O(tets).
void SubmeshBody::weigh_vertices() {
  shared_volumes_.assign(submeshes_.parts.size(), {});
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    if (body_.blocks[b].tissue.volume_change != VolumeChange::average_nodal) continue;
    std::vector<double> volume(body_.vertex_count, 0.0);
    for (std::size_t e = body_.blocks[b].begin; e < body_.blocks[b].end; ++e) {
      for (const std::uint32_t v : body_.elements[e]) volume[submeshes_.record_of_vertex[v]] += body_.rest[e].volume;
    }
    for (std::size_t p = 0; p < submeshes_.parts.size(); ++p) {
      const Submesh& part = submeshes_.parts[p];
      if (part.block != b) continue;
      SharedVolume& own = shared_volumes_[p];
      own.theta.assign(part.local_vertices(), 0.0F);
      const auto weigh = [&](std::size_t record) {
        own.per_volume.push_back(volume[record] > 0.0 ? static_cast<float>(1.0 / volume[record]) : 0.0F);
      };
      for (std::size_t k = 0; k < part.interior_count; ++k) weigh(part.first_interior + k);
      for (const std::uint32_t record : part.shared) weigh(record);
    }
  }
  slots_volume_.assign(submeshes_.interface.slot_count, 0.0F);
  part_of_slot_.clear();
  for (std::uint32_t p = 0; p < submeshes_.parts.size(); ++p) {
    part_of_slot_.insert(part_of_slot_.end(), submeshes_.parts[p].shared.size(), p);
  }
}

void SubmeshBody::spread_volume(std::size_t s, Scratch& scratch) {
  const Submesh& part = submeshes_.parts[s];
  if (!shares_volume(part)) return;
  SharedVolume& own = shared_volumes_[s];
  const VolumeKind kind = large_plans_[part.block]->lanes.volume;
  const Elements elements = elements_of(part, scratch);
  narrow(part, scratch);
  std::fill(own.theta.begin(), own.theta.end(), 0.0F);
  for (std::size_t b = 0; b < part.chains.count; b += kBlockBatches) {
    const std::size_t n = std::min(kBlockBatches, part.chains.count - b), items = n * kChainTets;
    kernels_.gather_elastic(elements, b, n, scratch.block);
    const float* rest = part.chains.rest.data() + b * kChainRest * kernels_.lanes;
    kernels_.response->volume_changes(scratch.block.gradient, rest, items, kind, scratch.block.x);
    const std::uint16_t* index = part.chains.index.data() + b * kChainVertices * kernels_.lanes;
    kernels_.response->spread_to_vertices(index, n, scratch.block.x, own.theta.data());
  }
  std::copy(own.theta.begin() + static_cast<std::ptrdiff_t>(part.interior_count), own.theta.end(),
            slots_volume_.begin() + static_cast<std::ptrdiff_t>(part.first_slot));
  for (std::size_t k = 0; k < part.interior_count; ++k) own.theta[k] *= own.per_volume[k];
}

/// ϑ_a of the shared vertices, from the slots of all submeshes of the same tissue.
void SubmeshBody::join_volume(std::size_t s) {
  const Submesh& part = submeshes_.parts[s];
  if (!shares_volume(part)) return;
  SharedVolume& own = shared_volumes_[s];
  const Interface& shared = submeshes_.interface;
  for (std::size_t k = 0; k < part.shared.size(); ++k) {
    const std::size_t vertex = part.shared[k] - shared.first_record;
    float sum = 0.0F;
    for (std::uint32_t i = shared.slot_begin[vertex]; i < shared.slot_begin[vertex + 1]; ++i) {
      const std::uint32_t slot = shared.slots[i];
      if (submeshes_.parts[part_of_slot_[slot]].block == part.block) sum += slots_volume_[slot];
    }
    const std::size_t local = part.interior_count + k;
    own.theta[local] = sum * own.per_volume[local];
  }
}

}  // namespace glisson::engine
