// body_image.h — fields of a body on the grid of an image: what the mesh has at the centre of each voxel.
//
//   const VoxelPlaces places(mesh, read_image_grid("abdomen_ct.nii.gz"));
//   write_nifti("displacement.nii.gz", places.vertex_values(displacement_mm, 3, nan), VoxelValues::displacement);
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "glisson/image/image.h"
#include "glisson/mesh.h"
#include "glisson/words.h"

namespace glisson {

/// Numbers at the voxels of a grid, `components` each.
struct ValueImage {
  ImageGrid grid;
  int components = 1;
  std::vector<float> values;  ///< component c of voxel v is values[c · grid.voxels() + v]
};

/// How values of tets become values at points.
enum class TetValues { smooth, own };
template <>
inline constexpr Word<TetValues> kWords<TetValues>[] = {
    {"smooth", TetValues::smooth,
     "linear in each tet, from means at its vertices over the tets of its region, by volume"},
    {"own", TetValues::own, "that of the tet, with jumps at its faces"}};

/// Which tet holds the centre of each voxel.
class VoxelPlaces {
 public:
  /// @param mesh       must outlive this, unchanged
  /// @param positions  of the vertices [m], as those of a deformed body; empty: at rest
  /// @param removed    per tet: 1 where it is gone; empty: none is
  /// @throws std::invalid_argument for positions or flags of another number than vertices or tets
  /// Cost: some 0.2 µs a tet and 5 ns a voxel in the boxes around tets; 4 bytes a voxel in the box around the body.
  VoxelPlaces(const TetMesh& mesh, const ImageGrid& grid, std::span<const Vec3d> positions = {},
              std::span<const char> removed = {});

  /// Voxels whose centres lie in the body, faces included; on a face that tets share, in that of lowest number.
  std::size_t inside() const { return inside_; }

  /// Values at vertices, linear in each tet: exact for linear fields, to single precision.
  /// @param values   `components` for each vertex, one vertex after the other
  /// @param outside  of voxels outside the body
  ValueImage vertex_values(std::span<const double> values, int components, float outside) const;
  /// Values of tets. @param values  `components` for each tet
  ValueImage tet_values(std::span<const double> values, int components, TetValues how, float outside) const;
  /// The region of the tet at each voxel, with the names of the mesh. @param outside  of voxels outside the body
  /// @throws std::invalid_argument for regions that are no labels: below 0, above 65535
  LabelImage labels(std::uint16_t outside = 0) const;

  /// Calls visit(voxel of the grid, tet) for each voxel in the body.
  void each_voxel(const std::function<void(std::size_t, std::uint32_t)>& visit) const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  struct Chart;
  struct Box {
    std::array<std::size_t, 3> first{1, 1, 1}, last{};
    bool empty() const { return first[0] > last[0]; }
  };
  Chart chart_of(std::size_t tet) const;
  Box box_around(std::span<const Vec3d> places) const;
  void mark(std::uint32_t tet);
  template <class Visit>
  void each_inside(Visit visit) const;
  ValueImage empty_image(int components, float outside) const;

  const TetMesh* mesh_;
  ImageGrid grid_;
  std::vector<Vec3d> index_;                   ///< vertices in voxels of the grid
  std::array<std::size_t, 3> low_{}, size_{};  ///< the box of voxels around the body
  std::vector<std::uint32_t> tet_of_;          ///< of each voxel in that box; kNone: outside
  std::size_t inside_ = 0;
};

/// The mean of an image over each tet of a mesh: over the voxels whose centres it holds, of a tet that holds none the value at its middle, linear
/// between voxels. NaN where the image has none.
std::vector<double> tet_means(const TetMesh& mesh, const GreyImage& image);

}  // namespace glisson
