#include "dynamics/step/mass_scaling.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dynamics/step/stable_step.h"

namespace glisson {
namespace {

/// Distance of a vertex from the opposite face, the smallest of four.
double smallest_altitude(const ElementRest& rest) {
  double steepest = norm(rest.s[0] + rest.s[1] + rest.s[2]);
  for (const Vec3d& s : rest.s) steepest = std::max(steepest, norm(s));
  return 1.0 / steepest;
}

}  // namespace

MassScaling scale_masses(Body& body, double step, double viscosity) {
  MassScaling scaling;
  const double before = std::accumulate(body.masses.begin(), body.masses.end(), 0.0);
  body.mass_factor.assign(body.elements.size(), 1.0);
  for (const TissueBlock& block : body.blocks) {
    for (std::size_t e = block.begin; e < block.end; ++e) {
      const double factor = mass_factor_for(body, block, e, step, viscosity);
      if (factor <= 1.0) continue;
      const double more = (factor - 1.0) * body.quarter_mass(block, e);
      for (const std::uint32_t v : body.elements[e]) body.masses[v] += more;
      body.mass_factor[e] = factor;
      scaling.added += 4.0 * more;
      scaling.tets.push_back(body.mesh_tet[e]);
    }
  }
  std::sort(scaling.tets.begin(), scaling.tets.end());
  scaling.share = scaling.added / before;
  return scaling;
}

MassScaling scaled_masses(Body& body, const SimulationOptions& o) {
  if (!o.mass_scaling_step || o.mass_scaling == MassScalingKind::variable) return {};
  return scale_masses(body, *o.mass_scaling_step, capabilities(o.integrator).viscosity_limits_step ? 1.0 : 0.0);
}

std::vector<LimitingTet> limiting_tets(const Body& body, std::size_t most, double viscosity) {
  std::vector<LimitingTet> all;
  for (const TissueBlock& block : body.blocks) {
    for (std::size_t e = block.begin; e < block.end; ++e) {
      if (body.rest[e].volume == 0.0) continue;
      all.push_back({body.mesh_tet[e], smallest_altitude(body.rest[e]), element_step(body, block, e, 1.0, viscosity)});
    }
  }
  const std::size_t count = std::min(most, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end(),
                    [](const LimitingTet& a, const LimitingTet& b) {
                      return a.step < b.step || (a.step == b.step && a.tet < b.tet);
                    });
  all.resize(count);
  return all;
}

}  // namespace glisson
