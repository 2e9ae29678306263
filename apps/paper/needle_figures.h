// needle_figures.h — the paper's needle in a container of liver, figures 4 to 6, held against our runs.
#pragma once

#include "glisson/fit.h"
#include "paper/figures.h"

namespace glisson::app {

/// Figure 4: the force on the needle before, at and after the puncture at three velocities; what the container carries of it.
SceneExtras figure4_extras(const Finished& runs);

/// Figures 5 and 6: four charts with the measured curves and the simulated one, and how well each set of curves is met; the
/// parameters of the fit with their intervals.
/// @param fit  of five curves at 2 mm/s; other curves are held out
/// @param runs  of the variants slow, middle and fast with the fitted tissue
SceneExtras figures_5_and_6_extras(const fit::FitResult& fit, const Finished& runs);

/// Bovine liver: the simulated force beside the measured one of [Okamura2004].
SceneExtras bovine_extras(const Scene& scene, const Finished& runs);

}  // namespace glisson::app
