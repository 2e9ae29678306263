// bind_scenes.cpp — scenes from files and text, their variants, and advice on these.
#include "glisson/scene/scene.h"

#include "glisson/scene/advice.h"
#include "live_simulation.h"

namespace glisson::python {
namespace {

/// A scene as Python holds it: its variants are objects of their own, to be changed before a run.
struct SceneObject {
  explicit SceneObject(Scene read) : scene(std::move(read)) {
    for (const Variant& v : scene.variants) variants.push_back(std::make_shared<Variant>(v));
  }
  Scene scene;
  std::vector<std::shared_ptr<Variant>> variants;  ///< in place of scene.variants
};

using Overrides = std::vector<std::pair<std::string, std::string>>;

std::vector<Override> overrides_of(const Overrides& pairs) {
  std::vector<Override> overrides;
  for (const auto& [key, value] : pairs) overrides.push_back({key, value});
  return overrides;
}

std::string of(const char* member) { return std::string("Variant::") + member; }

void bind_variant(nb::module_& m) {
  Options<OutputSpec>(m, "OutputSpec");
  nb::class_<Variant>(m, "Variant", doc("Variant"))
      .def_rw("name", &Variant::name)
      .def_rw("label", &Variant::label)
      .def_rw("tissue", &Variant::tissue)
      .def_rw("simulation", &Variant::simulation)
      .def_rw("start", &Variant::start, doc("Start"))
      .def_rw("on_inversion", &Variant::on_inversion, doc("OnInversion"))
      .def_rw("duration", &Variant::duration, doc(of("duration")))
      .def_rw("max_steps", &Variant::max_steps, doc(of("max_steps")))
      .def_rw("output", &Variant::output)
      .def_ro("scene_name", &Variant::scene_name, doc(of("scene_name")))
      .def_prop_ro(
          "tools",
          [](const Variant& v) {
            std::vector<std::string> names;
            for (const ToolSpec& tool : v.tools) names.push_back(tool.name);
            return names;
          },
          "Names of the prescribed motions")
      .def_prop_ro(
          "instruments",
          [](const Variant& v) {
            std::vector<std::string> names;
            for (const InstrumentSpec& x : v.instruments) names.push_back(x.name);
            return names;
          },
          "Names of the instruments")
      .def_prop_ro(
          "probes",
          [](const Variant& v) {
            std::vector<std::string> names;
            for (const ProbeSpec& x : v.probes) names.push_back(x.options.name);
            return names;
          },
          "Names of the probes")
      .def(
          "run_duration", [](const Variant& v) { return run_duration(v); }, doc("run_duration"))
      .def(
          "build_mesh", [](const Variant& v) { return build_mesh(v, mesh_loader()); }, doc("build_mesh"))
      .def("__copy__", [](const Variant& v) { return Variant(v); })
      .def("__deepcopy__", [](const Variant& v, nb::handle) { return Variant(v); })
      .def("__repr__", [](const Variant& v) { return "<Variant " + v.name + " of " + v.scene_name + ">"; });
}

void bind_charts(nb::module_& m) {
  Results<AxisSpec>(m, "AxisSpec")
      .read("column", &AxisSpec::column)
      .read("label", &AxisSpec::label)
      .read("scale", &AxisSpec::scale);
  nb::class_<MeasuredSpec>(m, "MeasuredSpec", doc("MeasuredSpec"))
      .def_ro("label", &MeasuredSpec::label)
      .def_prop_ro(
          "xs", [](const MeasuredSpec& s) { return scalars(s.xs); }, doc("MeasuredSpec::xs"))
      .def_prop_ro(
          "ys", [](const MeasuredSpec& s) { return scalars(s.ys); }, doc("MeasuredSpec::ys"));
  nb::class_<ChartSpec>(m, "ChartSpec", doc("ChartSpec"))
      .def_ro("title", &ChartSpec::title)
      .def_ro("x", &ChartSpec::x)
      .def_ro("y", &ChartSpec::y)
      .def_ro("measured", &ChartSpec::measured)
      .def_ro("variants", &ChartSpec::variants, doc("ChartSpec::variants"));
}

/// Advice on each of the variants, then on their laws.
std::vector<Advice> advise_on(const std::vector<std::shared_ptr<Variant>>& variants) {
  const MeshLoader load = mesh_loader();
  const nb::gil_scoped_release free;
  std::vector<Variant> looked_at;
  std::vector<Advice> all;
  for (const std::shared_ptr<Variant>& variant : variants) {
    looked_at.push_back(*variant);
    for (Advice& one : advise(*variant, load)) all.push_back(std::move(one));
  }
  for (Advice& one : advise_on_laws(looked_at)) all.push_back(std::move(one));
  return all;
}

void bind_advice(nb::module_& m) {
  Results<Advice>(m, "Advice")
      .read("variant", &Advice::variant)
      .read("rule", &Advice::rule)
      .read("kind", &Advice::kind)
      .read("about", &Advice::about)
      .read("name", &Advice::name)
      .read("text", &Advice::text);
  m.def("check_variants", &advise_on, "variants"_a, doc("advise"));
}

std::shared_ptr<Variant> variant_called(const SceneObject& s, const std::string& name) {
  std::string known;
  for (const auto& v : s.variants) {
    if (v->name == name) return v;
    known += (known.empty() ? "" : ", ") + v->name;
  }
  throw nb::key_error(("no variant \"" + name + "\"; there are: " + known).c_str());
}

}  // namespace

void bind_scenes(nb::module_& m) {
  nb::exception<SceneError>(m, "SceneError", PyExc_ValueError);
  bind_variant(m);
  bind_charts(m);
  bind_advice(m);
  nb::class_<SceneObject>(m, "Scene", doc("Scene"))
      .def_prop_ro("file", [](const SceneObject& s) { return s.scene.file; })
      .def_prop_ro("title", [](const SceneObject& s) { return s.scene.title; })
      .def_prop_ro("description", [](const SceneObject& s) { return s.scene.description; })
      .def_prop_ro(
          "notes", [](const SceneObject& s) { return s.scene.notes; }, doc("Scene::notes"))
      .def_prop_ro(
          "source", [](const SceneObject& s) { return s.scene.source; }, doc("Scene::source"))
      .def_prop_ro(
          "charts", [](const SceneObject& s) { return s.scene.charts; }, doc("Scene::charts"))
      .def_ro("variants", &SceneObject::variants, "To be read, and changed before a run")
      .def("__getitem__", variant_called, "name"_a)
      .def("__len__", [](const SceneObject& s) { return s.variants.size(); })
      .def("__repr__", [](const SceneObject& s) {
        return "<Scene " + s.scene.file.string() + " with " + std::to_string(s.variants.size()) + " variants>";
      });
  m.def(
      "read_scene",
      [](const std::filesystem::path& file, const Overrides& overrides) {
        return SceneObject(load_scene(file, overrides_of(overrides)));
      },
      "file"_a, "overrides"_a = Overrides{}, doc("load_scene"));
  m.def(
      "read_scene_text",
      [](std::string_view text, const std::string& name, const std::filesystem::path& base,
         const Overrides& overrides) { return SceneObject(parse_scene(text, name, base, overrides_of(overrides))); },
      "text"_a, "name"_a = "scene", "base"_a = std::filesystem::path("."), "overrides"_a = Overrides{},
      doc("parse_scene"));
  m.def("scene_reference_markdown", &scene_reference_markdown, doc("scene_reference_markdown"));
}

}  // namespace glisson::python
