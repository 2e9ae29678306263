// energy_ledger.h — the work of every force, accounted so that the scheme's balance is exact.
//
// Positions live at t_n, velocities at t_n ± h/2. The kick at t_n changes the velocity by h R_n / m, with R
// the sum of all forces on a vertex. With the kinetic energy K_n = ½ Σ m v₋·v₊ of the two velocities around t_n,
//   K_n − K_(n−1) = ½ h R_(n−1)·v_(n−½) + ½ h R_n·v_(n−½),
// so each force p does the work ½ h p·v₋ before t_n and ½ h p·v₊ after it. Summed over all forces this is an
// identity, for variable steps too; what a test of the balance proves is that no force was forgotten. For
// linear tissue the elastic work equals the change of ½ uᵀK u to rounding.
#pragma once

#include "engine/moving_body.h"
#include "glisson/archive.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

inline void archive(Archive& ar, Energies& e) {
  ar(e.elastic, e.kinetic, e.dissipated, e.numerical, e.work_tools, e.work_loads, e.initial, e.removed, e.changed);
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
  void book(double h, const KickPower& before, const KickPower& after, double kinetic) {
    add(0.5 * pending_step_, pending_);
    add(0.5 * h, before);
    pending_ = after;
    pending_step_ = h;
    now_.kinetic = kinetic;
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
  void add(double weight, const KickPower& p) {
    now_.elastic -= weight * p.elastic;
    now_.dissipated -= weight * (p.viscous + p.damping);
    now_.work_tools += weight * p.tools;
    now_.work_loads += weight * p.loads;
  }

  Energies now_;
  KickPower pending_;
  double pending_step_ = 0.0;
};

}  // namespace glisson
