// image_fuzz.cpp — any bytes as an image file: labels on a grid with a volume, or a message that names the file.
//
// The first byte picks the format (modulo 4: .nii.gz, .nrrd, .mha, .nii), the rest is the file; 4 MB may be taken for its voxels.
#include <cmath>
#include <cstdint>
#include <string>

#include "glisson/image/clean_labels.h"
#include "image/read/read_image.h"
#include "support.h"

using glisson::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const char* names[] = {"fuzz.nii.gz", "fuzz.nrrd", "fuzz.mha", "fuzz.nii"};
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const glisson::LabelImage image = glisson::image::read_labels({names[data[0] % 4], bytes}, {.memory = 4e6});
    require(image.voxels.size() == image.grid.voxels() && !image.voxels.empty(), "a label a voxel");
    require(std::isfinite(glisson::norm(image.grid.origin)) && image.grid.voxel_volume() > 0.0, "a grid with a volume");
    std::size_t voxels = 0;
    for (const glisson::LabelFigures& f : glisson::label_figures(image)) {
      require(f.pieces > 0 && f.voxels > 0, "each label has a piece");
      voxels += f.voxels;
    }
    require(voxels <= image.voxels.size(), "labels share no voxel");
  } catch (const glisson::ImageError& error) {
    require(std::string_view(error.what()).substr(0, 5) == "fuzz.", "a message begins with the file");
  }
  return 0;
}
