#include "cli/branches_note.h"

#include <fmt/format.h>

namespace glisson::app {

std::string branches_note(const Variant& v) {
  const SimulationOptions& o = v.simulation;
  if (o.integrator != Integrator::quasi_static || o.branches != StaticBranches::automatic) return {};
  const bool relaxes = any_tissue(v, [](const Tissue&t) { return !t.maxwell.empty(); }), viscous = is_viscous(v);
  if (!relaxes && !viscous) return {};
  return fmt::format(
      "quasi_static takes {}{}{} here: the forces are those after long times. motion.branches = \"follow\" lets {} go "
      "by the time of motions and loads, \"relaxed\" says that this is meant",
      relaxes ? "Maxwell branches as relaxed at once" : "", relaxes && viscous ? " and " : "",
      viscous ? "viscosity as without force" : "",
      relaxes && viscous ? "both"
      : relaxes          ? "them"
                         : "it");
}

}  // namespace glisson::app
