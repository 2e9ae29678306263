// bind_fields.cpp — the name of a field that there is not, answered as a scene answers a key that there is not.
#include "base/nearest.h"
#include "bind.h"

namespace glisson::python {

void no_such_field(nb::handle type, const std::string& field) {
  std::vector<std::string> known;
  for (nb::handle name : type.attr("_fields")) known.push_back(nb::cast<std::string>(name));
  const std::string meant = scene::nearest(field, known);
  const std::string way_out = meant.empty() ? "; there are " + scene::listed(known) : ": did you mean '" + meant + "'?";
  throw nb::type_error(
      (nb::cast<std::string>(type.attr("__name__")) + ": unknown field '" + field + "'" + way_out).c_str());
}

}  // namespace glisson::python
