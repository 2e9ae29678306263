// section_motion.cpp — [motion]: time, damping, gravity; what holds, loads and presses the body; [output].
#include "glisson/scene/scene.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"
#include "scene/run/result_names.h"

namespace glisson::scene {
namespace {

std::vector<Choice<Axes>> axes_choices() {
  return {{"xyz", {true, true, true}, "all"}, {"xy", {true, true, false}, ""}, {"xz", {true, false, true}, ""},
          {"yz", {false, true, true}, ""},    {"x", {true, false, false}, ""}, {"y", {false, true, false}, ""},
          {"z", {false, false, true}, ""}};
}

bool along_an_axis(const Vec3d& d) { return (d.x != 0.0) + (d.y != 0.0) + (d.z != 0.0) == 1; }

/// What must hold of a tool's direction.
void check_tool(ToolSpec& tool, const Node& table, const Place& place) {
  tool.origin = place.text();
  const std::string unfit = unfit_as_table(tool.name);
  if (const Node* name = table.find("name"); name && !unfit.empty()) place.complain(*name, "name", unfit);
  const Vec3d& d = tool.motion.direction;
  const Node* given = table.find("direction");
  if (!(norm(d) > 0.0) || !std::isfinite(norm(d))) {
    place.complain(*given, "direction",
                   Codec<Vec3d>::show(d) + " has no direction; give a vector that is not zero, such as [0, 0, -1]");
  } else if (tool.sideways_free && !along_an_axis(d)) {
    place.complain(
        *given, "direction",
        Codec<Vec3d>::show(d) +
            " is not along an axis, which `sideways = \"free\"` needs; use sideways = \"blocked\" or turn the mesh");
  }
}

}  // namespace

const SectionSpec& implicit_section() {
  static const SectionSpec section = [] {
    using Options = ImplicitOptions;
    Section<Options> s("motion.implicit", "Options of the integrators implicit and static.");
    s.key("scheme", &Options::scheme, "time scheme of the integrator implicit");
    s.key("spectral_radius", &Options::spectral_radius, "ρ∞ of generalised_alpha").in("-").within(between(0, 1));
    s.key("largest_step_s", &Options::largest_step, "first and largest automatic step")
        .in("s")
        .within(above(0))
        .otherwise("0.01, static 0.05");
    s.key("tolerance", &Options::tolerance, "residual force over the largest force")
        .in("-")
        .within(between(1e-13, 1e-2));
    s.key("most_iterations", &Options::most_iterations, "of Newton's method, before a step is halved")
        .within(between(1, 1000));
    s.key("most_cuts", &Options::most_cuts, "how often a step is halved before the run stops").within(between(0, 40));
    s.key("preconditioner", &Options::preconditioner, "preconditioner of the linear solves");
    return s.spec();
  }();
  return section;
}

const SectionSpec& motion_section() {
  static const SectionSpec section = [] {
    Section<Variant> s("motion",
                       "Time integration: the integrator, its step, damping, gravity, and the end of the run.");
    s.key(
        "integrator", [](Variant & v) -> auto& { return v.simulation.integrator; }, "how the body is advanced in time");
    s.key(
         "step_s", [](Variant & v) -> auto& { return v.simulation.step; },
         "time step h; \"auto\" takes 0.9 of the stable step and follows the tissue; for implicit and static the "
         "largest that converges")
        .in("s")
        .within(above(0))
        .otherwise("\"auto\"")
        .advise("\"auto\" chooses the largest safe step")
        .accepts_auto = true;
    s.key(
         "mass_scaling_step_s", [](Variant & v) -> auto& { return v.simulation.mass_scaling_step; },
         "adds mass only to tets whose element step bound is shorter, until it equals this step; explicit and "
         "semi_implicit. `glisson check` reports the tets and the mass")
        .in("s")
        .within(above(0))
        .otherwise("no mass is added");
    s.table(
        "implicit", implicit_section(), [](Variant & v) -> auto& { return v.simulation.implicit; },
        "options of the integrators implicit and static");
    s.key(
        "precision", [](Variant & v) -> auto& { return v.simulation.precision; },
        "precision of the element arithmetic");
    s.key(
         "damping_rate_per_s", [](Variant & v) -> auto& { return v.simulation.damping_rate; },
         "nodal damping in proportion to mass, γ/m")
        .in("1/s")
        .within(at_least(0));
    s.key(
         "nodal_damping_kg_per_s", [](Variant & v) -> auto& { return v.simulation.nodal_damping; },
         "nodal damping γ, equal at all vertices, in addition")
        .in("kg/s")
        .within(at_least(0));
    s.key(
         "gravity_m_s2", [](Variant & v) -> auto& { return v.simulation.gravity; }, "gravity")
        .in("m/s²");
    s.key(
         "gravity_ramp_s", [](Variant & v) -> auto& { return v.simulation.gravity_ramp; },
         "time over which gravity grows from 0")
        .in("s")
        .within(at_least(0));
    s.key("on_inversion", &Variant::on_inversion, "what to do when a tetrahedron inverts");
    s.key("duration_s", &Variant::duration, "simulated time")
        .in("s")
        .within(above(0))
        .otherwise("until the last tool has ended its motion");
    s.key("max_steps", &Variant::max_steps, "the run ends after that many steps")
        .within(between(1, Codec<std::uint64_t>::kLargest))
        .otherwise("no limit");
    return s.spec();
  }();
  return section;
}

const SectionSpec& fixed_section() {
  static const SectionSpec section = [] {
    Section<FixedSpec> s("fixed", "Holds the vertices of a set where they are.");
    s.key("set", &FixedSpec::set, "name of a vertex set").must();
    s.choice<Axes>("axes", &FixedSpec::axes, axes_choices(), "components that are held").otherwise("\"xyz\"");
    s.finish([](FixedSpec& x, const Node&, const Place& place) { x.origin = place.text(); });
    return s.spec();
  }();
  return section;
}

const SectionSpec& load_section() {
  static const SectionSpec section = [] {
    Section<LoadSpec> s("load", "A force on the vertices of a set, divided equally.");
    s.key("set", &LoadSpec::set, "name of a vertex set").must();
    s.key("force_N", &LoadSpec::force, "total force").in("N").must();
    s.key("ramp_s", &LoadSpec::ramp, "time of its linear growth from 0").in("s").within(at_least(0));
    s.finish([](LoadSpec& x, const Node&, const Place& place) { x.origin = place.text(); });
    return s.spec();
  }();
  return section;
}

const SectionSpec& tool_section() {
  static const SectionSpec section = [] {
    Section<ToolSpec> s(
        "tool", "A tool that presses: it moves the vertices of a set along a direction, and the force is measured.");
    const auto motion = [](auto member) {
      return [member](ToolSpec & t) -> auto& { return t.motion.*member; };
    };
    s.key("name", &ToolSpec::name, "name; no two tools of an experiment share one");
    s.key("set", &ToolSpec::set, "name of the vertex set it moves").must();
    s.key("direction", motion(&PressMotion::direction), "direction of pressing, of any length").in("-");
    s.key<Milli>("velocity_mm_s", motion(&PressMotion::velocity), "speed").in("mm/s").within(above(0));
    s.key<Milli>("depth_mm", motion(&PressMotion::depth), "how far it presses").in("mm").within(above(0));
    s.key("start_s", motion(&PressMotion::start), "start of the motion; until then its vertices are free")
        .in("s")
        .within(at_least(0));
    s.key("ramp_s", motion(&PressMotion::ramp),
          "time over which the speed rises from 0; 0: a sudden start, as in the paper")
        .in("s")
        .within(at_least(0));
    s.key("hold_s", motion(&PressMotion::hold), "rest at depth").in("s").within(at_least(0));
    s.key("returns", motion(&PressMotion::returns), "withdraw at the same speed after the hold");
    s.table(
        "record", record_section(), [](ToolSpec & t) -> auto& { return t.record.emplace(); },
        "a recorded path, in place of speed and depth");
    s.choice<bool>("sideways", &ToolSpec::sideways_free,
                   {{"blocked", false, "the vertices move with the tool in all components"},
                    {"free", true, "only along the direction, which must be along an axis: no friction"}},
                   "motion across the direction");
    s.spec().exclusions = {
        {{{"record"}, {"velocity_mm_s", "depth_mm", "start_s", "ramp_s", "hold_s", "returns"}}, false}};
    s.finish(check_tool);
    return s.spec();
  }();
  return section;
}

const SectionSpec& output_section() {
  static const SectionSpec section = [] {
    Section<OutputSpec> s("output", "Output of the run.");
    s.key("sample_rate_hz", &OutputSpec::sample_rate, "lines of forces.csv per simulated second")
        .in("Hz")
        .within(above(0));
    s.key("frames", &OutputSpec::frames, "states of the whole body stored over the run; 0: none")
        .within(between(0, 100000));
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
