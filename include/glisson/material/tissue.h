// tissue.h — a tissue: elasticity, stiffness law, viscosity, density.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "glisson/field.h"
#include "glisson/material/hyperelastic_law.h"
#include "glisson/material/stiffness_law.h"
#include "glisson/material/time_law.h"
#include "glisson/math.h"
#include "glisson/words.h"

namespace glisson {

/// The measure of deformation of a tetrahedron: the argument of a stiffness law.
enum class DeformationMeasure {
  equivalent_shear_strain,
  one_minus_q,
  regular_mean_ratio,  ///< 12 (3V)^⅔ / Σ l², mesh-dependent at rest
  radius_ratio,        ///< against the rest tet  [LiuJoe1994]
  solid_angle          ///< against the rest tet  [LiuJoe1994]
};
template <>
inline constexpr Word<DeformationMeasure> kWords<DeformationMeasure>[] = {
    {"equivalent_shear_strain", DeformationMeasure::equivalent_shear_strain,
     "s = √(3 (1 − q) / 2), 0 at rest, ≈ ‖dev ε‖"},
    {"intensity", DeformationMeasure::equivalent_shear_strain},
    {"one_minus_q", DeformationMeasure::one_minus_q, "1 − q, 0 at rest, ≈ ⅔ ‖dev ε‖²"},
    {"regular_mean_ratio", DeformationMeasure::regular_mean_ratio,
     "mean ratio of the deformed tetrahedron against a regular one, the paper's raw measure"},
    {"radius_ratio", DeformationMeasure::radius_ratio,
     "√(5 (1 − ρ) / 4), 0 at rest, ρ three times in- over circumradius"},
    {"solid_angle", DeformationMeasure::solid_angle,
     "0.831 (1 − σ), 0 at rest, σ the sine of half the smallest solid angle, 1 at rest"}};

/// The constant tensor of the viscosity η, [Schwartz2002, eq. 7] (the paper does not define it).
/// `pioletti` is 0 at rest and grows with stretch [Pioletti1998].
enum class ViscousTensor { shear, deviatoric, proportional, pioletti };
template <>
inline constexpr Word<ViscousTensor> kWords<ViscousTensor>[] = {
    {"shear", ViscousTensor::shear, "σ_v = 2 η ε̇"},
    {"deviatoric", ViscousTensor::deviatoric, "σ_v = 2 η dev ε̇"},
    {"proportional", ViscousTensor::proportional, "(η/E) × the elastic tensor at rest"},
    {"pioletti", ViscousTensor::pioletti, "S_v = 2 η (I₁ − 3) Ė, for large strain"}};

/// Strain ε of a tensor-mass tissue as a function of H = F − I; the stress is λ tr(ε) I + 2 μ ε in all three.
enum class Kinematics {
  small,
  corotational,  ///< P = R σ; safe when inverted
  green          ///< P = F S  [Picinbono2003]
};
template <>
inline constexpr Word<Kinematics> kWords<Kinematics>[] = {
    {"small", Kinematics::small, "ε = sym H, the paper's; takes a rotation by θ for the strain cos θ − 1"},
    {"corotational", Kinematics::corotational, "ε = U − I of F = R U, for large rotations"},
    {"green", Kinematics::green, "E = ½ (FᵀF − I), St Venant–Kirchhoff"}};

/// The force of a stiffness law.
enum class LawForm { secant, energy };
template <>
inline constexpr Word<LawForm> kWords<LawForm>[] = {
    {"secant", LawForm::secant, "σ = λ(x) tr(ε) I + 2 μ(x) ε, the paper's; stores no energy"},
    {"energy", LawForm::energy, "∂W/∂F of W = ½ λ(x) tr(ε)² + μ(x) ε:ε"}};

/// Fibres that stiffen the tissue along one direction a: W_f = ½ c (a·E a)², E = ½ (FᵀF − I) (of kinematics small: sym
/// H).
/// With moduli λ_L, μ_L along and λ_T, μ_T across the fibres, c = λ_L − λ_T + 2 (μ_L − μ_T) [Picinbono2003].
struct Fibres {
  Vec3d direction{0.0, 0.0, 1.0};  ///< a at rest, any length but 0; TetMesh::fibres override it
  double stiffness = 0.0;          ///< c [Pa]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("direction", &Fibres::direction, "a at rest, any length; fibre directions in the mesh override it")
            .direction(),
        field("stiffness", &Fibres::stiffness, "Pa", at_least(0),
              "c = λ_L − λ_T + 2 (μ_L − μ_T), along L and across T the fibres")
            .must());
  }
  bool operator==(const Fibres&) const = default;
};

/// One branch of a generalised Maxwell body: μ(t) = μ₀ (1 − Σ g (1 − e^(−t/τ))). With a law of its time τ follows the
/// tissue's measure of deformation, and the relaxation is no longer linear: dq/dt = (S − q)/τ(x) (docs/theory.md §7).
struct MaxwellBranch {
  double share = 0.0;                 ///< g, share of the instantaneous shear modulus that relaxes [-]; sum < 1
  double time = 1.0;                  ///< τ [s]
  std::optional<TimeLaw> time_law{};  ///< factor on τ as a function of the measure; none: constant

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("share", &MaxwellBranch::share, "-", strictly_between(0, 1),
              "g, share of the instantaneous shear modulus that relaxes, of E with maxwell_part = \"all\"; sum below 1")
            .must(),
        field("time", &MaxwellBranch::time, "s", above(0), "τ, time constant").must(),
        field("time_law", &MaxwellBranch::time_law, "law of τ, in the tissue's measure of deformation")
            .otherwise("τ constant"));
  }
  bool operator==(const MaxwellBranch&) const = default;
};

/// The stress that the Maxwell branches relax.
enum class MaxwellPart { deviator, all };
template <>
inline constexpr Word<MaxwellPart> kWords<MaxwellPart>[] = {
    {"deviator", MaxwellPart::deviator, "the deviator of the stress relaxes, bulk stays elastic"},
    {"all", MaxwellPart::all, "all of it"}};

/// Treatment of the volume change; linear tets lock from ν = 0.45 on.
enum class VolumeChange {
  element,
  average_nodal  ///< means weighted by volume [BonetBurton1998]
};
template <>
inline constexpr Word<VolumeChange> kWords<VolumeChange>[] = {
    {"element", VolumeChange::element, "of each element, the paper's; locks from ν = 0.45 on"},
    {"own", VolumeChange::element},
    {"average_nodal", VolumeChange::average_nodal,
     "mean of the vertices' means over their tets; for nearly incompressible tissue"},
    {"nodal", VolumeChange::average_nodal}};

/// λ and μ of linear elasticity [Pa].
struct LameParameters {
  double lambda = 0.0, mu = 0.0;
};

/// λ = E ν / ((1 + ν)(1 − 2ν)), μ = E / (2 (1 + ν)).
LameParameters lame_from_young(double youngs_modulus, double poisson_ratio);

/// A tissue: isotropic elasticity whose moduli may follow the local deformation, or a hyperelastic law; fibres;
/// Kelvin–Voigt viscosity and Maxwell branches.
///
/// Either `law` acts on E with ν constant (so λ and μ scale alike), or `lambda_law` and `mu_law` act on
/// λ and μ separately. Each maps the base modulus and the measure to a modulus in Pa. With `hyperelastic` the stress is
/// ∂W/∂F of that law instead; E, ν, kinematics and the stiffness laws are not used then.
struct Tissue {
  std::string name = "tissue";
  double youngs_modulus = 3600.0;  ///< E at rest [Pa]
  double poisson_ratio = 0.4;      ///< ν [-]
  double density = 1000.0;         ///< ρ [kg/m³]
  double viscosity = 0.0;          ///< η [Pa·s]
  ViscousTensor viscous_tensor = ViscousTensor::shear;
  DeformationMeasure measure = DeformationMeasure::equivalent_shear_strain;
  StiffnessLaw law = ConstantLaw{};          ///< E(x)
  std::optional<StiffnessLaw> lambda_law{};  ///< λ(x); with it or mu_law set, `law` must be constant
  std::optional<StiffnessLaw> mu_law{};      ///< μ(x)

  Kinematics kinematics = Kinematics::small;
  LawForm law_form = LawForm::secant;
  std::optional<HyperelasticLaw> hyperelastic{};
  std::optional<Fibres> fibres{};
  std::vector<MaxwellBranch> maxwell{};  ///< the given moduli are then the instantaneous ones; at most 8 branches
  MaxwellPart maxwell_part = MaxwellPart::deviator;
  VolumeChange volume_change = VolumeChange::element;

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("name", &Tissue::name, "name for the report; default for a preset: its name"),
        field("youngs_modulus", &Tissue::youngs_modulus, "Pa", above(0), "Young's modulus E at rest"),
        field("poisson_ratio", &Tissue::poisson_ratio, "-", strictly_between(-1, 0.5), "Poisson's ratio ν")
            .advise("0.45 to 0.49 is nearly incompressible"),
        field("density", &Tissue::density, "kg/m³", above(0), "density ρ"),
        field("viscosity", &Tissue::viscosity, "Pa·s", at_least(0), "viscosity η"),
        field("viscous_tensor", &Tissue::viscous_tensor, "tensor that carries η"),
        field("measure", &Tissue::measure, "measure of deformation x of the laws"),
        field("law", &Tissue::law, "law of E, ν constant").otherwise("{ kind = \"constant\" }"),
        field("lambda_law", &Tissue::lambda_law, "law of λ, in place of a law of E").otherwise("λ constant"),
        field("mu_law", &Tissue::mu_law, "law of μ, in place of a law of E").otherwise("μ constant"),
        field("kinematics", &Tissue::kinematics, "strain that E and ν act on"),
        field("law_form", &Tissue::law_form, "force of a stiffness law"),
        field("hyperelastic", &Tissue::hyperelastic, "large-deformation law, in place of E, ν and their laws")
            .otherwise("none"),
        field("fibres", &Tissue::fibres, "fibres that stiffen the tissue along one direction").otherwise("none"),
        field("maxwell", &Tissue::maxwell,
              "branches that relax, each with its time constant; the given moduli are then the instantaneous ones"),
        field("maxwell_part", &Tissue::maxwell_part, "stress that the branches relax"),
        field("volume_change", &Tissue::volume_change, "volume change that the bulk resists"));
  }
  /// Contradictions between its fields.
  Fault check() const;

  /// Instantaneous λ and μ at rest; those of the hyperelastic law where there is one.
  LameParameters lame() const;
  /// Whether the time of some Maxwell branch follows the measure.
  bool relaxation_follows() const;
  /// Whether strain is linear in the displacement gradient.
  bool has_small_strain() const { return !hyperelastic && kinematics == Kinematics::small; }
  /// Whether no stiffness law changes the moduli.
  bool has_constant_moduli() const { return std::holds_alternative<ConstantLaw>(law) && !lambda_law && !mu_law; }
  /// Whether the force is that of the paper's element: small strain, secant law, no fibres, no branches.
  bool is_tensor_mass() const;
  bool operator==(const Tissue&) const = default;
};

/// @throws std::invalid_argument naming the field, its value and the allowed range
void require_valid(const Tissue& tissue);

/// λ and μ of a tissue at value `x` of its measure [Pa], [Schwartz2002, eq. 6].
LameParameters lame_at(const Tissue& tissue, double x);

}  // namespace glisson
