// integrator.h — the integrators, and what each of them supports.
#pragma once

#include <string>

#include "glisson/words.h"

namespace glisson {

/// M a + γ v + f(u, v) = external (docs/integrators.md says when to take which).
enum class Integrator {
  central_difference,  ///< the paper's scheme; h* is set by stiffness and viscosity
  semi_implicit,       ///< the same with viscosity at the end of the step: h* of the body without viscosity, or more
  implicit,            ///< Newton's method each step, stable at any step; in double
  quasi_static  ///< equilibrium, without inertia: time orders motions and loads, or branches and viscosity follow it; in double
};

template <>
inline constexpr Word<Integrator> kWords<Integrator>[] = {
    {"central_difference", Integrator::central_difference,
     "the paper's equation 4: displacements from forces at the start of the step"},
    {"explicit", Integrator::central_difference},
    {"semi_implicit", Integrator::semi_implicit, "the same, viscosity taken at the end of the step"},
    {"implicit", Integrator::implicit, "Newton's method each step, stable at any step"},
    {"quasi_static", Integrator::quasi_static,
     "equilibrium without inertia; time orders motions and loads, `branches` says what relaxes and resists"},
    {"static", Integrator::quasi_static}};

/// What an integrator supports. Code that chooses or refuses an integrator uses these flags, not its name.
struct Capabilities {
  bool supports_interactions = false;           ///< instruments, capsules and containers: its steps are short
  bool supports_them_in_viscous_tissue = true;  ///< also if some tissue has a Kelvin–Voigt viscosity
  /// Supports the interactions that act in long steps (Interaction::refuses_long_steps), in any tissue.
  bool supports_contact = false;
  bool any_step_is_stable = false;     ///< it has no h*, needs no mass scaling and does not ring
  bool viscosity_limits_step = false;  ///< h* falls with viscosity
  bool supports_drag_stages = false;   ///< SimulationOptions::drag_stages above 1
  /// MassScalingKind::variable: mass is added and removed during the run.
  bool supports_variable_mass = false;
  bool supports_adaptive_precision = false;  ///< Precision::adaptive
  bool forces_at_step_end = false;           ///< Simulation::force_time() is the end of a step, not its start

  /// Whether it supports interactions with viscous or inviscid tissue.
  constexpr bool supports(bool viscous_tissue) const {
    return supports_interactions && (supports_them_in_viscous_tissue || !viscous_tissue);
  }
};

Capabilities capabilities(Integrator integrator);

/// The integrators that support instruments, capsules and containers, with their condition, as words for messages.
std::string supporting_integrators();

}  // namespace glisson
