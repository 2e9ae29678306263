// indentation.h — a layer of tissue pressed by a rigid indenter: force over depth and time (Glisson::fit).
//
//   const Indenter ball{.shape = IndenterShape::sphere, .radius = 0.003};
//   const std::vector<double> times{1.0, 2.0, 30.0}, depths{0.001, 0.002, 0.002};                 two seconds down, then held
//   indentation(tissue, ball, {.thickness = 0.01}, times, depths)                                  [N], one per time
//   indentation_depths(tissue, ball, {.thickness = 0.01}, times, forces)                           [m], under forces
#pragma once

#include <limits>
#include <numbers>
#include <span>
#include <string_view>
#include <vector>

#include "glisson/field.h"
#include "glisson/material/tissue.h"
#include "glisson/words.h"

namespace glisson::fit {

/// Shape of an indenter.
enum class IndenterShape {
  flat,    ///< a face with a sharp edge, or a rounded one
  sphere,  ///< a ball, on a shaft as wide as itself
  cone     ///< with a sharp tip
};

/// How tissue meets an indenter.
enum class IndenterContact { frictionless, bonded };

}  // namespace glisson::fit
namespace glisson {
template <>
inline constexpr Word<fit::IndenterContact> kWords<fit::IndenterContact>[] = {
    {"frictionless", fit::IndenterContact::frictionless,
     "tissue slides along it; under a punch with a sharp edge for small depths only"},
    {"bonded", fit::IndenterContact::bonded, "tissue stays where it touches first"}};
template <>
inline constexpr Word<fit::IndenterShape> kWords<fit::IndenterShape>[] = {
    {"sphere", fit::IndenterShape::sphere, "A ball, on a shaft as wide as itself."},
    {"flat", fit::IndenterShape::flat, "A flat-ended cylinder."},
    {"cone", fit::IndenterShape::cone, "A cone with a sharp tip."}};
}  // namespace glisson
namespace glisson::fit {

/// A rigid indenter. Without friction tissue slides along it; to a bonded one it sticks where it touches first.
struct Indenter {
  IndenterShape shape = IndenterShape::sphere;
  double radius = 0.0;      ///< of a sphere or a flat punch [m], > 0
  double half_angle = 0.0;  ///< of a cone, between its axis and its side, 10° to 89° [rad]
  IndenterContact contact = IndenterContact::frictionless;
  double edge_radius = 0.0;  ///< of a flat punch: of its rounded edge, 0 to `radius` [m]; 0: sharp

  static constexpr double kDegree = std::numbers::pi / 180.0;
  static constexpr Range kHalfAngles = between(10, 89);  ///< [°]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        no_key("shape", &Indenter::shape),
        field("radius", &Indenter::radius, "mm", above(0), "radius; of a flat one that of its face").must(),
        field("half_angle", &Indenter::half_angle, "°", kHalfAngles, "angle between its axis and its side").must(),
        field("contact", &Indenter::contact, "how tissue meets it"),
        field("edge_radius", &Indenter::edge_radius, "mm", at_least(0), "radius of its rounded edge; 0: sharp"));
  }
  /// Whether a shape has the member of this name; others are not looked at.
  static constexpr bool has(IndenterShape shape, std::string_view member) {
    if (member == "radius") return shape != IndenterShape::cone;
    if (member == "half_angle") return shape == IndenterShape::cone;
    return member != "edge_radius" || shape == IndenterShape::flat;
  }
  Fault check() const;

  bool bonded() const { return contact == IndenterContact::bonded; }
  /// A flat face with a sharp edge.
  bool sharp() const { return shape == IndenterShape::flat && !(edge_radius > 0.0); }
  bool operator==(const Indenter&) const = default;
};

/// A layer of tissue on a rigid floor, which the indenter presses.
struct Layer {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double thickness = kNone;  ///< at rest [m], > 0; infinite: a half-space
  double radius = kNone;     ///< of the specimen, whose side is free [m], > 0; infinite: it is wide
  bool bonded_floor = true;  ///< else it slides on the floor without friction

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(no_key("thickness", &Layer::thickness, "m", above(0)).or_infinite("a half-space"),
                no_key("radius", &Layer::radius, "m", above(0)).or_infinite("a wide layer"),
                no_key("bonded_floor", &Layer::bonded_floor));
  }

  bool thick() const { return thickness == kNone; }
  bool wide() const { return radius == kNone; }
};

/// The quasi-static force of an indenter; the tissue's Maxwell branches and viscosity depend on its history.
///
/// At little strain and depth it is Hertz's, Boussinesq's and Sneddon's [Sneddon1965] within 1 %, on thin bonded layers those of
/// [Hayes1972], for every Poisson ratio. Strains are finite. A sharp flat punch without friction can be followed while tissue slides by less
/// than 5 % of its radius past its edge, where strain is singular; with a rounded edge to half its radius and more, a bonded one to a
/// third of the thickness or so. Branches are exact while the depth grows or rests,
/// where κ ≫ μ or they hold all of the stress, viscosity where strains are small and κ ≫ μ [LeeRadok1960]; while the indenter
/// withdraws both are approximations. It does not pull.
/// @param tissue  hyperelastic and isotropic
/// @param times   [s], ascending, > 0; before them the indenter is at rest on the surface, at time 0
/// @param depths  [m], one per time, below the thickness; in between they change smoothly, without overshoot
/// @return [N], one per time
/// @throws std::invalid_argument for arguments out of range; std::runtime_error where no equilibrium is found
/// Costs some tens of solutions of 250 to 1000 unknowns: 0.05 to 0.5 s.
std::vector<double> indentation(const Tissue& tissue, const Indenter& indenter, const Layer& layer,
                                std::span<const double> times, std::span<const double> depths);

/// The depth of an indenter under given forces: creep. Indentation solved for it, with its limits: the elastic force F₀ follows
/// from F by the branches and viscosity, linearly, and the depth from F₀. Branches are exact while the contact grows or rests.
/// @param times   [s], ascending, > 0; before them the indenter is at rest on the surface, at time 0
/// @param forces  [N], one per time, > 0 where it presses; in between they change smoothly, without overshoot. A force that
///                comes at once is one at a first time that is far below the others
/// @return [m], one per time
/// @throws as indentation; std::runtime_error if no depth balances the forces
/// Costs several solutions, one after the other, until the mesh suits the depth.
std::vector<double> indentation_depths(const Tissue& tissue, const Indenter& indenter, const Layer& layer,
                                       std::span<const double> times, std::span<const double> forces);

}  // namespace glisson::fit
