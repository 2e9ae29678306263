// bind_cutting.cpp — a blade's edge led through a body by hand. Blades that are instruments: bind_instruments.cpp.
#include <sstream>

#include "glisson/instruments/cutting.h"
#include "live_simulation.h"

namespace glisson::python {
namespace {

/// A cutter and the simulation it cuts, which may be stepping in another thread or lend views.
class OwnCutter {
 public:
  OwnCutter(LiveSimulation& live, const CutOptions& options) : live_(live), cutter_(live.get(), options) {}

  static BladeEdge edge_of(const ArrayLike& given) {
    const std::vector<Vec3d> ends = to_vectors(given, "edge");
    if (ends.size() != 2) {
      throw nb::value_error(("edge has " + std::to_string(ends.size()) + " points; expected 2, its ends").c_str());
    }
    return {ends[0], ends[1]};
  }
  void place(const ArrayLike& edge) { cutter().place(edge_of(edge)); }
  CutReport advance(const ArrayLike& edge) {
    const BladeEdge to = edge_of(edge);
    live_.refuse_views();
    return live_.change([&](Simulation&) { return cutter_.advance(to); });
  }
  Doubles edge() { return vectors({cutter().edge().from, cutter().edge().to}); }
  /// Not while the simulation steps elsewhere.
  Cutter& cutter() {
    live_.get();
    return cutter_;
  }

 private:
  LiveSimulation& live_;
  Cutter cutter_;
};

nb::bytes save(OwnCutter& self) {
  std::ostringstream out;
  self.cutter().save(out);
  const std::string text = std::move(out).str();
  return nb::bytes(text.data(), text.size());
}
void load(OwnCutter& self, const nb::bytes& checkpoint) {
  std::istringstream in(std::string(checkpoint.c_str(), checkpoint.size()));
  self.cutter().load(in);
}

struct KeptCutter {
  std::shared_ptr<const void> state;
};

}  // namespace

void bind_cutting(nb::module_& m) {
  Results<CutReport>(m, "CutReport")
      .read("area", &CutReport::area)
      .read("faces_area", &CutReport::faces_area)
      .read("tets", &CutReport::tets)
      .read("faces", &CutReport::faces)
      .read("new_vertices", &CutReport::new_vertices)
      .read("moved_vertices", &CutReport::moved_vertices)
      .read("held_back", &CutReport::held_back)
      .read("largest_offset", &CutReport::largest_offset);
  Results<EdgePiece>(m, "EdgePiece")
      .read("tet", &EdgePiece::tet)
      .read("length", &EdgePiece::length)
      .read("weights", &EdgePiece::weights);
  const auto of = [](const char* member) { return doc(std::string("Cutter::") + member); };
  nb::class_<KeptCutter>(m, "CutterState", "What Cutter.save_state returns");
  nb::class_<OwnCutter>(m, "Cutter", doc("Cutter"))
      .def(nb::init<LiveSimulation&, const CutOptions&>(), "simulation"_a, "options"_a = CutOptions{},
           nb::keep_alive<1, 2>(), of("Cutter"),
           nb::sig("def __init__(self, simulation: Simulation, options: CutOptions = ...) -> None"))
      .def("place", &OwnCutter::place, "edge"_a, of("place"))
      .def("advance", &OwnCutter::advance, "edge"_a, of("advance"))
      .def(
          "contact", [](OwnCutter& c) { return c.cutter().contact(); }, of("contact"))
      .def_prop_ro("edge", &OwnCutter::edge, "Its ends where they are now, (2, 3) [m]")
      .def("save", save, of("save"))
      .def("load", load, "checkpoint"_a, of("load"))
      .def(
          "save_state", [](OwnCutter& c) { return KeptCutter{c.cutter().save_state()}; }, of("save_state"))
      .def(
          "load_state", [](OwnCutter& c, const KeptCutter& kept) { c.cutter().load_state(kept.state); }, "state"_a,
          of("load_state"));
}

}  // namespace glisson::python
