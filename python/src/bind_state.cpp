// bind_state.cpp — states in memory: save_state, load_state, reset.
#include "bind.h"
#include "live_simulation.h"
#include "rooms.h"

namespace glisson::python {
namespace {

using Live = LiveSimulation;

/// A state, and how many vertices its body has: views on the present one have to be as long.
struct KeptState {
  State state;
  std::size_t vertices = 0;
};

void require_same_size(const Live& live, std::size_t vertices) {
  if (live.get().mesh().vertices.size() != vertices) live.refuse_views();
}

}  // namespace

void bind_states(nb::module_& m, nb::class_<Live>& simulation) {
  nb::class_<KeptState>(m, "State", doc("State"))
      .def_prop_ro(
          "time", [](const KeptState& kept) { return kept.state.time(); }, doc("State::time"))
      .def("__repr__", [](const KeptState& kept) {
        return "State(time=" + std::string(nb::str(nb::float_(kept.state.time())).c_str()) + ")";
      });
  simulation
      .def(
          "save_state",
          [](const Live& live) {
            return KeptState{live.get().save_state(), live.get().mesh().vertices.size()};
          },
          doc("Simulation::save_state"))
      .def(
          "load_state",
          [](Live& live, const KeptState& kept) {
            require_same_size(live, kept.vertices);
            live.get().load_state(kept.state);
          },
          "state"_a, doc("Simulation::load_state"))
      .def(
          "reset",
          [](Live& live) {
            require_same_size(live, live.first_vertices());
            live.get().reset();
          },
          doc("Simulation::reset"));
}

}  // namespace glisson::python
