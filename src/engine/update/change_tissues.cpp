// change_tissues.cpp — other tissues in the submeshes of a moving body.
//
// Where the elements are, in records, submeshes and lanes, does not depend on what they are made of, but for one thing: a
// linear tissue is held by its edges, any other by its tets. So a tissue is exchanged as
//   tets → tets     moduli and laws of the block; fibre directions and room for branches
//   edges → edges   tensors of elastic edges are assembled anew; viscous ones hold none but shapes and stay
//   edges ↔ tets    the submesh is laid out anew, without the elements that are gone
#include <algorithm>
#include <atomic>
#include <cmath>

#include "element/block_response.h"
#include "engine/layout/response_batches.h"
#include "engine/submesh_body.h"
#include "engine/submesh_scratch.h"

namespace glisson::engine {

bool SubmeshBody::supports_tissues() const {
  return std::all_of(body_.blocks.begin(), body_.blocks.end(),
                     [](const TissueBlock& block) { return has_lanes(block.tissue); });
}

/// Gives a submesh what it holds of its tissue. @return whether its elements lie elsewhere now
bool SubmeshBody::refit(Submesh& part) const {
  const TissueBlock& block = body_.blocks[part.block];
  const bool by_edges = part.edges.count > 0, turns = by_edges != is_linear(block);
  part.fibre.clear(), part.memory.clear();
  if (!turns && !by_edges) {
    lay_out_response(body_, block.tissue, {}, part, kernels_.lanes);
    return false;
  }
  if (turns) {
    part.edges = {}, part.chains = {};
    std::erase_if(part.elements, [&](std::uint32_t e) { return body_.rest[e].volume == 0.0; });
  }
  lay_out(body_, submeshes_.record_of_vertex, part, kernels_.lanes);
  return turns;
}

void SubmeshBody::tissues_changed(std::span<const std::size_t> blocks, std::span<const double> nodal_damping) {
  std::vector<char> changed(body_.blocks.size(), 0), stays(body_.blocks.size(), 0);
  for (const std::size_t b : blocks) {
    const bool was_viscous = plans_[b].viscous;
    plans_[b] = plan_of(body_.blocks[b]);
    large_plans_[b] = large_plan_of(body_.blocks[b], plans_[b]);
    changed[b] = 1;
    stays[b] = was_viscous && plans_[b].viscous && is_linear(body_.blocks[b]) ? 1 : 0;
  }
  std::atomic<bool> moved = false;
  pool_.run(submeshes_.parts.size(), [&](std::size_t s, std::size_t) {
    Submesh& part = submeshes_.parts[s];
    const bool same_edges = stays[part.block] != 0 && part.edges.count > 0;
    if (changed[part.block] != 0 && !same_edges && refit(part)) moved = true;
  });
  if (moved) {
    connect(submeshes_);
    make_room();
    find_watches();
  }
  as_built_ = false;
  take_masses(nodal_damping);
}

std::vector<Sym3<double>> SubmeshBody::relaxing_stresses(std::size_t block) const {
  std::vector<Vec3d> u(body_.vertex_count), v(body_.vertex_count);
  read_state(u, v);
  return BlockResponse(body_, body_.blocks[block]).relaxing(u);
}

/// Of a body whose branches have relaxed, which it knows without numbers, writes those down.
void SubmeshBody::make_memory_explicit() {
  since_memory_ = 0.0;
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    const std::size_t n = body_.blocks[b].tissue.maxwell.size();
    if (n == 0) continue;
    set_branch_stresses(b, std::vector<Sym3<double>>((body_.blocks[b].end - body_.blocks[b].begin) * n));
  }
}

/// The memory holds m with q = m + to S, `to` of the last step (viscous_response-inl.h).
BranchMemory SubmeshBody::branch_memory(std::size_t b) const {
  const TissueBlock& block = body_.blocks[b];
  const std::vector<MaxwellBranch>& branches = block.tissue.maxwell;
  BranchMemory memory;
  if (branches.empty() || std::isinf(since_memory_)) return memory;
  for (const MaxwellBranch& branch : branches) {
    memory.left.push_back(1.0 - static_cast<double>(lane_weights(since_memory_, branch.time).to));
  }
  memory.held.resize((block.end - block.begin) * branches.size());
  for (const Submesh& part : submeshes_.parts) {
    if (part.block != b) continue;
    for_memory(part, block.tissue, kernels_.lanes, [&](std::uint32_t e, const auto& number) {
      for (std::size_t k = 0; k < branches.size(); ++k) {
        const auto m = [&](std::size_t i) { return static_cast<double>(*number(6 * k + i)); };
        memory.held[(e - block.begin) * branches.size() + k] = {m(0), m(1), m(2), m(3), m(4), m(5)};
      }
    });
  }
  return memory;
}

std::vector<Sym3<double>> SubmeshBody::branch_stresses(std::size_t b) {
  const TissueBlock& block = body_.blocks[b];
  const std::vector<MaxwellBranch>& branches = block.tissue.maxwell;
  std::vector<Sym3<double>> stresses((block.end - block.begin) * branches.size());
  const BranchMemory memory = branch_memory(b);
  if (memory.empty()) return stresses;
  const std::vector<Sym3<double>> S = relaxing_stresses(b);
  for (std::size_t i = 0; i < S.size(); ++i) {
    for (std::size_t k = 0; k < branches.size(); ++k) {
      stresses[i * branches.size() + k] = memory.stress(branches[k], i, k, S[i]);
    }
  }
  return stresses;
}

void SubmeshBody::set_branch_stresses(std::size_t b, std::span<const Sym3<double>> stresses) {
  const TissueBlock& block = body_.blocks[b];
  const std::vector<MaxwellBranch>& branches = block.tissue.maxwell;
  if (branches.empty()) return;
  if (std::isinf(since_memory_)) {
    if (std::all_of(stresses.begin(), stresses.end(), [](const auto& s) { return s == Sym3<double>{}; })) return;
    make_memory_explicit();
  }
  const std::vector<Sym3<double>> S = relaxing_stresses(b);
  for (Submesh& part : submeshes_.parts) {
    if (part.block != b) continue;
    for_memory(part, block.tissue, kernels_.lanes, [&](std::uint32_t e, const auto& number) {
      for (std::size_t k = 0; k < branches.size(); ++k) {
        const double left = 1.0 - static_cast<double>(lane_weights(since_memory_, branches[k].time).to);
        const std::size_t at = e - block.begin;
        const Sym3<double> m = S[at] * left - stresses[at * branches.size() + k] * (1.0 / branches[k].share);
        const std::array<double, 6> numbers{m.xx, m.yy, m.zz, m.xy, m.yz, m.zx};
        for (std::size_t i = 0; i < 6; ++i) *number(6 * k + i) = static_cast<float>(numbers[i]);
      }
    });
  }
}

}  // namespace glisson::engine
