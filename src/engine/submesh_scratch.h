// submesh_scratch.h — the memory a thread takes submeshes through.
#pragma once

#include <algorithm>

#include "engine/kernels/response_kernels.h"
#include "engine/submesh_body.h"

namespace glisson::engine {

/// Floats of n force records, up to a whole vector of lanes.
inline std::size_t force_floats(std::size_t n) { return (n * kForceFloats + kMaxLanes - 1) / kMaxLanes * kMaxLanes; }

/// What a thread works in.
struct SubmeshBody::Scratch {
  LaneVector<float> states, elastic, viscous;
  Block block;
  ResponseBlock response;
  alignas(64) float rate[kBlockTets * 9];
  alignas(64) float mean[kBlockTets];

  void make_room(std::size_t n) {
    states.resize(std::max(states.size(), n * kStateFloats));
    elastic.resize(std::max(elastic.size(), force_floats(n)));
    viscous.resize(elastic.size());
  }
};

}  // namespace glisson::engine
