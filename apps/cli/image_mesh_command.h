// image_mesh_command.h — glisson mesh of the labels of an image: options, mesh, figures.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace glisson::app {

/// What only images have.
struct ImageMeshOptions {
  std::vector<std::string> labels, implants, near;
  std::string size_image;
  std::optional<double> voxel_mm, smallest_piece_ml, largest_hole_ml, edges_across;
  std::optional<int> keep_pieces, smoothing;
  bool no_refine = false;
  const CLI::App* command = nullptr;  ///< that has them all, in a group of their own
};

/// What all meshes have.
struct MeshOutput {
  std::string out, json;
  std::optional<double> edge_mm;
  bool quiet = false;
};

void add_image_mesh_options(CLI::App& command, ImageMeshOptions& options);
/// @throws std::invalid_argument naming one that was given without an image
void refuse_image_options(const ImageMeshOptions& options);

/// Meshes labels of an image, writes mesh and figures, prints them. @throws ImageError, std::invalid_argument
int mesh_of_image(const std::string& file, const ImageMeshOptions& options, const MeshOutput& output);

}  // namespace glisson::app
