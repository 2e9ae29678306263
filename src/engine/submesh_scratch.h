// submesh_scratch.h — the memory a thread takes submeshes through, and vectors out of records and back.
#pragma once

#include <algorithm>

#include "engine/kernels/response_kernels.h"
#include "engine/submesh_body.h"

namespace glisson::engine {

inline constexpr std::size_t kInterfaceChunk = 512;  ///< interface vertices a task

/// Floats of n force records, up to a whole vector of lanes.
inline std::size_t force_floats(std::size_t n) { return (n * kForceFloats + kMaxLanes - 1) / kMaxLanes * kMaxLanes; }

inline Vec3d vector_of(const float* f) {
  return {static_cast<double>(f[0]), static_cast<double>(f[1]), static_cast<double>(f[2])};
}
inline Vec3d vector_of(const double* f) { return {f[0], f[1], f[2]}; }
inline void put(const Vec3d& v, double* out) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

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
