#include "material/axial_response.h"

#include <cmath>
#include <stdexcept>

#include "material/hyperelastic_response.h"
#include "material/stiffness_formulas.h"

namespace glisson {
namespace {

/// Ī₁ − 3 of a stretch along that is 1 + e times the one aside.
template <class T>
T excess_of_ratio(T e) {
  using std::cbrt;
  const T k = cbrt((T(1.0) + e) * (T(1.0) + e));
  const T less = e * (T(2.0) + e) / (k * k + k + T(1.0));  // k − 1
  return less * less * (k + T(2.0)) / k;
}
/// Ī₁ − 3.
template <class T>
T first_excess(Axial<T> h) {
  return excess_of_ratio((h.along - h.side) / (h.side + T(1.0)));
}
/// Ī₂ − 3, which is Ī₁ − 3 of the cofactors a c, a c and a².
template <class T>
T second_excess(Axial<T> h) {
  return excess_of_ratio((h.side - h.along) / (h.along + T(1.0)));
}

/// a² − c².
template <class T>
T difference_of_squares(Axial<T> h) {
  return (h.side - h.along) * (h.side + h.along + T(2.0));
}

/// ∂Ī₁/∂λ of each single stretch: 2 J^(−⅔) (λ − I₁/3λ).
template <class T>
Axial<T> first_slopes(Axial<T> h, T power) {
  const T d = T(2.0 / 3.0) * power * difference_of_squares(h);
  return {d / (h.side + T(1.0)), T(-2.0) * d / (h.along + T(1.0))};
}
/// ∂Ī₂/∂λ of each.
template <class T>
Axial<T> second_slopes(Axial<T> h, T power) {
  const T a = h.side + T(1.0), d = T(2.0 / 3.0) * power * difference_of_squares(h) * a;
  return {d, T(-2.0) * d * a / (h.along + T(1.0))};
}

Mat3<double> full_of(Axial<double> h) { return {{{{h.side, 0, 0}, {0, h.side, 0}, {0, 0, h.along}}}}; }
Mat3<Dual> full_of(Axial<Dual> h) { return {{{{h.side, 0.0, 0.0}, {0.0, h.side, 0.0}, {0.0, 0.0, h.along}}}}; }

bool is_constant(const Tissue& tissue) {
  const auto constant = [](const std::optional<StiffnessLaw>& law) {
    return !law || std::holds_alternative<ConstantLaw>(*law);
  };
  return constant(tissue.law) && constant(tissue.lambda_law) && constant(tissue.mu_law);
}

}  // namespace

AxialResponse::AxialResponse(const Tissue& tissue)
    : response_(tissue), laws_(tissue), lame_(tissue.lame()), viscosity_(viscous_coefficients(tissue)),
      small_(response_.small()), constant_(is_constant(tissue)) {
  if (tissue.fibres && tissue.fibres->stiffness > 0.0)
    throw std::invalid_argument("tissue \"" + tissue.name +
                                "\" has fibres, across which a specimen does not stay round; "
                                "take a scene in place of the homogeneous specimen");
  const bool of_shape = tissue.measure == DeformationMeasure::equivalent_shear_strain ||
                        tissue.measure == DeformationMeasure::one_minus_q;
  if (((!tissue.hyperelastic && !constant_) || response_.paces().follows()) && !of_shape)
    throw std::invalid_argument(
        "tissue \"" + tissue.name +
        "\" has a law of a measure that depends on the mesh; allowed: "
        "measure = \"intensity\" or \"one_minus_q\", or take a scene in place of the homogeneous "
        "specimen");
}

template <class T>
Axial<T> AxialResponse::hyperelastic(Axial<T> h) const {
  using std::cbrt, std::log1p;
  const HyperelasticLaw& law = *tissue().hyperelastic;
  const T a = h.side + T(1.0), c = h.along + T(1.0);
  const T aa = h.side * (h.side + T(2.0));                                  // a² − 1
  const T pressure = T(bulk_modulus(law)) * (aa + h.along + aa * h.along);  // κ (J − 1)
  const Axial<T> bulk{pressure * a * c, pressure * a * a};
  return bulk + std::visit(
                    [&]<class Law>(const Law& l) -> Axial<T> {
                      if constexpr (StretchLaw<Law>) {
                        const T third = log1p((h.along - h.side) / a) * T(1.0 / 3.0);
                        const std::array<T, 3> t = l.slopes(std::array<T, 3>{-third, -third, third + third});
                        return {t[0] / a, t[2] / c};
                      } else {
                        const InvariantSlopes<T> w = slopes_at(l, first_excess(h), [&] { return second_excess(h); });
                        const T root = cbrt(a * a * c), first = T(1.0) / (root * root);
                        return first_slopes(h, first) * w.first + second_slopes(h, first * first) * w.second;
                      }
                    },
                    law);
}

/// Of Ī₁ − 3.
template <class T>
T AxialResponse::measure_of(T excess) const {
  const T less_q = excess / (excess + T(3.0));  // 1 − q
  return tissue().measure == DeformationMeasure::equivalent_shear_strain ? intensity_of(less_q) : less_q;
}

template <class T>
T AxialResponse::measure(Axial<T> h) const {
  const double a = value_of(h.side) + 1.0, c = value_of(h.along) + 1.0;
  return std::min(a, c) > 0.0 ? measure_of(first_excess(h)) : response_.measure(full_of(h), ElementShape{});
}

template <class T>
Axial<T> AxialResponse::tensor_mass(Axial<T> h) const {
  using std::sqrt;
  const Tissue& x = tissue();
  const bool green = x.kinematics == Kinematics::green;
  const T half(0.5);
  const Axial<T> e = green ? Axial<T>{h.side + half * h.side * h.side, h.along + half * h.along * h.along} : h;
  Moduli<T> m{T(lame_.lambda), T(lame_.mu), T(0.0), T(0.0)};
  T measure(0.0), i1(0.0);
  if (!constant_) {
    i1 = first_excess(h);
    measure = measure_of(i1);
    m = laws_.at(measure);
  }
  const T dilation = e.side + e.side + e.along, p = m.lambda * dilation;
  Axial<T> P{p + T(2.0) * m.mu * e.side, p + T(2.0) * m.mu * e.along};
  if (green) P = {P.side * (h.side + T(1.0)), P.along * (h.along + T(1.0))};
  if (constant_ || x.law_form == LawForm::secant) return P;
  // ∂W/∂x ∂x/∂λ of W = ½ λ(x) tr(ε)² + μ(x) ε:ε, with ∂(1 − q)/∂λ = 3/Ī₁² ∂Ī₁/∂λ
  using std::cbrt;
  const T squares = T(2.0) * e.side * e.side + e.along * e.along;
  T rise = half * m.lambda_slope * dilation * dilation + m.mu_slope * squares;
  if (x.measure == DeformationMeasure::equivalent_shear_strain) {
    if (!(measure > T(1e-12))) return P;
    rise = rise * T(0.75) / measure;
  }
  const T a = h.side + T(1.0), root = cbrt(a * a * (h.along + T(1.0))), invariant = i1 + T(3.0);
  return P + first_slopes(h, T(1.0) / (root * root)) * (rise * T(3.0) / (invariant * invariant));
}

template <class T>
Axial<T> AxialResponse::elastic(Axial<T> h) const {
  const double a = value_of(h.side) + 1.0, c = value_of(h.along) + 1.0;
  if (std::min(a, c) < kSmallestStretch || a * a * c < kSmallestVolume) {
    const Mat3<T> P = response_.elastic(full_of(h), ElementShape{});
    return {P(0, 0), P(2, 2)};
  }
  return tissue().hyperelastic ? hyperelastic(h) : tensor_mass(h);
}

template <class T>
Axial<T> AxialResponse::viscous(Axial<T> h, Axial<T> rate) const {
  const T a = h.side + T(1.0), c = h.along + T(1.0);
  const Axial<T> e = small_ ? rate : Axial<T>{a * rate.side, c * rate.along};
  const T p = T(viscosity_.lambda) * (e.side + e.side + e.along), two_mu(2.0 * viscosity_.mu);
  const Axial<T> P = carry(h, {p + two_mu * e.side, p + two_mu * e.along});
  if (tissue().viscous_tensor != ViscousTensor::pioletti) return P;
  const T excess = T(2.0) * h.side * (h.side + T(2.0)) + h.along * (h.along + T(2.0));  // I₁ − 3
  return P * (excess > T(0.0) ? excess : T(0.0));
}

template <class T>
Axial<T> AxialResponse::relaxing(Axial<T> h, Axial<T> P) const {
  const T a = h.side + T(1.0), c = h.along + T(1.0);
  const bool all = tissue().maxwell_part == MaxwellPart::all;
  if (small_) {
    if (all) return P;
    const T third = (P.along - P.side) * T(1.0 / 3.0);
    return {-third, third + third};
  }
  const T J = a * a * c;
  if (!(J > T(0.5 * kSmallestVolume))) return {T(0.0), T(0.0)};
  const T fade = J < T(kSmallestVolume) ? T(2.0 / kSmallestVolume) * J - T(1.0) : T(1.0);
  if (all) return Axial<T>{P.side / a, P.along / c} * fade;
  if (!tissue()
           .hyperelastic) {  // the deviator that goes with the strain: of S, or of R S's σ (spherical_part of response.cpp)
    const bool green = tissue().kinematics == Kinematics::green;
    const T third = (green ? P.along / c - P.side / a : P.along - P.side) * T(1.0 / 3.0);
    return (green ? Axial<T>{-third, third + third} : Axial<T>{-third / a, (third + third) / c}) * fade;
  }
  const T third = (P.along * c - P.side * a) * T(1.0 / 3.0);  // of the Kirchhoff stress
  return Axial<T>{-third / (a * a), (third + third) / (c * c)} * fade;
}

template Axial<double> AxialResponse::elastic(Axial<double>) const;
template Axial<Dual> AxialResponse::elastic(Axial<Dual>) const;
template double AxialResponse::measure(Axial<double>) const;
template Dual AxialResponse::measure(Axial<Dual>) const;
template Axial<double> AxialResponse::viscous(Axial<double>, Axial<double>) const;
template Axial<Dual> AxialResponse::viscous(Axial<Dual>, Axial<Dual>) const;
template Axial<double> AxialResponse::relaxing(Axial<double>, Axial<double>) const;
template Axial<Dual> AxialResponse::relaxing(Axial<Dual>, Axial<Dual>) const;

}  // namespace glisson
