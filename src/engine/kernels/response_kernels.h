// response_kernels.h — the stages of tissues beyond the paper's: H in, first Piola–Kirchhoff stress P out.
//
//   gather H, Ḣ ──▶ [measure, law] ──▶ respond: P ──▶ fibres ──▶ Maxwell ──▶ viscous ──▶ push
//   gather H, σ_v ──▶ [measure, law] ──▶ all of it in one pass ──▶ push, where in_one_pass()
//
// A tet whose J has fallen below kSmallestVolume is answered by material/response.h instead, in double, one at a time: lanes
// hold the formulas for tissue, that one those for tets that are flat or inverted.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "element/body.h"
#include "engine/kernels/kernels.h"
#include "material/branch_weights.h"
#include "material/response.h"
#include "material/stretch_series.h"

namespace glisson::engine {

/// Values of a block between the stages, beside those of Block: items as there.
struct ResponseBlock {
  alignas(64) float piola[kBlockTets * 9];    ///< P, elastic; with Maxwell branches what is left after long times
  alignas(64) float viscous[kBlockTets * 9];  ///< P, viscous, and what the branches have not relaxed yet
  alignas(64) float ratio[kBlockTets];        ///< material/response.h, Stiffening, [item][lane]; 0 where no tet is
  alignas(64) float norm[kBlockTets];
  alignas(64) float pace[kMostBranches][kBlockTets];  ///< 1/τ of branches whose times follow the measure [1/s]
};

/// How fast a branch relaxes: 1/τ, with the law of its time where it has one.
struct LanePace {
  float plain = 0.0F;          ///< 1/τ without the law [1/s]
  std::size_t kind = 0;        ///< index in TimeLaw, or kNoTimeLaw
  std::vector<float> numbers;  ///< of the law's formula
};
inline constexpr std::size_t kNoTimeLaw = std::variant_size_v<TimeLaw>;

/// Which volume change tets share: that of the kinematics, or J − 1.
enum class VolumeKind { small, corotational, green, hyperelastic };

/// What the lanes need to know of a tissue.
struct LaneResponse {
  LaneTissue moduli;
  float rest_bound = 1.0F;                          ///< 1 over λ_max of the tangent at rest [1/Pa]
  float rest_isochoric = 1.0F, rest_volume = 1.0F;  ///< 1 over those of a hyperelastic law's two parts [1/Pa]
  float bulk = 0.0F;                                ///< κ of a hyperelastic law [Pa]
  float fibre = 0.0F;                               ///< c [Pa]
  float relaxing = 0.0F;                            ///< Σ g
  std::optional<HyperelasticLaw> law;
  std::optional<StretchSeries<float>> series;  ///< of a law of stretches, for stretches that are close to each other
  std::size_t mu_law = 0;                      ///< which of the block's two laws scales μ
  std::size_t branches = 0;                    ///< of Maxwell
  std::array<float, kMostBranches> share{};
  std::vector<LanePace> pace;  ///< of each branch; empty where all times are constant
  bool constant = true;        ///< whether no law of stiffness reads the measure
  bool small = false, deviator = true, viscous = false, pioletti = false, energy = false;
  DeformationMeasure measure{};
  VolumeKind volume = VolumeKind::small;
};

/// A branch's weights over one step: q goes on from its past by them (element/tissue_operator.cpp).
struct LaneWeights {
  float decay = 1.0F;
  float from = 0.0F, to = 0.0F;
};

/// What a stage works on.
struct ResponseItems {
  const float* gradient = nullptr;         ///< H, [item][9][lane]
  const float* rate = nullptr;             ///< Ḣ, the same
  const float* mean = nullptr;             ///< volume change of all that share it, [item][lane]; null: its own
  const float* fibre = nullptr;            ///< unit directions, [item][3][lane]
  float* memory = nullptr;                 ///< [item][number][lane], numbers as in response_batches.h
  const std::uint32_t* element = nullptr;  ///< of the body, [item][lane]; kNoElement where none is
  std::size_t items = 0;
};

/// How the stages tell of a tet that lanes do not answer.
struct Rescue {
  const Body* body = nullptr;
  const Response* response = nullptr;
};

/// @param H  of one lane, `stride` floats apart; P likewise
/// @param mean  volume change in the place of its own; null: its own
/// @return how stiff the tet is, without fibres and viscosity
Stiffening rescue(const Rescue&, std::uint32_t element, const float* H, float* P, std::size_t stride,
                  const float* mean);

/// tr(U − I) of a tet that lanes do not answer.
float rescue_stretch_sum(const float* H, std::size_t stride);

/// A step of the branches: with `previous` to the state that is asked for, with `next` on from it.
struct MaxwellStep {
  std::array<LaneWeights, kMostBranches> previous, next;
  float since = 0.0F;    ///< time since the memory was kept [s], where times of branches follow the measure
  bool relaxed = false;  ///< whether q is S: a state that was set
  bool moves = false;    ///< whether the memory goes on
};

/// P of the elastic part into `out.piola`; what the tangent has come to into `out.ratio` and `out.norm`.
/// @return whether a tet has J ≤ 0
using RespondStage = bool (*)(const ResponseItems&, const LaneResponse&, const Rescue&, const Block&,
                              ResponseBlock& out);
/// By Kinematics.
using TensorMassStages = std::array<RespondStage, 3>;
/// 1/τ of a branch at n measures.
using PaceStage = void (*)(const LanePace&, const float* x, std::size_t n, float* pace);
/// By index in TimeLaw; the last is for branches without a law.
using PaceStages = std::array<PaceStage, kNoTimeLaw + 1>;
/// By index in HyperelasticLaw.
using HyperelasticStages = std::array<RespondStage, std::variant_size_v<HyperelasticLaw>>;

/// What a pass over a block has found: the largest of out.ratio, and whether a tet has J ≤ 0, where it looked.
struct PassFound {
  float stiffest = 0.0F;
  bool inverted = false;
};
/// From H to the stresses times kForceScale, six numbers an item (relaxing_small-inl.h).
using StressPass = PassFound (*)(const ResponseItems&, const LaneResponse&, const MaxwellStep&, Block&,
                                 ResponseBlock& out);

/// Virtual work of the displacement, lane by lane [J]: of a tissue's stress, and what its linear twin adds to it.
struct WorkSeen {
  alignas(64) std::array<float, kMaxLanes> work{};
  alignas(64) std::array<float, kMaxLanes> error{};    ///< of the whole stress
  alignas(64) std::array<float, kMaxLanes> elastic{};  ///< of the elastic one
};

/// The functions of one instruction set.
struct ResponseKernels {
  std::array<TensorMassStages, 2> tensor_mass{};  ///< [moduli follow a law]
  HyperelasticStages hyperelastic{};
  /// Adds to `out.piola`; writes and adds to `out.viscous`.
  void (*fibres)(const ResponseItems&, const LaneResponse&, ResponseBlock& out) = nullptr;
  void (*maxwell)(const ResponseItems&, const LaneResponse&, const MaxwellStep&, ResponseBlock& out) = nullptr;
  /// The same for branches some of whose times follow the measure, whose paces are in `out`.
  void (*following)(const ResponseItems&, const LaneResponse&, const MaxwellStep&, ResponseBlock& out) = nullptr;
  PaceStages pace{};
  void (*viscous)(const ResponseItems&, const LaneResponse&, bool add, ResponseBlock& out) = nullptr;
  /// All of them for tissue of small strain with branches: [moduli follow a law][elastic and viscous apart].
  StressPass relaxing_small[2][2] = {};
  /// The largest of out.ratio.
  float (*stiffest)(std::size_t items, const ResponseBlock& out) = nullptr;
  /// Numbers of the tets that may be above their limits. @return how many
  std::size_t (*list_above)(std::size_t items, const ResponseBlock& out, const ListLimits&,
                            std::uint16_t* which) = nullptr;
  /// For volume changes that are shared (average_nodal-inl.h).
  void (*volume_changes)(const float* gradient, const float* rest, std::size_t items, VolumeKind kind,
                         float* out) = nullptr;
  void (*spread_to_vertices)(const std::uint16_t* index, std::size_t batches, const float* values,
                             float* vertices) = nullptr;
  void (*mean_of_vertices)(const std::uint16_t* index, std::size_t batches, const float* vertices,
                           float* values) = nullptr;
  /// For the choice of precision (compare_linear-inl.h), small strain: the branches at the state that is asked for. @param linear
  /// whether the tets are linear, so that the memory holds q, and `previous` leads there from `stress`, S of then
  void (*follow_branches)(const ResponseItems&, const LaneResponse&, const MaxwellStep&, bool linear, float* stress,
                          ResponseBlock& out) = nullptr;
  /// P of small strain as it is once all branches have relaxed.
  void (*relax_all)(const ResponseItems&, const LaneResponse&, ResponseBlock& out) = nullptr;
  /// Adds to what was seen. @param rest  of the items' chains @param late  whether `out.viscous` is part of the stress
  void (*compare_linear)(const ResponseItems&, const float* rest, const LaneTissue& twin, bool late,
                         const ResponseBlock& out, WorkSeen& seen) = nullptr;
  /// out.piola += out.viscous
  void (*merge)(std::size_t items, ResponseBlock& out) = nullptr;
};

/// Whether lanes have all that a tissue asks for; others move in double, one tet at a time.
bool has_lanes(const Tissue& tissue);
LaneResponse lane_response(const Tissue& tissue, const LaneTissue& moduli, std::size_t mu_law);
LaneWeights lane_weights(double step, double time);
/// Whether relaxing_small has all that a tissue asks for.
bool in_one_pass(const Tissue& tissue);
/// The elastic stage of a tissue.
RespondStage respond_stage(const ResponseKernels& kernels, const Tissue& tissue);

}  // namespace glisson::engine
