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

std::vector<Vec3d> MaxwellMemory::displacements() const {
  std::vector<Vec3d> u;
  for (const std::uint32_t record : submeshes_.record_of_vertex) u.push_back(records_.displacement(record));
  return u;
}

/// The tissue's measure of each element of a block.
std::vector<double> MaxwellMemory::measures(std::size_t b) const {
  const TissueBlock& block = body_.blocks[b];
  const Response response(block.tissue);
  const std::vector<Vec3d> u = displacements();
  std::vector<double> x;
  for (std::size_t e = block.begin; e < block.end; ++e) {
    x.push_back(
        response.measure(element_gradient(body_, e, std::span<const Vec3d>(u)), element_shape(body_, block.tissue, e)));
  }
  return x;
}

std::vector<Sym3<double>> MaxwellMemory::relaxing_stresses(std::size_t block) const {
  return BlockResponse(body_, body_.blocks[block]).relaxing(displacements());
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
    for_memory(part, block.tissue, lanes_, [&](std::uint32_t e, const auto& number) {
      for (std::size_t k = 0; k < n; ++k) {
        memory.held[(e - block.begin) * n + k] = tensor_at(number, 6 * k);
        memory.left[(e - block.begin) * n + k] = left[k];
      }
    });
  }
  return memory;
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
