// size_field.cpp — see size_field.h.
#include "mesh/lattice/size_field.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/nearest.h"
#include "base/require_fields.h"
#include "base/text.h"

namespace glisson {

Fault MeshSize::check() const {
  const int places = !near.empty() + !surface.empty() + !path.empty();
  if (places == 1) return {};
  return {places == 0 ? "names no place; give `near` or `surface` with the name of a region, or `path` with points"
                      : "names more than one place; give one of `near`, `surface` and `path`, and a size for each",
          "near"};
}

namespace lattice {
namespace {

constexpr double kMostRatio = 256.0;  ///< of the coarsest to the finest edge

double distance_from_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d along = b - a;
  const double length2 = dot(along, along);
  const double t = length2 > 0.0 ? std::clamp(dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
  return norm(p - a - along * t);
}

const BodyRegion& region_called(const std::string& where, const std::string& key, const std::string& name,
                                const std::vector<BodyRegion>& regions) {
  std::vector<std::string> known;
  for (const BodyRegion& r : regions) {
    if (r.name == name) return r;
    known.push_back(r.name);
  }
  const std::string meant = scene::nearest(name, known);
  detail::refuse(where, key,
                 "= \"" + name + "\" is no region" +
                     (meant.empty() ? "; there are: " + scene::listed(known) : "; did you mean \"" + meant + "\"?"));
}

void require_finer(const std::string& where, double edge, double mesh_edge) {
  if (edge < mesh_edge && edge * kMostRatio >= mesh_edge) return;
  detail::refuse(where, "edge [m]",
                 "= " + detail::show(edge) + " is outside the allowed range, " +
                     detail::number_text(mesh_edge / kMostRatio, 3) + " to below " + detail::show(mesh_edge) +
                     ", the mesh's own edge: give a finer size, or the mesh another edge");
}

}  // namespace

SizeField::SizeField(const std::vector<BodyRegion>& regions, double edge, const std::vector<MeshSize>& sizes,
                     double growth)
    : edge_(edge), finest_(edge), growth_(growth) {
  if (!kGrowthRange.contains(growth)) {
    throw std::invalid_argument("growth = " + detail::show(growth) + " is outside the allowed range, " +
                                kGrowthRange.text());
  }
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const MeshSize& size = sizes[i];
    const std::string where = "size " + std::to_string(i);
    detail::require_fields(where, size);
    require_finer(where, size.edge, edge);
    Place place{nullptr, !size.surface.empty(), {}, size.edge, size.within};
    if (!size.near.empty()) place.region = &region_called(where, "near", size.near, regions);
    if (!size.surface.empty()) place.region = &region_called(where, "surface", size.surface, regions);
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

double SizeField::at(const Vec3d& p) const {
  double edge = edge_;
  for (const Place& place : places_) {
    if (place.edge >= edge) continue;
    edge = std::min(edge, place.edge + growth_ * std::max(0.0, distance(place, p) - place.within));
  }
  return edge;
}

}  // namespace lattice
}  // namespace glisson
