// energy_ledger.h — the work of every force, accounted so that the scheme's balance is exact.
//
// Positions live at t_n, velocities at t_n ± h/2. The kick at t_n changes the velocity by h R_n / m, with R
// the sum of all forces on a vertex. With the kinetic energy K_n = ½ Σ m v₋·v₊ of the two velocities around t_n,
//   K_n − K_(n−1) = ½ h R_(n−1)·v_(n−½) + ½ h R_n·v_(n−½),
// so each force p does the work ½ h p·v₋ before t_n and ½ h p·v₊ after it. Summed over all forces this is an
// identity, for variable steps too; what a test of the balance proves is that no force was forgotten. For
// linear tissue the elastic work equals the change of ½ uᵀK u to rounding.
//
// A tool's impulse J does the work ½ J·(V₋ + V₊) with the velocities V of the tool: the trapezoidal rule for ∫ F·dX. The tissue
// takes ½ J·(v₋ + v₊); the rest is what contact, friction and fracture dissipate, or a needle stores in its bending.
#pragma once

#include "engine/moving_body.h"
#include "glisson/archive.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

inline void archive(Archive& ar, Energies& e) {
  ar(e.elastic, e.kinetic, e.dissipated, e.viscous, e.maxwell, e.damping, e.friction, e.contact, e.fracture,
     e.instruments, e.numerical, e.work_tools, e.work_loads, e.initial, e.removed, e.changed);
}

class EnergyLedger {
 public:
  /// Starts anew from a state with the given energies [J].
  void reset(double kinetic, double elastic) {
    *this = EnergyLedger();
    now_.initial = kinetic + elastic;
    now_.kinetic = kinetic;
    now_.elastic = elastic;
  }

  /// Books a kick: `before` with v₋, `after` with v₊; `kinetic` = ½ Σ m v₋·v₊.
  /// @param relaxes  viscous forces are those of Maxwell branches
  void book(double h, const KickPower& before, const KickPower& after, double kinetic, bool relaxes) {
    add(0.5 * pending_step_, pending_, relaxes);
    add(0.5 * h, before, relaxes);
    pending_ = after;
    pending_step_ = h;
    now_.kinetic = kinetic;
  }

  /// Books what the instruments store: work that contact did not lose [J].
  void store_in_instruments(double energy) {
    now_.contact -= energy - now_.instruments;
    now_.instruments = energy;
  }

  /// Books energy that left with part of the body [J]. Between two kicks the kinetic part is ½ m v² with the velocity
  /// that both know, so the next kick finds the kinetic energy of what stayed.
  void take_out(double kinetic, double elastic) {
    now_.removed += kinetic + elastic;
    now_.kinetic -= kinetic;
    now_.elastic -= elastic;
  }

  /// Books energy that other tissues bring in at the present deformation and velocity [J].
  void bring_in(double kinetic, double elastic) {
    now_.changed += kinetic + elastic;
    now_.kinetic += kinetic;
    now_.elastic += elastic;
  }
  /// Length of the last kick, of which the second half is not booked yet [s].
  double pending_step() const { return pending_step_; }

  const Energies& now() const { return now_; }
  /// What a step of another scheme has booked by itself.
  Energies& books() { return now_; }
  void archive(Archive& ar) { ar(now_, pending_, pending_step_); }

 private:
  void add(double weight, const KickPower& p, bool relaxes) {
    now_.elastic -= weight * p.elastic;
    now_.dissipated -= weight * (p.viscous + p.damping);
    (relaxes ? now_.maxwell : now_.viscous) -= weight * p.viscous;
    now_.damping -= weight * p.damping;
    now_.contact += weight * p.contact;
    now_.friction += weight * p.friction;
    now_.fracture += weight * p.fracture;
    now_.work_tools += weight * (p.tools + p.contact + p.friction + p.fracture);
    now_.work_loads += weight * p.loads;
  }

  Energies now_;
  KickPower pending_;
  double pending_step_ = 0.0;
};

}  // namespace glisson
