// clean_labels.h — from the labels of a segmentation to the regions of a body: chosen, joined, freed of islands and holes.
//
// Connectivity is one rule: voxels are connected where they share a face. Two that touch at an edge or a corner only are not: they are
// two pieces, of a region as of the space around it.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "glisson/field.h"
#include "glisson/image/image.h"

namespace glisson {

/// A region and the labels that it joins.
struct LabelGroup {
  std::string name;
  std::vector<int> labels;  ///< one or more

  /// Number of the region in the mesh: its first label.
  int number() const { return labels.front(); }
};

/// Groups from words as `5`, `liver`, `vessels=63+64`, `63+portal_vein`: numbers and names of labels, joined by `+`, with a name of the
/// group in front where it is not that of the first label. @throws std::invalid_argument naming a word without a label, a label twice
/// @param names  of the file
std::vector<LabelGroup> label_groups(std::span<const std::string> words, const std::map<int, std::string>& names);

// The fields of cleaning, for each struct that has them.

template <class S>
constexpr auto voxel_field() {
  return field(
      "voxel", &S::voxel, "mm", at_least(0),
      "edge of cubes that the image is resampled to first, each with the label of most of it; 0: its own voxels");
}
template <class S>
constexpr auto keep_pieces_field() {
  return field("keep_pieces", &S::keep_pieces, between(0, 1e6), "of each region the largest so many are kept; 0: all");
}
template <class S>
constexpr auto smallest_piece_field() {
  return field("smallest_piece_ml", &S::smallest_piece_ml, at_least(0),
               "smaller pieces are dropped, but for the largest of a region");
}
template <class S>
constexpr auto largest_hole_field() {
  return field("largest_hole_ml", &S::largest_hole_ml, at_least(0), "holes in the body up to that are filled");
}

/// What is done to labels before they are meshed, in this order.
struct CleanLabels {
  double voxel = 0.0;              ///< edge of cubes that the image is resampled to first [m]; 0: its own voxels
  int keep_pieces = 0;             ///< of each region the largest so many are kept; 0: all
  double smallest_piece_ml = 0.1;  ///< smaller pieces are dropped, but for the largest of a region
  double largest_hole_ml = 1.0;    ///< holes in the body up to that are filled

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(voxel_field<CleanLabels>(), keep_pieces_field<CleanLabels>(), smallest_piece_field<CleanLabels>(),
                largest_hole_field<CleanLabels>());
  }
};

/// Labels of groups on a grid: voxel v is of group voxels[v] − 1, or of none where it is 0.
struct GroupImage {
  ImageGrid grid;
  std::vector<std::uint8_t> voxels;
  std::vector<LabelGroup> groups;
  /// Whether the low and high faces along i, j and k are those of the whole image and cut a group.
  std::array<bool, 6> cut{};
  std::vector<std::string> report;  ///< a line for each step that changed something, in mL

  /// [m³] of each group.
  std::vector<double> volumes() const;
  /// Pieces of each group, by faces.
  std::vector<std::size_t> pieces() const;
};

/// @throws std::invalid_argument  more than 58 groups, a group without a voxel before or after cleaning, options out of range
/// Cost: some 50 ns a voxel.
GroupImage clean_labels(const LabelImage& image, const std::vector<LabelGroup>& groups, const CleanLabels& options);

/// A label of an image.
struct LabelFigures {
  int label = 0;
  std::string name;
  std::size_t voxels = 0;
  double volume = 0.0;  ///< [m³]
  std::size_t pieces = 0;
  double largest_piece = 0.0;                ///< [m³]
  std::array<std::size_t, 3> low{}, high{};  ///< first and last voxel along i, j, k in the whole image
  bool at_border = false;                    ///< of the image: it may be cut
};

/// The labels of an image, ascending, without the background.
std::vector<LabelFigures> label_figures(const LabelImage& image);

}  // namespace glisson
