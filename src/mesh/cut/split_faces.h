// split_faces.h — opens a mesh along faces: which vertices are doubled, and which corners take the copies.
//
// What a blade or a needle leaves behind, as topology alone. Faces are split, but only vertices can be doubled, and
// a vertex is doubled only where the split faces part the tets around it. So a crack is open inside and at the
// surface of the body, and closed along its rim:
//
//       ╲  A  ╱                      ╲  A  ╱         v lies between split faces ═: A and B meet at it only
//     ════ v ═══ w ─────     →     ════ v  ═╲        across them, so one group of tets gets a copy v'.
//       ╱  B  ╲                    ════ v' ═ w ──    w is the rim: A and B are still connected around it.
//                                    ╱  B  ╲
//
// A face whose three vertices are all at the rim stays as it was, and the mesh does not show that it is split: the
// plan lists such faces as `closed`. Handed in with the next split they make cuts in steps end where one cut would.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "glisson/mesh.h"
#include "mesh/topology/vertex_stars.h"

namespace glisson::detail {

/// This corner of the tet (0 … 3) is `vertex` from now on.
struct CornerChange {
  std::uint32_t tet;
  std::uint8_t corner;
  std::uint32_t vertex;
  bool operator==(const CornerChange&) const = default;
};

struct SplitPlan {
  std::vector<std::uint32_t> origins;  ///< new vertex first_new + i is a copy of origins[i]; ascending
  std::vector<CornerChange> corners;   ///< each corner at most once
  std::vector<Triangle> closed;        ///< split faces, earlier ones too, that are closed still; new vertex numbers
};

/// Plans to split a mesh along inner faces; changes nothing.
///
/// Around each vertex of the faces its tets fall into groups connected by faces that are not split. The largest
/// group (of equal ones that with the smallest tet number) keeps the vertex, every other one gets a copy. Tets that
/// meet at such a vertex without a common face, as removals leave them, are parted as well.
/// The plan depends neither on the order of the faces nor on that of their vertices.
/// @param tets       all tets; only those in `stars` live
/// @param stars      up to date with `tets`
/// @param faces      three vertices each, of two living tets; repeated ones are ignored
/// @param first_new  number of the first new vertex: vertices in use so far
/// @param closed     `closed` of the last plan: as `faces`, but those that removals took a tet from are dropped. After
///                   removals a call with these alone opens the cracks that can open now
/// @throws std::invalid_argument with the numbers of the first face that has a vertex out of range or twice, that no
///         tet holds, that is at the boundary (nothing to split), or that more than two tets hold
/// Cost: about 0.4 µs a face where vertices have 24 tets; nothing grows with the mesh.
SplitPlan plan_split(std::span<const Tet> tets, const VertexStars& stars, std::span<const Triangle> faces,
                     std::uint32_t first_new, std::span<const Triangle> closed = {});

/// Carries out a plan that was made with first_new = stars.vertices().
/// Positions, masses and states of the new vertices, copies of plan.origins, are the caller's.
void apply_split(const SplitPlan& plan, std::span<Tet> tets, VertexStars& stars);

}  // namespace glisson::detail
