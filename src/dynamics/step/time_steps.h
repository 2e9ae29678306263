// time_steps.h — how displacement, velocity and acceleration at t + h follow from those at t, by one unknown u⁺.
//
//   backward Euler  v⁺ = (u⁺ − u)/h,  a⁺ = (v⁺ − v)/h
//   Newmark         u⁺ = u + h v + h² [(½ − β) a + β a⁺],  v⁺ = v + h [(1 − γ) a + γ a⁺]
//   generalised-α   the same, with balance at  u_α = (1 − α_f) u⁺ + α_f u  and  a_α = (1 − α_m) a⁺ + α_m a,
//                   α_m = (2 ρ∞ − 1)/(ρ∞ + 1),  α_f = ρ∞/(ρ∞ + 1),  γ = ½ − α_m + α_f,  β = ¼ (1 − α_m + α_f)²
//                                                                                             [ChungHulbert1993]
//   static          v⁺ = a⁺ = 0
//   slow            a⁺ = 0, each half of a step in two stages where viscosity acts, γ = 1 − 1/√2 [Alexander1977]:
//                   v₁ = (u₁ − u)/(γ h) at t + γ h,   v⁺ = (u⁺ − u − (1 − γ) h v₁)/(γ h) at t + h
#pragma once

#include <array>
#include <numbers>
#include <vector>

#include "glisson/math.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// v⁺ = rate (u⁺ − u) + from_v v + from_a a, a⁺ likewise.
struct TimeStep {
  double h = 0.0;
  double alpha_m = 0.0, alpha_f = 0.0;
  double v_rate = 0.0, v_from_v = 0.0, v_from_a = 0.0;
  double a_rate = 0.0, a_from_v = 0.0, a_from_a = 0.0;

  Vec3d velocity(const Vec3d& du, const Vec3d& v, const Vec3d& a) const {
    return du * v_rate + v * v_from_v + a * v_from_a;
  }
  Vec3d acceleration(const Vec3d& du, const Vec3d& v, const Vec3d& a) const {
    return du * a_rate + v * a_from_v + a * a_from_a;
  }
};

inline TimeStep static_step(double h) {
  TimeStep s;
  s.h = h;
  return s;
}

/// Equilibrium at t + h with the velocity of a step of h.
inline TimeStep slow_step(double h) {
  TimeStep s = static_step(h);
  s.v_rate = 1.0 / h;
  return s;
}

/// The parts of a slow step of h: halves, since branches compare two with one to know their error; with viscosity each in stages, of
/// second order and without ringing, whatever the tissue's times are.
inline std::vector<TimeStep> slow_stages(double h, bool viscous) {
  constexpr double kGamma = 1.0 - 0.5 * std::numbers::sqrt2;
  const double half = 0.5 * h;
  if (!viscous) return {static_step(half), static_step(half)};
  TimeStep second = slow_step(kGamma * half);
  second.h = (1.0 - kGamma) * half, second.v_from_v = (2.0 * kGamma - 1.0) / kGamma;
  return {slow_step(kGamma * half), second, slow_step(kGamma * half), second};
}

/// Weights of the velocities of those stages for u⁺ − u over h, exact for cubics.
inline constexpr std::array<double, 4> kSlowWeights{5.0 / 3.0 * std::numbers::sqrt2 - 2.0,
                                                    1.0 - 2.0 / 3.0 * std::numbers::sqrt2, std::numbers::sqrt2 / 3.0,
                                                    2.0 - 4.0 / 3.0 * std::numbers::sqrt2};

inline TimeStep time_step(const ImplicitOptions& options, double h) {
  TimeStep s;
  s.h = h;
  if (options.scheme == TimeScheme::backward_euler) {
    s.v_rate = 1.0 / h;
    s.a_rate = 1.0 / (h * h), s.a_from_v = -1.0 / h;
    return s;
  }
  if (options.scheme == TimeScheme::generalised_alpha) {
    const double rho = options.spectral_radius;
    s.alpha_m = (2.0 * rho - 1.0) / (rho + 1.0), s.alpha_f = rho / (rho + 1.0);
  }
  const double shift = s.alpha_f - s.alpha_m, gamma = 0.5 + shift, beta = 0.25 * (1.0 + shift) * (1.0 + shift);
  s.a_rate = 1.0 / (beta * h * h), s.a_from_v = -1.0 / (beta * h), s.a_from_a = 1.0 - 0.5 / beta;
  s.v_rate = gamma / (beta * h), s.v_from_v = 1.0 - gamma / beta, s.v_from_a = h * (1.0 - 0.5 * gamma / beta);
  return s;
}

}  // namespace glisson
