// block_response.h — a tissue block as a whole at one state, in double: its stress, its stored energy, the stress its
// Maxwell branches relax, and the volume changes its tets share.
//
// For what is asked now and then (fields of a frame, a change of tissues, an account of energy); the loops that run every
// step have their own.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "element/body.h"
#include "element/branch_memory.h"
#include "material/response.h"

namespace glisson {

/// Some elements of a body, ascending: a run of them, or those of a list, which must outlive this.
class ElementList {
 public:
  explicit ElementList(const TissueBlock& block) : first_(block.begin), size_(block.end - block.begin) {}
  explicit ElementList(std::span<const std::uint32_t> list) : size_(list.size()), list_(list) {}
  std::size_t size() const { return size_; }
  std::size_t operator[](std::size_t i) const { return list_.empty() ? first_ + i : list_[i]; }

 private:
  std::size_t first_ = 0, size_;
  std::span<const std::uint32_t> list_;
};

/// Mean of the listed elements around each vertex, weighted by volume.
/// @param per_element  of all elements of the body
std::vector<double> vertex_means(const Body& body, const ElementList& elements, const std::vector<double>& per_element);
/// Replaces the value of each element of a block by the mean of those of its vertices.
void average(const Body& body, const TissueBlock& block, std::vector<double>& per_element);

class BlockResponse {
 public:
  /// @param body, @param block  must outlive this
  BlockResponse(const Body& body, const TissueBlock& block) : BlockResponse(body, block, ElementList(block)) {}
  /// The response of some elements of the block alone, with the volume changes of those they share vertices with.
  /// @param wanted  none may belong to another block
  BlockResponse(const Body& body, const TissueBlock& block, const ElementList& wanted);

  /// P of every wanted element [Pa], of which the forces follow: f_a = −V P s_a. Elastic, Kelvin–Voigt's and what
  /// the Maxwell branches have not relaxed, with the shared volume change where the tissue has one; of the linear law its share.
  /// @param v  velocity [m/s]
  std::vector<Mat3d> piola(std::span<const Vec3d> u, std::span<const Vec3d> v, const BranchMemory& memory) const;
  /// Energy of the elastic forces [J], Response::relaxed_energy over the wanted elements. @param memory  none: of the tissue's own
  /// law alone
  double energy(std::span<const Vec3d> u, const BranchMemory* memory = nullptr) const;
  bool stores_energy() const { return response_.stores_energy(); }
  /// S, of which each branch relaxes its share, of every wanted element [Pa].
  std::vector<Sym3<double>> relaxing(std::span<const Vec3d> u) const;

 private:
  bool shared() const { return block_.tissue.volume_change == VolumeChange::average_nodal; }
  std::vector<double> volume_changes(std::span<const Vec3d> u) const;
  template <class Visit>
  void for_elastic(std::span<const Vec3d> u, const Visit& visit) const;
  ElementList around() const { return around_.empty() ? wanted_ : ElementList(around_); }

  const Body& body_;
  const TissueBlock& block_;
  Response response_;
  std::optional<Response> linear_;  ///< of the linear law, where there is one
  ElementList wanted_;
  std::vector<std::uint32_t>
      around_;  ///< of part of a block with shared volume change: all that share a vertex with it
};

}  // namespace glisson
