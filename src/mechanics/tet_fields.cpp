#include "mechanics/tet_fields.h"

#include "tissue/shape_measure.h"

namespace glisson {
namespace {

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

LameParameters moduli(const Body& body, const Tissue& tissue, std::size_t e, const Mat3d& H) {
  double x = 0.0;
  switch (tissue.measure) {
    case DeformationMeasure::intensity:
      x = intensity_of(one_minus_q(H));
      break;
    case DeformationMeasure::one_minus_q:
      x = one_minus_q(H);
      break;
    case DeformationMeasure::regular_mean_ratio:
      x = regular_mean_ratio(H, body.rest[e].volume, edge_metric(body, e));
      break;
  }
  return lame_at(tissue, x);
}

}  // namespace

TetFields tet_fields(const Body& body, std::span<const Vec3d> u, std::span<const Vec3d> v) {
  const std::size_t n = body.elements.size();
  TetFields f{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n), std::vector<double>(6 * n)};
  for (const TissueBlock& block : body.blocks) {
    for (std::size_t e = block.begin; e < block.end; ++e) {
      const Mat3d H = element_gradient(body, e, u);
      const LameParameters lame = moduli(body, block.tissue, e, H);
      const Sym3<double> a = isotropic_stress(H, lame.lambda, lame.mu);
      const Sym3<double> b = isotropic_stress(element_gradient(body, e, v), block.viscous.lambda, block.viscous.mu);
      const std::size_t t = body.mesh_tet[e];
      f.q[t] = mean_ratio(H);
      f.s[t] = intensity_of(one_minus_q(H));
      f.jacobian[t] = jacobian(H);
      const std::array<double, 6> stress{a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.yz + b.yz, a.zx + b.zx};
      std::copy(stress.begin(), stress.end(), f.stress.begin() + static_cast<std::ptrdiff_t>(6 * t));
    }
  }
  return f;
}

double element_energy(const Body& body, const TissueBlock& block, std::size_t e, const std::array<Vec3d, 4>& u) {
  const Mat3d H = displacement_gradient<double>(body.rest[e].s, {u[1] - u[0], u[2] - u[0], u[3] - u[0]});
  const LameParameters lame = moduli(body, block.tissue, e, H);
  const double t = trace(H), squares = deviator_squared(H) + t * t / 3.0;
  return body.rest[e].volume * (0.5 * lame.lambda * t * t + lame.mu * squares);
}

double secant_energy(const Body& body, std::span<const Vec3d> u) {
  double sum = 0.0;
  for (const TissueBlock& block : body.blocks) {
    for (std::size_t e = block.begin; e < block.end; ++e) {
      const Tet& t = body.elements[e];
      sum += element_energy(body, block, e, {u[t[0]], u[t[1]], u[t[2]], u[t[3]]});
    }
  }
  return sum;
}

}  // namespace glisson
