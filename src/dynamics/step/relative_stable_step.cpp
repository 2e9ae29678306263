// relative_stable_step.cpp — see mesh_step.h.
#include "glisson/simulation/mesh_step.h"

#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "base/text.h"
#include "dynamics/step/stable_step.h"

namespace glisson {
namespace {

/// h* of a regular tet alone, which its element bound meets: Σ s sᵀ = 2/e² I, a quarter of its mass at each corner [s].
double regular_tet_step(const Tissue& tissue, double edge) {
  return damped_step(8.0 * modulus_bound(tissue.lame()) / (tissue.density * edge * edge), 0.0);
}

void require_edge_asked(double edge) {
  if (!(edge > 0.0) || !std::isfinite(edge))
    throw std::invalid_argument("edge [m] = " + detail::show(edge) + " is outside the allowed range, > 0 and finite");
}

Body body_of_default_tissue(const TetMesh& mesh) {
  std::map<int, Tissue> tissues;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) tissues.try_emplace(mesh.region_of(t), Tissue());
  return build_body(mesh, tissues);
}

double step_over_regular(const Body& body, double edge) {
  const std::vector<double> rest(body.blocks.size(), 1.0), none(body.blocks.size(), 0.0);
  const std::vector<double> undamped(body.vertex_count, 0.0);
  return stable_step(body, rest, undamped, {}, nullptr, none).step / regular_tet_step(Tissue(), edge);
}

}  // namespace

double relative_stable_step(const TetMesh& mesh, double edge) {
  require_edge_asked(edge);
  return step_over_regular(body_of_default_tissue(mesh), edge);
}

double relative_stable_step(const TetMesh& mesh, std::span<const double> edges) {
  if (edges.size() != mesh.tets.size()) {
    throw std::invalid_argument(std::to_string(edges.size()) + " edges for " + std::to_string(mesh.tets.size()) +
                                " tets; give one for each");
  }
  for (const double edge : edges) require_edge_asked(edge);
  Body body = body_of_default_tissue(mesh);
  for (std::size_t e = 0; e < body.rest.size(); ++e) {
    for (Vec3d& s : body.rest[e].s) s = s * edges[body.mesh_tet[e]];
  }
  return step_over_regular(body, 1.0);
}

}  // namespace glisson
