// submesh_scratch.h — the memory a thread takes submeshes through: float records and forces of local vertices, and what a block
// of batches holds between the stages.
#pragma once

#include <algorithm>

#include "engine/kernels/response_kernels.h"
#include "engine/layout/submesh.h"

namespace glisson::engine {

/// Floats of n force records, up to a whole vector of lanes.
inline std::size_t force_floats(std::size_t n) { return (n * kForceFloats + kMaxLanes - 1) / kMaxLanes * kMaxLanes; }

struct SubmeshScratch {
  LaneVector<float> states, elastic, viscous, pairs;
  Block block;
  ResponseBlock response;
  alignas(64) float rate[kBlockTets * 9];
  alignas(64) float mean[kBlockTets];

  /// @param n  local vertices
  void make_room(std::size_t n) {
    states.resize(std::max(states.size(), n * kStateFloats));
    elastic.resize(std::max(elastic.size(), force_floats(n)));
    viscous.resize(elastic.size());
    pairs.resize(2 * elastic.size());
  }
};

}  // namespace glisson::engine
