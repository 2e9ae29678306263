#include "engine/maxwell_memory.h"

#include <algorithm>
#include <cmath>

#include "element/block_response.h"
#include "element/element_shape.h"
#include "engine/layout/response_batches.h"

namespace glisson::engine {
namespace {

/// The tensor in the six numbers of a memory from the i-th on.
Sym3<double> tensor_at(const auto& number, std::size_t i) {
  const auto m = [&](std::size_t k) { return static_cast<double>(*number(i + k)); };
  return {m(0), m(1), m(2), m(3), m(4), m(5)};
}
void put_tensor(const Sym3<double>& a, const auto& number, std::size_t i) {
  const std::array<double, 6> numbers{a.xx, a.yy, a.zz, a.xy, a.yz, a.zx};
  for (std::size_t k = 0; k < 6; ++k) *number(i + k) = static_cast<float>(numbers[k]);
}

}  // namespace

/// The tissue's measure of each element of a block.
std::vector<double> MaxwellMemory::measures(std::size_t b) const {
  const TissueBlock& block = body_.blocks[b];
  const Response response(block.tissue);
  const std::vector<Vec3d> u = records_.displacements(submeshes_.record_of_vertex);
  std::vector<double> x;
  for (std::size_t e = block.begin; e < block.end; ++e) {
    x.push_back(
        response.measure(element_gradient(body_, e, std::span<const Vec3d>(u)), element_shape(body_, block.tissue, e)));
  }
  return x;
}

std::vector<Sym3<double>> MaxwellMemory::relaxing_stresses(std::size_t block) const {
  return BlockResponse(body_, body_.blocks[block]).relaxing(records_.displacements(submeshes_.record_of_vertex));
}

/// Of a body whose branches have relaxed, which it knows without numbers, writes those down.
void MaxwellMemory::make_explicit() {
  since_ = 0.0;
  for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
    const std::size_t n = body_.blocks[b].tissue.maxwell.size();
    if (n == 0) continue;
    set_stresses(b, std::vector<Sym3<double>>((body_.blocks[b].end - body_.blocks[b].begin) * n));
  }
}

/// Of branches whose times follow the deformation, from their overstress o, S and 1/τ when the memory was kept:
///   S − q = e^(−ξ) o + ½ (1 + e^(−ξ)) (S − S₀)        (branch_pace-inl.h)
void MaxwellMemory::follow_branches(std::size_t b, BranchMemory& memory) const {
  const TissueBlock& block = body_.blocks[b];
  const std::size_t n = memory.branches;
  const Response response(block.tissue);
  const std::vector<double> x = measures(b);
  for (const Submesh& part : submeshes_.parts) {
    if (part.block != b) continue;
    for_memory(part, block.tissue, lanes_, [&](std::uint32_t e, const auto& number) {
      const std::size_t at = e - block.begin;
      const Sym3<double> before = tensor_at(number, 6 * n);
      for (std::size_t k = 0; k < n; ++k) {
        const auto pace = static_cast<double>(*number(6 * n + 6 + k));
        const BranchWeights<> w = response.paces().weights(k, since_, pace, x[at], StepKind::central_difference);
        memory.left[at * n + k] = 1.0 - w.to;
        memory.held[at * n + k] = before * (1.0 - w.to) - tensor_at(number, 6 * k) * w.decay;
      }
    });
  }
}

/// The memory holds m with q = m + to S, `to` of the last step (viscous_response-inl.h).
BranchMemory MaxwellMemory::of_block(std::size_t b) const {
  const TissueBlock& block = body_.blocks[b];
  const std::vector<MaxwellBranch>& branches = block.tissue.maxwell;
  BranchMemory memory;
  list_linear(b, memory);
  if (branches.empty() || std::isinf(since_)) return memory;
  const std::size_t n = branches.size();
  memory.branches = n;
  memory.held.resize((block.end - block.begin) * n), memory.left.resize(memory.held.size());
  if (block.tissue.relaxation_follows()) {
    follow_branches(b, memory);
    return memory;
  }
  std::vector<double> left;
  for (const MaxwellBranch& branch : branches) {
    left.push_back(1.0 - static_cast<double>(lane_weights(since_, branch.time).to));
  }
  for (const Submesh& part : submeshes_.parts) {
    if (part.block != b) continue;
    if (part.linear.alone()) {
      hold_linear(part, memory);
      continue;
    }
    for_memory(part, block.tissue, lanes_, [&](std::uint32_t e, const auto& number) {
      for (std::size_t k = 0; k < n; ++k) {
        memory.held[(e - block.begin) * n + k] = tensor_at(number, 6 * k);
        memory.left[(e - block.begin) * n + k] = left[k];
      }
    });
  }
  return memory;
}

/// Says which elements of a block are linear.
void MaxwellMemory::list_linear(std::size_t b, BranchMemory& memory) const {
  const TissueBlock& block = body_.blocks[b];
  for (const Submesh& part : submeshes_.parts) {
    if (part.block != b || part.linear.share == 0.0) continue;
    memory.linear.resize(block.end - block.begin, 0.0);
    for (const std::uint32_t e : part.elements) memory.linear[e - block.begin] = part.linear.share;
  }
}

/// What the branches of a linear submesh hold: q = decay q₀ + from S₀ + to S.
void MaxwellMemory::hold_linear(const Submesh& part, BranchMemory& memory) const {
  const TissueBlock& block = body_.blocks[part.block];
  const std::vector<LaneWeights> w = weights_of(part, part.linear.since);
  for_linear_memory(part, block.tissue, lanes_, [&](std::uint32_t e, const auto& number, const auto& stress) {
    for (std::size_t k = 0; k < w.size(); ++k) {
      const std::size_t at = (e - block.begin) * w.size() + k;
      memory.held[at] = tensor_at(number, 6 * k) * double(w[k].decay) + tensor_at(stress, 0) * double(w[k].from);
      memory.left[at] = 1.0 - double(w[k].to);
    }
  });
}

/// Weights of a submesh's branches over a time [s].
std::vector<LaneWeights> MaxwellMemory::weights_of(const Submesh& part, double time) const {
  std::vector<LaneWeights> weights;
  for (const MaxwellBranch& branch : body_.blocks[part.block].tissue.maxwell) {
    weights.push_back(lane_weights(time, branch.time));
  }
  return weights;
}

std::vector<Sym3<double>> MaxwellMemory::stresses(std::size_t b) const {
  const TissueBlock& block = body_.blocks[b];
  const std::vector<MaxwellBranch>& branches = block.tissue.maxwell;
  std::vector<Sym3<double>> stresses((block.end - block.begin) * branches.size());
  const BranchMemory memory = of_block(b);
  if (memory.empty()) return stresses;
  const std::vector<Sym3<double>> S = relaxing_stresses(b);
  for (std::size_t i = 0; i < S.size(); ++i) {
    for (std::size_t k = 0; k < branches.size(); ++k) {
      stresses[i * branches.size() + k] = memory.stress(branches[k], i, k, S[i]);
    }
  }
  return stresses;
}

void MaxwellMemory::set_stresses(std::size_t b, std::span<const Sym3<double>> stresses) {
  const TissueBlock& block = body_.blocks[b];
  const std::vector<MaxwellBranch>& branches = block.tissue.maxwell;
  if (branches.empty()) return;
  if (std::isinf(since_)) {
    if (std::all_of(stresses.begin(), stresses.end(), [](const auto& s) { return s == Sym3<double>{}; })) return;
    make_explicit();
  }
  const std::vector<Sym3<double>> S = relaxing_stresses(b);
  const bool follows = block.tissue.relaxation_follows();
  const Response response(block.tissue);
  const std::vector<double> x = follows ? measures(b) : std::vector<double>{};
  const std::size_t n = branches.size();
  for (Submesh& part : submeshes_.parts) {
    if (part.block != b) continue;
    for_memory(part, block.tissue, lanes_, [&](std::uint32_t e, const auto& number) {
      const std::size_t at = e - block.begin;
      for (std::size_t k = 0; k < n; ++k) {
        const Sym3<double> over = stresses[at * n + k] * (1.0 / branches[k].share);
        if (follows) {
          put_tensor(over, number, 6 * k);
          // as much slower as it is faster now: no time has passed for the branch
          *number(6 * n + 6 + k) = -static_cast<float>(response.paces().at(k, x[at]));
        } else {
          const double left = 1.0 - static_cast<double>(lane_weights(since_, branches[k].time).to);
          put_tensor(S[at] * left - over, number, 6 * k);
        }
      }
      if (follows) put_tensor(S[at], number, 6 * n);
    });
  }
}

/// Calls `visit(number of the memory, of S)` for all numbers of a submesh's branches.
template <class Visit>
void MaxwellMemory::for_branches(Submesh& part, const Visit& visit) const {
  const std::size_t n = body_.blocks[part.block].tissue.maxwell.size(), each = 6 * lanes_;
  for (std::size_t i = 0; n > 0 && i < part.chains.element.size() / lanes_; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t j = 0; j < each; ++j) {
        visit(k, part.memory[(i * n + k) * each + j], part.linear.stress[i * each + j]);
      }
    }
  }
}

/// m = decay q + from S, backward.
void MaxwellMemory::enter_linear(Submesh& part, double h) const {
  constexpr float kGone = 1e-3F;  // of a step so long q is all but S
  part.linear.since = h;
  const std::vector<LaneWeights> w = weights_of(part, h);
  for_branches(
      part, [&](std::size_t k, float& m, float S) { m = w[k].decay > kGone ? (m - w[k].from * S) / w[k].decay : S; });
}

void MaxwellMemory::leave_linear(Submesh& part, double h) const {
  const std::vector<LaneWeights> w = weights_of(part, h);
  for_branches(part, [&](std::size_t k, float& m, float S) { m = w[k].decay * m + w[k].from * S; });
}

/// m = q − to S with q, S of now.
void MaxwellMemory::leave_linear(Submesh& part, std::span<const std::uint32_t> elements) const {
  const TissueBlock& block = body_.blocks[part.block];
  const std::size_t n = block.tissue.maxwell.size();
  if (n == 0) return;
  const std::vector<Sym3<double>> now =
      BlockResponse(body_, block, ElementList(elements)).relaxing(records_.displacements(submeshes_.record_of_vertex));
  const std::vector<LaneWeights> on = weights_of(part, part.linear.since), to = weights_of(part, since_);
  for_linear_memory(part, block.tissue, lanes_, [&](std::uint32_t e, const auto& number, const auto& stress) {
    const auto at = std::lower_bound(elements.begin(), elements.end(), e);
    if (at == elements.end() || *at != e) return;
    const Sym3<double>& S = now[static_cast<std::size_t>(at - elements.begin())];
    const Sym3<double> then = tensor_at(stress, 0);
    for (std::size_t k = 0; k < n; ++k) {
      const Sym3<double> q =
          tensor_at(number, 6 * k) * double(on[k].decay) + then * double(on[k].from) + S * double(on[k].to);
      put_tensor(q - S * double(to[k].to), number, 6 * k);
    }
  });
}

void MaxwellMemory::archive_stresses(Archive& ar) {
  std::vector<std::vector<float>> stress;
  for (const TissueBlock& block : body_.blocks) {
    stress.emplace_back(block.tissue.maxwell.empty() ? 0 : 6 * (block.end - block.begin), 0.0F);
  }
  const auto for_all = [&](const auto& visit) {
    for (Submesh& part : submeshes_.parts) {
      const TissueBlock& block = body_.blocks[part.block];
      if (block.tissue.maxwell.empty()) continue;
      const std::size_t numbers = part.chains.element.size() * 6;
      if (ar.reads()) part.linear.stress.resize(numbers, 0.0F);
      if (part.linear.stress.size() != numbers) continue;  // never by the linear law: all 0
      for_linear_memory(part, block.tissue, lanes_, [&](std::uint32_t e, const auto&, const auto& number) {
        for (std::size_t i = 0; i < 6; ++i) visit(*number(i), stress[part.block][(e - block.begin) * 6 + i]);
      });
    }
  };
  if (!ar.reads()) for_all([](float here, float& kept) { kept = here; });
  for (std::vector<float>& numbers : stress) ar.same_size(numbers);
  if (ar.reads()) for_all([](float& here, float kept) { here = kept; });
}

void MaxwellMemory::archive_numbers(Archive& ar) {
  std::vector<std::vector<float>> memory;
  for (const TissueBlock& block : body_.blocks) {
    memory.emplace_back((block.end - block.begin) * memory_numbers(block.tissue), 0.0F);
  }
  const auto for_all = [&](const auto& visit) {
    for (Submesh& part : submeshes_.parts) {
      const TissueBlock& block = body_.blocks[part.block];
      const std::size_t n = memory_numbers(block.tissue);
      for_memory(part, block.tissue, lanes_, [&](std::uint32_t e, const auto& number) {
        for (std::size_t i = 0; i < n; ++i) visit(*number(i), memory[part.block][(e - block.begin) * n + i]);
      });
    }
  };
  if (!ar.reads()) for_all([](float here, float& kept) { kept = here; });
  for (std::vector<float>& numbers : memory) ar.same_size(numbers);
  if (ar.reads()) for_all([](float& here, float kept) { here = kept; });
}

}  // namespace glisson::engine
