// bind_instruments.cpp — needles, contact tools, capsules, containers, blades; who moves them; what is read off them.
#include "glisson/instruments/blade.h"
#include "glisson/instruments/capsule.h"
#include "glisson/instruments/contact.h"
#include "glisson/instruments/container.h"
#include "glisson/instruments/driven_set.h"
#include "glisson/instruments/needle.h"
#include "glisson/instruments/tool_motion.h"
#include "live_simulation.h"
#include "report/instrument_json.h"
#include "report/json_text.h"

namespace glisson::python {
namespace {

void bind_shapes(nb::module_& m) {
  Options<FlatPunch>(m, "FlatPunch");
  Options<Ball>(m, "Ball");
  Options<NeedleShape>(m, "NeedleShape");
  Options<Plate>(m, "Plate");
  Options<CylinderWall>(m, "CylinderWall");
  Options<Block>(m, "Block");
  m.def(
      "distance_to",
      [](const Shape& shape, const Vec3d& x) {
        const ShapeDistance d = distance_to(shape, x);
        return std::pair(d.distance, d.normal);
      },
      "shape"_a, "x"_a, doc("distance_to"));
  Options<CylinderVessel>(m, "CylinderVessel");
  Options<BoxVessel>(m, "BoxVessel");
}

void bind_motions(nb::module_& m) {
  Options<SteadyMotion>(m, "SteadyMotion");
  Options<Stroke>(m, "Stroke");
  Options<StrokeMotion>(m, "StrokeMotion");
  Options<SineMotion>(m, "SineMotion");
  Options<RecordedMotion>(m, "RecordedMotion");
  Options<RotationMotion>(m, "RotationMotion");
  Options<PosesMotion>(m, "PosesMotion");
  m.def("rotation_angle", &rotation_angle, "motion"_a, "time"_a, doc("rotation_angle"));
  Options<HandCoupling>(m, "HandCoupling");
  m.def("largest_passive_stiffness", &largest_passive_stiffness, "coupling"_a, doc("largest_passive_stiffness"));
}

using MotionArgument = std::variant<PressMotion, SteadyMotion, StrokeMotion, SineMotion, RecordedMotion, nb::object>;

ToolPath path_of(const MotionArgument& motion, std::optional<double> end) {
  struct {
    std::optional<double> end;
    ToolPath operator()(const PressMotion& x) const { return press_path(x); }
    ToolPath operator()(const SteadyMotion& x) const { return steady_path(x); }
    ToolPath operator()(const StrokeMotion& x) const { return stroke_path(x); }
    ToolPath operator()(const SineMotion& x) const { return sine_path(x); }
    ToolPath operator()(const RecordedMotion& x) const { return recorded_path(x); }
    ToolPath operator()(const nb::object& x) const { return {Callback<Vec3d>("motion", x), end}; }
  } read{end};
  return std::visit(read, motion);
}

void bind_drivers(nb::module_& m) {
  Options<Pose>(m, "Pose");
  nb::class_<ToolDriver>(m, "ToolDriver", doc("ToolDriver"))
      .def_prop_ro("start", &ToolDriver::start, doc("ToolDriver::start"))
      .def_prop_ro("end", &ToolDriver::end, doc("ToolDriver::end"))
      .def_prop_ro("rejected", &ToolDriver::rejected, doc("ToolDriver::rejected"));
  nb::class_<PathDriver, ToolDriver>(m, "PathDriver", doc("PathDriver"))
      .def(
          "__init__",
          [](PathDriver* self, const Pose& start, const MotionArgument& motion, std::optional<double> end) {
            new (self) PathDriver(start, path_of(motion, end));
          },
          "start"_a, "motion"_a, "end"_a = nb::none(),
          "`motion` is one of the motions, or a function of time [s] that returns the displacement from the start [m].",
          nb::sig("def __init__(self, start: Pose, motion: PressMotion | SteadyMotion | StrokeMotion | SineMotion | "
                  "RecordedMotion | collections.abc.Callable[[float], collections.abc.Sequence[float] | "
                  "numpy.typing.NDArray[typing.Any]], end: float | None = None) -> None"));
  nb::class_<RigidDriver, ToolDriver>(m, "RigidDriver", doc("RigidDriver"))
      .def(
          "__init__",
          [](RigidDriver* self, const Pose& start, const std::variant<RotationMotion, PosesMotion>& motion) {
            const auto* turn = std::get_if<RotationMotion>(&motion);
            new (self) RigidDriver(start, turn ? rotation_path(*turn) : poses_path(std::get<PosesMotion>(motion)));
          },
          "start"_a, "motion"_a);
  using ForceOverTime = nb::typed<nb::callable, double(double)>;
  const PushMotion own;
  nb::class_<PushDriver, ToolDriver>(m, "PushDriver", doc("PushMotion"))
      .def(
          "__init__",
          [](PushDriver* self, const Pose& start, const std::variant<double, ForceOverTime>& force,
             const Vec3d& direction, double mass, double damping, bool guided, std::optional<double> stop,
             std::optional<double> end) {
            PushMotion motion{.direction = direction, .force = {}, .mass = mass, .damping = damping, .guided = guided};
            motion.stop = stop, motion.end = end;
            if (const double* steady = std::get_if<double>(&force)) {
              motion.force = [f = *steady](double) { return f; };
            } else {
              motion.force = Callback<double>("force", std::get<ForceOverTime>(force));
            }
            new (self) PushDriver(start, std::move(motion));
          },
          "start"_a, "force"_a, nb::kw_only(), "direction"_a = own.direction, "mass"_a = own.mass,
          "damping"_a = own.damping, "guided"_a = own.guided, "stop"_a = own.stop, "end"_a = own.end,
          "`force` is a number or a function of time [N].")
      .def_prop_ro("velocity", &PushDriver::velocity, doc("PushDriver::velocity"));
  nb::class_<HandDriver, ToolDriver>(m, "HandDriver", doc("HandCoupling"))
      .def(nb::init<const Pose&, const HandCoupling&>(), "start"_a, "coupling"_a = HandCoupling{},
           doc("HandDriver::HandDriver"))
      .def("set_target", &HandDriver::set_target, "target"_a, doc("HandDriver::set_target"))
      .def("offer_target", &HandDriver::offer_target, "target"_a, doc("HandDriver::offer_target"))
      .def_prop_ro("device_force", &HandDriver::device_force, doc("HandDriver::device_force"))
      .def_prop_ro("velocity", &HandDriver::velocity, doc("HandDriver::velocity"));
}

void bind_common(nb::module_& m) {
  Results<ToolForces>(m, "ToolForces")
      .read("normal", &ToolForces::normal)
      .read("friction", &ToolForces::friction)
      .read("cutting", &ToolForces::cutting)
      .read("torque", &ToolForces::torque)
      .def_prop_ro("total", &ToolForces::total, "Sum of the parts [N]");
  nb::class_<InstrumentEvent>(m, "InstrumentEvent", doc("InstrumentEvent"))
      .def_ro("time", &InstrumentEvent::time, doc("InstrumentEvent::time"))
      .def_ro("depth", &InstrumentEvent::depth, doc("InstrumentEvent::depth"))
      .def_ro("event", &InstrumentEvent::event, doc("InstrumentEvent::event"))
      .def("__repr__", [](const InstrumentEvent& e) {
        return "<" + e.event + " at " + std::to_string(e.time) + " s, " + std::to_string(e.depth * 1e3) + " mm>";
      });
  nb::class_<Interaction>(m, "Interaction", doc("Interaction"));
  nb::class_<Instrument, Interaction>(m, "Instrument", doc("Instrument"))
      .def_prop_ro("name", &Instrument::name)
      .def_prop_ro(
          "pose", [](const Instrument& x) { return x.pose(); }, doc("Instrument::pose"))
      .def_prop_ro(
          "forces", [](const Instrument& x) { return x.forces(); }, doc("Instrument::forces"))
      .def_prop_ro("force", &Instrument::force, doc("Instrument::force"))
      .def_prop_ro("sensor_force", &Instrument::sensor_force, doc("Instrument::sensor_force"))
      .def_prop_ro("force_pose", &Instrument::force_pose, doc("Instrument::force_pose"))
      .def_prop_ro("handle", &Instrument::handle, doc("Instrument::handle"))
      .def_prop_ro("handle_torque", &Instrument::handle_torque, doc("Instrument::handle_torque"))
      .def_prop_ro(
          "columns",
          [](const Instrument& x) {
            nb::dict out;
            for (const InstrumentColumn& c : x.columns()) out[nb::str(c.name.data(), c.name.size())] = c.read(x);
            return out;
          },
          "What forces.csv has of it, by column", nb::sig("def columns(self) -> dict[str, float]"))
      .def_prop_ro(
          "form",
          [](const Instrument& x) {
            return nb::cast<nb::dict>(nb::module_::import_("json").attr("loads")(json_text(instrument_form_json(x))));
          },
          "What a picture shows of it: its kind, and its sizes [m]", nb::sig("def form(self) -> dict[str, typing.Any]"))
      .def_prop_ro(
          "centre_line", [](const Instrument& x) { return vectors(x.centre_line()); }, doc("Instrument::centre_line"))
      .def_prop_ro("depth", &Instrument::depth, doc("Instrument::depth"))
      .def_prop_ro("force_depth", &Instrument::force_depth, doc("Instrument::force_depth"))
      .def_prop_ro("direction", [](const Instrument& x) { return x.direction(); })
      .def_prop_ro("rejected", &Instrument::rejected, doc("Instrument::rejected"))
      .def_prop_ro(
          "events", [](const Instrument& x) { return x.events(); }, doc("Instrument::events"));
}

void bind_driven_set(nb::module_& m) {
  nb::class_<DrivenSet, Instrument>(m, "DrivenSet", doc("DrivenSet"))
      .def_prop_ro("parts", &DrivenSet::parts, doc("DrivenSet::parts"))
      .def("torque", &DrivenSet::torque, "about"_a, doc("DrivenSet::torque"))
      .def_prop_ro("axial_torque", &DrivenSet::axial_torque, doc("DrivenSet::axial_torque"))
      .def_prop_ro("angle", &DrivenSet::angle, doc("DrivenSet::angle"));
}

void bind_needle(nb::module_& m) {
  Options<ShaftFriction>(m, "ShaftFriction");
  Options<TipResistance>(m, "TipResistance");
  Options<Rupture>(m, "Rupture");
  Options<InnerMembrane>(m, "InnerMembrane");
  Options<MembraneProcess>(m, "MembraneProcess");
  Options<NeedleOptions>(m, "NeedleOptions");
  nb::class_<Needle, Instrument>(m, "Needle", doc("Needle"))
      .def(nb::init<const NeedleOptions&, std::shared_ptr<ToolDriver>>(), "options"_a, "driver"_a,
           doc("Needle::Needle"))
      .def_prop_ro("stage", &Needle::stage, doc("NeedleStage"))
      .def_prop_ro(
          "crossing",
          [](const Needle& n) {
            std::vector<double> ends;
            for (const TissueInterval& i : n.crossing()) ends.insert(ends.end(), {i.from, i.to});
            const std::size_t size = ends.size() / 2;
            return owned<Doubles>(std::move(ends), {size, 2});
          },
          doc("Needle::crossing"))
      .def_prop_ro("inserted_length", &Needle::inserted_length, doc("Needle::inserted_length"))
      .def_prop_ro("path_length", &Needle::path_length, doc("Needle::path_length"))
      .def_prop_ro("tip_force", &Needle::tip_force, doc("Needle::tip_force"))
      .def_prop_ro(
          "path", [](const Needle& n) { return vectors(n.path()); }, doc("Needle::path"))
      .def_prop_ro("options", [](const Needle& n) { return n.options(); })
      .def(
          "tears",
          [](Needle& needle, const std::shared_ptr<Capsule>& capsule) {
            needle.on_puncture([capsule](const Vec3d& place, double radius) { capsule->open_at(place, radius); });
          },
          "capsule"_a, "Opens this capsule where and when the needle pierces the surface.");
}

void bind_contact(nb::module_& m) {
  Options<ContactOptions>(m, "ContactOptions");
  nb::class_<ContactTool, Instrument>(m, "ContactTool", doc("ContactTool"))
      .def(nb::init<const ContactOptions&, std::shared_ptr<ToolDriver>>(), "options"_a, "driver"_a,
           doc("ContactTool::ContactTool"))
      .def_prop_ro("touches", &ContactTool::touches, doc("ContactTool::touches"))
      .def_prop_ro("contact_area", &ContactTool::contact_area, doc("ContactTool::contact_area"))
      .def_prop_ro("largest_pressure", &ContactTool::largest_pressure, doc("ContactTool::largest_pressure"))
      .def_prop_ro(
          "contact_pressure",
          [](const ContactTool& tool) {
            const ContactPressure p = tool.contact_pressure();
            return std::pair(indices({p.vertices.begin(), p.vertices.end()}),
                             scalars({p.pascals.begin(), p.pascals.end()}));
          },
          "Loaded vertices, and the pressure on each [Pa]");
}

void bind_vessels(nb::module_& m) {
  Options<ContainerOptions>(m, "ContainerOptions");
  Results<ContainerLoads>(m, "ContainerLoads")
      .read("bottom", &ContainerLoads::bottom)
      .read("side", &ContainerLoads::side)
      .read("side_radial", &ContainerLoads::side_radial)
      .def_prop_ro("total", &ContainerLoads::total, "Sum of both [N]");
  nb::class_<Container, Interaction>(m, "Container", doc("Container"))
      .def(nb::init<const ContainerOptions&>(), "options"_a, doc("Container::Container"))
      .def_prop_ro(
          "sensor_loads", [](const Container& c) { return c.sensor_loads(); }, doc("ContainerLoads"))
      .def_prop_ro("up", &Container::up, doc("Container::up"));
}

void bind_capsule(nb::module_& m) {
  Options<CapsuleOptions>(m, "CapsuleOptions");
  nb::class_<Capsule, Interaction>(m, "Capsule", doc("Capsule"))
      .def(nb::init<const CapsuleOptions&>(), "options"_a, doc("Capsule::Capsule"))
      .def_prop_ro(
          "tension",
          [](const Capsule& c) {
            return scalars({c.tension().begin(), c.tension().end()});
          },
          doc("Capsule::tension"))
      .def_prop_ro(
          "open_share",
          [](const Capsule& c) {
            return scalars({c.open_share().begin(), c.open_share().end()});
          },
          doc("Capsule::open_share"))
      .def_prop_ro("largest_tension", &Capsule::largest_tension, doc("Capsule::largest_tension"))
      .def("tension_at", &Capsule::tension_at, "place"_a, doc("Capsule::tension_at"))
      .def("is_torn", &Capsule::is_torn, "triangle"_a, doc("Capsule::is_torn"))
      .def_prop_ro("open_area", &Capsule::open_area, doc("Capsule::open_area"))
      .def_prop_ro("energy", &Capsule::energy, doc("Capsule::energy"))
      .def_prop_ro("released_energy", &Capsule::released_energy, doc("Capsule::released_energy"))
      .def("tear", &Capsule::tear, "triangle"_a, doc("Capsule::tear"))
      .def("open_at", &Capsule::open_at, "place"_a, "radius"_a, doc("Capsule::open_at"));
}

void bind_blade(nb::module_& m) {
  Options<CutOptions>(m, "CutOptions");
  Options<BladeOptions>(m, "BladeOptions");
  nb::class_<Blade, Instrument>(m, "Blade", doc("Blade"))
      .def(nb::init<const BladeOptions&, std::shared_ptr<ToolDriver>>(), "options"_a, "driver"_a, doc("Blade::Blade"))
      .def_prop_ro("area", &Blade::area, doc("Blade::area"))
      .def_prop_ro("work_of_cut", &Blade::work_of_cut, doc("Blade::work_of_cut"))
      .def_prop_ro("length_in_tissue", &Blade::length_in_tissue, doc("Blade::length_in_tissue"));
}

}  // namespace

void bind_instruments(nb::module_& m) {
  bind_shapes(m);
  bind_motions(m);
  bind_drivers(m);
  bind_common(m);
  bind_driven_set(m);
  bind_contact(m);
  bind_vessels(m);
  bind_capsule(m);
  bind_needle(m);
  bind_blade(m);
}

}  // namespace glisson::python
