// command_info.cpp — glisson info: contents and defects of a mesh file, labels of an image.
#include <fmt/format.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/commands.h"
#include "cli/image_info.h"
#include "glisson/image/read_image.h"
#include "glisson/io.h"
#include "program/exit_code.h"
#include "program/option_check.h"
#include "program/standard_streams.h"
#include "report/json_text.h"

namespace glisson::app {
namespace {

struct InfoOptions {
  std::string mesh;
  double scale = 1.0;
  bool json = false;
};

std::map<int, std::size_t> tets_by_region(const TetMesh& mesh) {
  std::map<int, std::size_t> count;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) ++count[mesh.region_of(t)];
  return count;
}

nlohmann::ordered_json info_json(const std::string& file, const TetMesh& mesh, const MeshReport& r) {
  nlohmann::ordered_json json;
  json["file"] = file;
  json["vertices"] = r.vertices;
  json["tets"] = r.tets;
  json["boundary_triangles"] = r.boundary_triangles;
  json["pieces"] = r.pieces;
  json["box_min_m"] = {r.box_min.x, r.box_min.y, r.box_min.z};
  json["box_max_m"] = {r.box_max.x, r.box_max.y, r.box_max.z};
  json["volume_m3"] = r.volume;
  json["worst_mean_ratio"] = r.worst_mean_ratio;
  json["worst_tet"] = r.worst_tet;
  json["median_mean_ratio"] = r.median_mean_ratio;
  json["dihedral_histogram_10_deg"] = dihedral_histogram(mesh);
  json["reoriented_tets"] = r.reoriented_tets;
  json["duplicate_tets"] = r.duplicate_tets;
  json["degenerate_tets"] = r.degenerate_tets;
  json["unused_vertices"] = r.unused_vertices;
  json["non_manifold_faces"] = r.non_manifold_faces;
  json["regions"] = nlohmann::ordered_json::object();
  for (const auto& [region, count] : tets_by_region(mesh)) json["regions"][std::to_string(region)] = count;
  json["vertex_sets"] = nlohmann::ordered_json::object();
  for (const auto& [name, vertices] : mesh.vertex_sets) json["vertex_sets"][name] = vertices.size();
  json["warnings"] = r.warnings;
  return json;
}

int info(const InfoOptions& options) {
  if (is_image_file(options.mesh)) {
    if (options.scale != 1.0)
      throw std::invalid_argument("--scale is for meshes; an image has its unit of length in its header");
    return image_info(options.mesh, options.json);
  }
  const ImportedMesh imported = read_mesh(options.mesh, options.scale);
  if (options.json) {
    const auto json = info_json(options.mesh, imported.mesh, imported.report);
    say("{}\n", json_text(json, 2));
  } else {
    say("{}", format_report(options.mesh, imported.report, &imported.mesh));
  }
  return kDone;
}

}  // namespace

void add_info(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("info", "contents and defects of a mesh file, labels of an image");
  const auto options = std::make_shared<InfoOptions>();
  command
      ->add_option("mesh", options->mesh,
                   "mesh file (.vtu, .vtk, .msh, .inp) or image (.nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd)")
      ->required()
      ->type_name("MESH");
  command->add_option("--scale", options->scale, "factor on coordinates: 0.001 for a file in millimetres")
      ->type_name("S")
      ->check(within(above(0), Numbers::all))
      ->capture_default_str();
  command->add_flag("--json", options->json, "print JSON");
  command->footer(
      "Examples:\n  glisson info liver.vtu\n  glisson info organ_mm.msh --scale 0.001\n"
      "  glisson info labels.nii.gz\n"
      "  glisson info liver.vtu --json | jq .volume_m3");
  command->callback([options, &action] { action = [options] { return info(*options); }; });
}

}  // namespace glisson::app
