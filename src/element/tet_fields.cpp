#include "element/tet_fields.h"

#include "element/block_response.h"
#include "element/element_shape.h"
#include "material/volume_powers.h"

namespace glisson {
namespace {

LameParameters moduli(const Body& body, const Tissue& tissue, std::size_t e, const Mat3d& H) {
  double x = 0.0;
  switch (tissue.measure) {
    case DeformationMeasure::equivalent_shear_strain:
      x = intensity_of(one_minus_q(H));
      break;
    case DeformationMeasure::one_minus_q:
      x = one_minus_q(H);
      break;
    case DeformationMeasure::regular_mean_ratio:
      x = regular_mean_ratio(H, body.rest[e].volume, edge_metric(body, e));
      break;
    case DeformationMeasure::radius_ratio:
    case DeformationMeasure::solid_angle:
      break;  // never a tensor mass: goes by cauchy_stress
  }
  return lame_at(tissue, x);
}

/// σ = P Fᵀ/J; the symmetric part of P itself for small strain.
Sym3<double> cauchy_stress(bool small, const Mat3d& H, const Mat3d& P) {
  if (small) return symmetric(P);
  const Mat3d F = deformation_gradient(H);
  Mat3d PFt;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) PFt(i, j) = P(i, 0) * F(j, 0) + P(i, 1) * F(j, 1) + P(i, 2) * F(j, 2);
  }
  return symmetric(PFt) * (1.0 / std::max(jacobian(H), kSmallestVolume));
}

}  // namespace

TetFields tet_fields(const Body& body, std::span<const Vec3d> u, std::span<const Vec3d> v,
                     std::span<const BranchMemory> memory) {
  const std::size_t n = body.elements.size();
  TetFields f{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n), std::vector<double>(6 * n),
              std::vector<double>(9 * n)};
  for (std::size_t b = 0; b < body.blocks.size(); ++b) {
    const TissueBlock& block = body.blocks[b];
    const bool small = Response(block.tissue).small();
    const std::vector<Mat3d> piola =
        BlockResponse(body, block).piola(u, v, memory.empty() ? BranchMemory{} : memory[b]);
    for (std::size_t e = block.begin; e < block.end; ++e) {
      const Mat3d H = element_gradient(body, e, u), &P = piola[e - block.begin];
      const std::size_t t = body.mesh_tet[e];
      f.q[t] = mean_ratio(H);
      f.s[t] = intensity_of(one_minus_q(H));
      f.jacobian[t] = jacobian(H);
      const Sym3<double> a = cauchy_stress(small, H, P);
      const std::array<double, 6> stress{a.xx, a.yy, a.zz, a.xy, a.yz, a.zx};
      std::copy(stress.begin(), stress.end(), f.stress.begin() + static_cast<std::ptrdiff_t>(6 * t));
      for (std::size_t i = 0; i < 9; ++i) f.piola[9 * t + i] = P(i / 3, i % 3);
    }
  }
  return f;
}

double element_energy(const Body& body, const TissueBlock& block, std::size_t e, const std::array<Vec3d, 4>& u) {
  const Mat3d H = displacement_gradient<double>(body.rest[e].s, {u[1] - u[0], u[2] - u[0], u[3] - u[0]});
  if (!block.tissue.is_tensor_mass()) {
    const Response response(block.tissue);
    return body.rest[e].volume * response.relaxed_energy(H, element_shape(body, block.tissue, e));
  }
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
