#include "dynamics/pace/pace.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "dynamics/pace/automatic_pace.h"
#include "dynamics/pace/given_pace.h"
#include "dynamics/pace/variable_mass_pace.h"
#include "dynamics/step/step_rules.h"

namespace glisson {

bool Pace::has_to_bear(std::span<const double> stiffening) const {
  return enforces_ && std::ranges::all_of(stiffening, [](double r) { return std::isfinite(r); });
}

std::string Pace::too_large(double stable) const {
  std::ostringstream text;
  text << "step = " << step_ << " s is above the stable step h* = " << stable
       << " s of this mesh and tissue, and the run would be unstable. Ways out: a smaller step, or \"auto\", which "
          "takes "
       << kSafety << " h*; the integrator ";
  if (limits_.drag() == Drag::lags) {
    text << "\"semi_implicit\", or drag_stages of 2 to " << kMostDragStages << " (beside needles and containers "
         << kMostDragStagesBesideInstruments << ", beside tools in contact and blades " << kMostDragStagesBesideOthers
         << " at most), where viscosity is what limits "
         << "h*; ";
  }
  text << "\"implicit\", which is stable at any step; less viscosity or more nodal damping, which raise h*; a larger "
       << "density, or mass scaling of the smallest tets, where the inertia of the tissue does not matter, h* growing "
       << "with its square root";
  return text.str();
}

std::unique_ptr<Pace> make_pace(const PaceParts& parts, std::span<const double> stiffening) {
  const SimulationOptions& options = parts.state.options;
  StepLimits limits(parts.state.body, parts.state.gamma, parts.drag, options, stiffening);
  if (options.mass_scaling == MassScalingKind::variable)
    return std::make_unique<VariableMassPace>(std::move(limits), parts.state, parts.ledger);
  if (options.step) return std::make_unique<GivenPace>(std::move(limits), options);
  return std::make_unique<AutomaticPace>(std::move(limits), options);
}

}  // namespace glisson
