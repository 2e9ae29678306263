// command_mesh.cpp — glisson mesh: a scene's mesh as a file, and its figures.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/json_option.h"
#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/interrupt.h"
#include "cli/mesh_cache.h"
#include "cli/progress.h"
#include "cli/scene_options.h"
#include "cli/standard_streams.h"
#include "glisson/io.h"

namespace glisson::app {
namespace {

constexpr const char* kMeshFooter =
    "Regions are the cell data \"region\" of the file, with their names; sets of the scene are in it, too.\n"
    "\n"
    "Examples:\n"
    "  glisson mesh scenes/organs/liver.toml --out liver.vtu\n"
    "  glisson mesh scene.toml --set mesh.edge_mm=3 --out fine.vtu --json figures.json";

struct MeshOptions {
  SceneOptions scene;
  std::string out, json;
  bool quiet = false;
};

struct MeshFigures {
  double least_deg = 180.0, largest_deg = 0.0, seconds = 0.0;
  struct Region {
    std::string name;
    std::size_t tets = 0;
    double volume = 0.0;  ///< [m³]
  };
  std::map<int, Region> regions;
};

MeshFigures figures_of(const TetMesh& mesh) {
  MeshFigures figures;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (const double angle : dihedral_angles(mesh, t)) {
      figures.least_deg = std::min(figures.least_deg, angle);
      figures.largest_deg = std::max(figures.largest_deg, angle);
    }
    const int number = mesh.region_of(t);
    auto& region = figures.regions[number];
    ++region.tets;
    region.volume += six_rest_volume(mesh, t) / 6.0;
    const auto name = mesh.region_names.find(number);
    if (region.tets == 1) region.name = name != mesh.region_names.end() ? name->second : std::to_string(number);
  }
  return figures;
}

nlohmann::ordered_json mesh_json(const TetMesh& mesh, const MeshFigures& figures) {
  nlohmann::ordered_json json;
  json["vertices"] = mesh.vertices.size();
  json["tets"] = mesh.tets.size();
  json["min_dihedral_deg"] = figures.least_deg;
  json["max_dihedral_deg"] = figures.largest_deg;
  json["seconds"] = figures.seconds;
  json["regions"] = nlohmann::ordered_json::array();
  for (const auto& [number, r] : figures.regions) {
    json["regions"].push_back({{"name", r.name}, {"number", number}, {"tets", r.tets}, {"volume_ml", 1e6 * r.volume}});
  }
  return json;
}

/// The only variant, or the first; says so where there are more.
const Variant& chosen_variant(const Scene& scene, bool quiet) {
  const Variant& first = scene.variants.front();
  if (scene.variants.size() > 1 && !quiet) {
    say("variant  {}, the first of {}; choose another by --variant\n", first.name, scene.variants.size());
  }
  return first;
}

TetMesh made(const Variant& variant, bool quiet, MeshCache& meshes) {
  Progress progress({"mesh"}, 1, Progress::style_for(quiet));
  progress.started(0);
  const auto go_on = [&](double part) {
    progress.advanced(0, part);
    return !interrupted();
  };
  try {
    TetMesh mesh = build_mesh(variant, meshes.loader(), go_on);
    progress.ended(0, "finished");
    return mesh;
  } catch (...) {
    progress.clear();
    throw;
  }
}

int mesh(const MeshOptions& options) {
  if (std::filesystem::path(options.out).extension() != ".vtu") {
    throw std::invalid_argument("--out " + options.out +
                                ": the mesh is written as .vtu; give a name that ends in .vtu");
  }
  SceneOptions asked = options.scene;
  asked.set.insert(asked.set.begin(), "motion.max_steps=1");  // a mesh alone needs no end of a run
  const Scene scene = open_scene(asked);
  const Variant& variant = chosen_variant(scene, options.quiet);
  MeshCache meshes(options.quiet);
  catch_interrupts();
  const auto start = std::chrono::steady_clock::now();
  TetMesh body;
  try {
    body = made(variant, options.quiet, meshes);
  } catch (const MeshingStopped&) {
    return kInterrupted;
  }
  MeshFigures figures = figures_of(body);
  figures.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_vtu(options.out, body);
  write_json(options.json, mesh_json(body, figures));
  if (options.quiet) return kDone;
  say("{}: {} tets, {} vertices, dihedral angles {:.1f}° to {:.1f}°, {:.2f} s\n", options.out, body.tets.size(),
      body.vertices.size(), figures.least_deg, figures.largest_deg, figures.seconds);
  for (const auto& [number, r] : figures.regions) {
    say("  region {:<3} {:<20} {:>9} tets {:>10.4g} mL\n", number, r.name, r.tets, 1e6 * r.volume);
  }
  return kDone;
}

}  // namespace

void add_mesh(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("mesh", "write the mesh of a scene, and its figures");
  const auto options = std::make_shared<MeshOptions>();
  add_scene_options(*command, options->scene);
  command->add_option("--out", options->out, "the mesh, a .vtu file")->required()->type_name("FILE");
  add_json_option(*command, options->json);
  command->add_flag("--quiet", options->quiet, "print nothing but errors");
  command->footer(kMeshFooter);
  command->callback([options, &action] { action = [options] { return mesh(*options); }; });
}

}  // namespace glisson::app
