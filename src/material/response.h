// response.h — the stress with which a tissue answers a deformation gradient: every law, kinematics and viscosity.
//
//   P = P_elastic(H) + carry(S_v(H, Ḣ)) − carry(Σ g q)          first Piola–Kirchhoff stress, H = F − I
//
// carry(S) = F S, and S itself for small-strain kinematics. S_v is Kelvin–Voigt's stress, q a Maxwell branch's relaxed
// one. T is double, or Dual for ∂P/∂F : dF. Written to be read: the engine's lanes are tested against it.
#pragma once

#include "glisson/material/shape_measure.h"
#include "material/branch_pace.h"
#include "material/dual.h"
#include "material/modulus_laws.h"
#include "material/strain.h"
#include "material/viscosity.h"

namespace glisson {

/// What the single tet adds to its tissue.
struct ElementShape {
  double volume = 0.0;        ///< V at rest [m³]
  EdgeMetric<double> metric;  ///< for the raw mean ratio
  Vec3d fibre;                ///< unit vector a at rest; not used without fibres
  Mat3d turn;                 ///< rotation of the regular tet to this one, for radius_ratio and solid_angle
};

/// How stiff a tet has become: a bound of its tangent C over that at rest, C₀ (material/stiffness_bound.h).
struct Stiffening {
  double ratio = 1.0;  ///< C ≤ r C₀: scales what is known of the whole body
  double norm = 1.0;   ///< λ_max(C)/λ_max(C₀): says more of a tet that is stiff in one direction
};

/// Tangent of a stress σ = λ ϑ I + 2 μ ε of small strain whose moduli follow a measure x, ϑ held or tr ε:
///   ∂σ/∂F = λ I ⊗ I + 2 μ 𝟙 + rise ⊗ ∂x/∂F,   rise = λ' ϑ I + 2 μ' ε
struct SmallTangent {
  double lambda = 0.0, mu = 0.0;  ///< [Pa]; λ is 0 where ϑ is held
  Sym3<double> rise;              ///< [Pa]
  Mat3d gradient;                 ///< ∂x/∂F [-]
};

class Response {
 public:
  explicit Response(const Tissue& tissue);

  /// P of the elastic part [Pa], with the moduli of an instant.
  /// @param mean  volume change that takes the place of the tet's own (VolumeChange::average_nodal); null: its own
  template <class T>
  Mat3<T> elastic(const Mat3<T>& H, const ElementShape& shape, const T* mean = nullptr) const;
  /// W of it [J/m³]; of a secant law ½ σ:ε, which is not stored energy.
  double energy(const Mat3d& H, const ElementShape& shape, const double* mean = nullptr) const;
  /// The part of it that is left when all Maxwell branches have relaxed: of a tissue that stores_energy(), or of one
  /// without branches.
  double relaxed_energy(const Mat3d& H, const ElementShape& shape, const double* mean = nullptr) const;
  /// Whether small_tangent() is the tangent of elastic(): it is not with fibres and with laws in the form of an energy.
  bool has_small_tangent() const { return small() && tissue_.law_form == LawForm::secant && !tissue_.fibres; }
  SmallTangent small_tangent(const Mat3d& H, const ElementShape& shape, const double* mean = nullptr) const;
  /// Whether the elastic forces that are left after long times are the gradient of relaxed_energy.
  bool stores_energy() const;

  /// Kelvin–Voigt's P at the rate Ḣ [Pa].
  template <class T>
  Mat3<T> viscous(const Mat3<T>& H, const Mat3<T>& rate) const;
  /// The stress S of which the Maxwell branches relax their shares, from the elastic P [Pa].
  template <class T>
  Sym3<T> relaxing(const Mat3<T>& H, const Mat3<T>& P) const;
  /// F S; S for small strain.
  template <class T>
  Mat3<T> carry(const Mat3<T>& H, const Sym3<T>& S) const {
    return small() ? full(S) : product(deformation_gradient(H), full(S));
  }

  /// The measure x of deformation that laws of moduli and of the branches' times follow [-].
  template <class T>
  T measure(const Mat3<T>& H, const ElementShape& shape) const;
  /// How fast the branches relax at a measure.
  const BranchPaces& paces() const { return paces_; }

  /// The volume change ϑ that the bulk resists: tr ε of the kinematics, J − 1 of a hyperelastic law [-].
  template <class T>
  T volume_change(const Mat3<T>& H) const;
  /// ∂ϑ/∂F.
  Mat3d volume_direction(const Mat3d& H) const;
  /// ∂²W/∂ϑ² at H [Pa].
  double volume_modulus(const Mat3d& H, const ElementShape& shape) const;

  /// Of the tangent, elastic and viscous, for the stable step.
  Stiffening stiffening(const Mat3d& H, const ElementShape& shape) const;
  /// The same without fibres and viscosity.
  Stiffening elastic_stiffening(const Mat3d& H, const ElementShape& shape) const;

  const Tissue& tissue() const { return tissue_; }
  const LameParameters& viscosity() const { return viscosity_; }
  bool small() const { return tissue_.has_small_strain(); }
  /// Σ g of the Maxwell branches.
  double relaxing_share() const { return relaxing_share_; }

 private:
  /// The measure that the moduli follow; 0 where they follow none.
  template <class T>
  T measure_of_moduli(const Mat3<T>& H, const ElementShape& shape) const {
    return tissue_.has_constant_moduli() ? T(0.0) : measure(H, shape);
  }
  double tensor_mass_stiffening(const Mat3d& H, const ElementShape& shape) const;
  template <class T>
  Mat3<T> tensor_mass(const Mat3<T>& H, const Moduli<T>& m, const T* mean) const;
  template <class T>
  T mean_slope_energy(const Mat3<T>& H, const Moduli<T>& m) const;
  template <class T>
  Mat3<T> measure_gradient(const Mat3<T>& H, T x, const ElementShape& shape) const;
  template <class T>
  Mat3<T> fibre_piola(const Mat3<T>& H, const Vec3d& a) const;

  Tissue tissue_;
  ModulusLaws laws_;
  LameParameters lame_, viscosity_;
  BranchPaces paces_;
  double relaxing_share_ = 0.0;
};

}  // namespace glisson
