// branches_note.cpp — that statics forgets the past of a tissue, where nobody has said that it is to.
#include "scene/advice/rules.h"

namespace glisson {

std::string branches_note(const Variant& v) {
  const SimulationOptions& o = v.simulation;
  if (o.integrator != Integrator::quasi_static || o.branches != StaticBranches::automatic) return {};
  const bool relaxes = any_tissue(v, [](const Tissue&t) { return !t.maxwell.empty(); }), viscous = is_viscous(v);
  if (!relaxes && !viscous) return {};
  return advice::fill(
      "quasi_static takes {}{}{} here: the forces are those after long times. motion.branches = \"follow\" lets {} go "
      "by the time of motions and loads, \"relaxed\" says that this is meant",
      {relaxes ? "Maxwell branches as relaxed at once" : "", relaxes && viscous ? " and " : "",
       viscous ? "viscosity as without force" : "",
       relaxes && viscous ? "both"
       : relaxes          ? "them"
                          : "it"});
}

namespace advice {

Texts branches(const StepCase& c) {
  const std::string note = branches_note(c.variant);
  return note.empty() ? Texts{} : Texts{note};
}

}  // namespace advice
}  // namespace glisson
