// cutting.h — cuts a body while it moves: a blade's edge moves through it, and the tissue separates along its path.
//
//   Simulation ──▶ Cutter ── place(edge) ─▶ advance(edge) … advance(edge)       steps of the simulation in between
//                                            └▶ report of the cut: area, faces, distance of the faces from the path
//
// The mesh is split along faces of its tets; vertices of these faces are moved onto the path of the blade as far as the
// tets around them meet CutOptions. No tet is removed or added, so that mass and volume are conserved
// (docs/cutting.md).
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <span>
#include <vector>

#include "glisson/field.h"
#include "glisson/math.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// The cutting edge of a blade: the straight line between two points, present positions [m].
struct BladeEdge {
  Vec3d from, to;
};

struct CutOptions {
  bool snap = true;  ///< whether vertices are moved onto the cut; false: it follows existing faces
  /// Least mean ratio of a tet after a move (regular_mean_ratio; 1 is best).
  double least_quality = 0.15;
  /// Least element step bound after a move, relative to the body's bound when the Cutter is made (to which an automatic
  /// step falls with the first change of a mesh). In very viscous tissue the explicit scheme's bound scales
  /// with the square of a tet's size, and the same value allows smaller moves.
  double least_step = 0.4;

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("snap", &CutOptions::snap, "moves vertices onto the cut; otherwise it follows existing faces"),
                field("least_quality", &CutOptions::least_quality, "-", between(0.01, 0.5),
                      "least mean ratio of a tet after such a move"),
                field("least_step", &CutOptions::least_step, "-", between(0.05, 1),
                      "least stable step after such a move, relative to the body's before"));
  }
};

/// Result of an advance of the blade.
struct CutReport {
  double area = 0.0;        ///< of the blade's path through the tets cut, in the body at rest [m²]
  double faces_area = 0.0;  ///< of the split faces, at rest [m²]
  std::size_t tets = 0;     ///< cut through by this advance
  std::size_t faces = 0;    ///< split
  std::size_t new_vertices = 0, moved_vertices = 0;
  std::size_t held_back = 0;    ///< vertices of those faces that could not move onto the path
  double largest_offset = 0.0;  ///< largest distance of a vertex of those faces from the path, at rest [m]
};

/// A piece of a blade's edge in a tet that is not cut through.
struct EdgePiece {
  std::uint32_t tet = 0;
  double length = 0.0;              ///< [m]
  std::array<double, 4> weights{};  ///< barycentric weights of its midpoint [-]
  void archive(Archive& ar);
};

/// Moves one blade through a body. Several may cut the same body; each tracks its own cuts.
class Cutter {
 public:
  /// @param simulation  its body must outlive this; the Simulation may be moved
  /// @throws std::invalid_argument naming an option out of range
  /// Cost: O(tets) in time, 4 bytes a tet and 60 a vertex.
  explicit Cutter(Simulation& simulation, const CutOptions& options = {});
  ~Cutter();
  Cutter(Cutter&&) noexcept;
  Cutter& operator=(Cutter&&) noexcept;

  /// Places the blade without cutting, and begins another cut.
  /// @throws std::invalid_argument for a position that is not finite
  void place(const BladeEdge& edge);

  /// Moves the blade from its last place to `edge`, its ends straight and uniformly, relative to the body as it has
  /// moved since the last call, and cuts the tissue it passes. A tet that the edge has not left waits for the next
  /// advance. Following the same path again, or back, cuts nothing.
  /// @throws std::invalid_argument for a position that is not finite, or before place()
  /// Cost: a pass over vertices and tets, and a rebuild of the submeshes at the cut (docs/cutting.md).
  CutReport advance(const BladeEdge& edge);

  /// The pieces of the edge in uncut tissue.
  /// Cost: a pass over the tets.
  std::vector<EdgePiece> contact() const;
  /// The same of an edge at another place, which nothing has cut on its way there.
  /// @param moved  vertices that are elsewhere than in the present body
  /// @throws std::invalid_argument for a position that is not finite
  std::vector<EdgePiece> contact(const BladeEdge& edge, std::span<const ActiveVertex> moved = {}) const;

  const BladeEdge& edge() const;

  /// Writes the state that a continued run needs besides the simulation's checkpoint, saved at the same time.
  /// @throws std::runtime_error if it cannot be written
  void save(std::ostream& out) const;
  /// Restores the state of a saved Cutter, after the simulation has loaded its checkpoint.
  /// @throws std::runtime_error for a file that is truncated, modified or of another body
  void load(std::istream& in);
  /// The same within the checkpoint of an interaction. What is refused changes nothing.
  void archive(Archive& ar);
  /// Copies its state in memory, to go back to after Simulation::load_state() of a state that was saved at the same time.
  std::shared_ptr<const void> save_state() const;
  /// Goes to a state that save_state() of this Cutter returned.
  void load_state(const std::shared_ptr<const void>& state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glisson
