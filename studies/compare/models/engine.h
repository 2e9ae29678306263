// engine.h — a problem given to the engine with other tissues or another integrator, for models that the engine has the law of.
#pragma once

#include "compare/models/relaxation.h"

namespace glisson::models {

/// Runs the problem with these tissues in their place. Of `options` the integrator and its own options count; gravity and damping are the
/// problem's. What the engine refuses is the answer's trouble.
Answer run_engine(const Problem& problem, const std::map<int, Tissue>& tissues, const SimulationOptions& options,
                  const Stop& stop);

/// The scene's own tissue in equilibrium at each station.
struct Equilibria {
  Answer answer;
  std::vector<std::vector<Vec3d>> shapes;  ///< displacement of every vertex at each station [m]
};
/// @param near  shapes near those of the stations, from which each is sought; none: each is from the one before
Equilibria equilibria(const Problem& problem, std::span<const std::vector<Vec3d>> near, const Stop& stop);

/// Every tissue of the problem, changed.
template <class Change>
std::map<int, Tissue> changed(const Problem& problem, Change change) {
  std::map<int, Tissue> tissues = problem.tissues;
  for (auto& [region, tissue] : tissues) change(tissue);
  return tissues;
}

/// A tissue of linear elasticity with these moduli, in the place of another: its name, density and treatment of volume changes.
Tissue linear_tissue(const Tissue& other, const LameParameters& lame);

/// The longest step that the stations are whole multiples of [s], a 64th of the first at least: integrators that take any step then end
/// one at each.
double common_step(std::span<const double> stations);

/// The answer of a model that has no other viscosity than the scene's tissue, where that has none.
Answer without_viscosity(std::string_view what_it_is);

}  // namespace glisson::models
