// surface_distance.cpp — see surface_distance.h.
#include "image/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "mesh/topology/faces.h"
#include "mesher/implicit/surface_tree.h"

namespace glisson::image {
namespace {

using Triangles = std::vector<detail::Corners>;

constexpr double kBlur = 0.7;               ///< standard deviation in voxels: less than a vessel of two voxels bears
constexpr std::size_t kMostPoints = 20000;  ///< of a surface that distances are taken from
constexpr double kNearBorder = 1.5;         ///< voxels from a face of the image that cuts the body: closed flat there
constexpr double kShare = 0.95;

double quantile(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto n = static_cast<std::size_t>(kShare * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), values.end());
  return values[n];
}

/// Every so many of some triangles, so that at most kMostPoints are left.
template <class Visit>
void each_sample(const Triangles& triangles, Visit visit) {
  const std::size_t step = 1 + triangles.size() / kMostPoints;
  for (std::size_t t = 0; t < triangles.size(); t += step) visit(detail::middle_of(triangles[t]));
}

/// Labels of one group in a frame of the voxels around it.
class Part {
 public:
  Part(const GroupImage& image, std::size_t group) {
    std::array<std::size_t, 3> low = image.grid.size, high{};
    for (std::size_t v = 0; v < image.voxels.size(); ++v) {
      if (image.voxels[v] != group + 1) continue;
      const auto at = image.grid.place(v);
      for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], at[a]), high[a] = std::max(high[a], at[a] + 1);
    }
    grid_ = image.grid;
    Vec3d first{};
    for (std::size_t a = 0; a < 3; ++a) {
      first[a] = static_cast<double>(low[a]) - kFrame;
      grid_.size[a] = high[a] - low[a] + 2 * kFrame;
    }
    grid_.origin = image.grid.world(first);
    inside_.resize(grid_.voxels());
    for (std::size_t v = 0; v < inside_.size(); ++v) {
      auto at = grid_.place(v);
      bool there = true;  // beyond the image, what is at its border goes on: it is closed flat there
      for (std::size_t a = 0; a < 3; ++a) {
        const auto whole = static_cast<std::ptrdiff_t>(at[a] + low[a]) - kFrame;
        const auto last = static_cast<std::ptrdiff_t>(image.grid.size[a]) - 1;
        there = there && (image.cut[2 * a] || whole >= 0) && (image.cut[2 * a + 1] || whole <= last);
        at[a] = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(whole, 0, last));
      }
      inside_[v] = there && image.voxels[image.grid.at(at[0], at[1], at[2])] == group + 1 ? 1.0F : 0.0F;
    }
  }

  /// The voxels' faces towards others, each as two triangles.
  Triangles faces() const {
    Triangles out;
    const std::array<std::size_t, 3> step{1, grid_.size[0], grid_.size[0] * grid_.size[1]};
    for (std::size_t v = 0; v < inside_.size(); ++v) {
      const auto at = grid_.place(v);
      for (std::size_t a = 0; a < 3; ++a) {
        if (at[a] + 1 == grid_.size[a] || inside_[v] == inside_[v + step[a]]) continue;
        std::array<Vec3d, 4> corner{};
        for (std::size_t c = 0; c < 4; ++c) {
          Vec3d index{static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
          index[a] += 0.5;
          index[(a + 1) % 3] += c & 1 ? 0.5 : -0.5;
          index[(a + 2) % 3] += c & 2 ? 0.5 : -0.5;
          corner[c] = grid_.world(index);
        }
        out.push_back({corner[0], corner[1], corner[2]});
        out.push_back({corner[1], corner[3], corner[2]});
      }
    }
    return out;
  }

  /// The level ½ after a blur, by tets of the cells between voxels.
  Triangles level() const {
    const std::vector<float> u = blurred();
    Triangles out;
    for (std::size_t v = 0; v < u.size(); ++v) {
      const auto at = grid_.place(v);
      if (at[0] + 1 == grid_.size[0] || at[1] + 1 == grid_.size[1] || at[2] + 1 == grid_.size[2]) continue;
      std::array<float, 8> value{};
      std::array<Vec3d, 8> place{};
      bool below = false, above = false;
      for (std::size_t c = 0; c < 8; ++c) {
        const std::size_t i = at[0] + (c & 1), j = at[1] + ((c >> 1) & 1), k = at[2] + (c >> 2);
        value[c] = u[grid_.at(i, j, k)] - 0.5F;
        (value[c] < 0.0F ? below : above) = true;
      }
      if (!below || !above) continue;
      for (std::size_t c = 0; c < 8; ++c)
        place[c] = grid_.world({static_cast<double>(at[0] + (c & 1)), static_cast<double>(at[1] + ((c >> 1) & 1)),
                                static_cast<double>(at[2] + (c >> 2))});
      constexpr std::size_t kTets[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                           {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
      for (const auto& tet : kTets) cut(tet, value, place, out);
    }
    return out;
  }

 private:
  static constexpr int kFrame = 3;

  static void cut(const std::size_t (&tet)[4], const std::array<float, 8>& value, const std::array<Vec3d, 8>& place,
                  Triangles& out) {
    std::array<std::size_t, 4> in{}, ex{};
    std::size_t ins = 0, outs = 0;
    for (const std::size_t c : tet) (value[c] < 0.0F ? ex[outs++] : in[ins++]) = c;
    const auto root = [&](std::size_t a, std::size_t b) {
      return place[a] + (place[b] - place[a]) * (value[a] / (value[a] - value[b]));
    };
    if (ins == 0 || outs == 0) return;
    if (ins == 2) {
      const Vec3d p = root(in[0], ex[0]), q = root(in[0], ex[1]), r = root(in[1], ex[0]), s = root(in[1], ex[1]);
      out.push_back({p, q, r});
      out.push_back({q, s, r});
      return;
    }
    const std::size_t tip = ins == 1 ? in[0] : ex[0];
    const auto& base = ins == 1 ? ex : in;
    out.push_back({root(tip, base[0]), root(tip, base[1]), root(tip, base[2])});
  }

  std::vector<float> blurred() const {
    constexpr int kReach = 3;
    std::array<float, kReach + 1> w{};
    float sum = 0.0F;
    for (int n = 0; n <= kReach; ++n) {
      w[static_cast<std::size_t>(n)] = static_cast<float>(std::exp(-0.5 * n * n / (kBlur * kBlur)));
      sum += (n == 0 ? 1.0F : 2.0F) * w[static_cast<std::size_t>(n)];
    }
    std::vector<float> u = inside_, next(u.size());
    const std::array<std::size_t, 3> step{1, grid_.size[0], grid_.size[0] * grid_.size[1]};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t v = 0; v < u.size(); ++v) {
        const std::size_t at = grid_.place(v)[a];
        float x = w[0] * u[v];
        for (std::size_t n = 1; n <= kReach; ++n)
          x += w[n] * (u[v - std::min(n, at) * step[a]] + u[v + std::min(n, grid_.size[a] - 1 - at) * step[a]]);
        next[v] = x / sum;
      }
      u.swap(next);
    }
    return u;
  }

  ImageGrid grid_;
  std::vector<float> inside_;
};

/// Triangles of each region's surface in a mesh, and of it those towards labels and space alone.
struct MeshSurfaces {
  std::map<int, Triangles> all, without_implants;
};

MeshSurfaces surfaces_of_mesh(const TetMesh& mesh, const std::vector<int>& implants) {
  MeshSurfaces out;
  const auto is_implant = [&](int region) {
    return std::find(implants.begin(), implants.end(), region) != implants.end();
  };
  detail::for_each_face(mesh, {}, [&](std::span<const detail::FaceSide> sides) {
    if (sides.size() == 2 && mesh.regions[sides[0].tet] == mesh.regions[sides[1].tet]) return;
    for (const detail::FaceSide& side : sides) {
      detail::Corners x{};
      for (std::size_t i = 0; i < 3; ++i)
        x[i] = mesh.vertices[mesh.tets[side.tet][detail::kFaceCorners[side.corner][i]]];
      const int region = mesh.regions[side.tet];
      out.all[region].push_back(x);
      const bool beside_implant = std::any_of(
          sides.begin(), sides.end(), [&](const detail::FaceSide& s) { return is_implant(mesh.regions[s.tet]); });
      if (!beside_implant) out.without_implants[region].push_back(x);
    }
  });
  return out;
}

/// Whether a point is at a face of the image that cuts the body.
bool at_border(const GroupImage& labels, const Vec3d& index) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (labels.cut[2 * a] && index[a] < kNearBorder - 0.5) return true;
    if (labels.cut[2 * a + 1] && index[a] > static_cast<double>(labels.grid.size[a]) - 0.5 - kNearBorder) return true;
  }
  return false;
}

/// p95 of distances from samples of one surface to another.
double one_way(const Triangles& from, const Triangles& to, const std::function<bool(const Vec3d&)>& counts) {
  if (from.empty() || to.empty()) return 0.0;
  const detail::SurfaceTree tree(to);
  std::vector<double> distances;
  each_sample(from, [&](const Vec3d& p) {
    if (counts(p)) distances.push_back(std::abs(tree.distance(p)));
  });
  return quantile(std::move(distances));
}

/// Triangles with an area: level sets have some without.
Triangles with_area(Triangles triangles) {
  std::erase_if(triangles, [](const detail::Corners& t) { return !(norm(detail::area_vector(t)) > 1e-15); });
  return triangles;
}

/// Points spread evenly over the surface of an implant, as triangles of one place.
double implant_to_mesh(const Implant& implant, const Triangles& mesh) {
  constexpr int kPoints = 2000;
  const detail::SurfaceTree tree(mesh);
  std::vector<double> distances;
  for (int n = 0; n < kPoints; ++n) {
    const double z = 1.0 - (2.0 * n + 1.0) / kPoints, turn = n * std::numbers::pi * (3.0 - std::sqrt(5.0)),
                 r = std::sqrt(1.0 - z * z);
    distances.push_back(std::abs(tree.distance(implant.surface_point({r * std::cos(turn), r * std::sin(turn), z}))));
  }
  return quantile(std::move(distances));
}

/// Of a group of labels: `outer` is what of its surface in the mesh is compared with the level of its voxels, `all` is all of it.
void measure_group(const GroupImage& labels, std::size_t group, const Triangles& outer, const Triangles& all,
                   const std::function<bool(const Vec3d&)>& counts, ImageRegion& region) {
  const Part part(labels, group);
  const Triangles level = with_area(part.level()), faces = part.faces();
  region.distance_p95 = std::max(one_way(outer, level, counts), one_way(level, all, counts));
  region.faces_p95 = one_way(faces, all, counts);
}

void measure_implant(const Implant& implant, const Triangles& mesh, ImageRegion& region) {
  if (implant.labels)
    return measure_group(
        *implant.labels, 0, mesh, mesh, [](const Vec3d&) { return true; }, region);
  std::vector<double> distances;
  for (const detail::Corners& t : mesh) distances.push_back(std::abs(implant.region.distance(detail::middle_of(t))));
  region.distance_p95 = std::max(quantile(std::move(distances)), implant_to_mesh(implant, mesh));
  region.faces_p95 = region.distance_p95;
}

}  // namespace

void measure_distances(const GroupImage& labels, const std::vector<Implant>& implants, const TetMesh& mesh,
                       std::vector<ImageRegion>& regions) {
  std::vector<int> numbers;
  for (const Implant& implant : implants) {
    const auto it =
        std::find_if(regions.begin(), regions.end(), [&](const ImageRegion& r) { return r.name == implant.name; });
    numbers.push_back(it->label);
  }
  MeshSurfaces surfaces = surfaces_of_mesh(mesh, numbers);
  const auto counts = [&](const Vec3d& p) {
    if (at_border(labels, labels.grid.index(p))) return false;
    return std::none_of(implants.begin(), implants.end(), [&](const Implant& i) { return i.contains(p); });
  };
  for (ImageRegion& region : regions) {
    const Triangles& all = surfaces.all[region.label];
    if (all.empty()) continue;
    const auto implant =
        std::find_if(implants.begin(), implants.end(), [&](const Implant& i) { return i.name == region.name; });
    if (implant != implants.end()) {
      measure_implant(*implant, all, region);
      continue;
    }
    const auto& groups = labels.groups;
    const auto group =
        std::find_if(groups.begin(), groups.end(), [&](const LabelGroup& g) { return g.name == region.name; });
    measure_group(labels, static_cast<std::size_t>(group - groups.begin()), surfaces.without_implants[region.label],
                  all, counts, region);
  }
}

}  // namespace glisson::image
