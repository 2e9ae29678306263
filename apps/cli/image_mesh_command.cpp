// image_mesh_command.cpp — see image_mesh_command.h.
#include "cli/image_mesh_command.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/progress.h"
#include "glisson/image/image_body.h"
#include "glisson/image/read_image.h"
#include "glisson/io.h"
#include "glisson/simulation/mesh_step.h"
#include "program/exit_code.h"
#include "program/interrupt.h"
#include "program/json_option.h"
#include "program/standard_streams.h"

namespace glisson::app {
namespace {

constexpr double kVoxelsAnEdge = 2.0;  ///< where no edge is given
constexpr const char* kImageGroup = "Images";

/// `REGION=MM` of --near.
MeshSize size_of(const std::string& word) {
  const std::size_t equals = word.rfind('=');
  MeshSize size;
  std::size_t end = 0;
  try {
    if (equals != word.npos && equals > 0) size.edge = 1e-3 * std::stod(word.substr(equals + 1), &end);
  } catch (const std::exception&) {
    end = 0;
  }
  if (end == 0 || equals + 1 + end != word.size() || !(size.edge > 0.0) || !std::isfinite(size.edge))
    throw std::invalid_argument("--near " + word + ": write REGION=E, a region's name and an edge in mm, > 0");
  size.near = word.substr(0, equals);
  return size;
}

ImageBody body_of(const std::string& file, const ImageMeshOptions& options, std::optional<double> edge_mm) {
  if (options.labels.empty())
    throw std::invalid_argument(file + ": an image needs --labels, the regions by number or name; `glisson info " +
                                file + "` lists them");
  if (edge_mm && !(std::isfinite(*edge_mm) && *edge_mm > 0.0))
    throw std::invalid_argument(fmt::format("--edge-mm {} is out of range; allowed: > 0", *edge_mm));
  ImageBody body;
  body.path = file;
  body.labels = options.labels;
  body.implants = options.implants;
  if (options.voxel_mm) body.voxel = 1e-3 * *options.voxel_mm;
  if (options.keep_pieces) body.keep_pieces = *options.keep_pieces;
  if (options.smallest_piece_ml) body.smallest_piece_ml = *options.smallest_piece_ml;
  if (options.largest_hole_ml) body.largest_hole_ml = *options.largest_hole_ml;
  if (options.smoothing) body.smoothing = *options.smoothing;
  if (options.edges_across) body.edges_across = *options.edges_across;
  body.size_image = options.size_image;
  body.refine = !options.no_refine;
  for (const std::string& word : options.near) body.sizes.push_back(size_of(word));
  body.edge = edge_mm ? 1e-3 * *edge_mm : kVoxelsAnEdge * voxel_edge(body);
  return body;
}

nlohmann::ordered_json image_mesh_json(const ImageMesh& made, double relative_step, double seconds) {
  nlohmann::ordered_json figures;
  figures["vertices"] = made.mesh.vertices.size();
  figures["tets"] = made.mesh.tets.size();
  figures["min_dihedral_deg"] = made.report.min_dihedral_deg;
  figures["max_dihedral_deg"] = made.report.max_dihedral_deg;
  figures["relative_stable_step"] = relative_step;
  figures["seconds"] = seconds;
  figures["axes"] = "RAS";
  figures["notes"] = made.notes;
  figures["warnings"] = made.report.warnings;
  figures["regions"] = nlohmann::ordered_json::array();
  for (const ImageRegion& r : made.regions) {
    figures["regions"].push_back({{"name", r.name},
                                  {"number", r.label},
                                  {"label", r.label},
                                  {"tets", r.tets},
                                  {"volume_ml", 1e6 * r.volume},
                                  {"image_volume_ml", 1e6 * r.image_volume},
                                  {"pieces", r.pieces},
                                  {"image_pieces", r.image_pieces},
                                  {"distance_p95_mm", 1e3 * r.distance_p95},
                                  {"voxel_faces_p95_mm", 1e3 * r.faces_p95}});
  }
  return figures;
}

void say_figures(const ImageMesh& made, const std::string& out, double edge, double relative_step, double seconds) {
  for (const std::string& note : made.notes) say("  {}\n", note);
  say("{}: {} tets, {} vertices, dihedral angles {:.1f}° to {:.1f}°, {:.2f} s; metres, axes RAS\n", out,
      made.mesh.tets.size(), made.mesh.vertices.size(), made.report.min_dihedral_deg, made.report.max_dihedral_deg,
      seconds);
  say("  stable step {:.2f} of that of regular tets with edges of {:.3g} mm\n", relative_step, 1e3 * edge);
  for (const ImageRegion& r : made.regions) {
    say("  region {:<5} {:<28} {:>9} tets {:>10.4g} mL ({:+.2f} % of the image), {} of {} pieces, p95 {:.2f} mm\n",
        r.label, r.name, r.tets, 1e6 * r.volume, 100.0 * (r.volume / r.image_volume - 1.0), r.pieces, r.image_pieces,
        1e3 * r.distance_p95);
  }
  for (const std::string& warning : made.report.warnings) tell_warning(warning);
}

ImageMesh made_of(const ImageBody& body, bool quiet) {
  Progress progress({"mesh"}, 1, Progress::style_for(quiet));
  progress.started(0);
  try {
    ImageMesh made = image_mesh(body, [&](double part) {
      progress.advanced(0, part);
      return !interrupted();
    });
    progress.ended(0, "finished");
    return made;
  } catch (...) {
    progress.clear();
    throw;
  }
}

}  // namespace

void add_image_mesh_options(CLI::App& command, ImageMeshOptions& options) {
  const std::string others = command.option_defaults()->get_group();
  command.option_defaults()->group(kImageGroup);
  options.command = &command;
  command
      .add_option("--labels", options.labels,
                  "regions: numbers or names of labels, joined by +, with a name in front: liver,vessels=63+64")
      ->delimiter(',')
      ->type_name("L,…");
  command
      .add_option("--implant", options.implants,
                  "NAME=ball:X,Y,Z,DIAMETERmm, NAME=ellipsoid:X,Y,Z,A,B,Cmm (semi-axes), RAS in mm, or "
                  "NAME=labels:FILE:LABELS of another image; may be given again")
      ->type_name("NAME=SHAPE")
      ->allow_extra_args(false);
  command.add_option("--near", options.near, "shorter edges in a region and around it; may be given again")
      ->type_name("REGION=MM")
      ->allow_extra_args(false);
  command.add_option("--voxel-mm", options.voxel_mm, "resample to cubes of this edge first")->type_name("V");
  command.add_option("--keep-pieces", options.keep_pieces, "of each region the largest so many; 0: all")
      ->type_name("N");
  command.add_option("--smallest-piece-ml", options.smallest_piece_ml, "smaller pieces are dropped (0.1)")
      ->type_name("ML");
  command.add_option("--largest-hole-ml", options.largest_hole_ml, "holes up to that are filled (1)")->type_name("ML");
  command.add_option("--smoothing", options.smoothing, "rounds of smoothing that keep volumes and voxels (2); 0: none")
      ->type_name("N");
  command
      .add_option("--edges-across", options.edges_across,
                  "edges across vessels and sheets, shorter there; 0: as elsewhere")
      ->type_name("N");
  command.add_option("--size-image", options.size_image, "an image of wanted edges in mm, on any grid")
      ->type_name("FILE");
  command.add_flag("--no-refine", options.no_refine, "leave regions that come out torn or off in volume as they are");
  command.option_defaults()->group(others);
}

void refuse_image_options(const ImageMeshOptions& options) {
  const auto of_images = [](const CLI::Option* option) { return option->get_group() == kImageGroup; };
  for (const CLI::Option* option : options.command->get_options(of_images)) {
    if (option->count() > 0)
      throw std::invalid_argument(
          option->get_name() + " is for images (.nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd); a scene has keys of [mesh]");
  }
}

int mesh_of_image(const std::string& file, const ImageMeshOptions& options, const MeshOutput& output) {
  const auto start = std::chrono::steady_clock::now();
  const ImageBody body = body_of(file, options, output.edge_mm);
  catch_interrupts();
  ImageMesh made;
  try {
    made = made_of(body, output.quiet);
  } catch (const MeshingStopped&) {
    return kInterrupted;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  measure_distances(made);
  const double relative_step = relative_stable_step(made.mesh, edges_asked(body, made));
  write_vtu(output.out, made.mesh);
  (output.quiet ? keep_json : write_json)(output.json, image_mesh_json(made, relative_step, seconds));
  if (!output.quiet) say_figures(made, output.out, body.edge, relative_step, seconds);
  return kDone;
}

}  // namespace glisson::app
