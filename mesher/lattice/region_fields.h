// region_fields.h — the regions' functions as the mesher asks for them: values, gradients, points drawn onto surfaces.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "glisson/region_mesh.h"
#include "mesher/lattice/size_field.h"
#include "mesher/lattice/tet_complex.h"

namespace glisson::lattice {

inline constexpr Mask kCrease = Mask{1} << 62;  ///< in the mask of a vertex on a crease (crease.h)
inline constexpr Mask kCorner = Mask{1} << 61;  ///< at the end of creases; it stays
inline constexpr Mask kMarks = kCrease | kCorner;

/// Surfaces that a vertex lies on, given the labels that meet there: between two regions it is that of the one with
/// precedence, so of all labels but the last.
inline Mask surfaces_of(Mask labels) {
  labels &= ~kMarks;
  if (labels == 0) return 0;
  Mask last = Mask{1} << 63;
  while (!(labels & last)) last >>= 1;
  return labels & ~last;
}

/// Used by one thread.
class RegionFields {
 public:
  /// @param now_and_then  called once in 256 values, however slow the functions are; may throw
  RegionFields(const std::vector<BodyRegion>& regions, const SizeField& sizes, std::function<void()> now_and_then = {})
      : regions_(regions), sizes_(sizes), now_and_then_(std::move(now_and_then)), gradients_(kRemembered) {}

  std::size_t count() const { return regions_.size(); }
  const BodyRegion& region(std::size_t k) const { return regions_[k]; }
  const SizeField& sizes() const { return sizes_; }
  /// The longest edge asked for [m].
  double edge() const { return sizes_.coarsest(); }
  /// Label of what is in no region.
  Label outside() const { return static_cast<Label>(regions_.size()); }
  /// Whether tets of a label stay: it is a region's that is no hole.
  bool filled(Label label) const { return label != outside() && !regions_[label].hole; }
  /// The box of all regions that are no holes [m].
  Bounds bounds() const;
  /// Whether such a region may reach a cube, given by its centre and half its side [m].
  bool reached(const Vec3d& centre, double half) const;

  double value(std::size_t k, const Vec3d& p) const {
    if (++values_ % kNowAndThen == 0 && now_and_then_) now_and_then_();
    return regions_[k].distance(p);
  }
  /// By four points at the corners of a tetrahedron: of second order, and for a third of the cost of six.
  /// Those asked for lately are remembered: a vertex that does not move is asked about again.
  /// @param edge  length of edges asked for there [m]; also below
  Vec3d gradient(std::size_t k, const Vec3d& p, double edge) const;
  /// First region with p inside, or outside().
  Label label(const Vec3d& p) const;

  /// Moves p onto all the surfaces, by the shortest steps. @return the largest |value| left [m]
  double project(Vec3d& p, Mask surfaces, double edge) const;
  /// Largest |value| of the surfaces at p [m].
  double off(const Vec3d& p, Mask surfaces) const;
  /// Unit normals of the surfaces at p. @return how many
  std::size_t normals(const Vec3d& p, Mask surfaces, double edge, Vec3d* out, std::size_t capacity) const;

 private:
  struct Remembered {
    std::size_t k = ~std::size_t{0};
    double edge = 0.0;
    Vec3d at{}, gradient{};
  };
  static constexpr std::size_t kRemembered = 1 << 15;
  static constexpr std::uint64_t kNowAndThen = 256;

  const std::vector<BodyRegion>& regions_;
  const SizeField& sizes_;
  std::function<void()> now_and_then_;
  mutable std::uint64_t values_ = 0;           ///< asked for so far
  mutable std::vector<Remembered> gradients_;  ///< by the hash of place and region
};

}  // namespace glisson::lattice
