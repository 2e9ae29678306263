#include "material/reference/reference_stress.h"

#include <algorithm>
#include <cmath>

#include "material/stiffness_formulas.h"

namespace glisson::reference {
namespace {

using Principal = std::array<Real, 3>;

/// F = U diag(l) Vᵀ with U, V rotations and l descending in size; l₃ < 0 where det F < 0.
struct Singular {
  RealTensor U, V;
  Principal l;
};
Singular singular(const RealTensor& F) {
  const Eigen::JacobiSVD<RealTensor> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Singular s{svd.matrixU(), svd.matrixV(), {}};
  for (int i = 0; i < 3; ++i) s.l[static_cast<std::size_t>(i)] = svd.singularValues()(i);
  if (s.U.determinant() < 0) s.U.col(2) *= -1, s.l[2] *= -1;
  if (s.V.determinant() < 0) s.V.col(2) *= -1, s.l[2] *= -1;
  return s;
}
RealTensor rebuilt(const Singular& s, const Principal& w) {
  return s.U * Eigen::DiagonalMatrix<Real, 3>(w[0], w[1], w[2]) * s.V.transpose();
}

RealTensor symmetric_part(const RealTensor& a) { return (a + a.transpose()) / 2; }
RealTensor deviator(const RealTensor& a) { return a - a.trace() / 3 * RealTensor::Identity(); }
Real contract(const RealTensor& a, const RealTensor& b) { return a.cwiseProduct(b).sum(); }

RealTensor green(const RealTensor& F) { return (F.transpose() * F - RealTensor::Identity()) / 2; }
/// ε of the tissue's kinematics.
RealTensor strain(const Tissue& t, const RealTensor& F) {
  if (t.kinematics == Kinematics::small) return symmetric_part(F) - RealTensor::Identity();
  if (t.kinematics == Kinematics::green) return green(F);
  const Singular s = singular(F);
  return s.V * Eigen::DiagonalMatrix<Real, 3>(s.l[0], s.l[1], s.l[2]) * s.V.transpose() - RealTensor::Identity();
}

Real mean_ratio(const RealTensor& F) { return 3 * std::pow(F.determinant(), Real(2) / 3) / F.squaredNorm(); }

using RealCorners = std::array<RealVector, 4>;

RealCorners regular_corners() {
  return {RealVector(1, 1, 1), RealVector(-1, 1, -1), RealVector(1, -1, -1), RealVector(-1, -1, 1)};
}
RealTensor edges_from_first(const RealCorners& x) {
  RealTensor D;
  D << x[1] - x[0], x[2] - x[0], x[3] - x[0];
  return D;
}
Real area(const RealVector& a, const RealVector& b, const RealVector& c) { return (b - a).cross(c - a).norm() / 2; }

/// Three times the radius of the sphere inside over that of the sphere around.
Real radius_ratio(const RealCorners& x) {
  const Real volume = edges_from_first(x).determinant() / 6;
  const Real surface =
      area(x[1], x[2], x[3]) + area(x[0], x[2], x[3]) + area(x[0], x[1], x[3]) + area(x[0], x[1], x[2]);
  const RealTensor D = edges_from_first(x).transpose();
  const RealVector middle = D.inverse() * (D.rowwise().squaredNorm() / 2);  // from x₀, as far from all corners
  return 3 * (3 * volume / surface) / middle.norm();
}
/// 9/√6 sin(θ/2) of the solid angle θ at corner i, θ by the triple product of its unit edges.
Real solid_angle(const RealCorners& x, std::size_t i) {
  std::array<RealVector, 3> e;
  for (std::size_t k = 0; k < 3; ++k) e[k] = (x[(i + k + 1) % 4] - x[i]).normalized();
  const Real tangent = std::abs(e[0].dot(e[1].cross(e[2]))) / (1 + e[0].dot(e[1]) + e[1].dot(e[2]) + e[2].dot(e[0]));
  return 9 / std::sqrt(Real(6)) * std::sin(std::atan(tangent));
}
RealCorners carried(const MaterialPoint& point, const RealTensor& F) {
  RealCorners x = regular_corners();
  for (RealVector& corner : x) corner = F * regular_turn(point) * corner;
  return x;
}
std::size_t sharpest_corner(const RealCorners& x) {
  std::size_t least = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    if (solid_angle(x, i) < solid_angle(x, least)) least = i;
  }
  return least;
}
bool is_of_edges(DeformationMeasure m) {
  return m == DeformationMeasure::radius_ratio || m == DeformationMeasure::solid_angle;
}
/// √(5/4 (1 − ρ)), 0.831 (1 − σ).
Real edge_strain(const MaterialPoint& point, const RealTensor& F) {
  const bool radius = point.tissue.measure == DeformationMeasure::radius_ratio;
  const Real scale = Real(0.831);
  if (F.determinant() <= 0) return radius ? std::sqrt(Real(5) / 4) : scale;
  const RealCorners x = carried(point, F);
  if (radius) return std::sqrt(Real(5) / 4 * std::max(Real(0), 1 - radius_ratio(x)));
  return scale * std::max(Real(0), 1 - solid_angle(x, sharpest_corner(x)));
}
/// Its slope by differences of ρ or of the smallest corner's σ, which are smooth.
RealTensor edge_strain_slope(const MaterialPoint& point, const RealTensor& F) {
  const bool radius = point.tissue.measure == DeformationMeasure::radius_ratio;
  const Real s = edge_strain(point, F), h = Real(1e-4L);
  if (s == 0) return RealTensor::Zero();
  const std::size_t corner = sharpest_corner(carried(point, F));
  RealTensor slope;
  for (int k = 0; k < 9; ++k) {
    const auto at = [&](Real d) {
      RealTensor G = F;
      G(k / 3, k % 3) += d;
      const RealCorners x = carried(point, G);
      return radius ? radius_ratio(x) : solid_angle(x, corner);
    };
    slope(k / 3, k % 3) = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
  }
  return (radius ? -Real(5) / (8 * s) : -Real(0.831)) * slope;
}

/// ∂x/∂F.
RealTensor measure_slope(const MaterialPoint& point, const RealTensor& F) {
  if (is_of_edges(point.tissue.measure)) return edge_strain_slope(point, F);
  const RealTensor inverse_transposed = F.inverse().transpose();
  if (point.tissue.measure == DeformationMeasure::regular_mean_ratio) {
    RealTensor G = RealTensor::Zero();
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) {
        const RealVector l = point.rest[a] - point.rest[b];
        G += l * l.transpose();
      }
    }
    const Real x = shape_measure(point, F);
    return x * (Real(2) / 3 * inverse_transposed - 2 / contract(F * G, F) * F * G);
  }
  const Real q = mean_ratio(F);
  const RealTensor slope = q * (Real(2) / 3 * inverse_transposed - 2 / F.squaredNorm() * F);  // ∂q/∂F
  if (point.tissue.measure == DeformationMeasure::one_minus_q) return -slope;
  const Real s = shape_measure(point, F);
  if (s == 0) return RealTensor::Zero();
  return -Real(3) / (4 * s) * slope;
}

struct Moduli {
  Real lambda, mu, lambda_slope, mu_slope;
};
Moduli moduli(const Tissue& t, Real x) {
  const Real E = t.youngs_modulus, nu = t.poisson_ratio;
  const Real l = nu / ((1 + nu) * (1 - 2 * nu)), m = 1 / (2 * (1 + nu));
  if (t.lambda_law || t.mu_law) {
    const auto a = law_at(t.lambda_law.value_or(ConstantLaw{}), double(l * E), x);
    const auto b = law_at(t.mu_law.value_or(ConstantLaw{}), double(m * E), x);
    return {a.value, b.value, a.slope, b.slope};
  }
  const auto [value, slope] = law_at(t.law, t.youngs_modulus, x);
  return {l * value, m * value, l * slope, m * slope};
}

RealTensor tensor_mass_piola(const MaterialPoint& point, const RealTensor& F) {
  const Tissue& t = point.tissue;
  const Moduli m = moduli(t, shape_measure(point, F));
  const RealTensor e = strain(t, F);
  RealTensor P = m.lambda * e.trace() * RealTensor::Identity() + 2 * m.mu * e;
  if (t.kinematics == Kinematics::green) P = F * P;
  if (t.kinematics == Kinematics::corotational) P = rebuilt(singular(F), {1, 1, 1}) * P;
  if (t.law_form == LawForm::secant || F.determinant() <= 0) return P;
  const Real slope = m.lambda_slope * e.trace() * e.trace() / 2 + m.mu_slope * contract(e, e);
  return P + slope * measure_slope(point, F);
}

/// W(Ī₁, Ī₂) and its slopes.
InvariantEnergy energy_of(const NeoHookean& l, Real a, Real) { return {Real(l.mu) / 2 * a, Real(l.mu) / 2, 0}; }
InvariantEnergy energy_of(const MooneyRivlin& l, Real a, Real b) {
  return {l.c10 * a + l.c01 * b, Real(l.c10), Real(l.c01)};
}
InvariantEnergy energy_of(const Yeoh& l, Real a, Real) {
  return {l.c1 * a + l.c2 * a * a + l.c3 * a * a * a, l.c1 + 2 * l.c2 * a + 3 * l.c3 * a * a, 0};
}
InvariantEnergy energy_of(const Fung& l, Real a, Real) {
  return {l.mu / (2 * Real(l.b)) * std::expm1(l.b * a), Real(l.mu) / 2 * std::exp(l.b * a), 0};
}
InvariantEnergy energy_of(const VerondaWestmann& l, Real a, Real b) {
  return {l.c * std::expm1(l.b * a) - Real(l.c) * l.b / 2 * b, l.c * l.b * std::exp(l.b * a), -Real(l.c) * l.b / 2};
}

InvariantEnergy energy_of(const Gent& l, Real a, Real) {
  const Real left = 1 - a / l.limit;
  return {-Real(l.mu) * l.limit / 2 * std::log(left), l.mu / (2 * left), 0};
}
/// a/2b (e^{bx} − 1), q/2r (e^{rx²} − 1), and their slopes.
struct Term {
  Real W, slope;
};
Term exponential_term(Real a, Real b, Real x) { return {a / (2 * b) * std::expm1(b * x), a / 2 * std::exp(b * x)}; }
Term square_exponential_term(Real q, Real r, Real x) {
  return {q / (2 * r) * std::expm1(r * x * x), q * x * std::exp(r * x * x)};
}
InvariantEnergy energy_of(const Invariants& l, Real a, Real b) {
  InvariantEnergy w{l.c10 * a + l.c01 * b + l.c20 * a * a + l.c11 * a * b + l.c02 * b * b + l.c30 * a * a * a,
                    l.c10 + 2 * l.c20 * a + l.c11 * b + 3 * l.c30 * a * a, l.c01 + l.c11 * a + 2 * l.c02 * b};
  for (const Term& t : {exponential_term(l.a1, l.b1, a), square_exponential_term(l.q1, l.r1, a)}) {
    w.W += t.W, w.first += t.slope;
  }
  for (const Term& t : {exponential_term(l.a2, l.b2, b), square_exponential_term(l.q2, l.r2, b)}) {
    w.W += t.W, w.second += t.slope;
  }
  return w;
}

struct TensorInvariants {
  Real J, I1, I2;
  explicit TensorInvariants(const RealTensor& F) : J(F.determinant()), I1(F.squaredNorm()) {
    const RealTensor C = F.transpose() * F;
    I2 = (I1 * I1 - C.squaredNorm()) / 2;
  }
  Real first_excess() const { return std::pow(J, -Real(2) / 3) * I1 - 3; }
  Real second_excess() const { return std::pow(J, -Real(4) / 3) * I2 - 3; }
};

template <class Law>
RealTensor isochoric_piola(const Law& law, const RealTensor& F) {
  const TensorInvariants i(F);
  const InvariantEnergy w = energy_of(law, i.first_excess(), i.second_excess());
  const RealTensor inverse_transposed = F.inverse().transpose();
  const RealTensor first = std::pow(i.J, -Real(2) / 3) * (2 * F - Real(2) / 3 * i.I1 * inverse_transposed);
  const RealTensor second = std::pow(i.J, -Real(4) / 3) *
                            (2 * i.I1 * F - 2 * F * F.transpose() * F - Real(4) / 3 * i.I2 * inverse_transposed);
  return w.first * first + w.second * second;
}
template <class Law>
Real isochoric_energy(const Law& law, const RealTensor& F) {
  const TensorInvariants i(F);
  return energy_of(law, i.first_excess(), i.second_excess()).W;
}

/// λ_i ∂W/∂λ_i = Σ_k 2 μ_k/α_k ( λ̄_i^α_k − ⅓ Σ_j λ̄_j^α_k ).
RealTensor isochoric_piola(const Ogden& law, const RealTensor& F) {
  const Singular s = singular(F);
  const Real scale = std::pow(F.determinant(), -Real(1) / 3);
  Principal w{};
  for (std::size_t k = 0; k < law.mu.size(); ++k) {
    const Real alpha = law.alpha[k];
    Principal p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = std::pow(scale * s.l[i], alpha);
    const Real mean = (p[0] + p[1] + p[2]) / 3;
    for (std::size_t i = 0; i < 3; ++i) w[i] += 2 * law.mu[k] / alpha * (p[i] - mean) / s.l[i];
  }
  return rebuilt(s, w);
}
Real isochoric_energy(const Ogden& law, const RealTensor& F) {
  const Singular s = singular(F);
  const Real scale = std::pow(F.determinant(), -Real(1) / 3);
  Real W = 0;
  for (std::size_t k = 0; k < law.mu.size(); ++k) {
    const Real alpha = law.alpha[k];
    Real sum = -3;
    for (const Real l : s.l) sum += std::pow(scale * l, alpha);
    W += 2 * law.mu[k] / (alpha * alpha) * sum;
  }
  return W;
}

Real along_fibre(const MaterialPoint& point, const RealTensor& F) {
  const RealTensor E =
      point.tissue.has_small_strain() ? RealTensor(symmetric_part(F) - RealTensor::Identity()) : green(F);
  return point.fibre.dot(E * point.fibre);
}

}  // namespace

InvariantEnergy invariant_energy(const HyperelasticLaw& law, Real first_excess, Real second_excess) {
  return std::visit(
      [&]<class Law>(const Law& l) -> InvariantEnergy {
        if constexpr (StretchLaw<Law>) {
          return {};
        } else {
          return energy_of(l, first_excess, second_excess);
        }
      },
      law);
}

RealTensor regular_turn(const MaterialPoint& point) {
  return rebuilt(singular(edges_from_first(point.rest) * edges_from_first(regular_corners()).inverse()), {1, 1, 1});
}

Real shape_measure(const MaterialPoint& point, const RealTensor& F) {
  if (is_of_edges(point.tissue.measure)) return edge_strain(point, F);
  const Real J = F.determinant();
  if (point.tissue.measure == DeformationMeasure::regular_mean_ratio) {
    std::array<RealVector, 4> x;
    for (std::size_t a = 0; a < 4; ++a) x[a] = F * point.rest[a];
    const Real volume = (x[1] - x[0]).dot((x[2] - x[0]).cross(x[3] - x[0])) / 6;
    Real squares = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) squares += (x[a] - x[b]).squaredNorm();
    }
    return volume > 0 ? 12 * std::pow(3 * volume, Real(2) / 3) / squares : 0;
  }
  const Real p = J > 0 ? std::max(Real(0), 1 - mean_ratio(F)) : 1;
  return point.tissue.measure == DeformationMeasure::one_minus_q ? p : std::sqrt(Real(3) / 2 * p);
}

Real stored_energy(const MaterialPoint& point, const RealTensor& F) {
  const Tissue& t = point.tissue;
  Real W = 0;
  if (t.hyperelastic) {
    const Real dilation = F.determinant() - 1;
    W = std::visit([&](const auto& law) { return isochoric_energy(law, F); }, *t.hyperelastic) +
        Real(bulk_modulus(*t.hyperelastic)) / 2 * dilation * dilation;
  } else {
    const Moduli m = moduli(t, shape_measure(point, F));
    const RealTensor e = strain(t, F);
    W = m.lambda / 2 * e.trace() * e.trace() + m.mu * contract(e, e);
  }
  if (!t.fibres) return W;
  const Real along = along_fibre(point, F);
  return W + Real(t.fibres->stiffness) / 2 * along * along;
}

RealTensor piola(const MaterialPoint& point, const RealTensor& F) {
  const Tissue& t = point.tissue;
  RealTensor P;
  if (t.hyperelastic) {
    const Real J = F.determinant();
    P = std::visit([&](const auto& law) { return isochoric_piola(law, F); }, *t.hyperelastic) +
        Real(bulk_modulus(*t.hyperelastic)) * (J - 1) * J * F.inverse().transpose();
  } else {
    P = tensor_mass_piola(point, F);
  }
  if (!t.fibres) return P;
  const RealTensor S = Real(t.fibres->stiffness) * along_fibre(point, F) * point.fibre * point.fibre.transpose();
  return P + (t.has_small_strain() ? S : RealTensor(F * S));
}

RealTensor viscous_piola(const MaterialPoint& point, const RealTensor& F, const RealTensor& rate) {
  const Tissue& t = point.tissue;
  const RealTensor e = t.has_small_strain() ? symmetric_part(rate) : symmetric_part(F.transpose() * rate);
  const Real eta = t.viscosity;
  RealTensor S = 2 * eta * e;
  if (t.viscous_tensor == ViscousTensor::deviatoric) S = 2 * eta * deviator(e);
  if (t.viscous_tensor == ViscousTensor::proportional) {
    const LameParameters lame = t.lame();
    S = eta / Real(t.youngs_modulus) * (lame.lambda * e.trace() * RealTensor::Identity() + 2 * lame.mu * e);
  }
  if (t.viscous_tensor == ViscousTensor::pioletti) S *= std::max(Real(0), F.squaredNorm() - 3);  // I₁ − 3
  return t.has_small_strain() ? S : RealTensor(F * S);
}

RealTensor relaxing_stress(const MaterialPoint& point, const RealTensor& F) {
  const Tissue& t = point.tissue;
  const bool all = t.maxwell_part == MaxwellPart::all;
  const RealTensor P = piola(point, F);
  if (t.has_small_strain()) return all ? symmetric_part(P) : deviator(symmetric_part(P));
  const RealTensor S = F.inverse() * P, C = F.transpose() * F;
  if (all) return symmetric_part(S);
  if (t.hyperelastic) return symmetric_part(RealTensor(S - contract(S, C) / 3 * C.inverse()));
  if (t.kinematics == Kinematics::green) return deviator(symmetric_part(S));
  const RealTensor R = rebuilt(singular(F), {1, 1, 1});  // F⁻¹ R dev(Rᵀ P)
  return symmetric_part(RealTensor(F.inverse() * R * deviator(RealTensor(R.transpose() * P))));
}

Real pace(const MaterialPoint& point, std::size_t branch, const RealTensor& F) {
  const MaxwellBranch& b = point.tissue.maxwell[branch];
  if (!b.time_law) return 1 / Real(b.time);
  const Real x = shape_measure(point, F);
  Real factor = 0;
  if (const auto* e = std::get_if<ExponentialTime>(&*b.time_law)) {
    factor = std::clamp(std::exp(e->rate * x), Real(e->least), Real(e->most));
  } else {
    const auto& p = std::get<PowerTime>(*b.time_law);
    factor = std::clamp(std::pow(x / p.reference, Real(p.exponent)), Real(p.least), Real(p.most));
  }
  return 1 / (b.time * factor);
}

double relaxed_ramp(double t, double time) { return t + time * std::expm1(-t / time); }

double relaxed_sine(double t, double time, double omega) {
  const double x = omega * time;
  return (std::sin(omega * t) - x * std::cos(omega * t) + x * std::exp(-t / time)) / (1.0 + x * x);
}

}  // namespace glisson::reference
