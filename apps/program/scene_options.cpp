// scene_options.cpp — see scene_options.h.
#include "program/scene_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <thread>

#include "program/option_check.h"
#include "program/standard_streams.h"
#include "report/json_text.h"

namespace glisson::app {
namespace {

Override parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw std::invalid_argument(
        fmt::format("--set {}: expected key=value with a dotted key, e.g. --set tissue.poisson_ratio=0.45", text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::string mesh_text(const MeshSource& source) {
  if (const auto* file = std::get_if<MeshFile>(&source)) return file->path.string();
  if (std::holds_alternative<ImplicitBody>(source)) return "a body of shapes";
  if (std::holds_alternative<LiverOptions>(source)) return "a liver of shapes";
  if (std::holds_alternative<ImageBody>(source)) return "a body of labels";
  return std::holds_alternative<BoxOptions>(source) ? "a box" : "a cylinder";
}

void replace_mesh(Scene& scene, const std::string& file) {
  const std::string former = mesh_text(scene.variants.front().mesh);
  for (Variant& variant : scene.variants) {
    const auto* given = std::get_if<MeshFile>(&variant.mesh);
    variant.mesh = MeshFile{.path = file, .scale = given != nullptr ? given->scale : std::optional(1.0)};
  }
  scene.notes.push_back(fmt::format("The mesh is {} (--mesh) in place of {}.", file, former));
}

void keep_variants(Scene& scene, const std::vector<std::string>& wanted) {
  std::vector<Variant> kept;
  std::vector<std::string> names;
  for (Variant& variant : scene.variants) names.push_back(variant.name);
  for (const std::string& name : wanted) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      throw std::invalid_argument(fmt::format("--variant {}: {} has no such variant; it has {}", name,
                                              scene.file.string(), fmt::join(names, ", ")));
    }
    kept.push_back(scene.variants[static_cast<std::size_t>(found - names.begin())]);
  }
  scene.variants = std::move(kept);
}

std::string change_note(const SceneOptions& options) {
  std::string note;
  for (const std::string& set : options.set) note += " --set '" + set + "'";
  if (!options.mesh.empty()) note += " --mesh " + options.mesh;
  for (const std::string& variant : options.variants) note += " --variant " + variant;
  return note.empty() ? note : valid_utf8("# run with" + note + "\n");  // a comment of TOML is UTF-8, too
}

}  // namespace

void add_scene_options(CLI::App& command, SceneOptions& options) {
  command.add_option("scene", options.scene, "scene file (TOML)")->required()->type_name("SCENE");
  command.add_option("--set", options.set, "change a value of the scene for all its variants; may be repeated")
      ->type_name("key=value")
      ->allow_extra_args(false);
  command.add_option("--mesh", options.mesh, "take the mesh from this file (.vtu, .vtk, .msh, .inp) instead")
      ->type_name("FILE");
  command.add_option("--variant", options.variants, "only these variants")->type_name("NAME");
}

void add_threads_option(CLI::App& command, int& threads) {
  threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  command.add_option("--threads", threads, "variants that run in parallel; results do not depend on it")
      ->type_name("N")
      ->check(within(between(1, 1024), Numbers::whole))
      ->capture_default_str();
}

std::vector<Override> overrides_of(const SceneOptions& options) {
  std::vector<Override> overrides;
  for (const std::string& text : options.set) overrides.push_back(parse_override(text));
  if (options.mesh.empty()) return overrides;
  overrides.push_back({"mesh.kind", "file"});
  overrides.push_back({"mesh.path", std::filesystem::absolute(options.mesh).string()});
  return overrides;
}

Scene open_scene(const SceneOptions& options) {
  std::vector<Override> overrides;
  for (const std::string& text : options.set) overrides.push_back(parse_override(text));
  Scene scene = load_scene(options.scene, overrides);
  if (!options.variants.empty()) keep_variants(scene, options.variants);
  if (!options.mesh.empty()) replace_mesh(scene, options.mesh);
  std::set<std::string> repairs;
  for (const Variant& variant : scene.variants) {
    for (const std::string& repair : surface_repairs(variant)) repairs.insert(repair);
  }
  for (const std::string& repair : repairs) tell("warning: {}\n", repair);
  scene.source = change_note(options) + scene.source;
  return scene;
}

}  // namespace glisson::app
