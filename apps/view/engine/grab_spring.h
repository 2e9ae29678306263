// grab_spring.h — a hand that holds a patch of tissue: by springs, the pull of a mouse on the surface, or bonded to it.
//
//   vertex i ──/\/\/\── its place in the hand        fᵢ = kᵢ (xᵢ⁰ + d − xᵢ) − cᵢ vᵢ,   kᵢ = K mᵢ / Σm
//                                                     d: way of the hand since it took hold
//
// Springs in the ratio of the masses have one frequency ω² = K/Σm, so what they take off the stable step is known exactly.
// Bonded, as by tools with `bonded`, the vertices go where the hand goes: impulses give them the velocity (xᵢ⁰ + d − xᵢ)/h, and
// these over h are the force. The way of a frame is gone at an even speed: it is no blow.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "glisson/simulation/interaction.h"

namespace glisson::view {

class GrabSpring final : public Interaction {
 public:
  enum class Hold { springs, bonded };
  /// Takes hold of vertices where they are. @param stiffness  K [N/m], > 0 @param masses  per vertex of the mesh [kg]
  void hold(std::vector<std::uint32_t> vertices, std::span<const Vec3d> displacement, std::span<const double> masses,
            double stiffness, Hold how = Hold::springs);
  /// Leads the hand. @param way  d [m] @param within  time in which it goes there where it is bonded [s]
  void draw(const Vec3d& way, double within);
  void let_go();
  bool holds() const { return !vertices_.empty(); }
  Vec3d force() const { return force_; }  ///< on the tissue, of the last step [N]

  void attached(const BodyView&, double) override {}
  /// Holds copies of what it holds; springs go on in the ratio of the masses there are then.
  void body_changed(const BodyView& body, std::span<const std::uint32_t> origins) override;
  std::span<const std::uint32_t> reach(double, double) override { return vertices_; }
  int most_drag_stages() const override;
  void add_forces(const InteractionStep& step) override;
  void declare(const InteractionStep& step, StepRows& rows, int round) override;
  void solved(const InteractionStep& step, const StepRows& rows) override;
  void moved(const InteractionStep& step) override;
  double squared_frequency() const override;

 private:
  void share_out(std::span<const double> masses);

  std::vector<std::uint32_t> vertices_;  // ascending
  std::vector<Vec3d> held_at_, last_;    // displacement when taken hold of, and of the last step's end [m]
  std::vector<double> share_;            // mᵢ / Σm [-]
  double stiffness_ = 0.0, damping_ = 0.0, squared_frequency_ = 0.0;
  Hold how_ = Hold::springs;
  Vec3d way_{}, force_{};
  std::size_t row_count_ = 0;  // in this step
  Vec3d gone_{};               // of the way where it is bonded [m] …
  double speed_ = 0.0;         // … and how fast it goes on [m/s]
};

/// Vertices within a ball about one of them that hang together with it there: a cut through the ball parts them.
/// @param positions  present, per vertex [m]
std::vector<std::uint32_t> patch_around(const TetMesh& mesh, const std::vector<Vec3d>& positions, std::uint32_t vertex,
                                        double radius);

}  // namespace glisson::view
