// bind_heat.cpp — HeatSimulation: built, heated and cooled, stepped and read, with the habits of Simulation.
#include <chrono>
#include <cmath>
#include <sstream>

#include "glisson/heat/heat_places.h"
#include "glisson/heat/heat_simulation.h"
#include "glisson/scene/heat_run.h"
#include "glisson/scene/tissue_presets.h"
#include "live_simulation.h"
#include "rooms.h"

namespace glisson::python {
namespace {

std::string heat_doc(const char* member) { return std::string("HeatSimulation::") + member; }

using ThermalTissues = ByRegion<ThermalTissue>;

/// A HeatSimulation as Python holds it: one thread at a time, functions of the caller's kept where the garbage collector sees them.
class LiveHeat {
 public:
  LiveHeat(TetMesh mesh, const std::map<int, ThermalTissue>& tissues, const HeatOptions& options)
      : own_(std::in_place, std::move(mesh), tissues, options) {}
  LiveHeat(const Variant& variant, const MeshLoader& load) : built_(std::in_place, variant, load) {}

  HeatSimulation& get() {
    require_no_other_steps(stepping_);
    return own_ ? *own_ : built_->simulation;
  }
  const HeatSimulation& get() const { return const_cast<LiveHeat*>(this)->get(); }
  const std::optional<BuiltHeat>& built() const { return built_; }

  /// Steps while `next` gives a time to step towards, without the GIL. @throws StepError, and what callbacks raised
  template <class Next>
  void loop(Next next);

  std::vector<nb::object> functions;

 private:
  std::optional<HeatSimulation> own_;
  std::optional<BuiltHeat> built_;
  Fault fault_;
  std::atomic<std::thread::id> stepping_{};
};

template <class Next>
void LiveHeat::loop(Next next) {
  HeatSimulation& s = get();
  if (stepping_.load() != std::thread::id{})
    throw std::runtime_error("HeatSimulation: a function that it calls may not step it; step it when the step is done");
  fault_.raised = nullptr;
  bool interrupted = false;
  std::string trouble;
  struct Stepping {
    std::atomic<std::thread::id>& thread;
    ~Stepping() { thread = std::thread::id{}; }
  };
  stepping_ = std::this_thread::get_id();
  {
    const Stepping stepping{stepping_};
    const Fault::Scope scope(fault_);
    const nb::gil_scoped_release free;
    auto looked = std::chrono::steady_clock::now();
    while (const std::optional<double> towards = next(s)) {
      const HeatStep step = std::isinf(*towards) ? s.step() : s.step_towards(*towards);
      if (fault_.raised) break;
      if (step.status != HeatStatus::ok) {
        trouble = "a step of " + std::to_string(step.step) +
                  " s did not converge, and none that is shorter; look for a power or coefficient that is too large";
        break;
      }
      if (std::chrono::steady_clock::now() - looked < std::chrono::milliseconds(20)) continue;
      looked = std::chrono::steady_clock::now();
      const nb::gil_scoped_acquire gil;
      if (PyErr_CheckSignals() != 0) {
        interrupted = true;
        break;
      }
    }
  }
  if (interrupted) throw nb::python_error();
  fault_.rethrow();
  if (!trouble.empty()) throw StepError(trouble);
}

/// A value over time, as it is given: a number, a function of time, or times and values of a table.
TimeFunction<double> course_of(const char* name, const nb::object& given, LiveHeat& live) {
  if (given.is_none()) return {};
  double number = 0.0;
  if (nb::try_cast(given, number)) return table_course({}, {number});
  std::pair<std::vector<double>, std::vector<double>> table;
  if (nb::try_cast(given, table)) {
    const auto& [times, values] = table;
    if (times.empty() || times.size() != values.size() || !std::is_sorted(times.begin(), times.end())) {
      throw nb::value_error(
          (std::string(name) + ": a table is (times, values), both equally long, times ascending [s]").c_str());
    }
    return table_course(times, values);
  }
  return Callback<double>(name, given, live.functions);
}

void hold_vertices(LiveHeat& live, const VertexChoice& vertices, const nb::object& temperature) {
  keeping_functions(live, [&] {
    if (nb::isinstance<nb::str>(vertices)) {
      live.get().hold(nb::cast<std::string>(vertices), course_of("temperature", temperature, live));
    } else {
      live.get().hold(to_indices(vertices, 1, "vertices"), course_of("temperature", temperature, live));
    }
  });
}

nb::dict history_of(const LiveHeat& live) {
  const HeatHistory& h = live.get().state().history;
  nb::dict out;
  const auto add = [&out](const char* name, const auto& list) {
    out[name] = scalars(std::vector<double>(list.begin(), list.end()));
  };
  add("coldest", h.coldest), add("hottest", h.hottest), add("cem43", h.cem43), add("damage", h.damage);
  add("cold_time", h.cold_time), add("freezings", h.freezings), add("dead", h.dead);
  std::vector<double> below;
  for (const std::vector<double>& of : h.below) below.insert(below.end(), of.begin(), of.end());
  out["below"] = owned<Doubles>(std::move(below), {h.below.size(), h.coldest.size()});
  return out;
}

nb::dict readings_of(const LiveHeat& live) {
  live.get();
  nb::dict out;
  if (!live.built()) return out;
  const HeatSample sample = live.built()->read();
  const auto add = [&out](const std::vector<std::string>& names, const std::vector<double>& row) {
    for (std::size_t i = 0; i < names.size(); ++i) out[names[i].c_str()] = row[i];
  };
  add(live.built()->temperature_columns(), sample.temperatures), add(live.built()->heat_columns(), sample.heat);
  return out;
}

void bind_heat_types(nb::module_& m) {
  Options<TissueDeath>(m, "TissueDeath");
  Options<ThermalTissue>(m, "ThermalTissue");
  Options<HeatOptions>(m, "HeatOptions");
  Results<HeatLedger>(m, "HeatLedger")
      .read("stored", &HeatLedger::stored)
      .read("held", &HeatLedger::held)
      .read("surface", &HeatLedger::surface)
      .read("blood", &HeatLedger::blood)
      .read("metabolism", &HeatLedger::metabolism)
      .read("sources", &HeatLedger::sources)
      .read("removed", &HeatLedger::removed)
      .def_prop_ro("imbalance", &HeatLedger::imbalance, "Left over in the balance [J]");
  Results<IsothermExtent>(m, "IsothermExtent")
      .read("volume", &IsothermExtent::volume)
      .read("low", &IsothermExtent::low)
      .read("high", &IsothermExtent::high);
  nb::class_<HeatState>(m, "HeatState", doc("HeatState"))
      .def_ro("time", &HeatState::time, doc("HeatState::time"))
      .def("__repr__", [](const HeatState& s) {
        return "HeatState(time=" + std::string(nb::str(nb::float_(s.time)).c_str()) + ")";
      });
  m.def(
      "thermal_preset", [](const std::string& name) { return thermal_preset(name); }, "name"_a, doc("thermal_preset"));
  m.def("cem43", &cem43, "from_"_a, "to"_a, "time"_a, doc("cem43"));
}

constexpr const char* kCourse =
    "float | collections.abc.Callable[[float], float] | tuple[collections.abc.Sequence[float], "
    "collections.abc.Sequence[float]]";

/// A signature with the type of courses over time in place of "COURSE".
const char* with_courses(std::string text) {
  static std::vector<std::string> kept;
  kept.reserve(16);
  for (std::size_t at = text.find("COURSE"); at != std::string::npos; at = text.find("COURSE"))
    text.replace(at, 6, kCourse);
  kept.push_back(std::move(text));
  return kept.back().c_str();
}

void bind_heat_set_up(nb::class_<LiveHeat>& c) {
  c.def(
       "__init__",
       [](LiveHeat* self, const TetMesh& mesh, const ThermalTissues& tissues,
          const std::optional<HeatOptions>& options) {
         new (self) LiveHeat(mesh, of_regions(mesh, tissues), options.value_or(HeatOptions{}));
       },
       "mesh"_a, "tissues"_a, "options"_a = nb::none(), doc(heat_doc("HeatSimulation")))
      .def_static(
          "of_variant",
          [](const Variant& variant, std::optional<TetMesh> mesh) {
            Variant own = variant;
            if (mesh) own.mesh = MeshFile{};
            return new LiveHeat(own, mesh_loader(std::move(mesh)));
          },
          "variant"_a, "mesh"_a = nb::none(), nb::rv_policy::take_ownership, doc("BuiltHeat"))
      .def("hold", hold_vertices, "vertices"_a, "temperature"_a, doc(heat_doc("hold")),
           nb::sig(with_courses("def hold(self, vertices: str | numpy.typing.ArrayLike, temperature: COURSE) -> None")))
      .def(
          "add_flux",
          [](LiveHeat& live, const std::string& set, const nb::object& flux) {
            keeping_functions(live, [&] { live.get().add_flux(set, course_of("flux", flux, live)); });
          },
          "set"_a, "flux"_a, doc(heat_doc("add_flux")),
          nb::sig(with_courses("def add_flux(self, set: str, flux: COURSE) -> None")))
      .def(
          "add_convection",
          [](LiveHeat& live, const std::string& set, double coefficient, const nb::object& ambient) {
            keeping_functions(
                live, [&] { live.get().add_convection(set, coefficient, course_of("ambient", ambient, live)); });
          },
          "set"_a, "coefficient"_a, "ambient"_a, doc(heat_doc("add_convection")),
          nb::sig(with_courses("def add_convection(self, set: str, coefficient: float, ambient: COURSE) -> None")))
      .def(
          "add_source",
          [](LiveHeat& live, const Region& region, const nb::object& power) {
            keeping_functions(live, [&] {
              live.get().add_source(region_number(live.get().mesh(), region),
                                    course_of("power_per_volume", power, live));
            });
          },
          "region"_a, "power_per_volume"_a, doc(heat_doc("add_source")),
          nb::sig(with_courses("def add_source(self, region: int | str, power_per_volume: COURSE) -> None")))
      .def(
          "add_line_source",
          [](LiveHeat& live, const Vec3d& from, const Vec3d& to, const nb::object& power, const nb::object& temperature,
             const nb::object& coefficient, double radius) {
            keeping_functions(live, [&] {
              LineSource line{.from = from, .to = to};
              line.power_per_length = course_of("power_per_length", power, live);
              line.temperature = course_of("temperature", temperature, live);
              line.coefficient = course_of("coefficient", coefficient, live);
              line.radius = radius;
              live.get().add_line_source(line);
            });
          },
          "from_"_a, "to"_a, "power_per_length"_a = nb::none(), "temperature"_a = nb::none(),
          "coefficient"_a = nb::none(), "radius"_a = 0.0, doc("LineSource"),
          nb::sig(
              with_courses("def add_line_source(self, from_: collections.abc.Sequence[float] | "
                           "numpy.typing.NDArray[typing.Any], to: collections.abc.Sequence[float] | "
                           "numpy.typing.NDArray[typing.Any], power_per_length: COURSE | None = None, temperature: "
                           "COURSE | None = None, coefficient: COURSE | None = None, radius: float = 0.0) -> None")));
}

void bind_heat_stepping(nb::class_<LiveHeat>& c) {
  c.def(
       "step",
       [](LiveHeat& live, std::uint64_t n) {
         live.loop([&n](const HeatSimulation&) -> std::optional<double> {
           if (n == 0) return std::nullopt;
           --n;
           return INFINITY;
         });
       },
       "n"_a = 1, "Makes n steps; the GIL is released meanwhile.\n:raises StepError: if one did not converge")
      .def(
          "advance",
          [](LiveHeat& live, double until, const std::optional<std::function<void()>>& observer,
             std::optional<double> every) {
            if (!std::isfinite(until)) throw nb::value_error("advance: until is not finite; give a time [s]");
            if (every && !(*every > 0.0)) throw nb::value_error("advance: every is not positive; give a time [s]");
            const double start = live.get().time();
            for (std::uint64_t k = 1; live.get().time() < until; ++k) {
              const double next = observer && every ? std::min(until, start + static_cast<double>(k) * *every) : until;
              live.loop([next](const HeatSimulation& s) {
                return s.time() < next ? std::optional<double>(next) : std::nullopt;
              });
              if (observer) (*observer)();
            }
          },
          "until"_a, "observer"_a = nb::none(), "every"_a = nb::none(),
          "Steps to a time [s], the last step as long as is left. `observer()` is called at this interval of simulated "
          "time, "
          "and at the end; an exception in it ends the run.\n:raises StepError: if a step did not converge")
      .def(
          "save_state", [](const LiveHeat& live) { return live.get().state(); }, doc("HeatState"))
      .def(
          "load_state", [](LiveHeat& live, const HeatState& state) { live.get().load_state(state); }, "state"_a,
          doc(heat_doc("load_state")))
      .def(
          "save",
          [](const LiveHeat& live) {
            std::ostringstream out;
            live.get().save(out);
            const std::string text = std::move(out).str();
            return nb::bytes(text.data(), text.size());
          },
          doc(heat_doc("save")))
      .def(
          "load",
          [](LiveHeat& live, const nb::bytes& bytes) {
            std::istringstream in(std::string(bytes.c_str(), bytes.size()));
            live.get().load(in);
          },
          "checkpoint"_a, doc(heat_doc("load")));
}

void bind_heat_reading(nb::class_<LiveHeat>& c) {
  const auto copied = [](std::span<const double> values) {
    return scalars(std::vector<double>(values.begin(), values.end()));
  };
  c.def_prop_ro(
       "time", [](const LiveHeat& l) { return l.get().time(); }, doc(heat_doc("time")))
      .def_prop_ro(
          "steps", [](const LiveHeat& l) { return l.get().steps(); }, "Made so far")
      .def_prop_ro(
          "mesh", [](const LiveHeat& l) { return l.get().mesh(); }, doc(heat_doc("mesh")))
      .def_prop_ro(
          "temperature", [copied](const LiveHeat& l) { return copied(l.get().temperature()); },
          "Of every vertex [°C]; a copy")
      .def_prop_ro(
          "frozen_share", [](const LiveHeat& l) { return scalars(l.get().frozen_share()); },
          "Share of every vertex that is frozen [-]")
      .def_prop_ro(
          "limited_share", [](const LiveHeat& l) { return l.get().state().limited_share; },
          doc("HeatState::limited_share"))
      .def_prop_ro(
          "ledger", [](const LiveHeat& l) { return l.get().ledger(); }, doc("HeatLedger"))
      .def_prop_ro("history", history_of,
                   "What each vertex has been through: coldest, hottest [°C], cem43 [min], damage, cold_time [s], "
                   "freezings, dead, and "
                   "below, a row for each of HeatOptions.isotherms [s]",
                   nb::sig("def history(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"))
      .def_prop_ro("readings", readings_of,
                   "Of a scene's variant: its sensors, fronts, isotherms and ledger, by the columns of its tables",
                   nb::sig("def readings(self) -> dict[str, float]"))
      .def(
          "frozen_volume",
          [](const LiveHeat& l, const std::optional<Region>& region) {
            return region ? l.get().frozen_volume(region_number(l.get().mesh(), *region)) : l.get().frozen_volume();
          },
          "region"_a = nb::none(), doc(heat_doc("frozen_volume")))
      .def(
          "volume_below",
          [](const LiveHeat& l, double temperature, const std::optional<Region>& region) {
            return region ? l.get().volume_below(temperature, region_number(l.get().mesh(), *region))
                          : l.get().volume_below(temperature);
          },
          "temperature"_a, "region"_a = nb::none(), doc(heat_doc("volume_below")))
      .def(
          "dead_volume",
          [](const LiveHeat& l, const std::optional<Region>& region) {
            return region ? l.get().dead_volume(region_number(l.get().mesh(), *region)) : l.get().dead_volume();
          },
          "region"_a = nb::none(), doc(heat_doc("dead_volume")))
      .def(
          "extent_below",
          [](const LiveHeat& l, double temperature) {
            return isotherm_extent(l.get().mesh(), l.get().temperature(), temperature);
          },
          "temperature"_a, doc("IsothermExtent"))
      .def(
          "temperature_at",
          [](const LiveHeat& l, const ArrayLike& points) {
            return scalars(HeatPoints(l.get().mesh(), to_vectors(points, "points")).read(l.get().temperature()));
          },
          "points"_a,
          "Temperature at points, (n, 3) at rest [m] → (n,) [°C].\n:raises ValueError: naming a point outside the "
          "body");
}

int visit_heat(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (!nb::inst_ready(self)) return 0;
  for (const nb::object& function : nb::inst_ptr<LiveHeat>(self)->functions) Py_VISIT(function.ptr());
  return 0;
}
int drop_heat(PyObject* self) {
  const std::vector<nb::object> dropped = std::exchange(nb::inst_ptr<LiveHeat>(self)->functions, {});
  return 0;
}

}  // namespace

void bind_heat(nb::module_& m) {
  bind_heat_types(m);
  static PyType_Slot slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(visit_heat)},
                                {Py_tp_clear, reinterpret_cast<void*>(drop_heat)},
                                {0, nullptr}};
  nb::class_<LiveHeat> heat(m, "HeatSimulation", nb::type_slots(slots), doc("HeatSimulation"));
  bind_heat_set_up(heat);
  bind_heat_stepping(heat);
  bind_heat_reading(heat);
}

}  // namespace glisson::python
