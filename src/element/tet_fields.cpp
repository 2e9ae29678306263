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

TetFields empty_fields(std::size_t n) {
  return {std::vector<double>(n),     std::vector<double>(n),     std::vector<double>(n),
          std::vector<double>(6 * n), std::vector<double>(9 * n), std::vector<double>(n)};
}

/// Writes the fields of some elements of a block. @param place  of an element in the fields
template <class Place>
void add_block(const Body& body, const TissueBlock& block, const ElementList& elements, std::span<const Vec3d> u,
               std::span<const Vec3d> v, const BranchMemory& memory, const Place& place, TetFields& f) {
  const bool small = block.tissue.has_small_strain();
  const std::vector<Mat3d> piola = BlockResponse(body, block, elements).piola(u, v, memory);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const Mat3d H = element_gradient(body, elements[i], u), &P = piola[i];
    const std::size_t t = place(elements[i]);
    f.q[t] = mean_ratio(H);
    f.s[t] = intensity_of(one_minus_q(H));
    f.jacobian[t] = jacobian(H);
    f.linear[t] = memory.linear_share(elements[i] - block.begin);
    const Sym3<double> a = cauchy_stress(small, H, P);
    const std::array<double, 6> stress{a.xx, a.yy, a.zz, a.xy, a.yz, a.zx};
    std::copy(stress.begin(), stress.end(), f.stress.begin() + static_cast<std::ptrdiff_t>(6 * t));
    for (std::size_t k = 0; k < 9; ++k) f.piola[9 * t + k] = P(k / 3, k % 3);
  }
}

/// Gives tet `to` of the fields what tet `from` has.
void copy_tet(TetFields& f, std::size_t from, std::size_t to) {
  if (from == to) return;
  f.q[to] = f.q[from], f.s[to] = f.s[from], f.jacobian[to] = f.jacobian[from], f.linear[to] = f.linear[from];
  std::copy_n(f.stress.begin() + static_cast<std::ptrdiff_t>(6 * from), 6,
              f.stress.begin() + static_cast<std::ptrdiff_t>(6 * to));
  std::copy_n(f.piola.begin() + static_cast<std::ptrdiff_t>(9 * from), 9,
              f.piola.begin() + static_cast<std::ptrdiff_t>(9 * to));
}

const BranchMemory& memory_of(std::span<const BranchMemory> memory, std::size_t block) {
  static const BranchMemory none;
  return memory.empty() ? none : memory[block];
}

}  // namespace

TetFields tet_fields(const Body& body, std::span<const Vec3d> u, std::span<const Vec3d> v,
                     std::span<const BranchMemory> memory) {
  TetFields f = empty_fields(body.elements.size());
  const auto place = [&](std::size_t e) { return body.mesh_tet[e]; };
  for (std::size_t b = 0; b < body.blocks.size(); ++b) {
    add_block(body, body.blocks[b], ElementList(body.blocks[b]), u, v, memory_of(memory, b), place, f);
  }
  return f;
}

TetFields tet_fields(const Body& body, std::span<const std::uint32_t> tets, std::span<const Vec3d> u,
                     std::span<const Vec3d> v, std::span<const BranchMemory> memory) {
  constexpr std::uint32_t kNotWanted = ~0u;
  std::vector<std::uint32_t> first(body.elements.size(), kNotWanted);  // where each tet is first asked for
  for (std::uint32_t i = 0; i < tets.size(); ++i) {
    if (first[tets[i]] == kNotWanted) first[tets[i]] = i;
  }
  TetFields f = empty_fields(tets.size());
  const auto place = [&](std::size_t e) { return first[body.mesh_tet[e]]; };
  for (std::size_t b = 0; b < body.blocks.size(); ++b) {
    std::vector<std::uint32_t> wanted;
    for (std::size_t e = body.blocks[b].begin; e < body.blocks[b].end; ++e) {
      if (place(e) != kNotWanted) wanted.push_back(static_cast<std::uint32_t>(e));
    }
    if (wanted.empty()) continue;
    add_block(body, body.blocks[b], ElementList(wanted), u, v, memory_of(memory, b), place, f);
  }
  for (std::size_t i = 0; i < tets.size(); ++i) copy_tet(f, first[tets[i]], i);
  return f;
}

double von_mises(std::span<const double, 6> s) {
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
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
