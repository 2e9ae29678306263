// section_scene.cpp — the top level: what a scene says once, and what each of its variants consists of.
#include <cmath>

#include "glisson/scene/scene.h"
#include "scene/parse/result_names.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
const SectionSpec& measured_section() {
  static const SectionSpec section = [] {
    using M = MeasuredSpec;
    Section<M> s("chart.measured",
                 "Points from a .csv, whose first line names the columns, drawn over the lines of a chart.");
    s.key("path", &M::path, "the file, relative to the scene").must();
    s.key("label", &M::label, "text for the legend");
    s.key("x", &M::x, "its column along the x axis").must();
    s.key("y", &M::y, "its column along the y axis").must();
    s.key("x_offset", &M::x_offset, "subtracted from x, in its own unit, before scaling").in("-");
    s.key("x_scale", &M::x_scale, "factor on x for display").in("-");
    s.key("y_scale", &M::y_scale, "factor on y for display").in("-");
    return s.spec();
  }();
  return section;
}

const SectionSpec& chart_section() {
  static const SectionSpec section = [] {
    Section<ChartSpec> s("chart",
                         "A chart of the report. Without any, the report shows force against depth and against time.");
    s.key("title", &ChartSpec::title, "heading").must();
    s.key(
         "x", [](ChartSpec & c) -> auto& { return c.x.column; },
         "column of forces.csv or probes.csv along the x axis, e.g. `depth_m`")
        .must();
    s.key(
         "y", [](ChartSpec & c) -> auto& { return c.y.column; },
         "column of forces.csv or probes.csv along the y axis, e.g. `elastic_N`")
        .must();
    s.key(
         "x_scale", [](ChartSpec & c) -> auto& { return c.x.scale; },
         "factor on x for display; 1000 shows metres as millimetres")
        .in("-");
    s.key(
         "y_scale", [](ChartSpec & c) -> auto& { return c.y.scale; }, "factor on y for display")
        .in("-");
    s.key(
         "x_label", [](ChartSpec & c) -> auto& { return c.x.label; }, "label of the x axis, with unit")
        .otherwise("the column");
    s.key(
         "y_label", [](ChartSpec & c) -> auto& { return c.y.label; }, "label of the y axis, with unit")
        .otherwise("the column");
    s.tables("measured", measured_section(), &ChartSpec::measured, "measured points");
    s.key("variants", &ChartSpec::variants, "names of the variants shown").otherwise("all");
    s.key(
         "value", [](ChartSpec & c) -> auto& { return c.value.column; },
         "column whose largest value at each place (x, y) is shown as a map, in place of lines; places where it is "
         "never above 0 are left out")
        .otherwise("lines");
    s.key(
         "value_scale", [](ChartSpec & c) -> auto& { return c.value.scale; }, "factor on it for display")
        .in("-");
    s.key(
         "value_label", [](ChartSpec & c) -> auto& { return c.value.label; }, "label of its colours, with unit")
        .otherwise("the column");
    s.finish([](ChartSpec& c, const Node& table, const Place& place) {
      for (AxisSpec* axis : {&c.x, &c.y, &c.value}) {
        if (axis->label.empty()) axis->label = axis->column;
      }
      if (!c.value.column.empty() && !c.measured.empty())
        place.complain(*table.find("measured"), "measured",
                       "a map shows no measured points; leave out `value` or these");
    });
    return s.spec();
  }();
  return section;
}

namespace {

/// What is expected as bounds, and that there are some.
void complete_check(CheckSpec& c, const Node& table, const Place& place) {
  if (c.expected) {
    if (!c.tolerance && !c.tolerance_percent)
      return place.complain(*table.find("expected"), "expected", "needs `tolerance` or `tolerance_percent` with it");
    if (!c.tolerance) c.tolerance = 0.01 * *c.tolerance_percent * std::abs(*c.expected);
    c.at_least = *c.expected - *c.tolerance, c.at_most = *c.expected + *c.tolerance;
    return;
  }
  for (const char* key : {"tolerance", "tolerance_percent"}) {
    if (const Node* given = table.find(key))
      return place.complain(*given, key, "belongs to `expected`; give it, or bounds");
  }
  if (!c.at_least && !c.at_most)
    return place.complain("has no bound; give `at_least`, `at_most` or both, or `expected` with a tolerance");
  if (c.at_least && c.at_most && *c.at_least > *c.at_most)
    place.complain("`at_least` is above `at_most`; no value can be within them");
}

}  // namespace

const SectionSpec& check_section() {
  static const SectionSpec section = [] {
    using C = CheckSpec;
    Section<C> s(
        "check",
        "What a run is expected to give. `glisson run`, summary.json and the report say whether it does; where it "
        "does not, the program ends with status 1.");
    s.key("what", &C::what, "a sentence that says so").must();
    s.key("column", &C::column, "column of forces.csv or probes.csv, with `[heat]` of temperature.csv or heat.csv")
        .must();
    s.key("over", &C::over, "a column that it is divided by, line by line").otherwise("none");
    s.key("at", &C::at, "which of its values");
    s.key("expected", &C::expected, "what is expected, in the unit of the column; with a tolerance").otherwise("none");
    s.key("tolerance", &C::tolerance, "how far the value may be from it, in the same unit")
        .within(at_least(0))
        .otherwise("none");
    s.key("tolerance_percent", &C::tolerance_percent, "the same as a share of what is expected, in percent")
        .within(at_least(0))
        .otherwise("none");
    s.key("at_least", &C::at_least, "lower bound, in the unit of the column").otherwise("none");
    s.key("at_most", &C::at_most, "upper bound, in the unit of the column").otherwise("none");
    s.key("variants", &C::variants, "names of the variants that are held to it").otherwise("all");
    s.spec().exclusions = {{{{"expected"}, {"at_least", "at_most"}}, false},
                           {{{"tolerance"}, {"tolerance_percent"}}, false}};
    s.finish(complete_check);
    return s.spec();
  }();
  return section;
}

const SectionSpec& compare_section() {
  static const SectionSpec section = described<CompareSpec>(
      "compare", "What `glisson compare` does with the scene: the same experiment with other models, side by side.");
  return section;
}

const SectionSpec& variant_section() {
  static const SectionSpec section = [] {
    Section<Variant> s("variant", "One of several experiments in the same scene: its name and the keys that differ.");
    s.key("name", &Variant::name, "unique name, valid for a folder: its results go to `OUT/NAME/`")
        .otherwise("**required**");
    s.key("label", &Variant::label, "text for legends").otherwise("the name");
    s.table("mesh", mesh_section(), &Variant::mesh, "the body's mesh").must();
    s.named_tables("sets", selection_section(), &Variant::sets, "vertex sets by place");
    s.table("tissue", tissue_section(), &Variant::tissue, "the body's material");
    s.tables("region", region_section(), &Variant::regions, "parts with their own tissue");
    s.tables("stiffness", stiffness_section(), &Variant::stiffness, "moduli of tets from images of elastography");
    s.table(
        "motion", motion_section(), [](Variant& v) -> Variant& { return v; }, "time, damping, gravity");
    s.tables("fixed", fixed_section(), &Variant::fixed, "sets that are held");
    s.tables("load", load_section(), &Variant::loads, "what acts on sets from outside");
    s.tables("tool", tool_section(), &Variant::tools, "tools that press by moving vertices");
    s.tables("instrument", instrument_section(), &Variant::instruments, "tools that press in contact, or pierce");
    s.table(
        "container", container_section(), [](Variant & v) -> auto& { return v.container.emplace(); },
        "a rigid vessel around the body");
    s.tables("capsule", capsule_section(), &Variant::capsules, "membranes on the surface");
    s.tables("probe", probe_section(), &Variant::probes, "places that are read with the forces");
    s.table(
        "heat", heat_section(), [](Variant & v) -> auto& { return v.heat.emplace(); },
        "the body's temperature, in place of mechanics or, with `[heat.ice]`, beside it");
    s.table("output", output_section(), &Variant::output, "what is stored");
    for (const KeySpec& key : scene_section().keys) s.spec().other_words.push_back(key.name);
    s.finish([](Variant& v, const Node& table, const Place& place) {
      const Node* name = table.find("name");
      const std::string unfit = unfit_as_folder(v.name);
      if (name && !unfit.empty()) place.complain(*name, "name", unfit);
      if (v.label.empty()) v.label = v.name;
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& scene_section() {
  static const SectionSpec section = [] {
    Section<Scene> s("", "Keys before any heading.");
    s.key("title", &Scene::title, "heading of the report").otherwise("the file's name");
    s.key("description", &Scene::description, "what the experiment is, in a few sentences");
    s.key("notes", &Scene::notes, "choices made where the source gives no value, and the reasons").otherwise("[]");
    s.tables("chart", chart_section(), &Scene::charts, "charts of the report");
    s.tables("check", check_section(), &Scene::checks, "what its runs are expected to give");
    s.table("compare", compare_section(), &Scene::compare, "how it is given to other models");
    s.bare({.name = "variant",
            .help = "experiments that differ in some keys",
            .type = ValueType::table,
            .shape = Shape::list});
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
