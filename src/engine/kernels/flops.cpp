#include "engine/kernels/flops.h"
#include "engine/kernels/response_kernels.h"

#include <algorithm>

namespace glisson::engine {
namespace {

constexpr double kDifference = 3.0;
constexpr double kNarrow = 6.0;      ///< u and v against the origin, a local vertex
constexpr double kIntegrate = 27.0;  ///< three components of advance() in vertex_stages-inl.h

double laws_flops(const Tissue& tissue) {
  const auto of = [](const StiffnessLaw& law) { return static_cast<double>(count_law_flops(law)); };
  if (!tissue.lambda_law && !tissue.mu_law) return of(tissue.law);
  return of(tissue.lambda_law.value_or(ConstantLaw{})) + of(tissue.mu_law.value_or(ConstantLaw{}));
}

/// The three tets of a chain, divided by three: five differences and six forces between them.
double chain_flops_per_tet(const ElementFlops& f, const Tissue& tissue) {
  const double fields = tissue.viscosity > 0.0 ? 2.0 : 1.0;
  const double differences = 5.0 / 3.0 * kDifference * fields;
  const double stresses = static_cast<double>(f.gradient + f.stress) * fields + 6.0 * (fields - 1.0) + 6.0 + 2.0;
  // joined on three vertices (two tets more on one, one more on two), summed on one
  const double forces = 3.0 * static_cast<double>(f.force) + 4.0 + 4.0;
  return differences + stresses + static_cast<double>(f.measure[static_cast<std::size_t>(tissue.measure)]) +
         laws_flops(tissue) + forces;
}

bool is_constant(const StiffnessLaw& law) { return std::holds_alternative<ConstantLaw>(law); }
/// Whether forces depend on the measure.
bool follows_shape(const Tissue& tissue) {
  if (tissue.hyperelastic) return false;
  if (!tissue.lambda_law && !tissue.mu_law) return !is_constant(tissue.law);
  return !is_constant(tissue.lambda_law.value_or(ConstantLaw{})) || !is_constant(tissue.mu_law.value_or(ConstantLaw{}));
}

/// The three tets of a chain whose tissue deforms much, divided by three; P goes to the push as nine numbers, which are scaled
/// there, a symmetric stress as six that are already.
double response_flops_per_tet(const ElementFlops& f, const Tissue& tissue) {
  const ResponseFlops response = count_response_flops(tissue);
  const double fields = tissue.viscosity > 0.0 ? 2.0 : 1.0, gradient = static_cast<double>(f.gradient);
  const double once = 5.0 / 3.0 * kDifference + gradient;
  const double scaled = in_one_pass(tissue) ? (fields - 1.0) * static_cast<double>(f.stress) : 9.0;
  double sum = once * fields + static_cast<double>(response.tet) + scaled + 3.0 * static_cast<double>(f.force) + 8.0;
  if (follows_shape(tissue))
    sum += static_cast<double>(f.measure[static_cast<std::size_t>(tissue.measure)]) + laws_flops(tissue);
  // a pass of its own: gradients again, V times the change, added up at vertices (10 a chain), the mean of four (10 a chain)
  if (tissue.volume_change == VolumeChange::average_nodal)
    sum += once + static_cast<double>(response.volume) + 20.0 / 3.0;
  return sum;
}

/// Two products with a 3 × 3 tensor, four of them and the combinations where the tissue is viscous.
double edge_flops(const Tissue& tissue) {
  constexpr double kProduct = 15.0;
  const bool viscous = tissue.viscosity > 0.0;
  return viscous ? 2.0 * kDifference + 4.0 * kProduct + 18.0 + 2.0 + 18.0 : kDifference + 2.0 * kProduct;
}

std::size_t edge_count(const Submesh& part) {
  std::size_t n = 0;
  for (std::size_t batch = 0; batch < part.edges.count; ++batch) {
    const std::size_t lanes = part.edges.index.size() / (2 * part.edges.count);
    const std::uint16_t* index = part.edges.index.data() + batch * 2 * lanes;
    for (std::size_t lane = 0; lane < lanes; ++lane) n += index[lane] != index[lanes + lane] ? 1 : 0;
  }
  return n;
}

}  // namespace

double flops_per_tet(const Body& body, const Submeshes& submeshes) {
  const ElementFlops element = count_element_flops();
  std::vector<double> per_tet;  // of each tissue
  for (const TissueBlock& block : body.blocks) {
    const bool small = block.tissue.is_tensor_mass();
    per_tet.push_back(small ? chain_flops_per_tet(element, block.tissue)
                            : response_flops_per_tet(element, block.tissue));
  }
  double sum = kIntegrate * static_cast<double>(body.vertex_count);
  for (const Submesh& part : submeshes.parts) {
    const Tissue& tissue = body.blocks[part.block].tissue;
    // shared volumes narrow twice, and divide by the volume around a vertex
    const double narrows = tissue.volume_change == VolumeChange::average_nodal ? 2.0 * kNarrow + 1.0 : kNarrow;
    sum += narrows * static_cast<double>(part.local_vertices());
    sum += part.edges.count > 0 ? edge_flops(tissue) * static_cast<double>(edge_count(part))
                                : per_tet[part.block] * static_cast<double>(part.elements.size());
  }
  return sum / static_cast<double>(body.elements.size());
}

}  // namespace glisson::engine
