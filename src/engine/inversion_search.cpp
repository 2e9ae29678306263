#include "engine/inversion_search.h"

#include <cmath>

#include "glisson/material/shape_measure.h"

namespace glisson::engine {
namespace {

/// A linear submesh with large gradients is looked over for inverted tets once in so many steps.
constexpr std::uint64_t kInversionPeriod = 16;

}  // namespace

bool InversionSearch::is_due(std::size_t s, float longest_edge_squared, std::uint64_t steps, bool moves) {
  const float reach = submeshes_.parts[s].gradient_reach;
  const bool large = !(longest_edge_squared * reach * reach < 1.0F);
  const bool look = large && (looked_[s] != Looked::large || (steps + s) % kInversionPeriod == 0);
  if (moves) looked_[s] = large ? Looked::large : Looked::small;
  return look;
}

void InversionSearch::list(std::span<const std::uint32_t> elements, std::vector<std::uint32_t>& inverted) const {
  for (const std::uint32_t e : elements) {
    if (e == kNoElement) continue;
    const Tet& t = body_.elements[e];
    std::array<Vec3d, 4> u;
    for (std::size_t a = 0; a < 4; ++a) u[a] = records_.displacement(submeshes_.record_of_vertex[t[a]]);
    const Mat3d H = displacement_gradient<double>(body_.rest[e].s, {u[1] - u[0], u[2] - u[0], u[3] - u[0]});
    if (!(jacobian(H) > 0.0)) inverted.push_back(body_.mesh_tet[e]);
  }
}

/// Floats tell the few from which they cannot be told.
void InversionSearch::list(const ChainBatches& chains, std::size_t batch, std::size_t n, const Block& block,
                           std::vector<std::uint32_t>& inverted) const {
  constexpr float kUnsure = 1e-4F;  // J of floats is off by some 1e-6 (1 + ‖H‖²)^(3/2)
  const std::span<const std::uint32_t> elements = chains.elements_of(batch, n);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const float* at = block.gradient + i / lanes_ * 9 * lanes_ + i % lanes_;
    Mat3<float> H;
    for (std::size_t k = 0; k < 9; ++k) H(k / 3, k % 3) = at[k * lanes_];
    const float size = 1.0F + squared_norm(H);
    if (!(jacobian(H) > kUnsure * size * std::sqrt(size))) list(elements.subspan(i, 1), inverted);
  }
}

void InversionSearch::archive(Archive& ar) {
  std::vector<std::uint8_t> looked;
  for (const Looked l : looked_) looked.push_back(static_cast<std::uint8_t>(l));
  ar.all_below(looked, 1 + static_cast<std::size_t>(Looked::inverted));
  for (std::size_t p = 0; ar.reads() && p < looked_.size(); ++p) {
    looked_[p] = looked.size() == looked_.size() ? static_cast<Looked>(looked[p]) : Looked::inverted;
  }
}

}  // namespace glisson::engine
