#include "scene/build/loaded_start.h"

#include <stdexcept>

#include "base/text.h"
#include "mesh/inspect/nearest_point.h"
#include "mesh/inspect/tet_locator.h"

namespace glisson::scene {

Variant still_variant(const Variant& variant) {
  Variant still = variant;
  still.start = Start::rest;
  still.instruments.clear();
  still.container.reset();
  still.probes.clear();
  still.heat.reset();
  SimulationOptions& options = still.simulation;
  options.integrator = Integrator::quasi_static;
  options.step.reset();
  options.mass_scaling_step.reset();
  options.mass_scaling = MassScalingKind::fixed;
  options.drag_stages = 1;
  options.precision = Precision::double_precision;
  options.branches = StaticBranches::relaxed;
  options.track_energies = options.mesh_changes = false;
  return still;
}

void take_share(const Variant& still, double share, Variant& out) {
  out.simulation.gravity = still.simulation.gravity * share;
  for (std::size_t i = 0; i < out.loads.size(); ++i) {
    SurfaceLoad& load = out.loads[i].load;
    const SurfaceLoad& whole = still.loads[i].load;
    load.force = whole.force * share, load.traction = whole.traction * share;
    load.pressure = whole.pressure * share, load.moment = whole.moment * share;
  }
}

void move_to_rest(const TetMesh& loaded, const std::vector<Vec3d>& rest, ProbeOptions& probe) {
  auto* at = std::get_if<ProbePoint>(&probe.where);
  if (at == nullptr) return;
  const std::vector<char> removed(loaded.tets.size(), 0);
  const auto found = detail::TetLocator(loaded, removed).locate(at->position);
  if (!found) {
    const auto text = [](const Vec3d& x) {
      return "[" + detail::show(x.x) + ", " + detail::show(x.y) + ", " + detail::show(x.z) + "]";
    };
    throw std::invalid_argument("the point " + text(at->position) + " m is outside of the body; its nearest point is " +
                                text(detail::nearest_point(loaded, at->position)) + " m");
  }
  Vec3d place{};
  for (std::size_t a = 0; a < 4; ++a) place += rest[loaded.tets[found->tet][a]] * found->weights[a];
  at->position = place;
}

std::string refuses_loaded_start(const Variant& variant) {
  const SimulationOptions& options = variant.simulation;
  if (variant.container) {
    return "\"loaded\" does not support a [container]: where its walls press on the body is not known before the run; "
           "hold the "
           "sets that lie on it by [[fixed]], or take start = \"rest\" with gravity_ramp_s";
  }
  if (options.mass_scaling_step && options.mass_scaling == MassScalingKind::fixed) {
    return "\"loaded\" does not support mass_scaling_step with mass_scaling = \"fixed\", whose mass has a weight; take "
           "mass_scaling = \"variable\", or leave the step out";
  }
  if (options.gravity_ramp > 0.0) {
    return "\"loaded\" starts under the whole gravity: leave out gravity_ramp_s = " +
           detail::show(options.gravity_ramp) + ", or take start = \"rest\"";
  }
  return "";
}

}  // namespace glisson::scene
