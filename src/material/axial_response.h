// axial_response.h — the stress of a homogeneous specimen that is stretched along z and alike across: F = diag(a, a, c).
//
// The same answers as Response, by the formulas that are left of it when F is diagonal: no polar decomposition, no
// tensors. With k = (c/a)^⅔ the isochoric invariant loses no digits near rest: Ī₁ − 3 = (k − 1)² (k + 2) / k.
// A fit asks for millions of points; this is a tenth of the general way's cost.
#pragma once

#include <array>

#include "material/response.h"

namespace glisson {

/// A diagonal tensor, equal across: its entries along x and y, and along z.
template <class T>
struct Axial {
  T side{}, along{};

  friend Axial operator+(Axial a, Axial b) { return {a.side + b.side, a.along + b.along}; }
  friend Axial operator-(Axial a, Axial b) { return {a.side - b.side, a.along - b.along}; }
  friend Axial operator*(Axial a, T s) { return {a.side * s, a.along * s}; }
};

class AxialResponse {
 public:
  /// @throws std::invalid_argument for what is not alike in all of a specimen: fibres, and laws of measures that depend on
  ///         the mesh (regular_mean_ratio, radius_ratio, solid_angle)
  explicit AxialResponse(const Tissue& tissue);

  /// P of the elastic part [Pa], with the moduli of an instant. @param h  F − I
  template <class T>
  Axial<T> elastic(Axial<T> h) const;
  /// Kelvin–Voigt's P at the rate Ḟ [Pa].
  template <class T>
  Axial<T> viscous(Axial<T> h, Axial<T> rate) const;
  /// The stress S of which the Maxwell branches relax their shares, from the elastic P [Pa].
  template <class T>
  Axial<T> relaxing(Axial<T> h, Axial<T> P) const;
  /// The measure x of deformation that laws of moduli and of the branches' times follow [-].
  template <class T>
  T measure(Axial<T> h) const;
  const BranchPaces& paces() const { return response_.paces(); }
  /// F S; S for small strain.
  template <class T>
  Axial<T> carry(Axial<T> h, Axial<T> S) const {
    if (small_) return S;
    return {(h.side + T(1.0)) * S.side, (h.along + T(1.0)) * S.along};
  }

  const Tissue& tissue() const { return response_.tissue(); }
  bool is_viscous() const { return viscosity_.mu > 0.0; }

 private:
  template <class T>
  Axial<T> hyperelastic(Axial<T> h) const;
  template <class T>
  T measure_of(T excess) const;
  template <class T>
  Axial<T> tensor_mass(Axial<T> h) const;

  Response response_;  ///< for what is squashed beyond the reach of the short formulas
  ModulusLaws laws_;
  LameParameters lame_, viscosity_;
  bool small_ = true, constant_ = true;
};

}  // namespace glisson
