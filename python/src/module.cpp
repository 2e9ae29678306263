// module.cpp — glisson._core: the engine for Python. The package in python/glisson gives it its public face.
#include <stdexcept>

#include "bind.h"
#include "rooms.h"

NB_MODULE(_core, m) {
  namespace py = glisson::python;
  py::require_main_interpreter();
  nanobind::set_leak_warnings(false);  // objects of a script may live until the interpreter ends
  m.doc() = "The engine of glisson; import glisson instead.";
  py::bind_meshes(m);
  py::bind_implicit(m);
  py::bind_tissues(m);
  py::bind_material_point(m);
  py::bind_instruments(m);
  py::bind_own_driver(m);
  py::bind_own_interaction(m);
  py::bind_probes(m);
  py::bind_simulation(m);
  py::bind_cutting(m);
  py::bind_scenes(m);
  py::bind_results(m);
  py::bind_heat(m);
  py::bind_images(m);
}
