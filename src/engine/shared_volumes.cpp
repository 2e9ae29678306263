#include "engine/shared_volumes.h"

#include <algorithm>

namespace glisson::engine {

void SharedVolumes::weigh() {
  any_ = std::ranges::any_of(submeshes_.parts, [&](const Submesh& part) { return shares(part); });
  if (!any_) return;
  volumes_.assign(submeshes_.parts.size(), {});
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    if (body_.blocks[b].tissue.volume_change != VolumeChange::average_nodal) continue;
    std::vector<double> volume(body_.vertex_count, 0.0);
    for (std::size_t e = body_.blocks[b].begin; e < body_.blocks[b].end; ++e) {
      for (const std::uint32_t v : body_.elements[e]) volume[submeshes_.record_of_vertex[v]] += body_.rest[e].volume;
    }
    for (std::size_t p = 0; p < submeshes_.parts.size(); ++p) {
      const Submesh& part = submeshes_.parts[p];
      if (part.block != b) continue;
      Volumes& own = volumes_[p];
      own.theta.assign(part.local_vertices(), 0.0F);
      const auto weigh = [&](std::size_t record) {
        own.per_volume.push_back(volume[record] > 0.0 ? static_cast<float>(1.0 / volume[record]) : 0.0F);
      };
      for (std::size_t k = 0; k < part.interior_count; ++k) weigh(part.first_interior + k);
      for (const std::uint32_t record : part.shared) weigh(record);
    }
  }
  slots_.assign(submeshes_.interface.slot_count, 0.0F);
  part_of_slot_.clear();
  for (std::uint32_t p = 0; p < submeshes_.parts.size(); ++p) {
    part_of_slot_.insert(part_of_slot_.end(), submeshes_.parts[p].shared.size(), p);
  }
}

void SharedVolumes::spread(std::size_t s) {
  const Submesh& part = submeshes_.parts[s];
  Volumes& own = volumes_[s];
  std::copy_n(own.theta.data() + part.interior_count, part.shared.size(), slots_.data() + part.first_slot);
  for (std::size_t k = 0; k < part.interior_count; ++k) own.theta[k] *= own.per_volume[k];
}

const float* SharedVolumes::join(std::size_t s) {
  const Submesh& part = submeshes_.parts[s];
  Volumes& own = volumes_[s];
  const Interface& shared = submeshes_.interface;
  for (std::size_t k = 0; k < part.shared.size(); ++k) {
    const std::size_t vertex = part.shared[k] - shared.first_record;
    float sum = 0.0F;
    for (std::uint32_t i = shared.slot_begin[vertex]; i < shared.slot_begin[vertex + 1]; ++i) {
      const std::uint32_t slot = shared.slots[i];
      if (submeshes_.parts[part_of_slot_[slot]].block == part.block) sum += slots_[slot];
    }
    const std::size_t local = part.interior_count + k;
    own.theta[local] = sum * own.per_volume[local];
  }
  return own.theta.data();
}

}  // namespace glisson::engine
