// write_image.h — images as NIfTI-1 files (.nii, .nii.gz), in RAS and millimetres.
#pragma once

#include <filesystem>
#include <string>

#include "glisson/image/body_image.h"
#include "glisson/image/image.h"

namespace glisson {

/// What the numbers of a voxel are: NIfTI's intent.
enum class VoxelValues {
  plain,         ///< one number, or several without a meaning of their own
  vector,        ///< three components along RAS: intent 1007, five dimensions
  displacement,  ///< the same as a displacement in mm: intent 1006; ITK 5.3 and later turn it into LPS as they read
  symmetric      ///< xx, xy, yy, xz, yz, zz along RAS: intent 1007, for SimpleITK refuses 1005, that of such matrices
};
template <>
inline constexpr Word<VoxelValues> kWords<VoxelValues>[] = {
    {"plain", VoxelValues::plain, "numbers without a direction"},
    {"vector", VoxelValues::vector, "three components along RAS"},
    {"displacement", VoxelValues::displacement, "three components along RAS, in mm"},
    {"symmetric", VoxelValues::symmetric, "xx, xy, yy, xz, yz, zz along RAS"}};

/// Writes values as `float`. The sform is the grid; the qform is the same, or is left out where the axes are not at right angles.
/// @param description  at most 79 bytes, as "stress Pa"
/// @throws ImageError  another ending than .nii and .nii.gz, more than 32767 voxels along an axis, another number of components than
///   `kind` has, a file that cannot be written. The file is either complete or as it was.
void write_nifti(const std::filesystem::path& file, const ValueImage& image, VoxelValues kind = VoxelValues::plain,
                 const std::string& description = {});

/// Writes labels as whole numbers of 8 or 16 bits, with their names as a label table, which the readers here and Connectome Workbench
/// know. @throws ImageError as above
void write_nifti(const std::filesystem::path& file, const LabelImage& image, const std::string& description = {});

}  // namespace glisson
