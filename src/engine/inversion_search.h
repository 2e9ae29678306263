// inversion_search.h — finds the tets with J ≤ 0 of the submeshes.
//
// Where a tissue's gradients are formed, the lanes tell which blocks may have some. A linear submesh has edges only; |H| < 1
// leaves no room for J ≤ 0. Beyond that it is looked over at once, then every kInversionPeriod steps, and at each step while it
// has some.
#pragma once

#include "engine/kernels/kernels.h"
#include "engine/layout/submesh.h"
#include "engine/vertex_records.h"
#include "glisson/archive.h"

namespace glisson::engine {

class InversionSearch {
 public:
  /// @param body, @param submeshes, @param records  must outlive this @param lanes  of the kernels
  InversionSearch(const Body& body, const Submeshes& submeshes, const VertexRecords& records, std::size_t lanes)
      : body_(body), submeshes_(submeshes), records_(records), lanes_(lanes) {}

  /// Forgets what was seen.
  void reset() { looked_.assign(submeshes_.parts.size(), Looked::small); }
  /// Whether a linear submesh is to be looked over.
  /// @param longest_edge_squared  largest squared displacement difference of an edge [m²]
  /// @param steps  made so far @param moves  whether this is a step, which is then remembered
  bool is_due(std::size_t submesh, float longest_edge_squared, std::uint64_t steps, bool moves);
  /// A submesh has some.
  void found_in(std::size_t submesh) { looked_[submesh] = Looked::inverted; }

  /// Lists those of some elements that have J ≤ 0, as tets of the mesh.
  void list(std::span<const std::uint32_t> elements, std::vector<std::uint32_t>& inverted) const;
  /// The same of n batches whose gradients are in a block and whose lanes have found some.
  void list(const ChainBatches& chains, std::size_t batch, std::size_t n, const Block& block,
            std::vector<std::uint32_t>& inverted) const;

  void archive(Archive& ar);

 private:
  /// What the last look at a linear submesh told: gradients below 1, above, or J ≤ 0.
  enum class Looked : char { small, large, inverted };

  const Body& body_;
  const Submeshes& submeshes_;
  const VertexRecords& records_;
  std::size_t lanes_;
  std::vector<Looked> looked_;  ///< per submesh
};

}  // namespace glisson::engine
