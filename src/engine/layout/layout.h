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
// Each step a task takes one submesh through its own scratch memory, small enough for the nearest caches:
//
//   state ──▶ float records [u.xyz · | v.xyz ·], 32 bytes a local vertex
//                │ chains, a batch of L lanes at a time                     (L = 16, 8, 4 or 1 by instruction set)
//                ▼
//             forces [f.xyz 0], 16 bytes a local vertex ──▶ interior: integrated at once, still in cache
//                                                      └──▶ shared: put into the copy's own slot
//   when all tasks are done: each interface vertex adds up its slots in order of submesh, and is integrated.
//
// The element is a *chain* of three tets, each with a face in common with the next: six vertices fetched and six
// forces stored for three tets, instead of twelve. The two faces have an edge in common, 0–1; vertex 0 is the origin
// of the differences of all three:
//
//          2───────0───────5       tet A = 1, 2, 4 and 0
//         ╱ ╲     ╱│╲     ╱        tet B = 1, 2, 3 and 0      (seen along the edge 0–1; 1 is below 0)
//        ╱   ╲   ╱ │ ╲   ╱         tet C = 1, 3, 5 and 0
//       4─────(0 1)───3            the difference of 1 serves three tets, those of 2 and 3 two each
//
//   batch of L chains: index   6 × L × 16 bit, vertex-major                          = 12 bytes a chain
//                      rest   24 × L floats, see below                               = 96
//
// With edges e of vertices from 0 the gradients of a tet 0 1 a b, going round as 4, 2, 3, 5, are w (e_a × e_b) of 1,
// w (e_b × e₁) of a and w (e₁ × e_a) of b, where 1/w = e₁ · (e_a × e_b) = 6V. Kept are the products, n_a = e₁ × e_a serving
// two tets each, and w. Forces −V σ s are −⅙ σ times the products, without w.
//
//   rest      [ n₂ n₃ | e₄×e₂  e₂×e₃  e₃×e₅ | w of A, B, C | n₅ | n₄ ]
//
// Where six tets lie around one edge they make a *fan*: two chains with the same 0 and 1, the second one's 4 being the
// first one's 5, in the same lane of two batches that are gone through as one. Nine vertices are fetched for six tets, or
// eight where the fan is closed, the second one's 5 being the first one's 4:
//
//   batches   [ closed fans, by two | open fans, by two | chains ]
//
// The second chain's n₄, and its n₅ in a closed fan, are not read: they lie at the end.
//
// A chain of fewer tets has zeros for those that are missing (the middle one is always there); one that is taken out
// keeps its products, which its neighbours need, and loses w.
//
// Lane l of a batch takes chains far from those of the other lanes (of C chains in B batches, batch b takes b,
// b + B, b + 2B, …), so that lanes seldom add to the same force record in one go.
// Submeshes of a linear tissue hold edges instead (edge_batches.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace glisson::engine {

inline constexpr std::size_t kStateFloats = 8;   ///< float record of a local vertex: u, v
inline constexpr std::size_t kForceFloats = 4;   ///< force record of a local vertex
inline constexpr std::size_t kStateDoubles = 8;  ///< state record of a vertex: u, c, v, d
inline constexpr std::size_t kMaxLocalVertices = 65536;

inline constexpr std::size_t kChainVertices = 6;
inline constexpr std::size_t kChainTets = 3;
inline constexpr std::size_t kChainRest = 24;  ///< seven products of edges and three times w = 1/6V
inline constexpr std::size_t kRestAcross = 6;  ///< where the products opposite edge 0–1 begin, of A, B, C
inline constexpr std::size_t kRestScale = 15;  ///< where w of A, B, C lie
/// Where n of a vertex begins; 0 and 1 have none.
inline constexpr std::array<std::size_t, kChainVertices> kRestSpoke{0, 0, 0, 3, 21, 18};
inline constexpr std::size_t kBlockBatches = 2;  ///< batches that go through a stage together: even, for fans
inline constexpr std::size_t kMaxLanes = 16;
/// Tets of a block: the values a law sees at once.
inline constexpr std::size_t kBlockTets = kChainTets * kBlockBatches * kMaxLanes;

}  // namespace glisson::engine
