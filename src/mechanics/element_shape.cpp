#include "mechanics/element_shape.h"

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

ElementShape element_shape(const Body& body, const Tissue& tissue, std::size_t e) {
  ElementShape shape;
  shape.volume = body.rest[e].volume;
  if (tissue.measure == DeformationMeasure::regular_mean_ratio) shape.metric = edge_metric(body, e);
  if (tissue.fibres) {
    const Vec3d a = body.fibres.empty() ? tissue.fibres->direction : body.fibres[body.mesh_tet[e]];
    shape.fibre = a * (1.0 / norm(a));
  }
  return shape;
}

}  // namespace glisson
