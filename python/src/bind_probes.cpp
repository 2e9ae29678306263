// bind_probes.cpp — what is read at some places of a body, built by hand or of a scene.
#include "glisson/simulation/probe.h"

#include "glisson/instruments/instrument.h"
#include "live_simulation.h"
#include "rooms.h"

namespace glisson::python {
namespace {

using Where = decltype(ProbeOptions::where);

/// Probes and the simulation that they read, which may be stepping in another thread.
class OwnProbes {
 public:
  OwnProbes(LiveSimulation& live, const nb::dict& places, const nb::dict& tips) : live_(live), probes_(&own_) {
    std::vector<ProbeOptions> options;
    for (const auto& [name, place] : places) {
      Where where;
      if (!nb::try_cast(place, where)) {
        throw nb::type_error(("probe " + nb::cast<std::string>(nb::repr(name)) + " is " +
                              nb::cast<std::string>(nb::repr(place)) +
                              "; expected a ProbePoint, ProbeSet, ProbeRegion or ProbePlane")
                                 .c_str());
      }
      options.push_back({nb::cast<std::string>(name), std::move(where)});
      if (tips.contains(name)) options.back().tip = tip_of(nb::cast<std::shared_ptr<Instrument>>(tips[name]));
    }
    for (const auto& [name, instrument] : tips) {
      if (places.contains(name)) continue;
      throw nb::key_error(
          ("tips names " + nb::cast<std::string>(nb::repr(name)) + ", which is none of the places").c_str());
    }
    own_ = Probes(live.get(), std::move(options));
  }
  OwnProbes(LiveSimulation& live, Probes& of_scene) : live_(live), probes_(&of_scene) {}
  OwnProbes(const OwnProbes&) = delete;

  const std::vector<std::string>& columns() const { return probes_->columns(); }
  nb::dict read() {
    const std::vector<double> values = probes_->read(live_.get());
    nb::dict row;
    for (std::size_t i = 0; i < values.size(); ++i) row[columns()[i].c_str()] = values[i];
    return row;
  }
  std::vector<std::string> lost() const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < probes_->size(); ++i) {
      if (probes_->lost(i)) names.push_back(probes_->name(i));
    }
    return names;
  }

 private:
  static std::function<ProbeTip()> tip_of(std::shared_ptr<Instrument> instrument) {
    return [x = std::move(instrument)] { return ProbeTip{x->centre_line().back(), x->direction()}; };
  }

  LiveSimulation& live_;
  Probes own_;
  Probes* probes_;  ///< own_, or those of the scene
};

}  // namespace

nb::object probes_of(nb::handle simulation) {
  auto& live = nb::cast<LiveSimulation&>(simulation);
  auto* probes = live.probes() ? new OwnProbes(live, *live.probes()) : new OwnProbes(live, nb::dict(), nb::dict());
  return nb::cast(probes, nb::rv_policy::take_ownership);
}

void bind_probes(nb::module_& m) {
  Options<ProbePoint>(m, "ProbePoint");
  Options<ProbeSet>(m, "ProbeSet");
  Options<ProbeRegion>(m, "ProbeRegion");
  Options<ProbePlane>(m, "ProbePlane");
  nb::class_<OwnProbes>(m, "Probes", doc("Probes"))
      .def(
          nb::init<LiveSimulation&, const nb::dict&, const nb::dict&>(), "simulation"_a, "places"_a,
          "tips"_a = nb::dict(), nb::keep_alive<1, 2>(),
          "Places by name: {\"tumour\": ProbePoint(position=[0.02, 0.02, 0.05])}. `tips` has instruments by the name "
          "of a "
          "place: the distance of their tips to it is read, and its parts along and across.\n:raises ValueError: for a "
          "place that the body does not have, with the nearest that it has\n:raises KeyError: for a tip of no place",
          nb::sig("def __init__(self, simulation: Simulation, places: dict[str, ProbePoint | ProbeSet | ProbeRegion | "
                  "ProbePlane], tips: dict[str, Instrument] = {}) -> None"))
      .def_prop_ro("columns", &OwnProbes::columns, doc("Probes::columns"))
      .def("read", &OwnProbes::read,
           "Values by column at the present state of the simulation; docs/output.md has their units.",
           nb::sig("def read(self) -> dict[str, float]"))
      .def_prop_ro("lost", &OwnProbes::lost, "Names of the probes of which no tet is left; as of the last read()");
}

}  // namespace glisson::python
