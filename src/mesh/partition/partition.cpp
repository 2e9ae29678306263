#include "mesh/partition/partition.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <stdexcept>

#include "mesh/cut/star_moves.h"
#include "mesh/topology/buckets.h"

namespace glisson::detail {
namespace {

constexpr std::size_t kOrdered = 16;    // runs this short are left in the order of the mesh
constexpr double kNearlyLargest = 0.9;  // share of the largest variance from which on an axis is preferred

struct PlacedTet {
  Vec3d centroid;  // [m]
  double along;    // centroid in the direction of the last cut [m]
  std::uint32_t tet;
};

/// The chosen tets in ascending order, whatever order they come in: sums over them must not depend on it.
std::vector<PlacedTet> place(std::span<const Vec3d> vertices, std::span<const Tet> tets,
                             std::span<const std::uint32_t> chosen) {
  std::vector<std::uint32_t> numbers(chosen.begin(), chosen.end());
  std::sort(numbers.begin(), numbers.end());
  std::vector<PlacedTet> placed;
  placed.reserve(numbers.size());
  for (const std::uint32_t t : numbers) {
    const auto& [a, b, c, d] = tets[t];
    placed.push_back({(vertices[a] + vertices[b] + vertices[c] + vertices[d]) * 0.25, 0.0, t});
  }
  return placed;
}

/// Second moments of the centroids about their mean [m²], not divided by their number.
Eigen::Matrix3d moments(std::span<const PlacedTet> placed) {
  Vec3d mean{};
  for (const PlacedTet& p : placed) mean = mean + p.centroid;
  mean = mean * (1.0 / static_cast<double>(placed.size()));
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (const PlacedTet& p : placed) {
    const Vec3d d = p.centroid - mean;
    xx += d.x * d.x, xy += d.x * d.y, xz += d.x * d.z;
    yy += d.y * d.y, yz += d.y * d.z, zz += d.z * d.z;
  }
  return Eigen::Matrix3d{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}};
}

/// The direction in which the centroids spread most. A coordinate axis is taken where it is nearly as good:
/// generated meshes have their layers across the axes, and on a cube every direction is the largest.
Vec3d spread(std::span<const PlacedTet> placed) {
  const Eigen::Matrix3d m = moments(placed);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m);
  Eigen::Index axis = 0;
  const double along_axis = m.diagonal().maxCoeff(&axis);
  const Eigen::Vector3d d = along_axis >= kNearlyLargest * solver.eigenvalues()[2]
                                ? Eigen::Vector3d(Eigen::Vector3d::Unit(axis))
                                : Eigen::Vector3d(solver.eigenvectors().col(2));
  return {d[0], d[1], d[2]};
}

/// Moves the `left` tets lowest along the spread to the front. Ties are broken by number, so the two sets depend
/// on nothing else.
void cut(std::span<PlacedTet> placed, std::size_t left) {
  const Vec3d direction = spread(placed);
  for (PlacedTet& p : placed) p.along = dot(p.centroid, direction);
  std::nth_element(placed.begin(), placed.begin() + static_cast<std::ptrdiff_t>(left), placed.end(),
                   [](const PlacedTet& a, const PlacedTet& b) {
                     return a.along < b.along || (a.along == b.along && a.tet < b.tet);
                   });
}

/// Cuts into `parts` parts and appends their sizes; within a part goes on halving, for the order alone.
void bisect(std::span<PlacedTet> placed, std::size_t parts, std::vector<std::size_t>& sizes) {
  if (parts == 1) sizes.push_back(placed.size());
  if (parts <= 1 && placed.size() <= kOrdered) {
    std::sort(placed.begin(), placed.end(), [](const PlacedTet& a, const PlacedTet& b) { return a.tet < b.tet; });
    return;
  }
  const std::size_t left_parts = parts / 2;
  const std::size_t left = parts > 1 ? placed.size() * left_parts / parts : placed.size() / 2;
  cut(placed, left);
  bisect(placed.first(left), left_parts, sizes);
  bisect(placed.subspan(left), parts > 1 ? parts - left_parts : 0, sizes);
}

/// Tets in vertex numbers of their own, 0 … count − 1 in order of first use.
struct Renumbered {
  std::vector<Tet> tets;
  std::uint32_t count = 0;
};

Renumbered renumber(std::span<const PlacedTet> placed, std::span<const Tet> tets, std::size_t vertices) {
  constexpr std::uint32_t kNone = ~0u;
  Renumbered result;
  result.tets.reserve(placed.size());
  std::vector<std::uint32_t> number(vertices, kNone);
  for (const PlacedTet& p : placed) {
    Tet tet = tets[p.tet];
    for (std::uint32_t& v : tet) {
      if (number[v] == kNone) number[v] = result.count++;
      v = number[v];
    }
    result.tets.push_back(tet);
  }
  return result;
}

std::vector<std::uint32_t> part_of_each(std::span<const std::size_t> sizes) {
  std::vector<std::uint32_t> part;
  for (std::uint32_t p = 0; p < sizes.size(); ++p) part.insert(part.end(), sizes[p], p);
  return part;
}

}  // namespace

TetPartition partition_tets(std::span<const Vec3d> vertices, std::span<const Tet> tets,
                            std::span<const std::uint32_t> chosen, std::size_t target_tets) {
  if (target_tets == 0) throw std::invalid_argument("target_tets = 0 is out of range: it must be 1 or more");
  if (chosen.empty()) return {{}, {0}};
  std::vector<PlacedTet> placed = place(vertices, tets, chosen);
  std::vector<std::size_t> sizes;
  bisect(placed, (placed.size() + target_tets - 1) / target_tets, sizes);

  const Renumbered renumbered = renumber(placed, tets, vertices.size());
  std::vector<std::uint32_t> part = part_of_each(sizes);
  move_stars(renumbered.tets, renumbered.count, sizes.size(), kPartSlack, part);

  auto buckets = make_buckets<std::uint32_t>(sizes.size(), [&](const auto& sink) {
    for (std::size_t i = 0; i < placed.size(); ++i) sink(part[i], placed[i].tet);
  });
  return {std::move(buckets.items), std::move(buckets.begin)};
}

}  // namespace glisson::detail
