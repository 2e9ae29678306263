// tet_complex.h — a tetrahedral mesh that changes: tets come and go, vertices move, and a trial can be taken back.
//
// Each vertex knows its tets; all else (faces, rings of edges) is found from these short lists. While a trial is open every
// change is noted, so that it can be undone in reverse order.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "glisson/mesh.h"

namespace glisson::lattice {

using Label = std::uint8_t;
inline constexpr Label kNone = 255;       ///< of a tet that is no more
inline constexpr Label kUndecided = 254;  ///< not yet given to a region
using Mask = std::uint64_t;               ///< a set of labels

inline constexpr Mask bit(Label label) { return label == kUndecided ? Mask{1} << 63 : Mask{1} << label; }

/// The tets around an edge (u, v) in order: tet i has the vertices u, v, ring[i], ring[i + 1] and positive volume.
struct EdgeRing {
  std::vector<std::uint32_t> ring, tets;
  bool closed = false;  ///< then ring has as many entries as tets, else one more
  bool simple = false;  ///< the tets form one chain
};

class TetComplex {
 public:
  std::vector<Vec3d> points;
  std::vector<Tet> tets;
  std::vector<Label> labels;                      ///< of tets
  std::vector<std::vector<std::uint32_t>> stars;  ///< tets at each vertex
  std::vector<Mask> masks;                        ///< labels that meet at each vertex, with those of what is empty
  std::vector<double> edges;                      ///< length of edges asked for at each vertex [m]

  /// @param edge  length of edges asked for there [m]
  std::uint32_t add_vertex(const Vec3d& point, double edge);
  std::uint32_t add_tet(const Tet& tet, Label label);
  void remove_tet(std::uint32_t tet);
  void move(std::uint32_t vertex, const Vec3d& to);
  void set_mask(std::uint32_t vertex, Mask mask);

  bool alive(std::uint32_t tet) const { return labels[tet] != kNone; }
  bool has(std::uint32_t tet, std::uint32_t vertex) const {
    const Tet& t = tets[tet];
    return t[0] == vertex || t[1] == vertex || t[2] == vertex || t[3] == vertex;
  }

  /// Length of edges asked for in the middle of an edge, of a tet [m]. Exact where all are equal.
  double edge_between(std::uint32_t u, std::uint32_t v) const { return 0.5 * (edges[u] + edges[v]); }
  double edge_in(const Tet& t) const { return 0.25 * ((edges[t[0]] + edges[t[1]]) + (edges[t[2]] + edges[t[3]])); }

  /// The tet across the face opposite `corner`, or ~0u.
  std::uint32_t across(std::uint32_t tet, std::size_t corner) const;
  EdgeRing edge_ring(std::uint32_t u, std::uint32_t v) const;
  /// Labels of the tets at an edge.
  Mask labels_at_edge(std::uint32_t u, std::uint32_t v) const;
  Mask labels_at(std::uint32_t vertex) const;
  /// Vertices joined to `vertex` by an edge, ascending.
  void neighbours(std::uint32_t vertex, std::vector<std::uint32_t>& out) const;

  /// Cuts an edge at a new vertex. @return the vertex
  std::uint32_t split_edge(std::uint32_t u, std::uint32_t v, const Vec3d& at);

  /// Counts the changes that stay; `changed[v]` is its value when a tet at v or a neighbour of v last changed.
  std::uint32_t clock = 1;
  std::vector<std::uint32_t> changed;

  // A trial: what happens between begin() and keep() or take_back().
  void begin();
  void keep();
  void take_back();
  /// Live tets that the open trial added or of which it moved a vertex; may hold one twice.
  void touched(std::vector<std::uint32_t>& out) const;

 private:
  struct Change {
    enum class Kind : std::uint8_t { vertex, added, removed, moved, mask } kind;
    Label label;
    std::uint32_t index;
    Tet tet;
    Vec3d point;
    Mask mask;
  };
  void note_tet(const Tet& tet);
  void note_move(std::uint32_t vertex);

  std::vector<std::uint32_t> free_;
  std::vector<Change> log_;
  bool trying_ = false;
};

/// The other two corners of a tet with corners i and j, so that (i, j, k, l) is an even permutation.
inline constexpr std::array<std::array<std::array<std::uint8_t, 2>, 4>, 4> kOthers{{
    {{{0, 0}, {2, 3}, {3, 1}, {1, 2}}},
    {{{3, 2}, {0, 0}, {0, 3}, {2, 0}}},
    {{{1, 3}, {3, 0}, {0, 0}, {0, 1}}},
    {{{2, 1}, {0, 2}, {1, 0}, {0, 0}}},
}};

}  // namespace glisson::lattice
