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

}  // namespace

double relative_stable_step(const TetMesh& mesh, double edge) {
  if (!(edge > 0.0) || !std::isfinite(edge))
    throw std::invalid_argument("edge [m] = " + detail::show(edge) + " is outside the allowed range, > 0 and finite");
  const Tissue tissue;
  std::map<int, Tissue> tissues;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) tissues.try_emplace(mesh.region_of(t), tissue);
  const Body body = build_body(mesh, tissues);
  const std::vector<double> rest(body.blocks.size(), 1.0), none(body.blocks.size(), 0.0);
  const std::vector<double> undamped(body.vertex_count, 0.0);
  return stable_step(body, rest, undamped, {}, nullptr, none).step / regular_tet_step(tissue, edge);
}

}  // namespace glisson
