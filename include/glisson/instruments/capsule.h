// capsule.h — the skin of an organ: a membrane on the surface of the body that carries tension, tears and is pierced.
//
//      needle ▼                    t₁ ◀──╱╲──▶ t₁
//   ───╲     ╱───  capsule         ─────╱  ╲─────   under tension along the surface, none across it;
//       ╲   ╱                                       compressed it folds away
//        ╲_╱      tissue
//
// It has no mass of its own and no bending stiffness; it lies on triangles of the tets' surface and moves with their
// vertices. Tearing removes stiffness of the membrane, never volume of the body. Law and figures: docs/capsule.md.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "glisson/field.h"
#include "glisson/math.h"
#include "glisson/mesh.h"
#include "glisson/simulation/interaction.h"

namespace glisson {

struct CapsuleOptions {
  std::string name = "capsule";
  double thickness = 1e-4;         ///< t [m]
  double youngs_modulus = 8.22e6;  ///< E, of porcine capsule at small strain [Umale2011] [Pa]
  double poisson_ratio = 0.4;      ///< ν [-]
  double prestretch = 1.0;         ///< stretch at rest relative to the stress-free shape, both ways [-]
  /// α [-]: stress rises by e^{αQ}, Q the square of Green strain in one direction (docs/capsule.md).
  double stiffening = 0.0;
  /// Force per length of a line at rest across which the capsule tears [N/m]; none: it never tears by itself.
  std::optional<double> strength{};
  /// Tension is averaged over a disc of this diameter before it is compared with the strength, so that tearing does not
  /// depend on the mesh as long as it resolves the disc [m].
  double averaging_length = 5e-3;
  /// The covered part of the surface; neither given: all. Triangles whose vertices are all among these …
  std::vector<std::uint32_t> vertices{};
  /// … or just these, in any orientation.
  std::vector<Triangle> triangles{};

  template <class Take>
  static constexpr auto fields(Take take) {
    using C = CapsuleOptions;
    return take(field("name", &C::name, "name"),
                field("thickness", &C::thickness, "mm", above(0), "thickness")
                    .advise("an organ's capsule is 0.02 to 0.2 mm thick"),
                field("youngs_modulus", &C::youngs_modulus, "Pa", above(0), "Young's modulus E at small strain")
                    .advise("porcine Glisson's capsule has 8.2e6 Pa at small strain"),
                field("poisson_ratio", &C::poisson_ratio, "-", between(0, 0.5), "Poisson's ratio ν")
                    .advise("0.5 keeps the volume of the sheet"),
                field("prestretch", &C::prestretch, "-", between(1, 2),
                      "stretch of the surface at rest relative to its stress-free shape")
                    .advise("1 is a sheet without tension"),
                field("stiffening", &C::stiffening, "-", between(0, 1000),
                      "α: stress rises by exp(α Q), Q the square of strain")
                    .advise("0 is a linear sheet"),
                field("strength", &C::strength, "N/m", above(0), "force per length of a line across which it tears")
                    .otherwise("never tears")
                    .advise("leave it out for a capsule that does not tear"),
                field("averaging_length", &C::averaging_length, "mm", above(0),
                      "length over which tension is averaged for tearing")
                    .advise("take two edges of the surface triangles or more"),
                no_key("vertices", &C::vertices), no_key("triangles", &C::triangles));
  }
  Fault check() const;
};

/// A tear or opening of a capsule.
struct CapsuleEvent {
  enum class What { tear, opening };
  double time = 0.0;       ///< [s]
  What what = What::tear;  ///< by its own tension, or by open_at and tear
  Vec3d place{};           ///< its position in space [m]
  double area = 0.0;       ///< opened area of the surface at rest [m²]
};
template <>
inline constexpr Word<CapsuleEvent::What> kWords<CapsuleEvent::What>[] = {{"tear", CapsuleEvent::What::tear},
                                                                          {"opening", CapsuleEvent::What::opening}};

void archive(Archive& ar, CapsuleEvent& event);

/// A membrane on the surface of a body. Triangles keep their numbers.
class Capsule final : public Interaction {
 public:
  /// @throws std::invalid_argument naming the option, its value and the allowed range
  explicit Capsule(const CapsuleOptions& options);
  ~Capsule() override;

  const CapsuleOptions& options() const;
  /// In present vertex numbers, oriented outwards; triangles of removed tets keep their last numbers.
  std::span<const Triangle> triangles() const;
  /// Largest principal tension of every triangle at force_time(): force across a line per length of it at rest; 0 where
  /// torn, wrinkled across or slack [N/m].
  std::span<const double> tension() const;
  double largest_tension() const;  ///< [N/m]
  /// Mean tension of the intact part within the averaging length about the triangle nearest to a position in space
  /// [N/m].
  double tension_at(const Vec3d& place) const;
  /// Open share of every triangle [-], 0 … 1.
  std::span<const double> open_share() const;
  bool is_torn(std::size_t triangle) const;  ///< carries no tension any more, or its tet was removed
  double open_area() const;                  ///< of the surface at rest [m²]
  double energy() const override;            ///< stored, at force_time() [J]
  double released_energy() const override;   ///< by tears, openings and removed tets so far [J]
  const std::vector<CapsuleEvent>& events() const;

  /// Opens a whole triangle. @throws std::invalid_argument for an invalid triangle number
  void tear(std::size_t triangle);
  /// Opens a round hole in the surface at rest, about the point nearest to a position in space. A triangle with the
  /// open share φ keeps (1 − φ)/(1 + 2φ) of its stiffness, as a sheet with such a share of round holes
  /// (docs/capsule.md).
  /// @param radius  [m], > 0 @return opened area [m²] @throws std::invalid_argument
  double open_at(const Vec3d& place, double radius);

  std::string label() const override { return "the capsule"; }
  /// @throws std::invalid_argument for triangles that are not at the surface, or if none is left
  void attached(const BodyView& body, double time) override;
  void body_changed(const BodyView& body, std::span<const std::uint32_t> origins) override;
  std::span<const std::uint32_t> reach(double time, double h) override;
  int most_drag_stages() const override;
  void add_forces(const InteractionStep& step) override;
  std::string refuses_long_steps() const override { return {}; }
  void set_long_steps(bool are_long) override;
  bool constrains_long_steps() const override { return false; }
  void add_forces_at(std::span<const Vec3d> displacement, std::span<Vec3d> force) override;
  void add_stiffness(std::vector<TriangleStiffness>& all) const override;
  bool overshoots(const InteractionStep& step) override;
  void moved(const InteractionStep& step) override;
  double squared_frequency() const override;
  bool add_stiffness_bound(std::vector<VertexStiffness>& all) const override;
  void state_set(std::span<const Vec3d> displacement) override;
  void archive(Archive& ar) override;
  std::shared_ptr<const void> save_state() const override;
  void load_state(const std::shared_ptr<const void>& state, const BodyView* other_body) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace glisson
