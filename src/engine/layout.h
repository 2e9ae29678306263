// layout.h — how a submesh lies in memory.
//
// A submesh is a compact part of the body, of one tissue, with its own vertex numbers 0 … n−1:
//
//   local vertices   [ interior: in no other submesh … | shared: one copy of an interface vertex each … ]
//                      0                                 interior_count                              n
//
// The state lives once a vertex, in double, one 64-byte record each, all interiors first:
//
//   state     [ u.x u.y u.z c | v.x v.y v.z d ]     c = h/(m + γh) [s/kg], d = γh/(m + γh) [-]
//             ┌───────────────┬───────────────┬─────┬──────────────────────┐
//             │ interior of 0 │ interior of 1 │  …  │ interface vertices   │
//             └───────────────┴───────────────┴─────┴──────────────────────┘
//
// Each step a task takes one submesh through its own scratch memory, small enough for the first-level cache:
//
//   state ──▶ float records [u.xyz · | v.xyz ·], 32 bytes a local vertex
//                │ pairs, a batch of L lanes at a time                     (L = 16, 8, 4 or 1 by instruction set)
//                ▼
//             forces [f.xyz 0], 16 bytes a local vertex ──▶ interior: integrated at once, still in cache
//                                                      └──▶ shared: put into the copy's own slot
//   when all tasks are done: each interface vertex adds up its slots in order of submesh, and is integrated.
//
// The element is a *pair* of tets with a common face: five vertices fetched and five forces stored for two
// tets, instead of eight. Vertex 0 is on the common face and the origin of the differences:
//
//            1               tet A = 1, 2, 3 and 0
//          ╱ │ ╲             tet B = 4, 2, 3 and 0
//         0──┼──2            Both need the differences of 2 and 3; A has that of 1, B that of 4.
//          ╲ 3 ╱
//            4
//
//   batch of L pairs: index   5 × L × 16 bit, vertex-major          = 10 bytes a pair
//                     rest   20 × L floats: s₁ s₂ s₃ −V of A, s₄ s₂ s₃ −V of B = 80 bytes a pair
//
// Lane l of a batch takes pairs far from those of the other lanes (of P pairs in B batches, batch b takes b,
// b + B, b + 2B, …), so that lanes seldom add to the same force record in one go.
// Submeshes of a linear tissue hold edges instead (edges-inl.h).
#pragma once

#include <cstddef>
#include <cstdint>

namespace glisson::engine {

inline constexpr std::size_t kStateFloats = 8;   ///< float record of a local vertex: u, v
inline constexpr std::size_t kForceFloats = 4;   ///< force record of a local vertex
inline constexpr std::size_t kStateDoubles = 8;  ///< state record of a vertex: u, c, v, d
inline constexpr std::size_t kIndexScale = 4;    ///< factor in stored local indices
inline constexpr std::size_t kMaxLocalVertices = 65536 / kIndexScale;

inline constexpr std::size_t kPairVertices = 5;
inline constexpr std::size_t kTetRest = 10;      ///< three shape gradients and −V
inline constexpr std::size_t kBlockBatches = 4;  ///< batches that go through a stage together
inline constexpr std::size_t kMaxLanes = 16;
/// Tets of a block: the values a law sees at once.
inline constexpr std::size_t kBlockTets = 2 * kBlockBatches * kMaxLanes;

}  // namespace glisson::engine
