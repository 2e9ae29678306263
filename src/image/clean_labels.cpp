// clean_labels.cpp — chooses, resamples, drops islands and fills holes, and says in mL what that changed.
#include "glisson/image/clean_labels.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/require_fields.h"
#include "base/text.h"
#include "image/pieces.h"

namespace glisson {
namespace {

constexpr std::size_t kMostGroups = 58;  ///< regions of a mesh, less the border of the image and an implant
constexpr double kMostVoxels = 2e9;
constexpr double kRounding = 1e-9;  ///< relative, of volumes that are compared

std::string ml(double volume) { return detail::number_text(1e6 * volume, 4) + " mL"; }

GroupImage chosen(const LabelImage& image, const std::vector<LabelGroup>& groups) {
  if (groups.empty() || groups.size() > kMostGroups)
    throw std::invalid_argument(std::to_string(groups.size()) + " regions of labels; allowed: 1 to " +
                                std::to_string(kMostGroups) + ": join some by +");
  std::vector<std::uint8_t> group_of(65536, 0);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const int label : groups[g].labels)
      group_of[static_cast<std::size_t>(label)] = static_cast<std::uint8_t>(g + 1);
  }
  GroupImage out;
  out.grid = image.grid;
  out.groups = groups;
  out.voxels.resize(image.voxels.size());
  for (std::size_t v = 0; v < image.voxels.size(); ++v) out.voxels[v] = group_of[image.voxels[v]];
  return out;
}

void require_all(const GroupImage& image, const char* when, const std::string& source) {
  std::vector<std::size_t> count(image.groups.size() + 1, 0);
  for (const std::uint8_t g : image.voxels) ++count[g];
  for (std::size_t g = 0; g < image.groups.size(); ++g) {
    if (count[g + 1] > 0) continue;
    throw std::invalid_argument(source + ": region \"" + image.groups[g].name + "\" (label " +
                                std::to_string(image.groups[g].number()) + ") has no voxel " + when);
  }
}

/// Cubes in place of voxels, each of the group that holds most of 27 points in it.
void resample(GroupImage& image, double voxel) {
  if (voxel <= 0.0) return;
  const std::vector<double> before = image.volumes();
  const ImageGrid old = image.grid;
  const Vec3d spacing = old.spacing();
  ImageGrid grid = old;
  double voxels = 1.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double extent = spacing[a] * static_cast<double>(old.size[a]);
    grid.size[a] = static_cast<std::size_t>(std::max(1.0, std::round(extent / voxel)));
    voxels *= static_cast<double>(grid.size[a]);
    for (std::size_t r = 0; r < 3; ++r)  // the same box, so that its faces stay those of the image
      grid.axes(r, a) = old.axes(r, a) * static_cast<double>(old.size[a]) / static_cast<double>(grid.size[a]);
  }
  if (voxels > kMostVoxels)
    throw std::invalid_argument("cubes of " + detail::number_text(1e3 * voxel) + " mm make " +
                                detail::number_text(voxels, 3) +
                                " voxels of the image; allowed: 2·10⁹: give larger ones");
  const Vec3d half{0.5, 0.5, 0.5};
  grid.origin = old.world(-half) + grid.axes * half;
  std::vector<std::uint8_t> to(grid.voxels());
  std::vector<int> votes(image.groups.size() + 1);
  for (std::size_t v = 0; v < to.size(); ++v) {
    const auto at = grid.place(v);
    std::fill(votes.begin(), votes.end(), 0);
    for (int n = 0; n < 27; ++n) {
      const std::array<int, 3> third{n % 3, n / 3 % 3, n / 9};
      std::array<std::size_t, 3> from{};
      for (std::size_t a = 0; a < 3; ++a) {
        const double share = (static_cast<double>(at[a]) + (third[a] + 0.5) / 3.0) / static_cast<double>(grid.size[a]);
        from[a] = std::min(old.size[a] - 1, static_cast<std::size_t>(share * static_cast<double>(old.size[a])));
      }
      ++votes[image.voxels[old.at(from[0], from[1], from[2])]];
    }
    to[v] = static_cast<std::uint8_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
  }
  image.grid = grid;
  image.voxels = std::move(to);
  const std::vector<double> after = image.volumes();
  for (std::size_t g = 0; g < image.groups.size(); ++g)
    image.report.push_back("resampled: \"" + image.groups[g].name + "\" " + ml(before[g]) + " → " + ml(after[g]));
}

/// Calls `visit` with each voxel of a piece and each of its neighbours across a face outside of it.
template <class Visit>
void each_neighbour(const ImageGrid& grid, const image::Pieces& pieces,
                    const std::vector<std::vector<std::size_t>>& members, std::size_t piece, Visit visit) {
  const std::array<std::size_t, 3> step{1, grid.size[0], grid.size[0] * grid.size[1]};
  for (const std::size_t v : members[piece]) {
    const auto at = grid.place(v);
    for (std::size_t a = 0; a < 3; ++a) {
      if (at[a] > 0 && pieces.of[v - step[a]] != piece) visit(v - step[a]);
      if (at[a] + 1 < grid.size[a] && pieces.of[v + step[a]] != piece) visit(v + step[a]);
    }
  }
}

/// Voxels of some pieces.
std::vector<std::vector<std::size_t>> members_of(const image::Pieces& pieces, const std::vector<char>& wanted) {
  std::vector<std::vector<std::size_t>> members(pieces.all.size());
  for (std::size_t v = 0; v < pieces.of.size(); ++v) {
    if (wanted[pieces.of[v]]) members[pieces.of[v]].push_back(v);
  }
  return members;
}

/// Gives pieces to what they share most faces with. @return [m³] taken from each group, the background first
std::vector<double> give_away(GroupImage& image, const image::Pieces& pieces, const std::vector<char>& going) {
  const auto members = members_of(pieces, going);
  std::vector<double> taken(image.groups.size() + 1, 0.0);
  for (std::size_t p = 0; p < pieces.all.size(); ++p) {
    if (!going[p]) continue;
    std::vector<std::size_t> faces(image.groups.size() + 1, 0);
    each_neighbour(image.grid, pieces, members, p, [&](std::size_t w) { ++faces[image.voxels[w]]; });
    faces[pieces.all[p].value] = 0;
    const auto to = static_cast<std::uint8_t>(std::max_element(faces.begin(), faces.end()) - faces.begin());
    for (const std::size_t v : members[p]) image.voxels[v] = to;
    taken[pieces.all[p].value] += static_cast<double>(members[p].size()) * image.grid.voxel_volume();
  }
  return taken;
}

void drop_islands(GroupImage& image, const CleanLabels& options) {
  const image::Pieces pieces = image::find_pieces(image.grid, image.voxels);
  std::vector<std::vector<std::size_t>> of_group(image.groups.size() + 1);
  for (std::size_t p = 0; p < pieces.all.size(); ++p) of_group[pieces.all[p].value].push_back(p);
  std::vector<char> going(pieces.all.size(), 0);
  std::vector<std::size_t> count(image.groups.size() + 1, 0);
  for (std::size_t g = 1; g < of_group.size(); ++g) {
    std::stable_sort(of_group[g].begin(), of_group[g].end(),
                     [&](std::size_t a, std::size_t b) { return pieces.all[a].voxels > pieces.all[b].voxels; });
    for (std::size_t rank = 1; rank < of_group[g].size(); ++rank) {
      const double size = static_cast<double>(pieces.all[of_group[g][rank]].voxels) * image.grid.voxel_volume();
      const bool extra = options.keep_pieces > 0 && rank >= static_cast<std::size_t>(options.keep_pieces);
      if (!extra && 1e6 * size >= options.smallest_piece_ml * (1.0 - kRounding)) continue;
      going[of_group[g][rank]] = 1;
      ++count[g];
    }
  }
  const std::vector<double> taken = give_away(image, pieces, going);
  for (std::size_t g = 1; g < of_group.size(); ++g) {
    if (count[g] > 0)
      image.report.push_back("islands: " + detail::count_text(count[g], "piece", "pieces") + " of \"" +
                             image.groups[g - 1].name + "\" dropped, " + ml(taken[g]) +
                             "; they are of what is around them now");
  }
}

void fill_holes(GroupImage& image, double largest_ml) {
  if (largest_ml <= 0.0) return;
  const image::Pieces pieces = image::find_pieces(image.grid, image.voxels);
  std::vector<char> going(pieces.all.size(), 0);
  std::size_t count = 0;
  for (std::size_t p = 0; p < pieces.all.size(); ++p) {
    const image::Piece& piece = pieces.all[p];
    if (piece.value != 0 || piece.at_border ||
        static_cast<double>(piece.voxels) * image.grid.voxel_volume() * 1e6 > largest_ml * (1.0 + kRounding))
      continue;
    going[p] = 1;
    ++count;
  }
  if (count == 0) return;
  const std::vector<double> taken = give_away(image, pieces, going);
  image.report.push_back("holes: " + std::to_string(count) + " filled, " + ml(taken[0]));
}

/// Faces of the whole image that cut a group.
void find_cuts(GroupImage& image, const LabelImage& from) {
  const auto& n = image.grid.size;
  for (std::size_t v = 0; v < image.voxels.size(); ++v) {
    if (image.voxels[v] == 0) continue;
    const auto at = image.grid.place(v);
    for (std::size_t a = 0; a < 3; ++a) {
      const bool low_is_border = from.crop_low[a] == 0;
      const bool high_is_border = from.crop_low[a] + from.grid.size[a] == from.whole[a];
      if (at[a] == 0 && low_is_border) image.cut[2 * a] = true;
      if (at[a] + 1 == n[a] && high_is_border) image.cut[2 * a + 1] = true;
    }
  }
  constexpr const char* kFaces[] = {"first i", "last i", "first j", "last j", "first k", "last k"};
  for (std::size_t f = 0; f < 6; ++f) {
    if (image.cut[f])
      image.report.push_back(std::string("border: the image ends in the body at its ") + kFaces[f] +
                             "; it is closed flat there");
  }
}

}  // namespace

std::vector<double> GroupImage::volumes() const {
  std::vector<double> sums(groups.size(), 0.0);
  for (const std::uint8_t g : voxels) {
    if (g > 0) sums[g - 1u] += 1.0;
  }
  for (double& sum : sums) sum *= grid.voxel_volume();
  return sums;
}

std::vector<std::size_t> GroupImage::pieces() const {
  std::vector<std::size_t> count(groups.size(), 0);
  for (const image::Piece& p : image::find_pieces(grid, voxels).all) {
    if (p.value > 0) ++count[p.value - 1];
  }
  return count;
}

GroupImage clean_labels(const LabelImage& image, const std::vector<LabelGroup>& groups, const CleanLabels& options) {
  detail::require_fields("labels", options);
  GroupImage out = chosen(image, groups);
  require_all(out, "in the image", image.source);
  resample(out, options.voxel);
  drop_islands(out, options);
  fill_holes(out, options.largest_hole_ml);
  require_all(out, "left after cleaning; give smaller voxels or other limits of pieces", image.source);
  find_cuts(out, image);
  return out;
}

}  // namespace glisson
