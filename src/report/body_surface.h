// body_surface.h — what of a body can be drawn: its outer triangles, whether each is skin or was cut, and what lies inside.
//
// A face is skin where it was at the surface at first, else something has cut it open. Tets keep their numbers and the order of their
// corners while vertices are split, so a face is known by its tet and the corner opposite to it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "glisson/instruments/capsule.h"
#include "glisson/mesh.h"

namespace glisson {

/// What an outer triangle is.
enum class SurfaceKind : std::uint8_t { skin = 0, cut = 1, torn = 2 };

/// A region inside another one: closed, outward oriented.
struct RegionSurface {
  std::string name;
  std::vector<Triangle> triangles;
};

struct BodySurface {
  std::vector<Triangle> outer;  ///< in the order of boundary_triangles
  std::vector<SurfaceKind> kinds;
  std::vector<RegionSurface> regions;  ///< all but the largest, by their numbers
  std::string tissue;                  ///< name of the largest region; empty where it has none
};

/// The outer faces of a body as they were at first.
class SkinFaces {
 public:
  /// @throws std::invalid_argument as inspect
  explicit SkinFaces(const TetMesh& first);

  /// The surface of a later state of the same tets. @param removed  whether a tet is gone; none: all are there
  BodySurface surface(const TetMesh& mesh, const std::function<bool(std::uint32_t)>& removed = {}) const;

 private:
  std::vector<std::uint8_t> skin_;  ///< of each tet; bit i: the face opposite corner i was at the surface
};

/// Triangles of capsules that are torn, or open by more than half, in present vertex numbers.
std::vector<Triangle> torn_triangles(std::span<const std::shared_ptr<Capsule>> capsules);
/// Marks the skin under torn triangles.
void mark_torn(BodySurface& surface, const std::vector<Triangle>& torn);

}  // namespace glisson
