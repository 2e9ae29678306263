#include "material/response.h"

#include "material/edge_measure.h"
#include "material/stiffness_bound.h"
#include "material/stiffness_formulas.h"

namespace glisson {
namespace {

/// tr ε and ε:ε.
template <class T>
struct StrainNumbers {
  T trace, squares;
};

/// Principal Biot strains b_i = λ_i − 1 with their derivatives.
std::array<double, 3> biot(const Mat3d& H) { return principal_frame(H).b; }
std::array<Dual, 3> biot(const Mat3<Dual>& H) {
  const PrincipalFrame f = principal_frame(detail::values_of(H));
  const Mat3d A = product(transposed_product(f.u, detail::derivatives_of(H)), f.n);
  return {Dual{f.b[0], A(0, 0)}, Dual{f.b[1], A(1, 1)}, Dual{f.b[2], A(2, 2)}};
}

template <class T>
StrainNumbers<T> strain_numbers(Kinematics kinematics, const Mat3<T>& H) {
  if (kinematics == Kinematics::corotational) {
    const std::array<T, 3> b = biot(H);
    return {b[0] + b[1] + b[2], b[0] * b[0] + b[1] * b[1] + b[2] * b[2]};
  }
  const Sym3<T> e = kinematics == Kinematics::green ? green_strain(H) : symmetric(H);
  return {trace(e), contract(e, e)};
}

/// Of a tensor-mass tissue of large strain, the part of S = F⁻¹ P whose stress is p I in the frame of its strain: with σ − p I
/// the deviator of the strain relaxes, and what stays is the gradient of an energy. A Cauchy stress p I would not do: its
/// work over closed cycles is not 0, since p follows more than the volume.
/// @param cof  cof F
template <class T>
Sym3<T> spherical_part(Kinematics kinematics, const Mat3<T>& H, const Mat3<T>& P, const Sym3<T>& S, const Mat3<T>& cof,
                       T J) {
  const T third(1.0 / 3.0);
  if (kinematics == Kinematics::green) {
    const T p = trace(S) * third;
    return {p, p, p, T(0.0), T(0.0), T(0.0)};
  }
  const auto ones = [](const std::array<T, 3>&) { return std::array<T, 3>{T(1.0), T(1.0), T(1.0)}; };
  const Mat3<T> R = isotropic_piola(H, ones);
  const T p = trace(transposed_product(R, P)) * third;
  return symmetric(transposed_product(cof, R)) * (p / J);
}

}  // namespace

Response::Response(const Tissue& tissue)
    : tissue_(tissue), laws_(tissue), lame_(tissue.lame()), viscosity_(viscous_coefficients(tissue)),
      paces_(tissue.maxwell) {
  for (const MaxwellBranch& b : tissue_.maxwell) relaxing_share_ += b.share;
}

template <class T>
T Response::measure(const Mat3<T>& H, const ElementShape& shape) const {
  switch (tissue_.measure) {
    case DeformationMeasure::equivalent_shear_strain:
      return intensity_of(one_minus_q(H));
    case DeformationMeasure::one_minus_q:
      return one_minus_q(H);
    case DeformationMeasure::radius_ratio:
      return edge_strain(true, edge_measure(true, H, shape.turn).value);
    case DeformationMeasure::solid_angle:
      return edge_strain(false, edge_measure(false, H, shape.turn).value);
    case DeformationMeasure::regular_mean_ratio:
      break;
  }
  const EdgeMetric<double>& g = shape.metric;
  return regular_mean_ratio(H, T(shape.volume), EdgeMetric<T>{T(g.xx), T(g.yy), T(g.zz), T(g.xy), T(g.yz), T(g.zx)});
}

/// λ tr(ε) I + 2 μ ε in the tissue's kinematics, as P.
template <class T>
Mat3<T> Response::tensor_mass(const Mat3<T>& H, const Moduli<T>& m, const T* mean) const {
  if (tissue_.kinematics == Kinematics::corotational) {
    return isotropic_piola(H, [&](const std::array<T, 3>& b) {
      const T p = m.lambda * (mean != nullptr ? *mean : b[0] + b[1] + b[2]), two_mu = m.mu + m.mu;
      return std::array<T, 3>{p + two_mu * b[0], p + two_mu * b[1], p + two_mu * b[2]};
    });
  }
  const Sym3<T> e = tissue_.kinematics == Kinematics::green ? green_strain(H) : symmetric(H);
  Sym3<T> stress = e * (m.mu + m.mu);
  const T p = m.lambda * (mean != nullptr ? *mean : trace(e));
  stress.xx += p, stress.yy += p, stress.zz += p;
  return carry(H, stress);
}

/// ∂W/∂x of W = ½ λ(x) tr(ε)² + μ(x) ε:ε.
template <class T>
T Response::mean_slope_energy(const Mat3<T>& H, const Moduli<T>& m) const {
  const StrainNumbers<T> e = strain_numbers(tissue_.kinematics, H);
  return T(0.5) * m.lambda_slope * e.trace * e.trace + m.mu_slope * e.squares;
}

/// ∂x/∂F; 0 at rest, where s has no derivative, and where J ≤ 0, where x is kept.
template <class T>
Mat3<T> Response::measure_gradient(const Mat3<T>& H, T x, const ElementShape& shape) const {
  const T J = jacobian(H);
  if (!(J > T(0.0))) return {};
  const bool radius = tissue_.measure == DeformationMeasure::radius_ratio;
  if (radius || tissue_.measure == DeformationMeasure::solid_angle) return edge_strain_gradient(radius, H, shape.turn);
  const Mat3<T> F = deformation_gradient(H), cof = deformation_gradient(cofactor_change(H));
  if (tissue_.measure == DeformationMeasure::regular_mean_ratio) {
    const EdgeMetric<double>& g = shape.metric;
    const Mat3<T> FG =
        product(F, with_scalar<T>(Mat3d{{{{g.xx, g.xy, g.zx}, {g.xy, g.yy, g.yz}, {g.zx, g.yz, g.zz}}}}));
    const T total = trace(transposed_product(FG, F));
    return sum(scaled(cof, x * T(2.0 / 3.0) / J), scaled(FG, T(-2.0) * x / total));
  }
  const T q = mean_ratio(H), r = squared_norm(F) / (T(3.0) * J);
  // ∂q/∂F = q (⅔ F⁻ᵀ − 2 F/I₁) = −2 q/I₁ (F − r cof F)
  const T j = trace(H) + second_invariant(H) + determinant(H);
  const Mat3<T> gradient = scaled(deviatoric_direction(H, cofactor_change(H), j), T(-2.0) * q / (T(3.0) * J * r));
  if (tissue_.measure == DeformationMeasure::one_minus_q) return scaled(gradient, T(-1.0));
  if (!(x > T(1e-12))) return {};
  return scaled(gradient, T(-0.75) / x);
}

template <class T>
Mat3<T> Response::fibre_piola(const Mat3<T>& H, const Vec3d& a) const {
  const Vec3<T> along{T(a.x), T(a.y), T(a.z)};
  const Sym3<T> e = small() ? symmetric(H) : green_strain(H);
  const Vec3<T> carried = small() ? along : deformation_gradient(H) * along;
  const T tension = T(tissue_.fibres->stiffness) * dot(along, e * along);
  Mat3<T> P;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) P(i, j) = tension * carried[i] * along[j];
  }
  return P;
}

template <class T>
Mat3<T> Response::elastic(const Mat3<T>& H, const ElementShape& shape, const T* mean) const {
  Mat3<T> P;
  if (tissue_.hyperelastic) {
    const T own = volume_change(H);
    const T theta = mean != nullptr ? *mean + T(kOwnShare) * lost_volume(T(1.0) + own) : own;
    const Mat3<T> cof = deformation_gradient(cofactor_change(H));
    P = sum(isochoric_piola(*tissue_.hyperelastic, H), scaled(cof, T(bulk_modulus(*tissue_.hyperelastic)) * theta));
  } else {
    const T x = measure_of_moduli(H, shape);
    const Moduli<T> m = laws_.at(x);
    P = tensor_mass(H, m, mean);
    if (tissue_.law_form == LawForm::energy && !tissue_.has_constant_moduli()) {
      P = sum(P, scaled(measure_gradient(H, x, shape), mean_slope_energy(H, m)));
    }
  }
  return tissue_.fibres ? sum(P, fibre_piola(H, shape.fibre)) : P;
}

SmallTangent Response::small_tangent(const Mat3d& H, const ElementShape& shape, const double* mean) const {
  const double x = measure_of_moduli(H, shape);
  const Moduli<double> m = laws_.at(x);
  const Sym3<double> e = symmetric(H);
  SmallTangent t{
      .lambda = mean != nullptr ? 0.0 : m.lambda, .mu = m.mu, .rise = e * (2.0 * m.mu_slope), .gradient = {}};
  const double p = m.lambda_slope * (mean != nullptr ? *mean : trace(e));
  t.rise.xx += p, t.rise.yy += p, t.rise.zz += p;
  if (m.lambda_slope != 0.0 || m.mu_slope != 0.0) t.gradient = measure_gradient(H, x, shape);
  return t;
}

double Response::energy(const Mat3d& H, const ElementShape& shape, const double* mean) const {
  double W = 0.0;
  if (tissue_.hyperelastic) {
    const double own = volume_change(H), theta = mean != nullptr ? *mean : own;
    const double lost = mean != nullptr ? lost_volume(1.0 + own) : 0.0;
    W = isochoric_energy(*tissue_.hyperelastic, H) +
        0.5 * bulk_modulus(*tissue_.hyperelastic) * (theta * theta + kOwnShare * lost * lost);
  } else {
    const Moduli<double> m = laws_.at(measure(H, shape));
    const StrainNumbers<double> e = strain_numbers(tissue_.kinematics, H);
    const double theta = mean != nullptr ? *mean : e.trace;
    W = 0.5 * m.lambda * theta * theta + m.mu * e.squares;
  }
  if (!tissue_.fibres) return W;
  const Sym3<double> e = small() ? symmetric(H) : green_strain(H);
  const double along = dot(shape.fibre, e * shape.fibre);
  return W + 0.5 * tissue_.fibres->stiffness * along * along;
}

double Response::relaxed_energy(const Mat3d& H, const ElementShape& shape, const double* mean) const {
  const double W = energy(H, shape, mean);
  if (relaxing_share_ == 0.0 || tissue_.maxwell_part == MaxwellPart::all) return (1.0 - relaxing_share_) * W;
  if (tissue_.hyperelastic) return W - relaxing_share_ * isochoric_energy(*tissue_.hyperelastic, H);
  const StrainNumbers<double> e = strain_numbers(tissue_.kinematics, H);
  return W - relaxing_share_ * laws_.at(measure(H, shape)).mu * (e.squares - e.trace * e.trace / 3.0);
}

bool Response::stores_energy() const {
  if (tissue_.hyperelastic) return true;
  const bool constant = tissue_.has_constant_moduli();
  const bool deviator_relaxes = relaxing_share_ > 0.0 && tissue_.maxwell_part == MaxwellPart::deviator;
  if (deviator_relaxes) return constant && !tissue_.fibres;
  return constant || tissue_.law_form == LawForm::energy;
}

template <class T>
Mat3<T> Response::viscous(const Mat3<T>& H, const Mat3<T>& rate) const {
  const Sym3<T> e = small() ? symmetric(rate) : green_rate(H, rate);
  const Mat3<T> P = carry(H, isotropic_stress(e, T(viscosity_.lambda), T(viscosity_.mu)));
  if (tissue_.viscous_tensor != ViscousTensor::pioletti) return P;
  const T excess = T(2.0) * trace(green_strain(H));  // I₁ − 3, below 0 where more is lost in volume than sheared
  return scaled(P, excess > T(0.0) ? excess : T(0.0));
}

template <class T>
Sym3<T> Response::relaxing(const Mat3<T>& H, const Mat3<T>& P) const {
  if (small()) {
    Sym3<T> S = symmetric(P);
    if (tissue_.maxwell_part == MaxwellPart::all) return S;
    const T p = trace(S) * T(1.0 / 3.0);
    S.xx -= p, S.yy -= p, S.zz -= p;
    return S;
  }
  // S = F⁻¹ P; it has no meaning where J → 0, and fades there
  const T J = jacobian(H);
  if (!(J > T(0.5 * kSmallestVolume))) return {};
  const Mat3<T> cof = deformation_gradient(cofactor_change(H));
  const Sym3<T> S = symmetric(transposed_product(cof, P)) * (T(1.0) / J);
  const T fade = J < T(kSmallestVolume) ? T(2.0 / kSmallestVolume) * J - T(1.0) : T(1.0);
  if (tissue_.maxwell_part == MaxwellPart::all) return S * fade;
  if (!tissue_.hyperelastic) return (S - spherical_part(tissue_.kinematics, H, P, S, cof, J)) * fade;
  const Sym3<T> inverse = symmetric(transposed_product(cof, cof)) * (T(1.0) / (J * J));  // C⁻¹
  const Sym3<T> E = green_strain(H);
  const T pressure = (trace(S) + T(2.0) * contract(S, E)) * T(1.0 / 3.0);  // S:C / 3
  return (S - inverse * pressure) * fade;
}

template <class T>
T Response::volume_change(const Mat3<T>& H) const {
  if (tissue_.hyperelastic) return trace(H) + second_invariant(H) + determinant(H);
  switch (tissue_.kinematics) {
    case Kinematics::small:
      return trace(H);
    case Kinematics::green:
      return trace(green_strain(H));
    case Kinematics::corotational:
      break;
  }
  const std::array<T, 3> b = biot(H);
  return b[0] + b[1] + b[2];
}

Mat3d Response::volume_direction(const Mat3d& H) const {
  if (tissue_.hyperelastic) return deformation_gradient(cofactor_change(H));
  switch (tissue_.kinematics) {
    case Kinematics::small:
      return identity<double>();
    case Kinematics::green:
      return deformation_gradient(H);
    case Kinematics::corotational:
      break;
  }
  return detail::out_of_frame(principal_frame(H), identity<double>());
}

double Response::volume_modulus(const Mat3d& H, const ElementShape& shape) const {
  return tissue_.hyperelastic ? bulk_modulus(*tissue_.hyperelastic) : laws_.at(measure_of_moduli(H, shape)).lambda;
}

/// Tensor-mass tissues: r C₀ bounds the tangent of σ(ε) as in element/local_stiffness.h. With the Green strain it is
/// carried by F on both sides, and the stress adds its own size.
Stiffening Response::elastic_stiffening(const Mat3d& H, const ElementShape& shape) const {
  const double rest = std::max(3.0 * lame_.lambda + 2.0 * lame_.mu, 2.0 * lame_.mu);
  if (tissue_.hyperelastic) {
    const HyperelasticBound now = hyperelastic_bound(*tissue_.hyperelastic, H),
                            at_rest = hyperelastic_bound(*tissue_.hyperelastic, Mat3d{});
    const bool pushes = tissue_.volume_change == VolumeChange::average_nodal && jacobian(H) < kSmallestVolume;
    const double volume = (pushes ? 1.0 + kOwnShare : 1.0) * now.volume;
    return {std::max(now.isochoric / at_rest.isochoric, volume / at_rest.volume), (now.isochoric + volume) / rest};
  }
  double r = tensor_mass_stiffening(H, shape);
  if (tissue_.kinematics == Kinematics::green) {
    const Sym3<double> E = green_strain(H);
    const Moduli<double> m = laws_.at(measure(H, shape));
    const Sym3<double> S = isotropic_stress(E, m.lambda, m.mu);
    r = r * (1.0 + 2.0 * std::sqrt(contract(E, E))) + std::sqrt(contract(S, S)) / rest;
  }
  if (tissue_.kinematics == Kinematics::corotational) {
    const StrainNumbers<double> b = strain_numbers(tissue_.kinematics, H);
    const Moduli<double> m = laws_.at(measure(H, shape));
    r += turning_bound(b.trace, b.squares, m.lambda, m.mu) / rest;
  }
  return {r, r};
}

/// Viscous stress of large strain is carried by F on both sides.
Stiffening Response::stiffening(const Mat3d& H, const ElementShape& shape) const {
  Stiffening s = elastic_stiffening(H, shape);
  if (small() && !tissue_.fibres && tissue_.viscous_tensor != ViscousTensor::pioletti) {
    if (viscosity_.mu > 0.0) s.ratio = std::max(s.ratio, 1.0), s.norm = std::max(s.norm, 1.0);
    return s;
  }
  const Sym3<double> E = green_strain(H);
  const double stretch = 1.0 + 2.0 * std::sqrt(contract(E, E));  // ≥ ‖F‖²
  if (viscosity_.mu > 0.0) {
    const bool pioletti = tissue_.viscous_tensor == ViscousTensor::pioletti;
    const double drag = std::max(small() ? 1.0 : stretch, pioletti ? stretch * (1.0 + 2.0 * trace(E)) : 0.0);
    s.ratio = std::max(s.ratio, drag), s.norm = std::max(s.norm, drag);
  }
  if (tissue_.fibres) {
    const double along = std::abs(dot(shape.fibre, E * shape.fibre));
    const double rest = std::max(3.0 * lame_.lambda + 2.0 * lame_.mu, 2.0 * lame_.mu);
    const double more = tissue_.fibres->stiffness * (small() ? 1.0 : stretch + along) / rest;
    s.ratio += more, s.norm += more;
  }
  return s;
}

/// f + |f'| g ½ (e + √(e² + (K/2μ) t²)) of element/local_stiffness.h, with the larger of the two laws' ratios.
double Response::tensor_mass_stiffening(const Mat3d& H, const ElementShape& shape) const {
  const double x = measure_of_moduli(H, shape), bulk = lame_.lambda + 2.0 / 3.0 * lame_.mu;
  const Moduli<double> m = laws_.at(x);
  const double f = std::max(m.mu / lame_.mu, (m.lambda + 2.0 / 3.0 * m.mu) / bulk);
  if (tissue_.has_constant_moduli()) return f;
  const double mu_slope = std::abs(m.mu_slope), bulk_slope = std::abs(m.lambda_slope) + 2.0 / 3.0 * mu_slope;
  double g = 1.0;
  if (tissue_.measure == DeformationMeasure::one_minus_q) g = 4.0 / 3.0 * intensity_of(x);
  if (tissue_.measure == DeformationMeasure::regular_mean_ratio) g = 1.64 * x;
  const bool radius = tissue_.measure == DeformationMeasure::radius_ratio;
  if (radius || tissue_.measure == DeformationMeasure::solid_angle) {
    // no bound that holds for all shapes: the slope itself, and at least the steepest near rest
    g = std::max(radius ? 1.06 : 1.70, std::sqrt(squared_norm(measure_gradient(H, x, shape))));
  }
  const StrainNumbers<double> e = strain_numbers(tissue_.kinematics, H);
  const double e2 = std::max(0.0, e.squares - e.trace * e.trace / 3.0);
  const double reach = 0.5 * (std::sqrt(e2) + std::sqrt(e2 + bulk / (2.0 * lame_.mu) * e.trace * e.trace));
  const double secant = f + std::max(mu_slope / lame_.mu, bulk_slope / bulk) * g * reach;
  // the energy form adds ½ f' ε:C₀ε ∂x/∂ε: its derivative doubles σ₀ ⊗ ∂x/∂ε and bends with ∂²x/∂ε² ≈ 1/x, where the
  // bulk counts too. Six is what tests/material/stiffness_test.cpp needs; a law's own bend f'' is left out
  return tissue_.law_form == LawForm::energy ? f + 6.0 * (secant - f) : secant;
}

template Mat3<double> Response::elastic(const Mat3<double>&, const ElementShape&, const double*) const;
template Mat3<Dual> Response::elastic(const Mat3<Dual>&, const ElementShape&, const Dual*) const;
template Mat3<double> Response::viscous(const Mat3<double>&, const Mat3<double>&) const;
template Mat3<Dual> Response::viscous(const Mat3<Dual>&, const Mat3<Dual>&) const;
template double Response::measure(const Mat3<double>&, const ElementShape&) const;
template Dual Response::measure(const Mat3<Dual>&, const ElementShape&) const;
template Sym3<double> Response::relaxing(const Mat3<double>&, const Mat3<double>&) const;
template Sym3<Dual> Response::relaxing(const Mat3<Dual>&, const Mat3<Dual>&) const;
template double Response::volume_change(const Mat3<double>&) const;
template Dual Response::volume_change(const Mat3<Dual>&) const;

}  // namespace glisson
