// bind_simulation.cpp — simulations: built, held, driven, stepped and read.
#include <sstream>

#include "glisson/instruments/motion.h"
#include "glisson/instruments/rigid_motion.h"
#include "glisson/instruments/tool_motion.h"
#include "live_simulation.h"
#include "rooms.h"

namespace glisson::python {
namespace {

using Live = LiveSimulation;

std::string of(const char* member) { return std::string("Simulation::") + member; }

std::vector<std::uint32_t> chosen(const Live& live, const VertexChoice& choice) {
  if (!nb::isinstance<nb::str>(choice)) {
    const nb::object array = nb::module_::import_("numpy").attr("asarray")(choice);
    const std::size_t size = nb::cast<std::size_t>(array.attr("size")), all = live.get().mesh().vertices.size();
    if (nb::cast<std::string>(array.attr("dtype").attr("kind")) == "b" && size != all) {
      throw nb::value_error(
          ("vertices is a mask of " + std::to_string(size) + ", but the mesh has " + std::to_string(all) + " vertices")
              .c_str());
    }
    return to_indices(choice, 1, "vertices");
  }
  return live.get().mesh().vertex_set(nb::cast<std::string>(choice));
}

/// "xz": the components that are held or driven.
Axes axes_of(const std::string& word) {
  Axes axes{false, false, false};
  for (const char c : word) {
    bool* axis = c == 'x' ? &axes.x : c == 'y' ? &axes.y : c == 'z' ? &axes.z : nullptr;
    if (axis == nullptr) throw nb::value_error(("axes is \"" + word + "\"; allowed: letters of \"xyz\"").c_str());
    *axis = true;
  }
  return axes;
}

using Tissues = ByRegion<Tissue>;

ConstraintId drive(Live& live, const VertexChoice& vertices, const std::variant<PressMotion, nb::object>& motion,
                   const std::string& axes, std::optional<double> from) {
  const std::vector<std::uint32_t> set = chosen(live, vertices);
  if (const auto* press_motion = std::get_if<PressMotion>(&motion)) {
    return live.get().drive(set, press(*press_motion), axes_of(axes), from.value_or(press_motion->start));
  }
  const nb::object& function = std::get<nb::object>(motion);
  if (PyCallable_Check(function.ptr()) == 0) {
    throw nb::type_error(("motion = " + nb::cast<std::string>(nb::repr(function)) +
                          " is neither a PressMotion nor a function of time [s] that gives a displacement [m]")
                             .c_str());
  }
  return keeping_functions(live, [&] {
    Motion way = Callback<Vec3d>("motion", function, live.functions);
    return live.get().drive(set, std::move(way), axes_of(axes), from.value_or(0.0));
  });
}

ConstraintId drive_rigidly(Live& live, const VertexChoice& vertices,
                           const std::variant<RotationMotion, PosesMotion, nb::object>& motion, const std::string& axes,
                           std::optional<double> from) {
  struct {
    Live& live;
    PoseMotion operator()(const RotationMotion& x) const { return rotation_path(x).pose; }
    PoseMotion operator()(const PosesMotion& x) const { return poses_path(x).pose; }
    PoseMotion operator()(const nb::object& x) const {
      if (PyCallable_Check(x.ptr()) == 0) {
        throw nb::type_error(
            ("motion = " + nb::cast<std::string>(nb::repr(x)) +
             " is neither a RotationMotion nor a PosesMotion nor a function of time [s] that gives a Pose")
                .c_str());
      }
      return Callback<Pose>("motion", x, live.functions);
    }
  } read{live};
  const std::vector<std::uint32_t> set = chosen(live, vertices);
  return keeping_functions(
      live, [&] { return live.get().drive_rigidly(set, std::visit(read, motion), axes_of(axes), from.value_or(0.0)); });
}

void add_surface_load(Live& live, const VertexChoice& vertices, const SurfaceLoad& load, const nb::object& scale) {
  keeping_functions(live, [&] {
    std::function<double(double)> grows;
    if (!scale.is_none()) grows = Callback<double>("scale", scale, live.functions);
    live.get().add_surface_load(chosen(live, vertices), load, std::move(grows));
  });
}

void add_load(Live& live, const VertexChoice& vertices, const Vec3d& force, const nb::object& scale) {
  keeping_functions(live, [&] {
    std::function<double(double)> grows;
    if (!scale.is_none()) grows = Callback<double>("scale", scale, live.functions);
    live.get().add_load(chosen(live, vertices), force, std::move(grows));
  });
}

/// A read-only array on the engine's own numbers, that keeps the simulation. A body that may be cut moves in memory, so
/// there it is a copy.
template <class Scalar>
nb::object view(nb::handle self, const Scalar* data, std::initializer_list<std::size_t> shape) {
  auto& live = nb::cast<Live&>(self);
  using Array = nb::ndarray<nb::numpy, const Scalar, nb::c_contig>;
  if (live.may_change()) return Array(data, shape, self).cast(nb::rv_policy::copy);
  struct Held {
    nb::object simulation;
    Live* live;
  };
  ++live.views;
  nb::capsule owner(new Held{nb::borrow(self), &live}, [](void* p) noexcept {
    auto* held = static_cast<Held*>(p);
    --held->live->views;
    delete held;
  });
  return Array(data, shape, owner).cast(nb::rv_policy::reference);
}

nb::object vectors_view(nb::handle self, std::span<const Vec3d> values) {
  return view(self, reinterpret_cast<const double*>(values.data()), {values.size(), 3});
}

nb::bytes save(const Live& live) {
  std::ostringstream out;
  live.get().save(out);
  const std::string text = std::move(out).str();
  return nb::bytes(text.data(), text.size());
}

void load(Live& live, const nb::bytes& checkpoint) {
  live.refuse_views();
  std::istringstream in(std::string(checkpoint.c_str(), checkpoint.size()));
  live.get().load(in);
}

nb::dict tet_fields(const Live& live) {
  TetFields fields = live.get().tet_fields();
  const std::size_t n = fields.q.size();
  nb::dict out;
  out["q"] = scalars(std::move(fields.q));
  out["s"] = scalars(std::move(fields.s));
  out["jacobian"] = scalars(std::move(fields.jacobian));
  out["stress"] = owned<Doubles>(std::move(fields.stress), {n, 6});
  out["piola"] = owned<Doubles>(std::move(fields.piola), {n, 3, 3});
  out["linear"] = scalars(std::move(fields.linear));
  return out;
}

SplitReport split(Live& live, const ArrayLike& faces) {
  live.refuse_views();
  const std::vector<std::uint32_t> corners = to_indices(faces, 3, "faces");
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  }
  return live.change([&](Simulation& s) { return s.split_faces(triangles); });
}

nb::dict constraints_of(const Live& live) {
  nb::dict out;
  if (!live.built()) return out;
  for (std::size_t i = 0; i < live.built()->supports.size(); ++i) {
    out[live.variant()->fixed[i].set.c_str()] = live.built()->supports[i];
  }
  return out;
}

void bind_options(nb::module_& m) {
  Options<ImplicitOptions>(m, "ImplicitOptions");
  Options<SimulationOptions>(m, "SimulationOptions");
}

void bind_readings(nb::module_& m) {
  nb::class_<ConstraintId>(m, "Constraint", doc("ConstraintId")).def_ro("index", &ConstraintId::index);
  Results<ForceParts>(m, "ForceParts")
      .read("elastic", &ForceParts::elastic)
      .read("viscous", &ForceParts::viscous)
      .read("damping", &ForceParts::damping)
      .read("inertial", &ForceParts::inertial)
      .read("gravity", &ForceParts::gravity)
      .read("load", &ForceParts::load)
      .def_prop_ro("total", &ForceParts::total, "Sum of the parts [N]");
  Results<Energies>(m, "Energies")
      .read("elastic", &Energies::elastic)
      .read("kinetic", &Energies::kinetic)
      .read("dissipated", &Energies::dissipated)
      .read("viscous", &Energies::viscous)
      .read("maxwell", &Energies::maxwell)
      .read("damping", &Energies::damping)
      .read("friction", &Energies::friction)
      .read("contact", &Energies::contact)
      .read("fracture", &Energies::fracture)
      .read("instruments", &Energies::instruments)
      .read("numerical", &Energies::numerical)
      .read("work_tools", &Energies::work_tools)
      .read("work_loads", &Energies::work_loads)
      .read("initial", &Energies::initial)
      .read("removed", &Energies::removed)
      .read("changed", &Energies::changed)
      .def_prop_ro("imbalance", &Energies::imbalance, "Left over in the identity of the class [J]");
  Results<RemovalReport>(m, "RemovalReport")
      .read("tets", &RemovalReport::tets)
      .read("mass", &RemovalReport::mass)
      .read("momentum", &RemovalReport::momentum)
      .read("energy", &RemovalReport::energy)
      .read("loose_vertices", &RemovalReport::loose_vertices);
  Results<SplitReport>(m, "SplitReport")
      .read("first_new", &SplitReport::first_new)
      .read("origins", &SplitReport::origins)
      .read("closed_faces", &SplitReport::closed_faces);
  Results<EngineInfo>(m, "EngineInfo")
      .read("instruction_set", &EngineInfo::instruction_set)
      .read("threads", &EngineInfo::threads)
      .read("submeshes", &EngineInfo::submeshes)
      .read("flops_per_tet", &EngineInfo::flops_per_tet)
      .read("bytes_per_tet", &EngineInfo::bytes_per_tet);
  Results<MassScaling>(m, "MassScaling")
      .read("added", &MassScaling::added)
      .read("share", &MassScaling::share)
      .read("tets", &MassScaling::tets)
      .read("present", &MassScaling::present)
      .read("largest", &MassScaling::largest);
  Results<LimitingTet>(m, "LimitingTet")
      .read("tet", &LimitingTet::tet)
      .read("altitude", &LimitingTet::altitude)
      .read("step", &LimitingTet::step);
}

void bind_setting_up(nb::class_<Live>& c) {
  c.def(
       "__init__",
       [](Live* self, const TetMesh& mesh, const Tissues& tissues, const std::optional<SimulationOptions>& options) {
         new (self) Live(mesh, of_regions(mesh, tissues), options.value_or(SimulationOptions{}));
       },
       "mesh"_a, "tissues"_a, "options"_a = nb::none(), doc(of("Simulation")))
      .def_static(
          "of_variant",
          [](const Variant& variant, std::optional<TetMesh> mesh) {
            Variant own = variant;
            if (mesh) own.mesh = MeshFile{};
            return new Live(own, mesh_loader(std::move(mesh)));
          },
          "variant"_a, "mesh"_a = nb::none(), nb::rv_policy::take_ownership, doc("BuiltVariant"))
      .def(
          "fix",
          [](Live& live, const VertexChoice& v, const std::string& axes) {
            return live.get().fix(chosen(live, v), axes_of(axes));
          },
          "vertices"_a, "axes"_a = "xyz", doc(of("fix")))
      .def("drive", drive, "vertices"_a, "motion"_a, "axes"_a = "xyz", "from_time"_a = nb::none(), doc(of("drive")),
           nb::sig(
               "def drive(self, vertices: str | numpy.typing.ArrayLike, motion: PressMotion | "
               "collections.abc.Callable[[float], collections.abc.Sequence[float] | "
               "numpy.typing.NDArray[typing.Any]], axes: str = 'xyz', from_time: float | None = None) -> Constraint"))
      .def(
          "add_load", add_load, "vertices"_a, "force"_a, "scale"_a = nb::none(), doc(of("add_load")),
          nb::sig("def add_load(self, vertices: str | numpy.typing.ArrayLike, force: collections.abc.Sequence[float] | "
                  "numpy.typing.NDArray[typing.Any], scale: collections.abc.Callable[[float], float] | None = None) -> "
                  "None"))
      .def("drive_rigidly", drive_rigidly, "vertices"_a, "motion"_a, "axes"_a = "xyz", "from_time"_a = nb::none(),
           doc(of("drive_rigidly")),
           nb::sig(
               "def drive_rigidly(self, vertices: str | numpy.typing.ArrayLike, motion: RotationMotion | PosesMotion | "
               "collections.abc.Callable[[float], Pose], axes: str = 'xyz', from_time: float | None = None) -> "
               "Constraint"))
      .def("add_surface_load", add_surface_load, "vertices"_a, "load"_a, "scale"_a = nb::none(),
           doc(of("add_surface_load")),
           nb::sig("def add_surface_load(self, vertices: str | numpy.typing.ArrayLike, load: SurfaceLoad, scale: "
                   "collections.abc.Callable[[float], float] | None = None) -> None"))
      .def("attach", &Live::attach, "interaction"_a, nb::keep_alive<1, 2>(), doc(of("attach")))
      .def(
          "remove_tets",
          [](Live& live, const ArrayLike& tets) {
            return live.change([&](Simulation& s) { return s.remove_tets(to_indices(tets, 1, "tets")); });
          },
          "tets"_a, doc(of("remove_tets")))
      .def("split_faces", split, "faces"_a, doc(of("split_faces")))
      .def(
          "set_tissue",
          [](Live& live, const Region& region, const Tissue& tissue) {
            live.change([&](Simulation& s) { s.set_tissue(region_number(s.mesh(), region), tissue); });
          },
          "region"_a, "tissue"_a, doc(of("set_tissue")))
      .def(
          "set_tissues",
          [](Live& live, const Tissues& tissues) {
            live.change([&](Simulation& s) { s.set_tissues(of_regions(s.mesh(), tissues)); });
          },
          "tissues"_a, doc(of("set_tissues")))
      .def(
          "tissue",
          [](const Live& live, const Region& region) {
            return live.get().tissue(region_number(live.get().mesh(), region));
          },
          "region"_a = 0, doc(of("tissue")))
      .def(
          "is_removed", [](const Live& live, std::uint32_t tet) { return live.get().is_removed(tet); }, "tet"_a,
          doc(of("is_removed")))
      .def(
          "set_state",
          [](Live& live, const ArrayLike& u, const ArrayLike& v) {
            live.change([&](Simulation& s) { s.set_state(to_vectors(u, "displacement"), to_vectors(v, "velocity")); });
          },
          "displacement"_a, "velocity"_a, doc(of("set_state")));
}

void bind_stepping(nb::class_<Live>& c) {
  c.def("step", &Live::step, "n"_a = 1,
        "Makes n steps, each of step_size; the GIL is released meanwhile. Returns \"inverted\" if a tet inverted in "
        "one of them.\n:raises StepError: if a step was not made, with the reason and a remedy")
      .def("advance", &Live::advance, "until"_a, "observer"_a = nb::none(), "every"_a = nb::none(),
           "Steps until a time [s] is reached to half a step. `observer()` is called at this interval of simulated "
           "time, and at the end; an exception in it ends the run.")
      .def_prop_ro(
          "inverted_tets", [](const Live& live) { return indices(live.inverted()); },
          "Inverted tets in the state that the last step started from")
      .def("save", save, doc(of("save")))
      .def("load", load, "checkpoint"_a, doc(of("load")));
}

void bind_reading(nb::class_<Live>& c) {
  c.def_prop_ro(
       "time", [](const Live& l) { return l.get().time(); }, doc(of("time")))
      .def_prop_ro(
          "step_size", [](const Live& l) { return l.get().step_size(); }, doc(of("step_size")))
      .def_prop_ro(
          "stable_step", [](const Live& l) { return l.get().stable_step(); }, doc(of("stable_step")))
      .def_prop_ro(
          "steps", [](const Live& l) { return l.get().steps(); }, "Made so far")
      .def_prop_ro(
          "force_time", [](const Live& l) { return l.get().force_time(); }, doc(of("force_time")))
      .def_prop_ro(
          "energies", [](const Live& l) { return l.get().energies(); }, doc(of("energies")))
      .def_prop_ro(
          "stored_energy", [](const Live& l) { return l.get().stored_energy(); }, doc(of("stored_energy")))
      .def_prop_ro(
          "energy_drift", [](const Live& l) { return l.get().energy_drift(); }, doc(of("energy_drift")))
      .def_prop_ro(
          "linear_share", [](const Live& l) { return l.get().linear_share(); }, doc(of("linear_share")))
      .def_prop_ro(
          "engine_info", [](const Live& l) { return l.get().engine_info(); }, "How it is evaluated")
      .def_prop_ro(
          "mass_scaling", [](const Live& l) { return l.get().mass_scaling(); }, doc("MassScaling"))
      .def_prop_ro(
          "mesh", [](const Live& l) { return l.get().mesh(); }, doc(of("mesh")))
      .def_prop_ro(
          "present_mesh", [](const Live& l) { return l.get().present_mesh(); }, doc(of("present_mesh")))
      .def_prop_ro(
          "state_hash", [](const Live& l) { return l.get().state_hash(); }, doc(of("state_hash")))
      .def(
          "limiting_tets", [](const Live& l, std::size_t most) { return l.get().limiting_tets(most); }, "most"_a = 10,
          doc(of("limiting_tets")))
      .def(
          "contact_fields",
          [](const Live& l) {
            ContactFields fields = l.get().contact_fields();
            nb::dict out;
            out["traction"] = vectors(fields.traction);
            out["pressure"] = scalars(std::move(fields.pressure));
            return out;
          },
          doc("ContactFields"), nb::sig("def contact_fields(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"))
      .def("tet_fields", tet_fields, doc("TetFields"),
           nb::sig("def tet_fields(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"))
      .def(
          "force", [](const Live& l, ConstraintId id) { return l.get().force(id); }, "constraint"_a, doc(of("force")))
      .def(
          "torque", [](const Live& l, ConstraintId id, const Vec3d& about) { return l.get().torque(id, about); },
          "constraint"_a, "about"_a, doc(of("torque")))
      .def_prop_ro("constraints", constraints_of, "Of a scene's variant: its supports by name",
                   nb::sig("def constraints(self) -> dict[str, Constraint]"))
      .def_prop_ro(
          "instruments",
          [](const Live& l) {
            nb::dict out;
            if (l.built()) {
              for (const auto& x : l.built()->instruments) out[x->name().c_str()] = nb::cast(x);
            }
            return out;
          },
          "Of a scene's variant: its tools and instruments by name",
          nb::sig("def instruments(self) -> dict[str, typing.Any]"))
      .def_prop_ro(
          "container", [](const Live& l) { return l.built() ? l.built()->container : nullptr; },
          "Of a scene's variant, where it has one")
      .def_prop_ro("probes", probes_of, "Of a scene's variant: its probes, by the columns of probes.csv",
                   nb::sig("def probes(self) -> Probes"), nb::keep_alive<0, 1>())
      .def_prop_ro(
          "capsules",
          [](const Live& l) { return l.built() ? l.built()->capsules : std::vector<std::shared_ptr<Capsule>>{}; },
          "Of a scene's variant");
}

constexpr const char* kViewDoc =
    "\n\nA read-only view without a copy, up to date after every step() and advance(). It keeps the simulation alive; "
    "copy() what is to outlive the next step. With SimulationOptions(mesh_changes=True), a blade, implicit or "
    "quasi_static, a copy.";

void bind_views(nb::class_<Live>& c) {
  const auto add = [&](const char* name, auto read, const char* doc_of) {
    static std::vector<std::string> kept;
    kept.reserve(32);
    kept.push_back("def " + std::string(name) + "(self) -> numpy.typing.NDArray[numpy.float64]");
    const char* signature = kept.back().c_str();
    kept.push_back(std::string(doc_of) + kViewDoc);
    c.def_prop_ro(name, read, kept.back().c_str(), nb::sig(signature));
  };
  add(
      "displacement", [](nb::handle self) { return vectors_view(self, nb::cast<Live&>(self).get().displacement()); },
      doc(of("displacement")));
  add(
      "velocity", [](nb::handle self) { return vectors_view(self, nb::cast<Live&>(self).get().velocity()); },
      doc(of("velocity")));
  add(
      "masses",
      [](nb::handle self) {
        const std::span<const double> m = nb::cast<Live&>(self).get().masses();
        return view(self, m.data(), {m.size()});
      },
      doc(of("masses")));
  c.def_prop_ro(
      "positions", [](const Live& l) { return vectors(l.get().positions()); }, doc(of("positions")));
}

/// For the garbage collector: motions may refer to the simulation that calls them.
int visit_functions(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (!nb::inst_ready(self)) return 0;
  for (const nb::object& function : nb::inst_ptr<Live>(self)->functions) Py_VISIT(function.ptr());
  return 0;
}
int drop_functions(PyObject* self) {
  const std::vector<nb::object> dropped = std::exchange(nb::inst_ptr<Live>(self)->functions, {});
  return 0;
}

}  // namespace

void bind_simulation(nb::module_& m) {
  bind_options(m);
  bind_readings(m);
  nb::exception<StepError>(m, "StepError", PyExc_RuntimeError);
  Options<PressMotion>(m, "PressMotion");
  Options<SurfaceLoad>(m, "SurfaceLoad");
  m.def("press_depth", &press_depth, "motion"_a, "time"_a, doc("press_depth"));
  m.def("press_end", &press_end, "motion"_a, doc("press_end"));
  static PyType_Slot slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(visit_functions)},
                                {Py_tp_clear, reinterpret_cast<void*>(drop_functions)},
                                {0, nullptr}};
  nb::class_<Live> simulation(m, "Simulation", nb::type_slots(slots), doc("Simulation"));
  bind_setting_up(simulation);
  bind_stepping(simulation);
  bind_states(m, simulation);
  bind_views(simulation);
  bind_reading(simulation);
}

}  // namespace glisson::python
