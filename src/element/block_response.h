// block_response.h — a tissue block as a whole at one state, in double: its stress, its stored energy, the stress its
// Maxwell branches relax, and the volume changes its tets share.
//
// For what is asked now and then (fields of a frame, a change of tissues, an account of energy); the loops that run every
// step have their own.
#pragma once

#include <span>
#include <vector>

#include "element/body.h"
#include "element/branch_memory.h"
#include "material/response.h"

namespace glisson {

/// Mean of the elements around each vertex, of one block, weighted by volume.
/// @param per_element  of all elements of the body
std::vector<double> vertex_means(const Body& body, const TissueBlock& block, const std::vector<double>& per_element);
/// Replaces each element's value by the mean of those of its vertices.
void average(const Body& body, const TissueBlock& block, std::vector<double>& per_element);

class BlockResponse {
 public:
  /// @param body, @param block  must outlive this
  BlockResponse(const Body& body, const TissueBlock& block) : body_(body), block_(block), response_(block.tissue) {}

  /// P of every element of the block [Pa], of which the forces follow: f_a = −V P s_a. Elastic, Kelvin–Voigt's and what
  /// the Maxwell branches have not relaxed, with the shared volume change where the tissue has one.
  /// @param v  velocity [m/s]
  std::vector<Mat3d> piola(std::span<const Vec3d> u, std::span<const Vec3d> v, const BranchMemory& memory) const;
  /// Energy of the elastic forces [J], Response::relaxed_energy over the block.
  double energy(std::span<const Vec3d> u) const;
  bool stores_energy() const { return response_.stores_energy(); }
  /// S, of which each branch relaxes its share, of every element of the block [Pa].
  std::vector<Sym3<double>> relaxing(std::span<const Vec3d> u) const;

 private:
  bool shared() const { return block_.tissue.volume_change == VolumeChange::average_nodal; }
  std::vector<double> volume_changes(std::span<const Vec3d> u) const;
  template <class Visit>
  void for_elastic(std::span<const Vec3d> u, const Visit& visit) const;

  const Body& body_;
  const TissueBlock& block_;
  Response response_;
};

}  // namespace glisson
