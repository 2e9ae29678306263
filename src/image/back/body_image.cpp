// body_image.cpp — see body_image.h.
#include "glisson/image/body_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

namespace glisson {
namespace {

constexpr double kOutside = -1e-9;  ///< barycentric coordinates down to this count as inside
constexpr double kMargin = 1e-6;    ///< of boxes around tets, so that rounding leaves no voxel out [voxels]

void require_count(std::size_t given, std::size_t wanted, const char* what) {
  if (given != wanted)
    throw std::invalid_argument(std::string("VoxelPlaces: ") + std::to_string(given) + " " + what + " in place of " +
                                std::to_string(wanted));
}

/// Values at the corners of tets: means over the tets of a region around a vertex, weighted by their volumes.
class CornerMeans {
 public:
  CornerMeans(const TetMesh& mesh, std::span<const double> values, std::size_t components) : components_(components) {
    std::map<std::pair<std::uint32_t, int>, std::size_t> places;  // of a vertex in a region
    corners_.reserve(4 * mesh.tets.size());
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const double volume = std::abs(six_rest_volume(mesh, t));
      for (const std::uint32_t v : mesh.tets[t]) {
        const auto [place, is_new] = places.try_emplace({v, mesh.region_of(t)}, volumes_.size());
        corners_.push_back(place->second);
        if (is_new) {
          volumes_.push_back(0.0);
          sums_.resize(sums_.size() + components, 0.0);
        }
        volumes_[place->second] += volume;
        for (std::size_t c = 0; c < components; ++c)
          sums_[place->second * components + c] += volume * values[t * components + c];
      }
    }
  }

  double at(std::size_t tet, std::size_t corner, std::size_t component) const {
    const std::size_t place = corners_[4 * tet + corner];
    return volumes_[place] > 0.0 ? sums_[place * components_ + component] / volumes_[place] : 0.0;
  }

 private:
  std::size_t components_;
  std::vector<std::size_t> corners_;  ///< place of each tet's corners among the means
  std::vector<double> volumes_, sums_;
};

}  // namespace

/// A tet in voxels: barycentric coordinates of a place are linear in it.
struct VoxelPlaces::Chart {
  Vec3d first{};
  Mat3d inverse{};  ///< of the edges from the first corner, as columns

  std::array<double, 4> weights(const Vec3d& index) const {
    const Vec3d w = inverse * (index - first);
    return {1.0 - w.x - w.y - w.z, w.x, w.y, w.z};
  }
};

VoxelPlaces::Chart VoxelPlaces::chart_of(std::size_t tet) const {
  const Tet& t = mesh_->tets[tet];
  Mat3d edges;
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3d edge = index_[t[c + 1]] - index_[t[0]];
    for (std::size_t r = 0; r < 3; ++r) edges(r, c) = edge[r];
  }
  return {index_[t[0]], inverse(edges)};  // not finite where the tet is flat: no voxel is then in it
}

VoxelPlaces::VoxelPlaces(const TetMesh& mesh, const ImageGrid& grid, std::span<const Vec3d> positions,
                         std::span<const char> removed)
    : mesh_(&mesh), grid_(grid) {
  if (!positions.empty()) require_count(positions.size(), mesh.vertices.size(), "positions");
  if (!removed.empty()) require_count(removed.size(), mesh.tets.size(), "flags of removed tets");
  const Mat3d to_index = inverse(grid.axes);
  index_.reserve(mesh.vertices.size());
  for (const Vec3d& p : positions.empty() ? std::span<const Vec3d>(mesh.vertices) : positions)
    index_.push_back(to_index * (p - grid.origin));
  const Box box = box_around(index_);
  if (box.empty()) return;
  low_ = box.first;
  for (std::size_t a = 0; a < 3; ++a) size_[a] = box.last[a] - box.first[a] + 1;
  tet_of_.assign(size_[0] * size_[1] * size_[2], kNone);
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    if (removed.empty() || removed[t] == 0) mark(t);
  }
}

VoxelPlaces::Box VoxelPlaces::box_around(std::span<const Vec3d> places) const {
  Box box;
  for (std::size_t a = 0; a < 3; ++a) {
    double least = 1e300, largest = -1e300;
    for (const Vec3d& p : places) least = std::min(least, p[a]), largest = std::max(largest, p[a]);
    const double last = static_cast<double>(grid_.size[a]) - 1.0;
    const double from = std::max(std::ceil(least - kMargin), 0.0), to = std::min(std::floor(largest + kMargin), last);
    if (!(from <= to)) return {};
    box.first[a] = static_cast<std::size_t>(from);
    box.last[a] = static_cast<std::size_t>(to);
  }
  return box;
}

/// Marks the voxels of a tet that no earlier one has.
void VoxelPlaces::mark(std::uint32_t tet) {
  const Tet& t = mesh_->tets[tet];
  const std::array<Vec3d, 4> corners{index_[t[0]], index_[t[1]], index_[t[2]], index_[t[3]]};
  const Box box = box_around(corners);
  if (box.empty()) return;
  const Chart chart = chart_of(tet);
  for (std::size_t k = box.first[2]; k <= box.last[2]; ++k) {
    for (std::size_t j = box.first[1]; j <= box.last[1]; ++j) {
      for (std::size_t i = box.first[0]; i <= box.last[0]; ++i) {
        std::uint32_t& marked = tet_of_[i - low_[0] + size_[0] * (j - low_[1] + size_[1] * (k - low_[2]))];
        if (marked != kNone) continue;
        const auto w = chart.weights({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
        if (!std::all_of(w.begin(), w.end(), [](double x) { return x >= kOutside; })) continue;
        marked = tet;
        ++inside_;
      }
    }
  }
}

/// Calls visit(voxel of the grid, tet, place in voxels).
template <class Visit>
void VoxelPlaces::each_inside(Visit visit) const {
  std::size_t at = 0;
  for (std::size_t k = low_[2]; k < low_[2] + size_[2]; ++k) {
    for (std::size_t j = low_[1]; j < low_[1] + size_[1]; ++j) {
      for (std::size_t i = low_[0]; i < low_[0] + size_[0]; ++i, ++at) {
        if (at < tet_of_.size() && tet_of_[at] != kNone)
          visit(grid_.at(i, j, k), tet_of_[at],
                Vec3d{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
      }
    }
  }
}

ValueImage VoxelPlaces::empty_image(int components, float outside) const {
  if (components < 1) throw std::invalid_argument("VoxelPlaces: a field has 1 component or more");
  return {grid_, components, std::vector<float>(static_cast<std::size_t>(components) * grid_.voxels(), outside)};
}

ValueImage VoxelPlaces::vertex_values(std::span<const double> values, int components, float outside) const {
  ValueImage image = empty_image(components, outside);
  const auto n = static_cast<std::size_t>(components);
  require_count(values.size(), n * mesh_->vertices.size(), "values at vertices");
  each_inside([&](std::size_t voxel, std::uint32_t tet, const Vec3d& place) {
    const auto w = chart_of(tet).weights(place);
    for (std::size_t c = 0; c < n; ++c) {
      double sum = 0.0;
      for (std::size_t a = 0; a < 4; ++a) sum += w[a] * values[n * mesh_->tets[tet][a] + c];
      image.values[c * grid_.voxels() + voxel] = static_cast<float>(sum);
    }
  });
  return image;
}

ValueImage VoxelPlaces::tet_values(std::span<const double> values, int components, TetValues how, float outside) const {
  ValueImage image = empty_image(components, outside);
  const auto n = static_cast<std::size_t>(components);
  require_count(values.size(), n * mesh_->tets.size(), "values of tets");
  const auto fill = [&](const auto& value_of) {
    each_inside([&](std::size_t voxel, std::uint32_t tet, const Vec3d& place) {
      const auto value = value_of(tet, place);
      for (std::size_t c = 0; c < n; ++c) image.values[c * grid_.voxels() + voxel] = static_cast<float>(value(c));
    });
  };
  if (how == TetValues::own) {
    fill([&](std::uint32_t tet, const Vec3d&) { return [&, tet](std::size_t c) { return values[n * tet + c]; }; });
    return image;
  }
  const CornerMeans means(*mesh_, values, n);
  fill([&](std::uint32_t tet, const Vec3d& place) {
    return [&means, tet, w = chart_of(tet).weights(place)](std::size_t c) {
      double sum = 0.0;
      for (std::size_t a = 0; a < 4; ++a) sum += w[a] * means.at(tet, a, c);
      return sum;
    };
  });
  return image;
}

LabelImage VoxelPlaces::labels(std::uint16_t outside) const {
  for (const int region : mesh_->regions) {
    if (region < 0 || region > std::numeric_limits<std::uint16_t>::max())
      throw std::invalid_argument("region " + std::to_string(region) + " is no label; allowed: 0 to 65535");
  }
  LabelImage image;
  image.grid = grid_;
  image.whole = grid_.size;
  image.voxels.assign(grid_.voxels(), outside);
  image.names = mesh_->region_names;
  each_inside([&](std::size_t voxel, std::uint32_t tet, const Vec3d&) {
    image.voxels[voxel] = static_cast<std::uint16_t>(mesh_->region_of(tet));
  });
  return image;
}

void VoxelPlaces::each_voxel(const std::function<void(std::size_t, std::uint32_t)>& visit) const {
  each_inside([&](std::size_t voxel, std::uint32_t tet, const Vec3d&) { visit(voxel, tet); });
}

namespace {

/// Linear between voxels; those without a value are left out. NaN outside of the image, and where no voxel has a value.
double value_between(const GreyImage& image, const Vec3d& p) {
  const Vec3d index = image.grid.index(p);
  std::array<std::size_t, 3> low{};
  std::array<double, 3> t{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double last = static_cast<double>(image.grid.size[a] - 1);
    if (!(index[a] >= -0.5 && index[a] <= last + 0.5)) return std::numeric_limits<double>::quiet_NaN();
    const double x = std::clamp(index[a], 0.0, last);
    low[a] = std::min(static_cast<std::size_t>(x), image.grid.size[a] - 1);
    t[a] = x - static_cast<double>(low[a]);
  }
  double sum = 0.0, weights = 0.0;
  for (std::size_t c = 0; c < 8; ++c) {
    double w = 1.0;
    std::array<std::size_t, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
      w *= (c >> a) & 1 ? t[a] : 1.0 - t[a];
      at[a] = std::min(low[a] + ((c >> a) & 1), image.grid.size[a] - 1);
    }
    const double value = image.voxels[image.grid.at(at[0], at[1], at[2])];
    if (std::isnan(value)) continue;
    sum += w * value;
    weights += w;
  }
  return weights > 0.0 ? sum / weights : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<double> tet_means(const TetMesh& mesh, const GreyImage& image) {
  std::vector<double> sums(mesh.tets.size(), 0.0), counts(mesh.tets.size(), 0.0);
  std::vector<char> held(mesh.tets.size(), 0);
  VoxelPlaces(mesh, image.grid).each_voxel([&](std::size_t voxel, std::uint32_t tet) {
    held[tet] = 1;
    const double value = image.voxels[voxel];
    if (std::isnan(value)) return;
    sums[tet] += value;
    counts[tet] += 1.0;
  });
  for (std::size_t t = 0; t < sums.size(); ++t) {
    if (held[t] != 0) {
      sums[t] = counts[t] > 0.0 ? sums[t] / counts[t] : std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    Vec3d middle{};
    for (const std::uint32_t v : mesh.tets[t]) middle += mesh.vertices[v] * 0.25;
    sums[t] = value_between(image, middle);
  }
  return sums;
}

}  // namespace glisson
