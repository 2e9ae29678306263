// read_image.h — images from files: NIfTI-1 and NIfTI-2 (.nii, .nii.gz), NRRD (.nrrd, .nhdr, .seg.nrrd), MetaImage (.mha, .mhd).
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "glisson/image/image.h"

namespace glisson {

/// An image that cannot be used: what() gives the file, what is wrong, the value, and what to do.
class ImageError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// An image whose numbers are no labels: what() gives the first voxel.
class NotLabels : public ImageError {
 public:
  using ImageError::ImageError;
};

struct ReadImageOptions {
  /// Labels whose box is kept, the rest of the image is left out as it is read; empty: the whole image is kept. Labels that are not there
  /// are refused. Of a grey image: no effect.
  std::vector<int> crop_to{};
  std::size_t margin = 0;  ///< voxels around that box that are kept, too
  /// Bytes that the voxels may take; none: what the machine has available.
  std::optional<double> memory{};
  bool gaps = false;  ///< of a grey image: NaN is kept, a voxel without a value; else it is refused
};

/// Whether a name ends as one of the formats.
bool is_image_file(const std::filesystem::path& file);

/// Reads labels: whole numbers from 0 to 65535, of any type of number; a file of `double` that holds whole numbers is one of labels.
/// Names come from the file: the label table of a NIfTI extension, the segments of a .seg.nrrd.
/// @throws NotLabels for other numbers; ImageError for a file that is missing, truncated or of another kind than it says, more or fewer than
///   three dimensions, a grid without volume, more voxels than there is memory for, labels to crop to that are not there
/// Cost: some 10 ns a voxel, twice that with `crop_to`. Memory: 2 bytes a voxel that is kept.
LabelImage read_label_image(const std::filesystem::path& file, const ReadImageOptions& options = {});

/// The names of labels that a file gives, by its header alone; empty where it gives none. @throws ImageError
std::map<int, std::string> read_label_names(const std::filesystem::path& file);

/// The grid of an image, by its header alone. @throws ImageError
ImageGrid read_image_grid(const std::filesystem::path& file);

/// Reads values, scaled as the file says. @throws ImageError as read_label_image, and for values that are not finite, but for NaN where `gaps` says so
GreyImage read_grey_image(const std::filesystem::path& file, const ReadImageOptions& options = {});

}  // namespace glisson
