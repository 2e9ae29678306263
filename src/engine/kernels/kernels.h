// kernels.h — the stages a submesh goes through, as functions of the instruction set chosen at run time.
//
//   narrow ──▶ [ gather ──▶ measure ──▶ law ──▶ push ] a block of batches at a time ──▶ integrate
//
// Splitting the element into stages lets the processor overlap many short dependency chains: one long loop
// body took 5.6 ns a tet where the stages take 2.6 (docs/engine.md). It also keeps laws, measures and
// viscosity apart: each is one small function, chosen when the body is built.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "element/stiff_element.h"
#include "engine/layout/layout.h"
#include "glisson/material/tissue.h"

namespace glisson::engine {

/// What a stress is multiplied by to give forces from the products of edges: −V w.
inline constexpr float kForceScale = -1.0F / 6.0F;

/// Of a limit of stiffening, what lanes compare with: rounding lists no tet too few.
inline constexpr float kBelowLimit = 1.0F - 1e-5F;

/// From which stiffening on tets are listed.
struct ListLimits {
  float block = 0.0F;                      ///< times kBelowLimit
  const StiffLimit* single = nullptr;      ///< per element; null: none
  const std::uint32_t* element = nullptr;  ///< [item][lane]
};

/// Values of a block of batches between the stages, vectors of L lanes: item i = 3 batch + (0: A, 1: B, 2: C).
struct Block {
  alignas(64) float gradient[kBlockTets * 9];  ///< H, [item][9][lane]
  alignas(64) float viscous[kBlockTets * 6];   ///< −⅙ σ_v, [item][6][lane]
  alignas(64) float x[kBlockTets];             ///< measure, [item][lane]
  alignas(64) float y[kBlockTets];             ///< see element_math-inl.h, Measured
  alignas(64) float value[2][kBlockTets];      ///< modulus of the law on E, or of those on λ and μ
  alignas(64) float slope[2][kBlockTets];      ///< its derivative by x
};

/// Moduli of a submesh's tissue, as the lanes need them.
struct LaneTissue {
  float lambda = 0, mu = 0;                  ///< what a law's value is multiplied by: [Pa], or 1 for laws on λ and μ
  float viscous_lambda = 0, viscous_mu = 0;  ///< [Pa·s]
  float bulk_over_two_mu = 0;                ///< at rest [-]
  float rest_mu = 0;                         ///< μ at rest [Pa]
};

/// Where the batches of a submesh are and where their forces go.
struct Elements {
  const float* states = nullptr;         ///< float records, kStateFloats a local vertex
  const std::uint16_t* index = nullptr;  ///< [batch][6][lane]
  const float* rest = nullptr;           ///< [batch][24][lane]
  std::size_t pairs = 0;                 ///< of batches at the front that hold fans,
  std::size_t closed_pairs = 0;          ///< of these the first ones, whose fans are closed
  float* elastic = nullptr;              ///< force records, of the whole force where that is pushed as one
  float* viscous = nullptr;
  float* pairs_of_forces = nullptr;  ///< elastic and viscous force records side by side, where they are pushed at once
  LaneTissue tissue;
  bool prefetch = false;   ///< whether rest data come from beyond the second-level cache
  std::size_t mu_law = 0;  ///< which of the block's two laws scales μ: 0 for a law on E
};

/// A law ready for lanes. One on E is taken relative to E at rest, one on λ or μ is in Pa.
struct LaneLaw {
  std::size_t kind = 0;        ///< index in StiffnessLaw
  std::vector<float> numbers;  ///< of the law's formula
};
/// @param base  modulus at rest [Pa], @param unit  in which moduli are taken [Pa]
LaneLaw lane_law(StiffnessLaw law, double base, double unit);

/// What the laws of a submesh have come to, lane by lane: stiffness + √slope_squared bounds tangent over rest stiffness.
struct StiffnessSeen {
  alignas(64) std::array<float, kMaxLanes> stiffness{};
  alignas(64) std::array<float, kMaxLanes> slope_squared{};
};

/// One law on an array: value[i] = M(x[i]) and slope[i] = M'(x[i]).
using LawStage = void (*)(const LaneLaw&, const float* x, std::size_t n, float* value, float* slope);

/// Energies per unit time of a range of vertices at a kick [W], and ½ Σ m v₋·v₊ [J].
struct VertexWork {
  double elastic_before = 0, elastic_after = 0, viscous_before = 0, viscous_after = 0;
  double damping_before = 0, damping_after = 0, loads_before = 0, loads_after = 0, kinetic = 0;
};

struct Kick {
  double step = 0;                              ///< h [s]
  alignas(32) std::array<double, 4> gravity{};  ///< [m/s²], w = 0
  const double* weighs = nullptr;               ///< per vertex: share of its mass that has weight; null: all of it
  const double* masses = nullptr;               ///< per vertex [kg]: for the books
  const double* damping = nullptr;              ///< per vertex γ [kg/s]: likewise
};

/// Force records of a run of vertices in a stage of drag.
struct DragStage {
  Kick kick;
  double tau = 0.0;  ///< share of the step
  bool first = false;
  const float* elastic = nullptr;  ///< E
  float* viscous = nullptr;        ///< V, of this stage
  float* sum = nullptr;            ///< A
};

/// A linear tissue's submesh by edges.
struct Edges {
  const float* states = nullptr;
  const std::uint16_t* index = nullptr;  ///< [batch][2][lane]
  const float* tensor = nullptr;         ///< [batch][9][lane]
  std::size_t batches = 0;
  float* elastic = nullptr;
  float* viscous = nullptr;
  LaneTissue tissue;
};

struct ResponseKernels;

/// The functions of one instruction set.
struct Kernels {
  const char* instruction_set = "";
  std::size_t lanes = 1;
  const ResponseKernels* response = nullptr;  ///< for tissues beyond the paper's (response_kernels.h)

  /// Float records of `n` vertices from consecutive state records, relative to the record `origin`.
  void (*narrow)(const double* state, const double* origin, std::size_t n, float* out) = nullptr;
  /// The same from the state records numbered by `which`.
  void (*narrow_chosen)(const double* state, const std::uint32_t* which, const double* origin, std::size_t n,
                        float* out) = nullptr;

  /// Vectors of four doubles, relative to `origin`, into the first half of float records. @param which  numbers of the vectors;
  /// null: consecutive ones
  void (*narrow_vectors)(const double* vectors, const std::uint32_t* which, const double* origin, std::size_t n,
                         float* out) = nullptr;

  /// Batches [begin, begin + n): gradients, and viscous stress where there is viscosity. Where there are fans, `begin`
  /// is even, here and in push, and n is unless they are the last.
  void (*gather_elastic)(const Elements&, std::size_t begin, std::size_t n, Block&) = nullptr;
  void (*gather_viscous)(const Elements&, std::size_t begin, std::size_t n, Block&) = nullptr;
  /// Gradients of displacement, and of velocity into `rate`, [item][9][lane].
  void (*gather_rates)(const Elements&, std::size_t begin, std::size_t n, Block&, float* rate) = nullptr;
  /// Viscous stress of the velocities in the first half of the records, for push_viscous.
  void (*gather_drag)(const Elements&, std::size_t begin, std::size_t n, Block&) = nullptr;
  /// x and y of a block. @return whether a tet has J ≤ 0
  using Measure = bool (*)(const Elements&, std::size_t begin, std::size_t n, Block&);
  std::array<Measure, 3> measure{};                               ///< by DeformationMeasure
  std::array<LawStage, std::variant_size_v<StiffnessLaw>> law{};  ///< by index in StiffnessLaw
  /// Values of a law on E into the block, by index in StiffnessLaw; what they and their slopes have come to is added to what
  /// was seen. @return whether the bound of a tet may be above the limit
  using WatchLaw = bool (*)(const LaneLaw&, Block&, std::size_t n, float limit, StiffnessSeen&);
  std::array<WatchLaw, std::variant_size_v<StiffnessLaw>> watch_law{};
  /// The same of laws on λ and μ, whose values and slopes are in the block.
  bool (*watch_lame)(const Block&, const LaneTissue&, std::size_t n, float limit, StiffnessSeen&) = nullptr;
  /// Numbers of the tets of a block whose bound may be above their limits, from the values and slopes of one law or two. @return how many
  std::size_t (*list_stiff)(const Block&, const LaneTissue&, std::size_t laws, std::size_t n, const ListLimits&,
                            std::uint16_t* which) = nullptr;
  /// Stress and forces of a block, added to the force records: the elastic ones, the viscous ones (to theirs), or
  /// both as one.
  void (*push_elastic)(const Elements&, std::size_t begin, std::size_t n, const Block&) = nullptr;
  void (*push_viscous)(const Elements&, std::size_t begin, std::size_t n, const Block&) = nullptr;
  void (*push_merged)(const Elements&, std::size_t begin, std::size_t n, const Block&) = nullptr;
  /// Forces f_a = −V P s_a of a first Piola–Kirchhoff stress P [Pa], [item][9][lane], row by row: P_ij at 3 i + j.
  /// Added to the force records `forces`: the elastic or the viscous ones.
  void (*push_piola)(const Elements&, std::size_t begin, std::size_t n, const float* piola, float* forces) = nullptr;

  /// The same of a symmetric stress times kForceScale, [item][6][lane]: xx, yy, zz, xy, yz, zx.
  void (*push_stress)(const Elements&, std::size_t begin, std::size_t n, const float* stress, float* forces) = nullptr;

  /// Elastic and viscous forces of a block at once, apart: added to `pairs_of_forces`. The stresses of the block, those of push_piola
  /// and of push_stress.
  void (*push_apart)(const Elements&, std::size_t begin, std::size_t n, const Block&) = nullptr;
  void (*push_piolas_apart)(const Elements&, std::size_t begin, std::size_t n, const float* elastic,
                            const float* viscous) = nullptr;
  void (*push_stresses_apart)(const Elements&, std::size_t begin, std::size_t n, const float* elastic,
                              const float* viscous) = nullptr;
  /// Force records of `n` vertices from pairs of them.
  void (*part_forces)(const float* pairs, std::size_t n, float* elastic, float* viscous) = nullptr;

  /// Forces of a linear submesh. @return the largest squared displacement difference of an edge [m²]
  float (*edges_elastic)(const Edges&) = nullptr;
  float (*edges_merged)(const Edges&) = nullptr;
  float (*edges_split)(const Edges&) = nullptr;

  /// A stage of drag of `n` vertices (element/drag_stages.h): V += f, A += τ V, δ = τ [c (E + V) − d (v₋ + h g) + h g], c and d from
  /// their state records. The first stage has no f, and A = τ V. @param delta  four numbers a vertex; null: none is asked for
  void (*drag)(const double* state, const DragStage&, std::size_t n, const float* force, double* delta) = nullptr;
  /// a += b, `n` floats, a multiple of 16.
  void (*add)(float* a, const float* b, std::size_t n) = nullptr;
  /// Whether all of `n` floats are finite; n is a multiple of 16.
  bool (*all_finite)(const float* values, std::size_t n) = nullptr;
  /// Forces on `n` interface vertices: out[v] = Σ slots[which[i]], i from begin[v] to begin[v + 1], in this order.
  void (*sum_slots)(const float* slots, const std::uint32_t* begin, const std::uint32_t* which, std::size_t n,
                    float* out) = nullptr;
  /// Kick and drift of `n` vertices: v₊ = v₋ + c f − d v₋ + h (1 − d) w g, u₊ = u + h v₊  [Schwartz2002, eq. 4], w the share that weighs.
  void (*integrate)(double* state, const float* force, std::size_t n, const Kick&) = nullptr;
  /// The same with elastic and viscous forces apart; the work is added to `work`. @param viscous  null: there are none
  void (*integrate_accounted)(double* state, const float* elastic, const float* viscous, std::size_t n, const Kick&,
                              VertexWork& work) = nullptr;
};

/// The kernels of the best instruction set of this processor.
const Kernels& best_kernels();
/// All that this processor can run, the best first: for tests of their equivalence.
std::vector<const Kernels*> all_kernels();

}  // namespace glisson::engine
