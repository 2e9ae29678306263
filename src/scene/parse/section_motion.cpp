// section_motion.cpp — [motion]: time, damping, gravity; what holds, loads and presses the body; [output].
#include "glisson/scene/scene.h"
#include "scene/parse/result_names.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

std::vector<Choice<Axes>> axes_choices() {
  return {{"xyz", {true, true, true}, "all"}, {"xy", {true, true, false}, ""}, {"xz", {true, false, true}, ""},
          {"yz", {false, true, true}, ""},    {"x", {true, false, false}, ""}, {"y", {false, true, false}, ""},
          {"z", {false, false, true}, ""}};
}

bool along_an_axis(const Vec3d& d) { return (d.x != 0.0) + (d.y != 0.0) + (d.z != 0.0) == 1; }

/// What must hold between the keys of a load.
void check_load(LoadSpec& load, const Node& table, const Place& place) {
  load.origin = place.text();
  std::string acting;
  bool acts = false;
  each_field<SurfaceLoad>([&](const FieldText& f) {
    if (f.name == "follows") return;
    acts = acts || table.find(f.key()) != nullptr;
    acting += (acting.empty() ? "`" : ", `") + f.key() + "`";
  });
  if (!acts) place.complain("nothing acts; give at least one of " + acting);
  const Node *times = table.find("times_s"), *factors = table.find("factors");
  if (!times && !factors) return;
  if (!times) return place.complain(*factors, "factors", "needs `times_s`, as many times as factors");
  if (load.times.size() != load.factors.size() || load.times.empty()) {
    return place.complain(*times, "times_s",
                          std::to_string(load.times.size()) + " times and " + std::to_string(load.factors.size()) +
                              " `factors`; give as many of both, one or more");
  }
  if (table.find("ramp_s")) place.complain(*times, "times_s", "and `ramp_s` exclude each other; give one of them");
  for (std::size_t i = 1; i < load.times.size(); ++i) {
    if (load.times[i] > load.times[i - 1]) continue;
    return place.complain(*times, "times_s",
                          "number " + std::to_string(i + 1) + " is not later than the one before it");
  }
}

/// What must hold of a run that starts loaded.
void check_start(Variant& variant, const Node& table, const Place& place) {
  const Node* start = table.find("start");
  if (!start || variant.start != Start::loaded) return;
  variant.start_origin = place.inside("start", start->where).text();
  const SimulationOptions& options = variant.simulation;
  if (const Node* ramp = table.find("gravity_ramp_s"); ramp && options.gravity_ramp > 0.0) {
    place.complain(*ramp, "gravity_ramp_s",
                   "start = \"loaded\" begins under the whole gravity; leave it out, or take start = \"rest\"");
  }
  if (options.mass_scaling_step && options.mass_scaling == MassScalingKind::fixed) {
    place.complain(*table.find("mass_scaling_step_s"), "mass_scaling_step_s",
                   "start = \"loaded\" does not support mass that is added for the whole run, which has a weight; take "
                   "mass_scaling = \"variable\", or leave it out");
  }
}

/// What must hold of a tool's direction.
void check_tool(ToolSpec& tool, const Node& table, const Place& place) {
  tool.origin = place.text();
  const std::string unfit = unfit_as_table(tool.name);
  if (const Node* name = table.find("name"); name && !unfit.empty()) place.complain(*name, "name", unfit);
  if (tool.axial_free && !tool.rotation) place.complain(*table.find("axial"), "axial", "needs `[tool.rotation]`");
  if (tool.axial_free && tool.rotation && !along_an_axis(tool.rotation->axis)) {
    place.complain(*table.find("axial"), "axial",
                   "\"free\" needs an axis along x, y or z, not " + Codec<Vec3d>::show(tool.rotation->axis) +
                       "; use axial = \"held\" or turn the mesh");
  }
  if (tool.sideways_free && (tool.rotation || tool.poses)) {
    place.complain(*table.find("sideways"), "sideways",
                   "\"free\" is for tools that move along a direction; leave it out");
  }
  const Vec3d& d = tool.motion.direction;
  const Node* given = table.find("direction");
  if (tool.sideways_free && !along_an_axis(d)) {
    place.complain(
        *given, "direction",
        Codec<Vec3d>::show(d) +
            " is not along an axis, which `sideways = \"free\"` needs; use sideways = \"blocked\" or turn the mesh");
  }
}

}  // namespace

const SectionSpec& implicit_section() {
  static const SectionSpec section =
      described<ImplicitOptions>("motion.implicit", "Options of the integrators implicit and quasi_static.");
  return section;
}

const SectionSpec& motion_section() {
  static const SectionSpec section = [] {
    Section<Variant> s("motion",
                       "Time integration: the integrator, its step, damping, gravity, and the end of the run.");
    s.fields(&Variant::simulation);
    s.key("start", &Variant::start, "the state of the body in the mesh, in which the run starts");
    s.key("on_inversion", &Variant::on_inversion, "what to do when a tetrahedron inverts");
    s.key("duration_s", &Variant::duration, "simulated time")
        .in("s")
        .within(above(0))
        .otherwise("until the last tool has ended its motion, without tools the last record of a support");
    s.key("max_steps", &Variant::max_steps, "the run ends after that many steps")
        .within(between(1, Codec<std::uint64_t>::kLargest))
        .otherwise("no limit");
    s.finish(check_start);
    return s.spec();
  }();
  return section;
}

const SectionSpec& fixed_section() {
  static const SectionSpec section = [] {
    Section<FixedSpec> s(
        "fixed",
        "Holds the vertices of a set where they are, or moves them by a record. Sets may share vertices: a component "
        "is held "
        "once, and its force counts with the first set that names it. Sets and tools that ask different things of one "
        "component are refused.");
    s.key("set", &FixedSpec::set, "name of a vertex set").must();
    s.choice<Axes>("axes", &FixedSpec::axes, axes_choices(), "components that are held").otherwise("\"xyz\"");
    s.table(
        "record", record_section(), [](FixedSpec & x) -> auto& { return x.record.emplace(); },
        "a recorded path that the set follows, as of breathing");
    s.key("direction", &FixedSpec::direction, "direction of the record's `depth_m`, of any length").in("-").direction();
    s.finish([](FixedSpec& x, const Node& table, const Place& place) {
      x.origin = place.text();
      if (const Node* direction = table.find("direction"); direction && !x.record)
        place.complain(*direction, "direction", "belongs to a set that moves; give `record`, or leave it out");
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& load_section() {
  static const SectionSpec section = [] {
    Section<LoadSpec> s(
        "load",
        "What acts on a set from outside: force, traction, pressure, moment; springs and dashpots to the "
        "ground. Faces of the set are the faces of the body's surface all corners of which are in it.");
    s.key("set", &LoadSpec::set, "name of a vertex set").must();
    s.fields(&LoadSpec::load);
    s.key("ramp_s", &LoadSpec::ramp, "time of linear growth from 0 of force, traction, pressure and moment")
        .in("s")
        .within(at_least(0));
    s.key("times_s", &LoadSpec::times, "times of `factors`, ascending").in("s").otherwise("none");
    s.key("factors", &LoadSpec::factors,
          "what force, traction, pressure and moment are multiplied by at `times_s`: linear between them, constant "
          "before and after")
        .otherwise("none");
    s.finish(check_load);
    return s.spec();
  }();
  return section;
}

const SectionSpec& tool_section() {
  static const SectionSpec section = [] {
    Section<ToolSpec> s(
        "tool", "A tool that presses: it moves the vertices of a set along a direction, and the force is measured.");
    s.key("name", &ToolSpec::name, "name; no two tools of an experiment share one");
    s.key("set", &ToolSpec::set, "name of the vertex set it moves").must();
    s.fields(&ToolSpec::motion);
    s.at("start_s").help += "; until then its vertices are free";
    s.table(
        "record", record_section(), [](ToolSpec & t) -> auto& { return t.record.emplace(); },
        "a recorded path, in place of speed and depth");
    s.table(
        "rotation", rotation_section(), [](ToolSpec & t) -> auto& { return t.rotation.emplace(); },
        "a rotation about an axis, in place of speed and depth; its torque is recorded");
    s.table(
        "poses", poses_section(), [](ToolSpec & t) -> auto& { return t.poses.emplace(); },
        "poses from a table, in place of speed and depth");
    s.choice<bool>("axial", &ToolSpec::axial_free,
                   {{"held", false, "the vertices do not move along the axis of a rotation"},
                    {"free", true, "they are free along it; it must be along x, y or z"}},
                   "motion along the axis of `rotation`");
    s.choice<bool>("sideways", &ToolSpec::sideways_free,
                   {{"blocked", false, "the vertices move with the tool in all components"},
                    {"free", true, "only along the direction, which must be along an axis: no friction"}},
                   "motion across the direction");
    s.spec().exclusions = {
        {{{"record"}, {"velocity_mm_s", "depth_mm", "start_s", "ramp_s", "hold_s", "returns"}, {"rotation"}, {"poses"}},
         false}};
    s.finish(check_tool);
    return s.spec();
  }();
  return section;
}

const SectionSpec& output_section() {
  static const SectionSpec section = described<OutputSpec>("output", "Output of the run.");
  return section;
}

}  // namespace glisson::scene
