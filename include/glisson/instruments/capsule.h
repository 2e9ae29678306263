// capsule.h — the skin of an organ: a membrane on the surface of the body that bears tension, tears and is pierced.
//
//      needle ▼                    t₁ ◀──╱╲──▶ t₁
//   ───╲     ╱───  capsule         ─────╱  ╲─────   under tension along the surface, none across it;
//       ╲   ╱                                       compressed it folds away
//        ╲_╱      tissue
//
// It has no mass of its own and no bending stiffness; it lies on triangles of the tets' surface and moves with their
// vertices. Tearing takes stiffness off it, never volume off the body. Law and figures: docs/capsule.md.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "glisson/math.h"
#include "glisson/mesh.h"
#include "glisson/simulation/interaction.h"

namespace glisson {

struct CapsuleOptions {
  std::string name = "capsule";
  double thickness = 1e-4;         ///< t [m], > 0
  double youngs_modulus = 8.22e6;  ///< E, of porcine capsule at small strain [Umale2011] [Pa], > 0
  double poisson_ratio = 0.4;      ///< ν [-], 0 … 0.5
  double prestretch = 1.0;         ///< of the surface at rest from where it bears nothing, both ways [-], 1 … 2
  /// α [-], 0 … 1000: stress rises by e^{αQ}, Q the square of Green strain in one direction (docs/capsule.md).
  double stiffening = 0.0;
  /// Force across a line per length of it at rest at which the capsule tears by itself [N/m], > 0; none: it does not.
  std::optional<double> strength{};
  /// Tension is averaged over a disc of this diameter before it is compared with the strength, so that the tear does not
  /// depend on the mesh as long as that resolves the disc [m], > 0.
  double averaging_length = 5e-3;
  /// Which part of the surface it covers; neither given: all. Triangles whose vertices are all among these …
  std::vector<std::uint32_t> vertices{};
  /// … or just these, in any orientation.
  std::vector<Triangle> triangles{};
};

/// Something that happened to a capsule.
struct CapsuleEvent {
  enum class What { tear, opening };
  double time = 0.0;       ///< [s]
  What what = What::tear;  ///< by its own tension, or by open_at and tear
  Vec3d place{};           ///< where it was, in space [m]
  double area = 0.0;       ///< of the surface at rest that was opened [m²]
};

/// A membrane on the surface of a body. Triangles keep their numbers for good.
class Capsule final : public Interaction {
 public:
  /// @throws std::invalid_argument naming the option, its value and the allowed range
  explicit Capsule(const CapsuleOptions& options);
  ~Capsule() override;

  const CapsuleOptions& options() const;
  /// In present vertex numbers, outward oriented; those that went with their tet keep their last ones.
  std::span<const Triangle> triangles() const;
  /// Largest principal tension of every triangle at force_time(): force across a line per length of it at rest; 0 where
  /// torn, wrinkled across or slack [N/m].
  std::span<const double> tension() const;
  double largest_tension() const;  ///< [N/m]
  /// Tension of what is whole within the averaging length about the triangle nearest to a place in space [N/m].
  double tension_at(const Vec3d& place) const;
  /// Share of every triangle that is open [-], 0 … 1.
  std::span<const double> open_share() const;
  bool is_torn(std::size_t triangle) const;  ///< bears nothing any more, or went with its tet
  double open_area() const;                  ///< of the surface at rest [m²]
  double energy() const;                     ///< stored, at force_time() [J]
  /// What opening and removed tets have set free so far; Energies::elastic still counts it [J].
  double released_energy() const;
  const std::vector<CapsuleEvent>& events() const;

  /// Opens a triangle wholly. @throws std::invalid_argument for a number that is no triangle's
  void tear(std::size_t triangle);
  /// Opens a round hole in the surface as it was at rest, about the point nearest to a place in space. A triangle of which
  /// the hole takes the share φ keeps (1 − φ)/(1 + 2φ) of its stiffness, the part that a sheet with such a share of round
  /// holes keeps (docs/capsule.md).
  /// @param radius  [m], > 0 @return area that was opened by it [m²] @throws std::invalid_argument
  double open_at(const Vec3d& place, double radius);

  /// @throws std::invalid_argument for triangles that are not at the surface, or where none is left
  std::string label() const override { return "the capsule"; }
  void attached(const BodyView& body, double time) override;
  void body_changed(const BodyView& body, std::span<const std::uint32_t> origins) override;
  std::span<const std::uint32_t> reach(double time, double h) override;
  void add_forces(const InteractionStep& step) override;
  double squared_frequency() const override;
  std::vector<double> past() const override;
  bool restore(std::span<const double> past) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace glisson
