#include "glisson/contact/shaft_friction.h"

#include "base/text.h"

namespace glisson {
namespace {

/// Tissue that slips holds no more than tissue that sticks.
Fault at_most(double dynamic, double most, const char* field, const char* other) {
  if (dynamic <= most) return {};
  return {detail::show(dynamic) + " N/m is above " + other + " = " + detail::show(most) +
              " N/m; tissue that slips holds no more than tissue that sticks",
          field};
}

}  // namespace

Fault ShaftFriction::check() const {
  const Fault in = at_most(dynamic_in, static_in, "dynamic_in", "static_in");
  return in.what.empty() ? at_most(dynamic_out, static_out, "dynamic_out", "static_out") : in;
}

}  // namespace glisson
