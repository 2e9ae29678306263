#include "element/block_response.h"

#include <cmath>

#include "element/element_shape.h"

namespace glisson {

std::vector<double> vertex_means(const Body& body, const TissueBlock& block, const std::vector<double>& per_element) {
  std::vector<double> sum(body.vertex_count, 0.0), volume(body.vertex_count, 0.0);
  for (std::size_t e = block.begin; e < block.end; ++e) {
    for (const std::uint32_t v : body.elements[e]) {
      sum[v] += body.rest[e].volume * per_element[e];
      volume[v] += body.rest[e].volume;
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = volume[v] > 0.0 ? sum[v] / volume[v] : 0.0;
  return sum;
}

void average(const Body& body, const TissueBlock& block, std::vector<double>& per_element) {
  const std::vector<double> at = vertex_means(body, block, per_element);
  for (std::size_t e = block.begin; e < block.end; ++e) {
    const Tet& t = body.elements[e];
    per_element[e] = 0.25 * (at[t[0]] + at[t[1]] + at[t[2]] + at[t[3]]);
  }
}

/// ϑ of each element of the block, 0 of the others.
std::vector<double> BlockResponse::volume_changes(std::span<const Vec3d> u) const {
  std::vector<double> theta(body_.elements.size(), 0.0);
  for (std::size_t e = block_.begin; e < block_.end; ++e) {
    theta[e] = response_.volume_change(element_gradient(body_, e, u));
  }
  return theta;
}

double BlockResponse::energy(std::span<const Vec3d> u) const {
  const std::vector<double> at =
      shared() ? vertex_means(body_, block_, volume_changes(u)) : std::vector<double>{};  // ϑ_a of each vertex
  double sum = 0.0;
  for (std::size_t e = block_.begin; e < block_.end; ++e) {
    if (!(body_.rest[e].volume > 0.0)) continue;
    double square = 0.0;
    if (shared()) {
      for (const std::uint32_t v : body_.elements[e]) square += 0.25 * at[v] * at[v];
    }
    const double root = std::sqrt(square);
    sum += body_.rest[e].volume * response_.relaxed_energy(element_gradient(body_, e, u),
                                                           element_shape(body_, block_.tissue, e),
                                                           shared() ? &root : nullptr);
  }
  return sum;
}

/// Calls `visit(e, H, P)` with the elastic P of each element that is there.
template <class Visit>
void BlockResponse::for_elastic(std::span<const Vec3d> u, const Visit& visit) const {
  std::vector<double> mean;
  if (shared()) average(body_, block_, mean = volume_changes(u));
  for (std::size_t e = block_.begin; e < block_.end; ++e) {
    if (!(body_.rest[e].volume > 0.0)) continue;
    const Mat3d H = element_gradient(body_, e, u);
    visit(e, H, response_.elastic(H, element_shape(body_, block_.tissue, e), shared() ? &mean[e] : nullptr));
  }
}

std::vector<Mat3d> BlockResponse::piola(std::span<const Vec3d> u, std::span<const Vec3d> v,
                                        const BranchMemory& memory) const {
  const std::vector<MaxwellBranch>& branches = block_.tissue.maxwell;
  std::vector<Mat3d> stress(block_.end - block_.begin);
  for_elastic(u, [&](std::size_t e, const Mat3d& H, Mat3d P) {
    const std::size_t i = e - block_.begin;
    if (!branches.empty()) {
      const Sym3<double> S = response_.relaxing(H, P);
      Sym3<double> sum = S * -response_.relaxing_share();
      for (std::size_t k = 0; k < branches.size() && !memory.empty(); ++k) sum += memory.stress(branches[k], i, k, S);
      P = glisson::sum(P, response_.carry(H, sum));
    }
    if (block_.tissue.viscosity > 0.0) P = sum(P, response_.viscous(H, element_gradient(body_, e, v)));
    stress[i] = P;
  });
  return stress;
}

std::vector<Sym3<double>> BlockResponse::relaxing(std::span<const Vec3d> u) const {
  std::vector<Sym3<double>> stress(block_.end - block_.begin);
  for_elastic(
      u, [&](std::size_t e, const Mat3d& H, const Mat3d& P) { stress[e - block_.begin] = response_.relaxing(H, P); });
  return stress;
}

}  // namespace glisson
