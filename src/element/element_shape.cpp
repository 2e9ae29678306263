#include "element/element_shape.h"

#include "material/edge_measure.h"
#include "material/principal.h"

namespace glisson {

EdgeMetric<double> edge_metric(const Body& body, std::size_t e) {
  EdgeMetric<double> G;
  const Tet& t = body.elements[e];
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      const Vec3d l = body.rest_positions[t[a]] - body.rest_positions[t[b]];
      G.xx += l.x * l.x, G.yy += l.y * l.y, G.zz += l.z * l.z;
      G.xy += l.x * l.y, G.yz += l.y * l.z, G.zx += l.z * l.x;
    }
  }
  return G;
}

Mat3d regular_turn(const Body& body, std::size_t e) {
  const Tet& t = body.elements[e];
  Mat3d rest, regular;  // columns: edges from corner 0
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3d l = body.rest_positions[t[a + 1]] - body.rest_positions[t[0]];
    for (std::size_t i = 0; i < 3; ++i) rest(i, a) = l[i], regular(i, a) = detail::kRegularEdges[a][i];
  }
  Mat3d map = product(rest, inverse(regular));
  map = scaled(map, 1.0 / std::cbrt(determinant(map)));
  for (std::size_t i = 0; i < 3; ++i) map(i, i) -= 1.0;
  return detail::out_of_frame(principal_frame(map), identity<double>());
}

ElementShape element_shape(const Body& body, const Tissue& tissue, std::size_t e) {
  ElementShape shape;
  shape.volume = body.rest[e].volume;
  if (tissue.measure == DeformationMeasure::regular_mean_ratio) shape.metric = edge_metric(body, e);
  if (tissue.measure == DeformationMeasure::radius_ratio || tissue.measure == DeformationMeasure::solid_angle) {
    shape.turn = regular_turn(body, e);
  }
  if (tissue.fibres) {
    const Vec3d a = body.fibres.empty() ? tissue.fibres->direction : body.fibres[body.mesh_tet[e]];
    shape.fibre = unit(a);
  }
  return shape;
}

}  // namespace glisson
