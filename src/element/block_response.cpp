#include "element/block_response.h"

#include <cmath>

#include "element/element_shape.h"
#include "glisson/material/linear_law.h"

namespace glisson {

std::vector<double> vertex_means(const Body& body, const ElementList& elements,
                                 const std::vector<double>& per_element) {
  std::vector<double> sum(body.vertex_count, 0.0), volume(body.vertex_count, 0.0);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::size_t e = elements[i];
    for (const std::uint32_t v : body.elements[e]) {
      sum[v] += body.rest[e].volume * per_element[e];
      volume[v] += body.rest[e].volume;
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = volume[v] > 0.0 ? sum[v] / volume[v] : 0.0;
  return sum;
}

void average(const Body& body, const TissueBlock& block, std::vector<double>& per_element) {
  const std::vector<double> at = vertex_means(body, ElementList(block), per_element);
  for (std::size_t e = block.begin; e < block.end; ++e) {
    const Tet& t = body.elements[e];
    per_element[e] = 0.25 * (at[t[0]] + at[t[1]] + at[t[2]] + at[t[3]]);
  }
}

BlockResponse::BlockResponse(const Body& body, const TissueBlock& block, const ElementList& wanted)
    : body_(body), block_(block), response_(block.tissue), wanted_(wanted) {
  if (has_linear_law(block.tissue)) linear_.emplace(linear_law(block.tissue));
  if (!shared() || wanted.size() == block.end - block.begin) return;
  std::vector<char> near(body.vertex_count, 0);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    for (const std::uint32_t v : body.elements[wanted[i]]) near[v] = 1;
  }
  for (std::size_t e = block.begin; e < block.end; ++e) {
    const Tet& t = body.elements[e];
    if (near[t[0]] + near[t[1]] + near[t[2]] + near[t[3]] > 0) around_.push_back(static_cast<std::uint32_t>(e));
  }
}

/// ϑ of each element around those wanted, 0 of the others.
std::vector<double> BlockResponse::volume_changes(std::span<const Vec3d> u) const {
  std::vector<double> theta(body_.elements.size(), 0.0);
  const ElementList elements = around();
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::size_t e = elements[i];
    theta[e] = response_.volume_change(element_gradient(body_, e, u));
  }
  return theta;
}

double BlockResponse::energy(std::span<const Vec3d> u, const BranchMemory* memory) const {
  const std::vector<double> at =
      shared() ? vertex_means(body_, around(), volume_changes(u)) : std::vector<double>{};  // ϑ_a of each vertex
  double sum = 0.0;
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    const std::size_t e = wanted_[i];
    if (!(body_.rest[e].volume > 0.0)) continue;
    double square = 0.0;
    if (shared()) {
      for (const std::uint32_t v : body_.elements[e]) square += 0.25 * at[v] * at[v];
    }
    const double root = std::sqrt(square), share = memory != nullptr ? memory->linear_share(e - block_.begin) : 0.0;
    const Mat3d H = element_gradient(body_, e, u);
    const ElementShape shape = element_shape(body_, block_.tissue, e);
    double energy = response_.relaxed_energy(H, shape, shared() ? &root : nullptr);
    if (share > 0.0) energy += share * (linear_->energy(H, shape) - energy);
    sum += body_.rest[e].volume * energy;
  }
  return sum;
}

/// Calls `visit(i, H, P)` with the elastic P of each wanted element that is there, the i-th of them.
template <class Visit>
void BlockResponse::for_elastic(std::span<const Vec3d> u, const Visit& visit) const {
  std::vector<double> at;  // mean ϑ of each vertex
  if (shared()) at = vertex_means(body_, around(), volume_changes(u));
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    const std::size_t e = wanted_[i];
    if (!(body_.rest[e].volume > 0.0)) continue;
    const Mat3d H = element_gradient(body_, e, u);
    const Tet& t = body_.elements[e];
    const double mean = shared() ? 0.25 * (at[t[0]] + at[t[1]] + at[t[2]] + at[t[3]]) : 0.0;
    visit(i, H, response_.elastic(H, element_shape(body_, block_.tissue, e), shared() ? &mean : nullptr));
  }
}

std::vector<Mat3d> BlockResponse::piola(std::span<const Vec3d> u, std::span<const Vec3d> v,
                                        const BranchMemory& memory) const {
  const std::vector<MaxwellBranch>& branches = block_.tissue.maxwell;
  std::vector<Mat3d> stress(wanted_.size());
  for_elastic(u, [&](std::size_t i, const Mat3d& H, Mat3d P) {
    const std::size_t e = wanted_[i];
    if (!branches.empty()) {
      const Sym3<double> S = response_.relaxing(H, P);
      Sym3<double> sum = S * -response_.relaxing_share();
      for (std::size_t k = 0; k < branches.size() && !memory.empty(); ++k)
        sum += memory.stress(branches[k], e - block_.begin, k, S);
      P = glisson::sum(P, response_.carry(H, sum));
    }
    const bool drags = block_.tissue.viscosity > 0.0;
    const Mat3d rate = drags ? element_gradient(body_, e, v) : Mat3d{};
    if (drags) P = sum(P, response_.viscous(H, rate));
    stress[i] = P;
    const double share = memory.linear_share(e - block_.begin);
    if (share == 0.0) return;
    Mat3d L = linear_->elastic(H, element_shape(body_, block_.tissue, e));
    if (drags) L = sum(L, linear_->viscous(H, rate));
    stress[i] = sum(scaled(P, 1.0 - share), scaled(L, share));
  });
  return stress;
}

std::vector<Sym3<double>> BlockResponse::relaxing(std::span<const Vec3d> u) const {
  std::vector<Sym3<double>> stress(wanted_.size());
  for_elastic(u, [&](std::size_t i, const Mat3d& H, const Mat3d& P) { stress[i] = response_.relaxing(H, P); });
  return stress;
}

}  // namespace glisson
