// energies.h — what a constraint exerts, component by component, and where the energy of a body is.
#pragma once

#include "glisson/math.h"

namespace glisson {

/// A force by component [N]: the force of a constraint (tool, support) on the tissue at time t.
///
///   total = elastic + viscous + damping + inertial + gravity + load
///
/// `elastic` and `viscous` balance the tissue's own forces, `damping` overcomes γ v, `inertial` accelerates the driven
/// masses, `gravity` and `load` balance weight and other loads, including those of interactions.
struct ForceParts {
  Vec3d elastic, viscous, damping, inertial, gravity, load;
  Vec3d total() const { return elastic + viscous + damping + inertial + gravity + load; }
  ForceParts& operator+=(const ForceParts& f) {
    elastic += f.elastic, viscous += f.viscous, damping += f.damping;
    inertial += f.inertial, gravity += f.gravity, load += f.load;
    return *this;
  }
};

/// Energies at force_time() [J]. Exact identity of the schemes, up to rounding and the tolerance of Newton's method:
///   kinetic + elastic + dissipated + friction + contact + fracture + instruments + numerical + removed
///     = initial + work_tools + work_loads + changed.
/// Between tool and tissue, with J the impulse of a step on the tissue, V and v the velocities of tool and tissue where it acts,
/// before (−) and after (+): the work of the tool is ½ J·(V₋ + V₊), the tissue receives ½ J·(v₋ + v₊), and friction,
/// contact or fracture the difference.
struct Energies {
  double elastic = 0.0;  ///< − work of the elastic forces; the stored energy but for Simulation::energy_drift()
  double kinetic = 0.0;  ///< explicit, semi-implicit: ½ Σ m v(t−h/2)·v(t+h/2), the scheme's own; implicit: ½ Σ m v²
  double dissipated = 0.0;  ///< by viscosity, Maxwell branches, nodal damping and dashpots: viscous + maxwell + damping
  double viscous = 0.0;  ///< part of `dissipated` by Kelvin–Voigt viscosity; in a body with Maxwell branches, by both
  double maxwell = 0.0;  ///< part of `dissipated` by Maxwell branches, including the energy they still store
  double damping = 0.0;  ///< part of `dissipated` by nodal damping and dashpots
  double friction = 0.0;  ///< by slip along tools, shafts and containers
  /// By impulses across a surface: impacts, and the remainder of the model of a bent needle. Negative where tissue that was
  /// inside a tool at the start is pushed out.
  double contact = 0.0;
  double fracture = 0.0;     ///< work of cutting tips and edges, and the energy released by torn or opened capsules
  double instruments = 0.0;  ///< stored in instruments: bending of needles
  /// By the time scheme of `implicit` itself. Backward Euler: ½ Σ m |Δv|² − ½ ΔF·Δu a step, F the elastic forces.
  /// Newmark: 0. Quasi-static: ½ of the residual at the start, along Δu. Generalised-α: the remainder of the balance, which
  /// then proves nothing.
  double numerical = 0.0;
  /// Of tools, instruments and supports: force on the tissue times the motion of the tool, torques included. An Interaction
  /// of a program's own counts by the motion of the tissue unless it calls InteractionStep::book.
  double work_tools = 0.0;
  /// Of gravity and of loads, springs to the ground among them: what a spring stores is negative work of loads.
  double work_loads = 0.0;
  double initial = 0.0;  ///< kinetic and elastic energy of the state given by set_state
  /// Kinetic and elastic energy lost with removed tets, or by moves of vertices at rest.
  double removed = 0.0;
  /// Added by changes of tissues: stored energy at the present deformation, and kinetic energy of added mass. Also the energy
  /// stored in capsules when they were attached.
  double changed = 0.0;
  double imbalance() const {
    return kinetic + elastic + dissipated + friction + contact + fracture + instruments + numerical + removed -
           initial - work_tools - work_loads - changed;
  }
};

}  // namespace glisson
