// command_mesh.cpp — glisson mesh: the mesh of a scene, of the body within a closed surface, or of labels of an image, as a file, and its
// figures.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/text.h"
#include "cli/commands.h"
#include "cli/image_mesh_command.h"
#include "cli/progress.h"
#include "glisson/image/read_image.h"
#include "glisson/io.h"
#include "glisson/scene/surface_file.h"
#include "glisson/simulation/mesh_step.h"
#include "program/exit_code.h"
#include "program/interrupt.h"
#include "program/json_option.h"
#include "program/mesh_cache.h"
#include "program/scene_options.h"
#include "program/standard_streams.h"

namespace glisson::app {
namespace {

constexpr const char* kMeshFooter =
    "Regions are the cell data \"region\" of the file, with their names; sets of the scene are in it, too.\n"
    "\n"
    "Examples:\n"
    "  glisson mesh scenes/organs/liver.toml --out liver.vtu\n"
    "  glisson mesh organ.stl --scale 0.001 --edge-mm 4 --out organ.vtu\n"
    "  glisson mesh labels.nii.gz --labels liver,vessels=63+64 --implant tumour=ball:80,165,400,18mm --out body.vtu\n"
    "  glisson mesh abaqus_mm.inp --scale 0.001 --out organ.vtu\n"
    "  glisson mesh scene.toml --set mesh.edge_mm=3 --out fine.vtu --json figures.json";

constexpr double kMostEdges = 1000.0;  ///< across a surface, from which on its unit is in doubt

struct MeshOptions {
  SceneOptions scene;
  std::optional<double> edge_mm, scale;  ///< of a surface
  std::string out, json;
  bool quiet = false;
  ImageMeshOptions image;
};

struct MeshFigures {
  double least_deg = 180.0, largest_deg = 0.0, seconds = 0.0;
  std::pair<double, double> edges{};      ///< shortest and longest asked for [m]; 0: none were
  std::optional<double> relative_step{};  ///< relative_stable_step, where an edge was asked for
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

/// The body of shapes that a mesh was asked for by its edge; none where it was given by its cells or a file.
std::optional<ImplicitBody> asked_body(const MeshSource& source) {
  if (const auto* body = std::get_if<ImplicitBody>(&source)) return *body;
  if (const auto* liver = std::get_if<LiverOptions>(&source)) return liver_body(*liver);
  return {};
}

/// The shortest and longest edge that a body asks for [m].
std::pair<double, double> edges_of(const ImplicitBody& body) {
  double finest = body.edge;
  for (const MeshSize& s : body.sizes) finest = std::min(finest, s.edge);
  return {finest, body.edge};
}

nlohmann::ordered_json mesh_json(const TetMesh& mesh, const MeshFigures& figures,
                                 const std::vector<std::string>& repairs) {
  nlohmann::ordered_json json;
  json["vertices"] = mesh.vertices.size();
  json["tets"] = mesh.tets.size();
  json["min_dihedral_deg"] = figures.least_deg;
  json["max_dihedral_deg"] = figures.largest_deg;
  if (figures.relative_step) json["relative_stable_step"] = *figures.relative_step;
  json["seconds"] = figures.seconds;
  if (!repairs.empty()) json["surface_repairs"] = repairs;
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

/// The mesh that was asked for as a variant of its own, for a surface without a scene.
Variant surface_variant(const MeshOptions& options) {
  const std::filesystem::path file = options.scene.scene;
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument(fmt::format("{}: {}", file.string(), what));
  };
  if (!options.scene.set.empty() || !options.scene.mesh.empty() || !options.scene.variants.empty())
    refuse("--set, --mesh and --variant are for scenes; leave them out");
  if (!options.edge_mm) refuse("a surface needs --edge-mm E, the mean length of the tets' edges in mm");
  if (!(std::isfinite(*options.edge_mm) && *options.edge_mm > 0.0))
    refuse(fmt::format("--edge-mm {} is out of range; allowed: > 0", *options.edge_mm));
  ImplicitBody body;
  body.edge = 1e-3 * *options.edge_mm;
  SurfaceShape surface = load_surface(file, options.scale.value_or(1.0));
  const Bounds& box = surface.solid->bounds();
  const double extent = std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z});
  if (!options.scale && extent > kMostEdges * body.edge)
    refuse(fmt::format(
        "the surface is {:.3g} m across, and --edge-mm {} is a {:.0f}th of that; a file in millimetres takes "
        "--scale 0.001, one in metres a longer edge",
        extent, *options.edge_mm, extent / body.edge));
  body.shapes.push_back({file.stem().string(), std::move(surface)});
  body.regions.push_back({file.stem().string(), "", false});
  Variant variant;
  variant.name = "main";
  variant.scene_name = file.string();
  variant.mesh = std::move(body);
  return variant;
}

/// Whether a file holds tets already, by its name.
bool is_tet_file(const std::filesystem::path& file) {
  const std::string ending = detail::lower_case(file.extension().string());
  return ending == ".vtu" || ending == ".vtk" || ending == ".msh" || ending == ".inp";
}

/// The tets of a file as they are, in metres and as .vtu.
Variant tet_file_variant(const MeshOptions& options) {
  const std::string& file = options.scene.scene;
  if (options.edge_mm || !options.scene.set.empty())
    throw std::invalid_argument(fmt::format("{} holds tets, which are written as they are: leave out {}", file,
                                            options.edge_mm ? "--edge-mm" : "--set"));
  Variant variant;
  variant.name = "main";
  variant.scene_name = file;
  variant.mesh = MeshFile{file, options.scale.value_or(1.0)};
  return variant;
}

Variant scene_variant(const MeshOptions& options) {
  for (const auto& [name, given] : {std::pair("--edge-mm", options.edge_mm), std::pair("--scale", options.scale)}) {
    if (given)
      throw std::invalid_argument(
          fmt::format("{} is for surfaces (.stl, .obj, .ply); the mesh of a scene takes --set mesh.{}={}", name,
                      name == std::string("--scale") ? "scale" : "edge_mm", *given));
  }
  SceneOptions asked = options.scene;
  asked.set.insert(asked.set.begin(), "motion.max_steps=1");  // a mesh alone needs no end of a run
  return chosen_variant(open_scene(asked), options.quiet);
}

int mesh(const MeshOptions& options) {
  if (std::filesystem::path(options.out).extension() != ".vtu") {
    throw std::invalid_argument("--out " + options.out +
                                ": the mesh is written as .vtu; give a name that ends in .vtu");
  }
  const std::string& given = options.scene.scene;
  if (is_image_file(given)) {
    if (options.scale || !options.scene.set.empty() || !options.scene.mesh.empty() || !options.scene.variants.empty())
      throw std::invalid_argument(given + ": --scale, --set, --mesh and --variant are not for images; leave them out");
    return mesh_of_image(given, options.image, {options.out, options.json, options.edge_mm, options.quiet});
  }
  refuse_image_options(options.image);
  const Variant variant = is_surface_file(given) ? surface_variant(options)
                          : is_tet_file(given)   ? tet_file_variant(options)
                                                 : scene_variant(options);
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
  if (const auto asked = asked_body(variant.mesh)) {
    figures.edges = edges_of(*asked);
    figures.relative_step = asked->sizes.empty() ? relative_stable_step(body, asked->edge)
                                                 : relative_stable_step(body, edges_asked(body, *asked));
  }
  write_vtu(options.out, body);
  (options.quiet ? keep_json : write_json)(options.json, mesh_json(body, figures, surface_repairs(variant)));
  if (options.quiet) return kDone;
  if (is_surface_file(options.scene.scene)) {
    for (const std::string& repair : surface_repairs(variant)) say("{}\n", repair);
  }
  say("{}: {} tets, {} vertices, dihedral angles {:.1f}° to {:.1f}°, {:.2f} s\n", options.out, body.tets.size(),
      body.vertices.size(), figures.least_deg, figures.largest_deg, figures.seconds);
  if (figures.relative_step) {
    const auto& [finest, coarsest] = figures.edges;
    const std::string from = finest < coarsest ? fmt::format("{:.3g} to ", 1e3 * finest) : "";
    say("  stable step {:.2f} of that of regular tets with edges of {}{:.3g} mm\n", *figures.relative_step, from,
        1e3 * coarsest);
  }
  for (const auto& [number, r] : figures.regions) {
    say("  region {:<3} {:<20} {:>9} tets {:>10.4g} mL\n", number, r.name, r.tets, 1e6 * r.volume);
  }
  return kDone;
}

}  // namespace

void add_mesh(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("mesh", "write the mesh of a scene, a surface or another file, and its figures");
  const auto options = std::make_shared<MeshOptions>();
  add_scene_options(*command, options->scene);
  command->get_option("scene")->description(
      "scene file (TOML), a closed surface (.stl, .obj, .ply), an image of labels (.nii, .nii.gz, .nrrd, .nhdr, .mha, "
      ".mhd), or tets (.vtu, "
      ".vtk, .msh, .inp)");
  command
      ->add_option("--edge-mm", options->edge_mm,
                   "of a surface or an image: mean length of the tets' edges (image: two voxels)")
      ->type_name("E");
  add_image_mesh_options(*command, options->image);
  command
      ->add_option("--scale", options->scale,
                   "of a surface or of tets: factor on the coordinates, 0.001 for a file in millimetres")
      ->type_name("FACTOR");
  command->add_option("--out", options->out, "the mesh, a .vtu file")->required()->type_name("FILE")->check(file_place);
  add_json_option(*command, options->json);
  command->add_flag("--quiet", options->quiet, "print nothing but errors");
  command->footer(kMeshFooter);
  command->callback([options, &action] { action = [options] { return mesh(*options); }; });
}

}  // namespace glisson::app
