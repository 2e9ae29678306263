// candidates.h — ways to run a scene, of which a fit takes the cheapest that will do (ladder.h).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fit/forward/section_forward.h"
#include "glisson/scene/scene.h"

namespace glisson::fit {

/// Last changes of an experiment that runs for so long [s].
using Adjust = std::function<void(Variant&, double duration)>;

struct ForwardCandidate {
  std::string name;
  Adjust adjust;
  double factor = 0.0;  ///< of density, for explicit steps that still have to be found; 0: complete
  Integrator integrator{};
  int steps = 0;  ///< as of Rung
};

/// So many equal steps.
Adjust equal_stepping(Integrator integrator, int steps);

/// Slow presses hardly move mass: ρ × factor lengthens the explicit step by √factor. Damping keeps its share of critical.
/// @param step  [s], the same at all parameters: steps that follow the tissue make the force rough in them; 0: automatic
Adjust heavier_tissue(double factor, double step);

/// The scene as the reference: its own settings, or those of the integrator asked for. Implicit and static runs without a step
/// of their own take 400, or 2000 where the past counts: backward Euler is of first order.
Adjust reference_run(const ForwardSpec& spec);

/// Those for a scene, the cheaper ones of a kind first.
std::vector<ForwardCandidate> forward_candidates(const Variant& v, const ForwardSpec& spec);

}  // namespace glisson::fit
