// shared_volumes.h — volume changes that tets share over their vertices (VolumeChange::average_nodal), summed over submeshes.
//
//   task per submesh:  ElementForces → V ϑ at its vertices     inner ones: over the volume around them, done
//                                                              shared ones: into the slot of its copy
//   then, in the pass of the forces, each submesh adds up the slots of its shared vertices that are of its tissue.
//
// Tissues do not share with each other: a vertex between two of them has a mean in each.
#pragma once

#include "engine/layout/submesh.h"

namespace glisson::engine {

class SharedVolumes {
 public:
  /// @param body, @param submeshes  must outlive this
  SharedVolumes(const Body& body, const Submeshes& submeshes) : body_(body), submeshes_(submeshes) {}

  /// Takes over tissues, tets and slots, where some tissue's tets share. Cost: O(tets).
  void weigh();
  /// Whether some tissue's tets share.
  bool any() const { return any_; }
  /// Whether those of a submesh do.
  bool shares(const Submesh& part) const {
    return body_.blocks[part.block].tissue.volume_change == VolumeChange::average_nodal;
  }
  /// Where the sums of V ϑ belong, one a local vertex.
  float* sums(std::size_t submesh) { return volumes_[submesh].theta.data(); }
  /// Takes over the sums of a submesh.
  void spread(std::size_t submesh);
  /// When all submeshes have spread theirs: ϑ of each local vertex [-].
  const float* join(std::size_t submesh);

 private:
  /// One over the volume around each local vertex, and ϑ_a.
  struct Volumes {
    std::vector<float> per_volume, theta;
  };

  const Body& body_;
  const Submeshes& submeshes_;
  bool any_ = false;
  std::vector<Volumes> volumes_;  ///< per submesh
  std::vector<float> slots_;
  std::vector<std::uint32_t> part_of_slot_;
};

}  // namespace glisson::engine
