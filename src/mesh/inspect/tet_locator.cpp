#include "mesh/inspect/tet_locator.h"

#include <algorithm>
#include <cmath>

#include "mesh/topology/buckets.h"

namespace glisson::detail {
namespace {

constexpr double kOutside = -1e-9;    ///< barycentric coordinates down to this count as inside
constexpr double kWellInside = 1e-6;  ///< of a point above this in all coordinates no other tet is asked
constexpr int kMostCells = 256;       ///< along an axis
/// Edge of a cell over that of a cube of six tets: some 20 tets reach into a cell, and a tet into some 27 cells.
constexpr double kCell = 0.5;

Vec3d lower(const Vec3d& a, const Vec3d& b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3d upper(const Vec3d& a, const Vec3d& b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

double six_volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return dot(b - a, cross(c - a, d - a));
}

}  // namespace

TetLocator::TetLocator(const TetMesh& mesh, std::span<const char> removed) : mesh_(&mesh) {
  const auto lives = [&](std::size_t t) { return removed.empty() || removed[t] == 0; };
  double volume = 0.0;
  std::size_t living = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!lives(t)) continue;
    for (const std::uint32_t v : mesh.tets[t]) {
      low_ = living == 0 && v == mesh.tets[t][0] ? mesh.vertices[v] : lower(low_, mesh.vertices[v]);
      high_ = living == 0 && v == mesh.tets[t][0] ? mesh.vertices[v] : upper(high_, mesh.vertices[v]);
    }
    volume += six_rest_volume(mesh, t) / 6.0;
    ++living;
  }
  if (living == 0) {
    begin_.assign(2, 0);
    return;
  }
  cell_ = kCell * std::cbrt(6.0 * volume / static_cast<double>(living));
  for (std::size_t a = 0; a < 3; ++a) {
    cell_ = std::max(cell_, (high_[a] - low_[a]) / kMostCells);
  }
  for (std::size_t a = 0; a < 3; ++a) cells_[a] = 1 + static_cast<int>((high_[a] - low_[a]) / cell_);
  Buckets<std::uint32_t> grid = make_buckets<std::uint32_t>(number(0, 0, cells_[2]), [&](const auto& sink) {
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
      if (!lives(t)) continue;
      Vec3d lo = mesh.vertices[mesh.tets[t][0]], hi = lo;
      for (const std::uint32_t v : mesh.tets[t]) {
        lo = lower(lo, mesh.vertices[v]);
        hi = upper(hi, mesh.vertices[v]);
      }
      const auto from = cell_of(lo), to = cell_of(hi);
      for (int k = from[2]; k <= to[2]; ++k) {
        for (int j = from[1]; j <= to[1]; ++j) {
          for (int i = from[0]; i <= to[0]; ++i) sink(number(i, j, k), t);
        }
      }
    }
  });
  begin_ = std::move(grid.begin);
  tets_ = std::move(grid.items);
}

std::array<int, 3> TetLocator::cell_of(const Vec3d& x) const {
  std::array<int, 3> cell;
  for (std::size_t a = 0; a < 3; ++a) {
    cell[a] = std::clamp(static_cast<int>(std::floor((x[a] - low_[a]) / cell_)), 0, cells_[a] - 1);
  }
  return cell;
}

/// The point by a tet, where its coordinates there are not below the least.
std::optional<LocatedPoint> TetLocator::within(std::uint32_t tet, const Vec3d& x, double least) const {
  const Tet& t = mesh_->tets[tet];
  const Vec3d &a = mesh_->vertices[t[0]], &b = mesh_->vertices[t[1]], &c = mesh_->vertices[t[2]],
              &d = mesh_->vertices[t[3]];
  const double whole = 1.0 / six_volume(a, b, c, d);
  std::array<double, 4> w;
  if ((w[0] = six_volume(x, b, c, d) * whole) >= least && (w[1] = six_volume(a, x, c, d) * whole) >= least &&
      (w[2] = six_volume(a, b, x, d) * whole) >= least && (w[3] = six_volume(a, b, c, x) * whole) >= least) {
    return LocatedPoint{tet, w};
  }
  return {};  // nor are points that are not finite in any tet
}

std::optional<LocatedPoint> TetLocator::locate(const Vec3d& x, std::uint32_t guess) const {
  if (auto found = within(guess, x, kWellInside)) return found;
  return locate(x);
}

std::optional<LocatedPoint> TetLocator::locate(const Vec3d& x) const {
  const double margin = 1e-6 * cell_;
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(x[a] >= low_[a] - margin && x[a] <= high_[a] + margin)) return {};
  }
  const auto cell = cell_of(x);
  const std::size_t n = number(cell[0], cell[1], cell[2]);
  for (std::size_t k = begin_[n]; k < begin_[n + 1]; ++k) {
    if (auto found = within(tets_[k], x, kOutside)) return found;
  }
  return {};
}

}  // namespace glisson::detail
