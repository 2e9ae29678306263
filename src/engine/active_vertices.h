// active_vertices.h — the vertices of a body of submeshes that supports and instruments act on, and those at rest: their forces
// and states for those who drive them, and where the tasks find them among the records that they move.
#pragma once

#include "engine/layout/submesh.h"
#include "engine/vertex_records.h"
#include "glisson/simulation/active_vertex.h"

namespace glisson::engine {

inline constexpr std::size_t kInterfaceChunk = 512;  ///< interface vertices a task

/// One of them as a task sees it.
struct LocalVertex {
  std::uint32_t local;  ///< its record, counted from the run's first
  std::uint32_t place;  ///< among all that are active, or at rest
};

/// Consecutive state records that one task moves, and those of them that are active or at rest, ascending.
struct RecordRun {
  std::size_t first, size;
  std::span<const LocalVertex> active, resting;
};

class ActiveVertices {
 public:
  /// @param submeshes, @param records  must outlive this
  ActiveVertices(const Submeshes& submeshes, const VertexRecords& records) : submeshes_(submeshes), records_(records) {}

  /// MovingBody::watch
  void add(std::span<const std::uint32_t> vertices, std::span<const std::uint32_t> apart);
  /// Takes all others from those active. @param vertices  ascending, all of them active
  void keep(std::span<const std::uint32_t> vertices);
  /// @param vertices  at rest from now on, and no others
  void rest(std::span<const std::uint32_t> vertices);
  /// Finds all of them in the submeshes and the interface, which are laid out anew.
  void locate();

  std::span<ActiveVertex> active() { return active_; }
  std::span<RestingVertex> resting() { return resting_; }
  /// A vertex that is active; null: it is not.
  ActiveVertex* find(std::uint32_t vertex);

  /// The interior vertices of a submesh.
  RecordRun interior(std::size_t submesh) const;
  /// Interface vertices from kInterfaceChunk · chunk on, so many.
  RecordRun interface(std::size_t chunk) const;
  std::size_t chunks() const { return active_in_.interface.size(); }
  /// Whether elastic and viscous forces are asked for one by one at a vertex of a submesh.
  bool asks_apart(std::size_t submesh) const { return holds_apart_[submesh] != 0; }

  /// Hands out the forces on those of a run, and the states of the active ones. @param viscous  null: `elastic` has both
  void take_forces(const RecordRun& run, const float* elastic, const float* viscous);

 private:
  /// One list for each task.
  struct Lists {
    std::vector<std::vector<LocalVertex>> interior;   ///< per submesh
    std::vector<std::vector<LocalVertex>> interface;  ///< per chunk of the interface
  };
  void sort(std::span<const std::uint32_t> records, Lists& lists) const;

  const Submeshes& submeshes_;
  const VertexRecords& records_;
  std::vector<ActiveVertex> active_;
  std::vector<RestingVertex> resting_;
  std::vector<std::uint32_t> apart_;  ///< vertices whose forces are asked for one by one, ascending
  Lists active_in_, resting_in_;
  std::vector<char> holds_apart_;  ///< per submesh: it has one of apart_
};

}  // namespace glisson::engine
