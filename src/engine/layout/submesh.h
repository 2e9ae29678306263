// submesh.h — a body cut into submeshes: what layout.h draws, as data.
#pragma once

#include <cstdint>
#include <limits>
#include <new>
#include <span>
#include <vector>

#include "element/body.h"
#include "engine/layout/layout.h"

namespace glisson::engine {

/// Memory for vectors of lanes: whole cache lines.
template <class T>
struct CacheLines {
  using value_type = T;
  static constexpr std::align_val_t kAlignment{64};
  CacheLines() = default;
  template <class U>
  explicit CacheLines(const CacheLines<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kAlignment)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, kAlignment); }
  bool operator==(const CacheLines&) const = default;
};
template <class T>
using LaneVector = std::vector<T, CacheLines<T>>;

inline constexpr std::uint32_t kNoElement = std::numeric_limits<std::uint32_t>::max();

/// Chains of tets in batches. Batches 2 i and 2 i + 1 for i < pairs are the two chains of fans.
struct ChainBatches {
  std::size_t count = 0;               ///< batches
  std::size_t pairs = 0;               ///< pairs of batches that hold fans
  std::size_t closed_pairs = 0;        ///< of these the first ones, whose fans are all closed
  LaneVector<std::uint16_t> index;     ///< [batch][6][lane]
  LaneVector<float> rest;              ///< [batch][24][lane]: products of edges at rest [m²], 1/6V [1/m³]
  std::vector<std::uint32_t> element;  ///< [batch][3 tets][lane]: element of the body, kNoElement where none is

  /// Elements of n batches.
  std::span<const std::uint32_t> elements_of(std::size_t batch, std::size_t n) const {
    const std::size_t each = element.size() / count;
    return std::span(element).subspan(batch * each, n * each);
  }
};

/// Edges of a linear tissue in batches (edge_stages-inl.h).
struct EdgeBatches {
  std::size_t count = 0;
  LaneVector<std::uint16_t> index;  ///< [batch][2][lane]
  LaneVector<float> tensor;         ///< [batch][9][lane]
};

/// The linear law of a submesh of another tissue, by which it moves while its deformation is small (precision_choice.h).
struct LinearForm {
  bool wanted = false;       ///< whether its share grows, else it falls
  double share = 0.0;        ///< of the linear law in the forces, the rest is of the tissue's own [-]
  EdgeBatches edges;         ///< empty until it is used first, and after each change of the submesh
  LaneVector<float> stress;  ///< S of each tet when the submesh was looked at last, [batch][3 tets][6][lane] [Pa]
  double since = 0.0;        ///< time since then; while it is alone, the branches' memory holds their q of then [s]

  /// Whether there is nothing of the tissue's own law in the forces.
  bool alone() const { return share == 1.0; }
};

struct Submesh {
  std::size_t block = 0;                ///< tissue block of the body
  std::size_t first_interior = 0;       ///< its first record of the state
  std::size_t interior_count = 0;       ///< local vertices 0 … interior_count − 1
  std::vector<std::uint32_t> shared;    ///< records of the other local vertices
  std::size_t first_slot = 0;           ///< where its copies of them put their forces
  std::vector<std::uint32_t> elements;  ///< elements of the body
  ChainBatches chains;                  ///< empty for a linear tissue
  EdgeBatches edges;                    ///< for a linear tissue
  LaneVector<float> fibre;              ///< unit directions, [batch][3 tets][3][lane]; of a tissue with fibres
  LaneVector<float> memory;             ///< of Maxwell branches, [batch][3 tets][branch][6][lane] [Pa]
  LinearForm linear;                    ///< in place of the chains, where precision is adaptive
  std::size_t laid_out = 0;     ///< batches of chains when it was laid out; those after hold what has changed since
  float gradient_reach = 0.0F;  ///< largest Σ |s_a| of a tet [1/m]: |H| is at most this times the longest |δu|

  std::size_t local_vertices() const { return interior_count + shared.size(); }
  /// Local vertex of a state record that is one of its own.
  std::uint32_t local_of_record(std::uint32_t record) const;
};

/// Interface vertices and the slots in which submeshes leave their forces on them.
struct Interface {
  std::size_t first_record = 0;           ///< state records from here to the end are interface vertices
  std::vector<std::uint32_t> slot_begin;  ///< per interface vertex, one more than those
  std::vector<std::uint32_t> slots;       ///< ascending: in order of submesh
  std::size_t slot_count = 0;

  std::size_t size() const { return slot_begin.size() - 1; }
};

struct Submeshes {
  std::vector<Submesh> parts;
  Interface interface;
  std::vector<std::uint32_t> record_of_vertex;  ///< state record of each vertex of the mesh
};

/// Tets a submesh aims at in a body of so many: as many as possible while there are sixteen submeshes for threads, from
/// kLeastSubmesh up to where each could lose all connections and its vertices still be numbered.
/// @param changes  whether the body will be cut: kLeastSubmesh, of which one is soon laid out anew
std::size_t submesh_tets(std::size_t tets, bool changes);
inline constexpr std::size_t kLeastSubmesh = 2048;

/// @throws std::invalid_argument if a submesh has more vertices than kMaxLocalVertices
/// @param lanes  of the kernels that will run on it
Submeshes build_submeshes(const Body& body, std::size_t lanes, std::size_t target_tets = kLeastSubmesh);

/// Lays the elements of one submesh out anew; its interior range and its elements are given.
void lay_out(const Body& body, const std::vector<std::uint32_t>& record_of_vertex, Submesh& part, std::size_t lanes);
/// Assembles the edges of a submesh's linear form, where it has none. @param twin  the block with its linear law
void assemble_linear(const Body& body, const TissueBlock& twin, const std::vector<std::uint32_t>& record_of_vertex,
                     Submesh& part, std::size_t lanes);
/// Gives the submeshes their slots and the interface vertices the lists of them.
void connect(Submeshes& submeshes);

/// Bytes that a step reads or writes of a body's submeshes and state, over its tets.
double bytes_per_tet(const Submeshes& submeshes, std::size_t tets);

/// Whether the tissue is linear, so that its submeshes hold edges.
bool is_linear(const TissueBlock& block);

}  // namespace glisson::engine
