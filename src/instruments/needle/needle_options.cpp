#include "instruments/needle/needle_options.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace glisson {
namespace {

class Check {
 public:
  explicit Check(const std::string& needle) : needle_(needle) {}

  void that(bool ok, const std::string& name, double value, const char* range) const {
    if (ok) return;
    std::ostringstream text;
    text << "needle " << needle_ << ": " << name << " = " << value << " is outside the allowed range, " << range;
    throw std::invalid_argument(text.str());
  }
  void positive(const std::string& name, double value) const {
    that(value > 0.0 && std::isfinite(value), name, value, "> 0 and finite");
  }
  void not_negative(const std::string& name, double value) const {
    that(value >= 0.0 && std::isfinite(value), name, value, ">= 0 and finite");
  }
  void tip(const std::string& where, const TipResistance& r) const {
    not_negative(where + "cutting [N]", r.cutting);
    not_negative(where + "puncture [N]", r.puncture);
  }
  void friction(const char* way, double most, double slipping, double viscous) const {
    const std::string suffix = std::string("_") + way;
    not_negative("friction.static" + suffix + " [N/m]", most);
    that(slipping >= 0.0 && slipping <= most, "friction.dynamic" + suffix + " [N/m]", slipping,
         "0 to the static one: tissue that slips holds no more than tissue that sticks");
    not_negative("friction.viscous" + suffix + " [N s/m^2]", viscous);
  }

 private:
  std::string needle_;
};

}  // namespace

void require_needle(const NeedleOptions& o) {
  const Check check(o.name);
  check.positive("diameter [m]", o.diameter);
  check.positive("length [m]", o.length);
  check.positive("length of direction", norm(o.direction));
  check.positive("zone [m]", o.zone);
  check.positive("spacing [m]", o.spacing);
  check.that(!(o.rupture.force && o.rupture.toughness), "rupture.toughness [J/m^2]", o.rupture.toughness.value_or(0.0),
             "none where rupture.force is given: one of the two decides");
  if (o.rupture.force) check.positive("rupture.force [N]", *o.rupture.force);
  if (o.rupture.toughness) check.positive("rupture.toughness [J/m^2]", *o.rupture.toughness);
  check.positive("rupture.membrane_thickness [m]", o.rupture.membrane_thickness);
  check.tip("tip.", o.tip);
  for (const auto& [region, r] : o.regions) check.tip("regions[" + std::to_string(region) + "].", r);
  const ShaftFriction& f = o.friction;
  check.friction("in", f.static_in, f.dynamic_in, f.viscous_in);
  check.friction("out", f.static_out, f.dynamic_out, f.viscous_out);
  check.positive("friction.stick_speed [m/s]", f.stick_speed);
  if (o.youngs_modulus) check.positive("youngs_modulus [Pa]", *o.youngs_modulus);
  check.that(o.inner_diameter >= 0.0 && o.inner_diameter < o.diameter, "inner_diameter [m]", o.inner_diameter,
             "0 to the diameter");
  check.not_negative("bevel_share", o.bevel_share);
  check.that(std::isfinite(norm(o.bevel_side)), "length of bevel_side", norm(o.bevel_side), "finite");
}

}  // namespace glisson
