// rooms.h — the parts of the Python module, one file each.
#pragma once

#include <nanobind/nanobind.h>

namespace glisson::python {

void bind_meshes(nanobind::module_& m);
void bind_implicit(nanobind::module_& m);
void bind_tissues(nanobind::module_& m);
void bind_material_point(nanobind::module_& m);
void bind_instruments(nanobind::module_& m);
void bind_scenes(nanobind::module_& m);
void bind_simulation(nanobind::module_& m);
void bind_own_driver(nanobind::module_& m);
void bind_own_interaction(nanobind::module_& m);
void bind_cutting(nanobind::module_& m);
void bind_probes(nanobind::module_& m);
void bind_results(nanobind::module_& m);
void bind_heat(nanobind::module_& m);
void bind_images(nanobind::module_& m);

class LiveSimulation;
/// States in memory, as members of Simulation.
void bind_states(nanobind::module_& m, nanobind::class_<LiveSimulation>& simulation);

/// Of a scene's variant those of the scene; of another simulation none. The result needs the simulation to be kept.
nanobind::object probes_of(nanobind::handle simulation);

}  // namespace glisson::python
