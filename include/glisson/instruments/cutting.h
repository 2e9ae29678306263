// cutting.h — cuts a body while it moves: a blade's edge is led through it, and the tissue parts along its path.
//
//   Simulation ──▶ Cutter ── place(edge) ─▶ advance(edge) … advance(edge)       steps of the simulation in between
//                                            └▶ what was cut: area, faces, how near the faces lie to the path
//
// The mesh is parted along faces of its tets; vertices of these faces are moved onto the path of the blade as far as the
// tets around them stay as good as CutOptions say. No tet is removed or added, so that mass and volume stay
// (docs/cutting.md).
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <vector>

#include "glisson/math.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// The cutting edge of a blade: a straight line between two points where it is now [m].
struct BladeEdge {
  Vec3d from, to;
};

struct CutOptions {
  bool snap = true;  ///< whether vertices are moved onto the cut; false: it runs along faces as they are
  /// Least mean ratio of a tet that a move may leave behind (regular_mean_ratio; 1 is best), 0.01 … 0.5.
  double least_quality = 0.15;
  /// Least bound of the stable step that a moved vertex may leave to a tet, over the bound of the body when the Cutter is
  /// made, to which an automatic step falls when a mesh is changed at all, 0.05 … 1. Where tissue is very viscous, the
  /// explicit scheme's bound goes with the square of a tet's size, and the same number lets vertices go less far.
  double least_step = 0.4;
};

/// What an advance of the blade has done.
struct CutReport {
  double area = 0.0;        ///< of the blade's path through the tets it has gone through, in the body at rest [m²]
  double faces_area = 0.0;  ///< of the faces parted, at rest [m²]
  std::size_t tets = 0;     ///< gone through by this advance
  std::size_t faces = 0;    ///< parted
  std::size_t new_vertices = 0, moved_vertices = 0;
  std::size_t held_back = 0;    ///< vertices of those faces that could not go all the way
  double largest_offset = 0.0;  ///< largest distance of a vertex of those faces from the path, at rest [m]
};

/// A piece of a blade's edge that lies in a tet which is not cut through.
struct EdgePiece {
  std::uint32_t tet = 0;
  double length = 0.0;              ///< [m]
  std::array<double, 4> weights{};  ///< of its middle, of the tet's corners [-]
};

/// Leads one blade through a body. Several may cut the same body; each knows its own cuts.
class Cutter {
 public:
  /// @param simulation  must outlive this, and stay where it is
  /// @throws std::invalid_argument naming an option out of range
  /// Cost: O(tets) in time, 4 bytes a tet and 60 a vertex.
  explicit Cutter(Simulation& simulation, const CutOptions& options = {});
  ~Cutter();
  Cutter(Cutter&&) noexcept;
  Cutter& operator=(Cutter&&) noexcept;

  /// Puts the blade somewhere, without cutting, and begins another cut.
  /// @throws std::invalid_argument for a place that is not finite
  void place(const BladeEdge& edge);

  /// Leads the blade from where it was to `edge`, its ends straight and uniformly, against the body as it has moved since
  /// the last call, and cuts what it passes. A tet that the edge has not left waits for the next advance. Going over the
  /// same path again, or back, cuts nothing.
  /// @throws std::invalid_argument for a place that is not finite, or before place()
  /// Cost: a pass over vertices and tets, and the submeshes at the cut laid out anew (docs/cutting.md).
  CutReport advance(const BladeEdge& edge);

  /// Where the edge is in tissue that is not cut: what it has to break next.
  /// Cost: a pass over the tets.
  std::vector<EdgePiece> contact() const;

  const BladeEdge& edge() const;

  /// What a continued run needs beside the simulation's own checkpoint, saved at the same time.
  /// @throws std::runtime_error where it cannot be written
  void save(std::ostream& out) const;
  /// Takes over what another Cutter saved, after the simulation has loaded its checkpoint.
  /// @throws std::runtime_error for what is cut, changed or of another body
  void load(std::istream& in);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glisson
