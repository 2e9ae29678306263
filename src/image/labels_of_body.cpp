// labels_of_body.cpp — see labels_of_body.h.
#include "image/labels_of_body.h"

#include <algorithm>
#include <set>

#include "base/nearest.h"

namespace glisson::image {

std::map<int, std::string> label_names(const ImageBody& body) {
  return body.image ? body.image->names : read_label_names(body.path);
}

ImageGrid whole_grid(const ImageBody& body) { return body.image ? body.image->grid : read_image_grid(body.path); }

LabelImage body_labels(const ImageBody& body, const ReadImageOptions& reading) {
  return body.image ? cropped(*body.image, reading) : read_label_image(body.path, reading);
}

LabelImage cropped(const LabelImage& image, const ReadImageOptions& reading) {
  const std::set<int> wanted(reading.crop_to.begin(), reading.crop_to.end());
  std::set<int> found;
  std::array<std::size_t, 3> low = image.grid.size, high{}, size{};
  for (std::size_t v = 0; v < image.voxels.size(); ++v) {
    const int label = image.voxels[v];
    if (label == 0) continue;
    found.insert(label);
    if (!wanted.contains(label)) continue;
    const auto at = image.grid.place(v);
    for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], at[a]), high[a] = std::max(high[a], at[a] + 1);
  }
  for (const int label : wanted) {
    if (!found.contains(label))
      fail_without_label(image.source, label, image.names, std::vector<int>(found.begin(), found.end()));
  }
  if (wanted.empty()) return image;
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] -= std::min(low[a], reading.margin);
    size[a] = std::min(image.grid.size[a], high[a] + reading.margin) - low[a];
  }
  LabelImage part;
  static_cast<ImageFrame&>(part) = image;
  part.names = image.names;
  part.grid = image.grid.part(low, size);
  for (std::size_t a = 0; a < 3; ++a) part.crop_low[a] = image.crop_low[a] + low[a];
  part.voxels.resize(part.grid.voxels());
  for (std::size_t v = 0; v < part.voxels.size(); ++v) {
    const auto at = part.grid.place(v);
    part.voxels[v] = image.voxels[image.grid.at(low[0] + at[0], low[1] + at[1], low[2] + at[2])];
  }
  return part;
}

void fail_without_label(const std::string& source, int label, const std::map<int, std::string>& names,
                        const std::vector<int>& found) {
  constexpr std::size_t kMostListed = 100;
  std::vector<std::string> there;
  for (const int f : found) {
    const auto name = names.find(f);
    there.push_back(std::to_string(f) + (name == names.end() ? "" : " " + name->second));
    if (there.size() == kMostListed) break;
  }
  throw ImageError(source + ": no voxel has the label " + std::to_string(label) +
                   (there.empty() ? "; all are 0" : "; there are: " + scene::listed(there)));
}

}  // namespace glisson::image
