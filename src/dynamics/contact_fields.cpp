#include "dynamics/contact_fields.h"

namespace glisson {
namespace {

/// A third of the area of the triangles around each vertex of the surface [m²].
std::vector<double> nodal_areas(const TetMesh& present, std::span<const Vec3d> x) {
  std::vector<double> area(x.size(), 0.0);
  for (const Triangle& t : boundary_triangles(present)) {
    const double third = norm(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]])) / 6.0;
    for (const std::uint32_t v : t) area[v] += third;
  }
  return area;
}

}  // namespace

ContactFields contact_fields(const TetMesh& present, std::span<const Vec3d> positions,
                             std::span<const std::shared_ptr<Interaction>> interactions) {
  ContactFields fields{std::vector<Vec3d>(positions.size()), std::vector<double>(positions.size(), 0.0)};
  bool any = false;
  for (const auto& x : interactions) any = x->add_contact(fields.traction, fields.pressure) || any;
  if (!any) return {};
  const std::vector<double> area = nodal_areas(present, positions);
  for (std::size_t v = 0; v < area.size(); ++v) {
    const double per_area = area[v] > 0.0 ? 1.0 / area[v] : 0.0;
    fields.traction[v] *= per_area, fields.pressure[v] *= per_area;
  }
  return fields;
}

}  // namespace glisson
