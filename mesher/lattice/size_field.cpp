// size_field.cpp — see size_field.h.
#include "mesher/lattice/size_field.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "base/nearest.h"
#include "base/require_fields.h"
#include "base/text.h"

namespace glisson {

Fault MeshSize::check() const {
  const int places = !near.empty() + !surface.empty() + !path.empty();
  if (per_radius > 0.0 && surface.empty())
    return {"is given without `surface`; name the region whose surface is curved", "per_radius"};
  if (places == 1) return {};
  return {places == 0 ? "names no place; give `near` or `surface` with the name of a region, or `path` with points"
                      : "names more than one place; give one of `near`, `surface` and `path`, and a size for each",
          "near"};
}

namespace {

constexpr double kMostRatio = 256.0;  ///< of the coarsest to the finest edge

std::string no_such_region(const std::string& name, const std::vector<std::string>& regions) {
  if (name.empty() || std::find(regions.begin(), regions.end(), name) != regions.end()) return {};
  const std::string meant = scene::nearest(name, regions);
  return "\"" + name + "\" is no region of the mesh" +
         (meant.empty() ? "; there are: " + scene::listed(regions) : "; did you mean \"" + meant + "\"?");
}

}  // namespace

SizeFault check_sizes(const std::vector<MeshSize>& sizes, double mesh_edge, const std::vector<std::string>& regions) {
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const MeshSize& s = sizes[i];
    if (std::string what = no_such_region(s.near, regions); !what.empty()) return {std::move(what), i, "near"};
    if (std::string what = no_such_region(s.surface, regions); !what.empty()) return {std::move(what), i, "surface"};
    if (s.edge * kMostRatio >= mesh_edge) continue;
    return {detail::number_text(1e3 * s.edge) +
                " mm is out of range; allowed: " + detail::number_text(1e3 * mesh_edge / kMostRatio, 3) +
                " or more, a " + detail::number_text(kMostRatio) + "th of the edge of the mesh, " +
                detail::number_text(1e3 * mesh_edge) + " mm",
            i, "edge_mm"};
  }
  return {};
}

namespace lattice {
namespace {

double distance_from_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d along = b - a;
  const double length2 = dot(along, along);
  const double t = length2 > 0.0 ? std::clamp(dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
  return norm(p - a - along * t);
}

const BodyRegion& region_called(const std::string& name, const std::vector<BodyRegion>& regions) {
  return *std::find_if(regions.begin(), regions.end(), [&](const BodyRegion& r) { return r.name == name; });
}

}  // namespace

SizeField::SizeField(const std::vector<BodyRegion>& regions, const RegionMeshOptions& options)
    : edge_(options.edge), finest_(options.edge), growth_(options.growth), free_(options.size_at) {
  detail::require_fields("mesh", options);
  const std::vector<MeshSize>& sizes = options.sizes;
  std::vector<std::string> names;
  for (const BodyRegion& r : regions) names.push_back(r.name);
  if (const SizeFault fault = check_sizes(sizes, edge_, names); !fault.what.empty()) {
    throw std::invalid_argument("size " + std::to_string(fault.index) + ": " + fault.key + " " + fault.what);
  }
  for (const MeshSize& size : sizes) {
    if (size.edge >= edge_) continue;  // the mesh is as fine
    Place place{nullptr, !size.surface.empty(), {}, {}, size.edge, size.within};
    if (!size.near.empty()) place.region = &region_called(size.near, regions);
    if (!size.surface.empty()) place.region = &region_called(size.surface, regions);
    if (size.per_radius > 0.0) {
      place.curvature.emplace(curvature_sizes(*place.region, size.per_radius, size.edge, edge_), growth_, size.within);
    }
    for (const PathPoint& point : size.path) place.path.push_back(point.at);
    places_.push_back(std::move(place));
    finest_ = std::min(finest_, size.edge);
  }
}

double SizeField::distance(const Place& place, const Vec3d& p) {
  if (place.region != nullptr) {
    const double d = place.region->distance(p);
    return place.surface ? std::abs(d) : std::max(0.0, d);
  }
  double least = norm(p - place.path.front());
  for (std::size_t i = 1; i < place.path.size(); ++i) {
    least = std::min(least, distance_from_segment(p, place.path[i - 1], place.path[i]));
  }
  return least;
}

double SizeField::free_size(const Vec3d& p) const {
  const double size = free_(p);
  if (size * kMostRatio >= edge_ && std::isfinite(size)) return size;
  std::ostringstream text;
  text << "size_at gives " << detail::number_text(size) << " m at (" << p.x << ", " << p.y << ", " << p.z
       << ") m; allowed: finite and " << detail::number_text(edge_ / kMostRatio, 3) << " m or more, a "
       << detail::number_text(kMostRatio) << "th of the edge of the mesh; return that edge, "
       << detail::number_text(edge_) << " m, where none shorter is needed";
  throw std::invalid_argument(text.str());
}

double SizeField::at(const Vec3d& p) const {
  double edge = free_ ? std::min(edge_, free_size(p)) : edge_;
  for (const Place& place : places_) {
    if (place.edge >= edge) continue;
    if (place.curvature) {
      edge = place.curvature->at(p, edge);
      continue;
    }
    edge = std::min(edge, place.edge + growth_ * std::max(0.0, distance(place, p) - place.within));
  }
  return edge;
}

}  // namespace lattice
}  // namespace glisson
