// image.h — labelled and grey images on a grid in space.
//
//   LabelImage image = read_label_image("abdomen_labels.nii.gz");
//   Vec3d centre = image.grid.world({0, 0, 0});          // of the first voxel [m]
//
// World axes are RAS, whatever the file has: x to the patient's right, y to the front (anterior), z to the head (superior). Files
// of NIfTI are RAS; those of NRRD and MetaImage are mostly LPS, whose x and y are negated on reading.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "glisson/math.h"

namespace glisson {

/// Where the voxels of an image are: the centre of voxel (i, j, k) is  origin + axes (i, j, k)ᵀ.
struct ImageGrid {
  std::array<std::size_t, 3> size{1, 1, 1};  ///< voxels along i, j and k; in memory i is fastest
  Mat3d axes = identity<double>();           ///< column a: from a voxel to the next along axis a [m]
  Vec3d origin{};                            ///< centre of voxel (0, 0, 0) [m]

  std::size_t voxels() const { return size[0] * size[1] * size[2]; }
  std::size_t at(std::size_t i, std::size_t j, std::size_t k) const { return i + size[0] * (j + size[1] * k); }
  std::array<std::size_t, 3> place(std::size_t voxel) const {
    return {voxel % size[0], voxel / size[0] % size[1], voxel / (size[0] * size[1])};
  }
  Vec3d world(const Vec3d& index) const { return origin + axes * index; }
  /// The inverse: fractions of voxels. `axes` is not singular.
  Vec3d index(const Vec3d& world) const { return inverse(axes) * (world - origin); }
  /// Distance of neighbouring voxels along i, j and k [m].
  Vec3d spacing() const;
  double voxel_volume() const { return std::abs(determinant(axes)); }  ///< [m³]
  /// The grid of a part, whose first voxel is `low`.
  ImageGrid part(const std::array<std::size_t, 3>& low, const std::array<std::size_t, 3>& part_size) const;
};

/// What images of both kinds have.
struct ImageFrame {
  ImageGrid grid;
  std::string source;                         ///< the file, for messages
  std::array<std::size_t, 3> crop_low{};      ///< place of the first voxel in the whole image
  std::array<std::size_t, 3> whole{1, 1, 1};  ///< size of the whole image
  std::vector<std::string> notes;             ///< a sentence each: what the file leaves open and what was taken
};

/// A number a voxel: 0 is the background.
struct LabelImage : ImageFrame {
  std::vector<std::uint16_t> voxels;
  std::map<int, std::string> names;  ///< of labels, where the file gives them

  /// The name of a label, or "label 7".
  std::string name_of(int label) const;
};

/// A value a voxel, as Hounsfield units.
struct GreyImage : ImageFrame {
  std::vector<float> voxels;
};

}  // namespace glisson
