// maxwell_memory.h — what the Maxwell branches of submeshes hold of their past, as it is asked for and set from outside; the
// kernels go on with it themselves (viscous_response-inl.h, branch_pace-inl.h).
//
// Between steps it is that of the last one: some time has passed since, over which each branch is followed first. A state that
// was set has relaxed, which is known without numbers.
#pragma once

#include <limits>

#include "element/branch_memory.h"
#include "engine/kernels/response_kernels.h"
#include "engine/layout/submesh.h"
#include "engine/vertex_records.h"
#include "glisson/archive.h"

namespace glisson::engine {

class MaxwellMemory {
 public:
  /// @param body, @param submeshes, @param records  must outlive this @param lanes  for which the submeshes are laid out
  MaxwellMemory(const Body& body, Submeshes& submeshes, const VertexRecords& records, std::size_t lanes)
      : body_(body), submeshes_(submeshes), records_(records), lanes_(lanes) {}

  /// Time since the memory was kept [s]; infinite: the branches have relaxed.
  double since() const { return since_; }
  /// A step of h > 0 [s] has been made, at whose beginning the memory was kept.
  void passed(double h) { since_ = h; }
  void relax() { since_ = std::numeric_limits<double>::infinity(); }

  /// MovingBody::branch_memory, branch_stresses, set_branch_stresses
  BranchMemory of_block(std::size_t block) const;
  std::vector<Sym3<double>> stresses(std::size_t block) const;
  void set_stresses(std::size_t block, std::span<const Sym3<double>> stresses);

  /// A submesh becomes linear after a step of h [s]: from then on its memory holds q, of the beginning of that step.
  void enter_linear(Submesh& part, double h) const;
  /// One that was linear and was looked at in that step is so no more.
  void leave_linear(Submesh& part, double h) const;
  /// The same at any time, of some elements of one. @param elements  ascending
  void leave_linear(Submesh& part, std::span<const std::uint32_t> elements) const;

  void archive_time(Archive& ar) { ar(since_); }
  /// The numbers of all elements, in their order.
  void archive_numbers(Archive& ar);
  /// S of the last look, of adaptive precision, likewise.
  void archive_stresses(Archive& ar);

 private:
  template <class Visit>
  void for_branches(Submesh& part, const Visit& visit) const;
  std::vector<LaneWeights> weights_of(const Submesh& part, double time) const;
  void list_linear(std::size_t block, BranchMemory& memory) const;
  void hold_linear(const Submesh& part, BranchMemory& memory) const;
  std::vector<double> measures(std::size_t block) const;
  std::vector<Sym3<double>> relaxing_stresses(std::size_t block) const;
  void follow_branches(std::size_t block, BranchMemory& memory) const;
  void make_explicit();

  const Body& body_;
  Submeshes& submeshes_;
  const VertexRecords& records_;
  std::size_t lanes_;
  double since_ = 0.0;
};

}  // namespace glisson::engine
