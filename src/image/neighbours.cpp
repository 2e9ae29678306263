// neighbours.cpp — see glisson/image/neighbours.h.
#include "glisson/image/neighbours.h"

#include <map>
#include <set>
#include <stdexcept>

#include "image/distance_map.h"

namespace glisson {

std::vector<Neighbour> neighbours(const LabelImage& image, const GroupImage& body, double within) {
  if (body.grid.size != image.grid.size)
    throw std::invalid_argument("neighbours: the body was cleaned on another grid than that of its image");
  std::vector<char> set(image.voxels.size());
  for (std::size_t v = 0; v < set.size(); ++v) set[v] = body.voxels[v] != 0 ? 1 : 0;
  const std::vector<float> distance = image::distance_to(image.grid.size, image.grid.spacing(), set);
  std::map<int, std::size_t> near;
  std::set<int> own;
  for (const LabelGroup& group : body.groups) own.insert(group.labels.begin(), group.labels.end());
  for (std::size_t v = 0; v < set.size(); ++v) {
    if (set[v] == 0 && image.voxels[v] != 0 && own.count(image.voxels[v]) == 0 &&
        static_cast<double>(distance[v]) <= within)
      ++near[image.voxels[v]];
  }
  std::vector<Neighbour> all;
  for (const auto& [label, voxels] : near) all.push_back({label, image.name_of(label), voxels});
  return all;
}

}  // namespace glisson
