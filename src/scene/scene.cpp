// scene.cpp — text in, checked scene out.
#include "glisson/scene.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <set>
#include <system_error>

#include "scene/expand.h"
#include "scene/nearest.h"
#include "scene/sections.h"
#include "scene/select.h"

namespace glisson {
namespace {

using namespace scene;

std::vector<std::string> generated_sets(const MeshSource& mesh) {
  if (std::holds_alternative<BoxOptions>(mesh)) return {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  if (std::holds_alternative<CylinderOptions>(mesh)) return {"bottom", "top", "wall", "axis"};
  return {};
}

/// Complains about sets that are used and exist nowhere, as far as that is known before a mesh is read.
void check_sets(const Variant& variant, const Node& experiment, Problems& problems) {
  if (std::holds_alternative<MeshFile>(variant.mesh)) return;
  std::vector<std::string> known = generated_sets(variant.mesh);
  for (const auto& [name, selection] : variant.sets) known.push_back(name);
  for (const char* user : {"fixed", "load", "tool"}) {
    const Node* list = experiment.find(user);
    for (std::size_t i = 0; list && i < list->array()->size(); ++i) {
      const Node& set = *(*list->array())[i].find("set");
      if (std::find(known.begin(), known.end(), *set.text()) != known.end()) continue;
      problems.add(set.where, std::string(user) + "." + std::to_string(i) + ".set", no_such_set(*set.text(), known));
    }
  }
}

/// Complains about every element of `list` whose `name` an earlier one has.
void check_names(const Array& list, const std::string& path, Problems& problems) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Node* name = list[i].find("name");
    std::string folded = name && name->text() ? *name->text() : path;
    std::transform(folded.begin(), folded.end(), folded.begin(), [](unsigned char c) { return std::tolower(c); });
    if (seen.insert(folded).second) continue;
    problems.add(name ? name->where : list[i].where, path + "." + std::to_string(i) + ".name",
                 "\"" + (name ? *name->text() : folded) +
                     "\" is taken (upper and lower case count as the same); names must differ");
  }
}

void check_end(const Variant& variant, const Node& experiment, Problems& problems) {
  if (!variant.tools.empty() || variant.duration || variant.max_steps) return;
  const Node* motion = experiment.find("motion");
  problems.add(motion ? motion->where : experiment.where, "motion",
               "nothing says when the run ends: give `duration_s` or `max_steps`, or a [[tool]] whose motion ends it");
}

Variant read_variant(const Node& experiment, const std::filesystem::path& base, Problems& problems) {
  Variant variant;
  variant.scene_name = problems.file();
  const std::size_t before = problems.count();
  read_section(variant_section(), experiment, &variant, {problems, "", experiment.where});
  if (problems.count() > before) return variant;
  auto* file = std::get_if<MeshFile>(&variant.mesh);
  if (file && file->path.is_relative()) file->path = base / file->path;
  if (const Node* tools = experiment.find("tool")) check_names(*tools->array(), "tool", problems);
  if (const Node* regions = experiment.find("region")) check_names(*regions->array(), "region", problems);
  check_sets(variant, experiment, problems);
  check_end(variant, experiment, problems);
  return variant;
}

void check_charts(const Scene& scene, const Node& node, Problems& problems) {
  std::vector<std::string> known;
  for (const Variant& v : scene.variants) known.push_back(v.name);
  for (std::size_t i = 0; i < scene.charts.size(); ++i) {
    for (std::size_t k = 0; k < scene.charts[i].variants.size(); ++k) {
      const std::string& name = scene.charts[i].variants[k];
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      const Node& word = (*(*node.find("chart")->array())[i].find("variants")->array())[k];
      problems.add(word.where, "chart." + std::to_string(i) + ".variants",
                   "no variant \"" + name + "\"; the scene has: " + listed(known));
    }
  }
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& name, const std::filesystem::path& base,
                  std::span<const Override> overrides) {
  const Node root = parse_document(text, name);
  Problems problems(name);
  const Expanded expanded = expand(root, overrides, problems);
  Scene result;
  result.file = name;
  result.source = text;
  read_section(scene_section(), expanded.scene, &result, {problems, "", root.where});
  read_section(variant_section(), expanded.base, nullptr, {problems, "", root.where});
  for (const Node& experiment : expanded.variants) result.variants.push_back(read_variant(experiment, base, problems));
  if (problems.count() == 0) {
    check_names(expanded.variants, "variant", problems);
    check_charts(result, expanded.scene, problems);
  }
  problems.throw_if_any();
  if (result.title.empty()) result.title = result.file.stem().string();
  return result;
}

Scene load_scene(const std::filesystem::path& file, std::span<const Override> overrides) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) throw SceneError(file.string() + ": is a folder; name a .toml file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw SceneError(file.string() + ": cannot be read; check the path and that you may read it");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) throw SceneError(file.string() + ": cannot be read to its end");
  return parse_scene(text, file.string(), file.parent_path(), overrides);
}

}  // namespace glisson
