// shaft_friction.h — friction along a needle's shaft: it sticks, or slips with a dry and a viscous part.
#pragma once

#include "glisson/field.h"

namespace glisson {

/// Stick–slip along the inserted shaft, per metre, for a needle that goes in or comes out (modified Karnopp)
/// [Okamura2004].
struct ShaftFriction {
  double static_in = 0.0, static_out = 0.0;    ///< largest force while it sticks, D [N/m]
  double dynamic_in = 0.0, dynamic_out = 0.0;  ///< force while it slips, C [N/m], at most D
  double viscous_in = 0.0, viscous_out = 0.0;  ///< b [N s/m²]
  double stick_speed = 1e-4;                   ///< below this slip speed it may stick again [m/s]

  template <class Take>
  static constexpr auto fields(Take take) {
    using F = ShaftFriction;
    return take(field("static_in", &F::static_in, "N/m", at_least(0), "largest force while it sticks"),
                field("static_out", &F::static_out, "N/m", at_least(0), "the same during withdrawal"),
                field("dynamic_in", &F::dynamic_in, "N/m", at_least(0), "force while it slips"),
                field("dynamic_out", &F::dynamic_out, "N/m", at_least(0), "the same during withdrawal"),
                field("viscous_in", &F::viscous_in, "N s/m²", at_least(0), "additional force per speed of slip"),
                field("viscous_out", &F::viscous_out, "N s/m²", at_least(0), "the same during withdrawal"),
                field("stick_speed", &F::stick_speed, "mm/s", above(0), "below this slip speed it may stick again"));
  }
  Fault check() const;
};

}  // namespace glisson
