// label_fields.cpp — see label_fields.h.
#include "image/label_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/distance_map.h"

namespace glisson::image {
namespace {

constexpr std::size_t kPad = 4;       ///< voxels around the image
constexpr int kSub = 4;               ///< points a voxel's edge where volumes are counted
constexpr int kLastRounds = 4;        ///< without smoothing: volumes and voxels alone
constexpr int kCorrections = 5;       ///< of volumes by those of the splines
constexpr double kVolumeShare = 0.8;  ///< of the shift that would bring the volume at once
constexpr double kMostShift = 0.25;   ///< of it in a round, in voxels

/// An image with a frame of kPad voxels that continue its border.
GroupImage padded(const GroupImage& from) {
  GroupImage to;
  to.groups = from.groups;
  to.grid = from.grid;
  const double pad = static_cast<double>(kPad);
  to.grid.origin = from.grid.world({-pad, -pad, -pad});
  for (std::size_t& n : to.grid.size) n += 2 * kPad;
  to.voxels.resize(to.grid.voxels());
  for (std::size_t v = 0; v < to.voxels.size(); ++v) {
    auto at = to.grid.place(v);
    for (std::size_t a = 0; a < 3; ++a) at[a] = std::clamp(at[a], kPad, kPad + from.grid.size[a] - 1) - kPad;
    to.voxels[v] = from.voxels[from.grid.at(at[0], at[1], at[2])];
  }
  return to;
}

/// The least singular value of the directions of the axes: 1 where they are at right angles. True distances are at least that share of those
/// by spacings alone.
double least_stretch(const ImageGrid& grid) {
  const Vec3d s = grid.spacing();
  Mat3d unit = grid.axes;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) unit(r, c) /= s[c];
  }
  const Mat3d gram = transposed(unit) * unit;
  double off = 0.0;  // Gershgorin: the least eigenvalue is at least 1 − the largest sum of a row beside the diagonal
  for (std::size_t r = 0; r < 3; ++r)
    off = std::max(off, std::abs(gram(r, (r + 1) % 3)) + std::abs(gram(r, (r + 2) % 3)));
  return std::sqrt(std::max(0.04, 1.0 - off));
}

class Fields {
 public:
  Fields(const GroupImage& image, const SmoothingOptions& options)
      : image_(image), options_(options), spacing_(image.grid.spacing()), count_(image.groups.size() + 1),
        voxel_(std::cbrt(image.grid.voxel_volume())) {
    measure_distances();
    count_voxels();
    find_cells();
  }

  void smooth() {
    for (int round = 0; round < options_.rounds + kLastRounds; ++round) {
      if (round < options_.rounds) {
        for (std::vector<float>& phi : phi_) diffuse(phi);
      }
      keep_volumes();
      keep_voxels();
    }
  }

  /// f of a group at the voxels.
  std::vector<float> by_precedence(std::size_t group) const {
    std::vector<float> f(image_.voxels.size());
    for (std::size_t v = 0; v < f.size(); ++v) {
      float least = phi_[0][v];
      for (std::size_t j = group + 1; j < count_; ++j) least = std::min(least, phi_[j][v]);
      f[v] = 0.5F * (phi_[group][v] - least);
    }
    return f;
  }

  /// Volumes that splines of all groups bound, by precedence, in voxels; the space around them first.
  std::vector<double> bounded(const std::vector<std::shared_ptr<const SplineField>>& fields) const {
    std::vector<double> volume = outside_cells();
    for (const std::size_t v : cells_) {
      std::uint64_t there = 0;
      for (std::size_t c = 0; c < 8; ++c) there |= std::uint64_t{1} << image_.voxels[corner(v, c)];
      const auto at = image_.grid.place(v);
      for (int p = 0; p < kSub * kSub * kSub; ++p) {
        const std::array<double, 3> sub = sub_point(p);
        const Vec3d index{static_cast<double>(at[0]) + sub[0], static_cast<double>(at[1]) + sub[1],
                          static_cast<double>(at[2]) + sub[2]};
        double left = 1.0;
        for (std::size_t g = 1; g < count_; ++g) {
          if (!((there >> g) & 1)) continue;
          const double share = std::clamp(0.5 - fields[g - 1]->at_index(index) * kSub / voxel_, 0.0, 1.0);
          volume[g] += left * share / (kSub * kSub * kSub);
          left *= 1.0 - share;
        }
        volume[0] += left / (kSub * kSub * kSub);
      }
    }
    return volume;
  }

  /// Aims at other volumes, by what the splines' are off, and goes there without smoothing.
  void correct(const std::vector<double>& bounded) {
    for (std::size_t g = 0; g < count_; ++g) aim_[g] += wanted_[g] - bounded[g];
    for (int round = 0; round < kLastRounds; ++round) {
      keep_volumes();
      keep_voxels();
    }
  }
  /// Voxels that are not of the group whose φ is the least.
  std::size_t changed() const {
    std::size_t n = 0;
    for (std::size_t v = 0; v < image_.voxels.size(); ++v) n += least_at(v) != image_.voxels[v];
    return n;
  }

 private:
  void measure_distances() {
    const double stretch = least_stretch(image_.grid);
    const double half = 0.5 * std::min({spacing_.x, spacing_.y, spacing_.z});
    std::vector<char> inside(image_.voxels.size()), outside(image_.voxels.size());
    for (std::size_t k = 0; k < count_; ++k) {
      for (std::size_t v = 0; v < inside.size(); ++v) {
        inside[v] = image_.voxels[v] == k;
        outside[v] = !inside[v];
      }
      std::vector<float> to = distance_to(image_.grid.size, spacing_, inside);
      const std::vector<float> from = distance_to(image_.grid.size, spacing_, outside);
      const double most = norm(
          Vec3d{spacing_.x * image_.grid.size[0], spacing_.y * image_.grid.size[1], spacing_.z * image_.grid.size[2]});
      for (std::size_t v = 0; v < to.size(); ++v) {
        const double d = inside[v] ? half - std::min<double>(from[v], most) : std::min<double>(to[v], most) - half;
        to[v] = static_cast<float>(stretch * d);
      }
      phi_.push_back(std::move(to));
    }
  }

  void count_voxels() {
    wanted_.assign(count_, 0.0);
    for (const std::uint8_t g : image_.voxels) wanted_[g] += 1.0;
    aim_ = wanted_;
    for (int p = 0; p < kSub * kSub * kSub; ++p) {
      const std::array<double, 3> t = sub_point(p);
      for (std::size_t c = 0; c < 8; ++c) {
        float product = 1.0F;
        for (std::size_t a = 0; a < 3; ++a) product *= static_cast<float>((c >> a) & 1 ? t[a] : 1.0 - t[a]);
        weights_[static_cast<std::size_t>(p)][c] = product;
      }
    }
  }

  /// Cells between 8 voxels that are not all of one group.
  void find_cells() {
    const auto& n = image_.grid.size;
    for (std::size_t k = 0; k + 1 < n[2]; ++k) {
      for (std::size_t j = 0; j + 1 < n[1]; ++j) {
        for (std::size_t i = 0; i + 1 < n[0]; ++i) {
          const std::size_t v = image_.grid.at(i, j, k);
          bool same = true;
          for (std::size_t c = 1; c < 8; ++c) same = same && image_.voxels[corner(v, c)] == image_.voxels[v];
          if (!same) cells_.push_back(v);
        }
      }
    }
  }
  std::size_t corner(std::size_t v, std::size_t c) const {
    const auto& n = image_.grid.size;
    return v + (c & 1) + ((c >> 1) & 1) * n[0] + (c >> 2) * n[0] * n[1];
  }

  /// A round of smoothing by w, 1 − 2w, w along each axis, less along axes of longer voxels.
  void diffuse(std::vector<float>& phi) {
    const auto& n = image_.grid.size;
    const std::array<std::size_t, 3> step{1, n[0], n[0] * n[1]};
    const double least = std::min({spacing_.x, spacing_.y, spacing_.z});
    scratch_.resize(phi.size());
    for (std::size_t a = 0; a < 3; ++a) {
      const auto w = static_cast<float>(0.25 * (least / spacing_[a]) * (least / spacing_[a]));
      for (std::size_t v = 0; v < phi.size(); v += n[0]) {
        const std::array<std::size_t, 3> at = image_.grid.place(v);
        if (a == 0) {
          for (std::size_t i = 0; i < n[0]; ++i) {
            const float below = phi[v + (i > 0 ? i - 1 : 0)], above = phi[v + (i + 1 < n[0] ? i + 1 : i)];
            scratch_[v + i] = phi[v + i] + w * (below - 2.0F * phi[v + i] + above);
          }
        } else {
          const float* below = phi.data() + v - (at[a] > 0 ? step[a] : 0);
          const float* above = phi.data() + v + (at[a] + 1 < n[a] ? step[a] : 0);
          for (std::size_t i = 0; i < n[0]; ++i)
            scratch_[v + i] = phi[v + i] + w * (below[i] - 2.0F * phi[v + i] + above[i]);
        }
      }
      phi.swap(scratch_);
    }
  }

  std::size_t least_at(std::size_t v) const {
    std::size_t least = 0;
    for (std::size_t j = 1; j < count_; ++j) {
      if (phi_[j][v] < phi_[least][v]) least = j;
    }
    return least;
  }

  /// Volumes of all groups in voxels, by kSub³ points between the voxels' centres.
  std::vector<double> counted() const {
    std::vector<double> volume = outside_cells();
    for (const std::size_t v : cells_) count_cell(v, volume);
    return volume;
  }
  /// Voxels of each group but for their eighths in cells of several.
  std::vector<double> outside_cells() const {
    std::vector<double> volume = wanted_;
    for (const std::size_t v : cells_) {
      for (std::size_t c = 0; c < 8; ++c) volume[image_.voxels[corner(v, c)]] -= 0.125;
    }
    return volume;
  }
  /// Place of a point in a cell, in voxels from its first corner.
  static std::array<double, 3> sub_point(int p) {
    const int i = p % kSub, j = p / kSub % kSub, k = p / (kSub * kSub);
    return {(i + 0.5) / kSub, (j + 0.5) / kSub, (k + 0.5) / kSub};
  }
  void count_cell(std::size_t v, std::vector<double>& volume) const {
    std::array<std::uint8_t, 8> there{};
    std::size_t kinds = 0;
    for (std::size_t c = 0; c < 8; ++c) {
      const std::uint8_t g = image_.voxels[corner(v, c)];
      if (std::find(there.begin(), there.begin() + kinds, g) == there.begin() + kinds) there[kinds++] = g;
    }
    std::array<std::array<float, 8>, 8> phi{};
    for (std::size_t m = 0; m < kinds; ++m) {
      for (std::size_t c = 0; c < 8; ++c) phi[m][c] = phi_[there[m]][corner(v, c)];
    }
    for (const auto& w : weights_) {
      std::size_t least = 0, next = 0;
      float best = std::numeric_limits<float>::infinity(), second = best;
      for (std::size_t m = 0; m < kinds; ++m) {
        float value = 0.0F;
        for (std::size_t c = 0; c < 8; ++c) value += w[c] * phi[m][c];
        if (value < best) {
          second = best, next = least;
          best = value, least = m;
        } else if (value < second) {
          second = value, next = m;
        }
      }
      // A point stands for the 1/kSub of a voxel around it, of which an interface so near cuts off a part.
      const double share = std::min(1.0, 0.5 + 0.5 * (second - best) * kSub / voxel_);
      volume[there[least]] += share / (kSub * kSub * kSub);
      volume[there[next]] += (1.0 - share) / (kSub * kSub * kSub);
    }
  }

  /// Raises or lowers φ of each group by what its volume is off, over its surface.
  void keep_volumes() {
    const std::vector<double> now = counted();
    std::vector<double> surface(count_, 0.0);
    for (const std::size_t v : cells_) {
      std::array<bool, 256> seen{};
      for (std::size_t c = 0; c < 8; ++c) {
        const std::uint8_t g = image_.voxels[corner(v, c)];
        if (!seen[g])
          surface[g] += 0.6, seen[g] = true;  // a plane through the grid meets some 1.6 cells a face of a voxel
      }
    }
    for (std::size_t k = 1; k < count_; ++k) {
      const double off = (now[k] - aim_[k]) / std::max(1.0, surface[k]);
      const auto shift = static_cast<float>(2.0 * voxel_ * std::clamp(kVolumeShare * off, -kMostShift, kMostShift));
      for (float& x : phi_[k]) x += shift;  // the interface moves by half of it
    }
  }

  /// Lets the own φ of each voxel stay the least by the margin.
  void keep_voxels() {
    const auto margin = static_cast<float>(2.0 * options_.margin * voxel_);
    for (std::size_t v = 0; v < image_.voxels.size(); ++v) {
      const std::size_t own = image_.voxels[v];
      float other = std::numeric_limits<float>::infinity();
      for (std::size_t j = 0; j < count_; ++j) {
        if (j != own) other = std::min(other, phi_[j][v]);
      }
      const float lacks = phi_[own][v] - other + margin;
      if (!(lacks > 0.0F)) continue;
      phi_[own][v] -= 0.5F * lacks;
      for (std::size_t j = 0; j < count_; ++j) {
        if (j != own) phi_[j][v] = std::max(phi_[j][v], phi_[own][v] + margin);
      }
    }
  }

  const GroupImage& image_;
  SmoothingOptions options_;
  Vec3d spacing_;
  std::size_t count_;  ///< of groups with the space around them
  double voxel_;       ///< edge of a cube of a voxel's volume [m]
  std::vector<std::vector<float>> phi_;
  std::vector<double> wanted_;  ///< voxels of each group
  std::vector<double> aim_;     ///< that trilinear φ are to bound, so that the splines bound `wanted_`
  std::array<std::array<float, 8>, kSub * kSub * kSub> weights_{};  ///< of a cell's corners at its points
  std::vector<std::size_t> cells_;                                  ///< by their first voxel
  std::vector<float> scratch_;
};

/// The box around a part of a grid, half a voxel and one more around it [m].
Bounds world_box(const ImageGrid& grid, const std::array<std::size_t, 3>& low, const std::array<std::size_t, 3>& high) {
  Bounds box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  for (std::size_t c = 0; c < 8; ++c) {
    Vec3d index{};
    for (std::size_t a = 0; a < 3; ++a)
      index[a] = (c >> a) & 1 ? static_cast<double>(high[a]) + 1.5 : static_cast<double>(low[a]) - 1.5;
    const Vec3d p = grid.world(index);
    for (std::size_t d = 0; d < 3; ++d) {
      box.min[d] = std::min(box.min[d], p[d]);
      box.max[d] = std::max(box.max[d], p[d]);
    }
  }
  return box;
}

std::vector<Bounds> boxes_of(const GroupImage& image) {
  const std::size_t groups = image.groups.size();
  std::vector<std::array<std::size_t, 3>> low(groups, image.grid.size), high(groups);
  for (std::size_t v = 0; v < image.voxels.size(); ++v) {
    if (image.voxels[v] == 0) continue;
    const auto at = image.grid.place(v);
    const std::size_t g = image.voxels[v] - 1u;
    for (std::size_t a = 0; a < 3; ++a) {
      low[g][a] = std::min(low[g][a], at[a]);
      high[g][a] = std::max(high[g][a], at[a]);
    }
  }
  std::vector<Bounds> boxes;
  for (std::size_t g = 0; g < groups; ++g) boxes.push_back(world_box(image.grid, low[g], high[g]));
  return boxes;
}

}  // namespace

LabelFields smooth_fields(const GroupImage& from, const SmoothingOptions& options) {
  const GroupImage image = padded(from);
  Fields fields(image, options);
  fields.smooth();
  LabelFields out;
  for (int round = 0;; ++round) {
    out.fields.clear();
    for (std::size_t g = 1; g <= image.groups.size(); ++g)
      out.fields.push_back(std::make_shared<const SplineField>(image.grid, fields.by_precedence(g)));
    out.volumes = fields.bounded(out.fields);
    if (round == kCorrections) break;
    fields.correct(out.volumes);
  }
  out.volumes.erase(out.volumes.begin());
  for (double& v : out.volumes) v *= image.grid.voxel_volume();
  out.changed_voxels = fields.changed();
  out.bounds = boxes_of(image);
  return out;
}

BodyRegion field_region(const std::string& name, std::shared_ptr<const SplineField> field, const Bounds& box) {
  const auto distance = [field = std::move(field), box](const Vec3d& p) {
    Vec3d beyond{};
    for (std::size_t a = 0; a < 3; ++a) beyond[a] = std::max({box.min[a] - p[a], 0.0, p[a] - box.max[a]});
    const double outside = norm(beyond);
    return outside > 0.0 ? std::max(field->at(p), outside) : field->at(p);
  };
  return {name, distance, box, false};
}

}  // namespace glisson::image
