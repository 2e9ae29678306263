// label_figures.cpp — what labels an image has, how large they are and in how many pieces.
#include <algorithm>
#include <map>

#include "glisson/image/clean_labels.h"
#include "image/pieces.h"

namespace glisson {

std::vector<LabelFigures> label_figures(const LabelImage& image) {
  std::map<int, LabelFigures> figures;
  const ImageGrid& grid = image.grid;
  for (std::size_t v = 0; v < image.voxels.size(); ++v) {
    const int label = image.voxels[v];
    if (label == 0) continue;
    const auto [it, fresh] = figures.try_emplace(label);
    LabelFigures& f = it->second;
    const auto at = grid.place(v);
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t whole = at[a] + image.crop_low[a];
      f.low[a] = fresh ? whole : std::min(f.low[a], whole);
      f.high[a] = fresh ? whole : std::max(f.high[a], whole);
    }
    ++f.voxels;
  }
  for (const image::Piece& piece : image::find_pieces(grid, image.voxels).all) {
    if (piece.value == 0) continue;
    LabelFigures& f = figures[static_cast<int>(piece.value)];
    ++f.pieces;
    f.largest_piece = std::max(f.largest_piece, static_cast<double>(piece.voxels) * grid.voxel_volume());
  }
  std::vector<LabelFigures> out;
  for (auto& [label, f] : figures) {
    f.label = label;
    f.name = image.name_of(label);
    f.volume = static_cast<double>(f.voxels) * grid.voxel_volume();
    for (std::size_t a = 0; a < 3; ++a) f.at_border = f.at_border || f.low[a] == 0 || f.high[a] + 1 == image.whole[a];
    out.push_back(f);
  }
  return out;
}

}  // namespace glisson
