// response_flops.cpp — counts what the stages of large deformation do, by running them on numbers that remember where they
// came from.
//
// The stages are compiled here once more, with lanes that hold one such number. Of all operations those count that reach the
// forces, or the branches' memory; those that lead to the bound of the stable step alone do not, nor those on constants, which
// the compiler takes out of the loop.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <unordered_map>
#include <vector>

#include "engine/kernels/flops.h"
#include "engine/kernels/inlined.h"
#include "engine/kernels/response_kernels.h"
#include "engine/layout/response_batches.h"
#include "material/hyperelastic_formulas.h"
#include "material/stiffness_formulas.h"

#undef HWY_NAMESPACE
#define HWY_NAMESPACE N_TRACED
#undef HWY_TARGET_TOGGLE
#define GLISSON_LANES_INL_H_

namespace glisson::engine::HWY_NAMESPACE {

/// The operations so far, each with what it was done on.
struct Tape {
  struct Node {
    std::uint32_t operations, from[3];
  };
  static constexpr std::uint32_t kConstant = 0;
  std::vector<Node> nodes{{}};
  std::unordered_map<const float*, std::uint32_t> stored;

  std::uint32_t add(std::uint32_t operations, std::uint32_t a, std::uint32_t b = kConstant,
                    std::uint32_t c = kConstant) {
    if (a == kConstant && b == kConstant && c == kConstant) return kConstant;
    nodes.push_back({operations, {a, b, c}});
    return static_cast<std::uint32_t>(nodes.size() - 1);
  }
  std::uint32_t input() {
    nodes.push_back({0, {kConstant, kConstant, kConstant}});
    return static_cast<std::uint32_t>(nodes.size() - 1);
  }
  /// Operations that the numbers stored in [begin, begin + n) come from.
  std::size_t reaching(const std::vector<std::pair<const float*, std::size_t>>& outputs) const {
    std::vector<char> needed(nodes.size(), 0);
    for (const auto& [begin, n] : outputs) {
      for (std::size_t i = 0; i < n; ++i) {
        const auto found = stored.find(begin + i);
        if (found != stored.end()) needed[found->second] = 1;
      }
    }
    std::size_t sum = 0;
    for (std::size_t k = nodes.size() - 1; k > kConstant; --k) {
      if (needed[k] == 0) continue;
      sum += nodes[k].operations;
      for (const std::uint32_t from : nodes[k].from) needed[from] = 1;
    }
    return sum;
  }
};
inline thread_local Tape* tape = nullptr;

struct F {
  float value = 0.0F;
  std::uint32_t node = Tape::kConstant;
};
struct Lanes {};
inline constexpr std::size_t kLanes = 1;

inline F after(std::uint32_t operations, float value, F a, F b = {}, F c = {}) {
  return {value, tape->add(operations, a.node, b.node, c.node)};
}
inline F operator+(F a, F b) { return after(1, a.value + b.value, a, b); }
inline F operator-(F a, F b) { return after(1, a.value - b.value, a, b); }
inline F operator*(F a, F b) { return after(1, a.value * b.value, a, b); }
inline F operator/(F a, F b) { return after(1, a.value / b.value, a, b); }
inline F Set(Lanes, float value) { return {value}; }
inline F MulAdd(F a, F b, F c) { return after(2, a.value * b.value + c.value, a, b, c); }
inline F NegMulAdd(F a, F b, F c) { return after(2, c.value - a.value * b.value, a, b, c); }
inline F MulSub(F a, F b, F c) { return after(2, a.value * b.value - c.value, a, b, c); }
inline F Sqrt(F a) { return after(1, std::sqrt(a.value), a); }
inline F Abs(F a) { return after(0, std::abs(a.value), a); }
inline F Neg(F a) { return after(0, -a.value, a); }
inline F Min(F a, F b) { return after(0, std::min(a.value, b.value), a, b); }
inline F Max(F a, F b) { return after(0, std::max(a.value, b.value), a, b); }
inline bool Lt(F a, F b) { return a.value < b.value; }
inline bool Gt(F a, F b) { return a.value > b.value; }
inline bool Ge(F a, F b) { return a.value >= b.value; }
inline bool AllTrue(Lanes, bool all) { return all; }
inline bool AllFalse(Lanes, bool any) { return !any; }
/// Both are worked out in lanes.
inline F IfThenElse(bool choice, F yes, F no) { return after(0, choice ? yes.value : no.value, yes, no); }
inline F guess_inverse_cube_root(Lanes, F a) { return after(0, 1.0F / std::cbrt(a.value), a); }

namespace hn {
using N_TRACED::Abs, N_TRACED::AllFalse, N_TRACED::AllTrue, N_TRACED::Ge, N_TRACED::Gt, N_TRACED::IfThenElse,
    N_TRACED::Lt, N_TRACED::Max, N_TRACED::Min, N_TRACED::MulAdd, N_TRACED::MulSub, N_TRACED::Neg, N_TRACED::NegMulAdd,
    N_TRACED::Set, N_TRACED::Sqrt;
inline F Zero(Lanes) { return {}; }
inline F IfThenElseZero(bool choice, F yes) { return choice ? yes : F{}; }
inline F IfThenZeroElse(bool choice, F no) { return choice ? F{} : no; }
inline bool IsNaN(F a) { return std::isnan(a.value); }
inline float GetLane(F a) { return a.value; }
inline F MaxOfLanes(Lanes, F a) { return a; }
inline F Load(Lanes, const float* at) {
  const auto known = tape->stored.find(at);
  if (known != tape->stored.end()) return {*at, known->second};
  const F leaf{*at, tape->input()};
  tape->stored.emplace(at, leaf.node);
  return leaf;
}
inline void Store(F a, Lanes, float* at) {
  *at = a.value;
  tape->stored[at] = a.node;
}
// Highway's, counted by hand in hwy/contrib/math: range reduction, polynomial and scaling; conversions are none.
inline F Exp(Lanes, F a) { return after(24, std::exp(a.value), a); }
inline F Expm1(Lanes, F a) { return after(25, std::expm1(a.value), a); }
inline F Log(Lanes, F a) { return after(23, std::log(a.value), a); }
inline F Log1p(Lanes, F a) { return after(23, std::log1p(a.value), a); }
}  // namespace hn

}  // namespace glisson::engine::HWY_NAMESPACE

#include "engine/kernels/average_nodal-inl.h"
#include "engine/kernels/branch_pace-inl.h"
#include "engine/kernels/hyper_response-inl.h"
#include "engine/kernels/lane_scalar-inl.h"
#include "engine/kernels/relaxing_small-inl.h"
#include "engine/kernels/viscous_response-inl.h"

namespace glisson::engine {
namespace {

namespace traced = HWY_NAMESPACE;

bool respond(const Tissue& tissue, const ResponseItems& in, const LaneResponse& r, const Block& block,
             ResponseBlock& out) {
  const Rescue none;
  if (tissue.hyperelastic) {
    constexpr HyperelasticStages kLaws = traced::hyperelastic_stages(std::type_identity<HyperelasticLaw>());
    return kLaws[tissue.hyperelastic->index()](in, r, none, block, out);
  }
  constexpr std::array<TensorMassStages, 2> kStages = {traced::tensor_mass_stages<false>(),
                                                       traced::tensor_mass_stages<true>()};
  return kStages[r.constant ? 0 : 1][static_cast<std::size_t>(tissue.kinematics)](in, r, none, block, out);
}

void relax(const ResponseItems& in, const LaneResponse& r, const MaxwellStep& step, const Block& block,
           ResponseBlock& out) {
  if (r.pace.empty()) {
    if (r.branches > 0) traced::maxwell(in, r, step, out);
    return;
  }
  constexpr PaceStages kPaces = traced::pace_stages(std::type_identity<TimeLaw>());
  for (std::size_t k = 0; k < r.branches; ++k) kPaces[r.pace[k].kind](r.pace[k], block.x, 1, out.pace[k]);
  traced::following(in, r, step, out);
}

}  // namespace

std::size_t count_law_flops(const StiffnessLaw& law) {
  traced::Tape tape;
  traced::tape = &tape;
  const traced::LaneScalar x(traced::F{0.02F, tape.input()});
  float value = 0.0F;
  traced::hn::Store(std::visit([&](const auto& l) { return l.at(l.numbers(1.0), x).value.v; }, law), {}, &value);
  traced::tape = nullptr;
  return tape.reaching({{&value, 1}});
}

ResponseFlops count_response_flops(const Tissue& tissue) {
  traced::Tape tape;
  traced::tape = &tape;
  // one tet, strained by some percent
  constexpr std::array<float, 9> kGradient{0.02F, 0.01F, -0.01F, 0.005F, -0.03F, 0.01F, 0.0F, 0.02F, 0.01F};
  const auto block = std::make_unique<Block>();
  const auto out = std::make_unique<ResponseBlock>();
  std::fill_n(block->value[0], 1, 1.0F), std::fill_n(block->value[1], 1, 1.0F);
  std::fill_n(block->slope[0], 1, 1.0F), std::fill_n(block->slope[1], 1, 1.0F);
  block->x[0] = 0.02F, block->y[0] = 1.0F;
  const bool two_laws = tissue.lambda_law || tissue.mu_law;
  const LaneResponse r = lane_response(tissue, {1.0F, 1.0F, 1.0F, 1.0F, 1.0F, 1.0F}, two_laws ? 1 : 0);
  std::array<float, 9> gradient = kGradient, rate = kGradient;
  std::array<float, 3> fibre{1.0F, 0.0F, 0.0F};
  std::vector<float> memory(std::max<std::size_t>(6, memory_numbers(tissue)), 0.0F), mean{0.001F};
  const ResponseItems in{.gradient = gradient.data(),
                         .rate = rate.data(),
                         .mean = tissue.volume_change == VolumeChange::average_nodal ? mean.data() : nullptr,
                         .fibre = fibre.data(),
                         .memory = memory.data(),
                         .element = nullptr,
                         .items = 1};
  MaxwellStep step;
  step.moves = true;
  if (in_one_pass(tissue)) {
    const bool constant = tissue.has_constant_moduli();
    const StressPass pass = constant ? traced::relaxing_small<false, false> : traced::relaxing_small<true, false>;
    pass(in, r, step, *block, *out);
  } else {
    respond(tissue, in, r, *block, *out);
    if (r.fibre > 0.0F) traced::fibres(in, r, *out);
    relax(in, r, step, *block, *out);
    if (r.viscous) traced::viscous(in, r, r.branches > 0, *out);
    if (r.viscous || r.branches > 0) traced::merge(1, *out);
  }
  ResponseFlops flops;
  flops.tet = tape.reaching({{out->piola, 9}, {memory.data(), memory.size()}});
  if (tissue.volume_change == VolumeChange::average_nodal) {
    traced::Tape second;
    traced::tape = &second;
    std::array<float, kChainRest> rest;
    rest.fill(1.0F);
    float change = 0.0F;
    traced::volume_changes(gradient.data(), rest.data(), 1, r.volume, &change);
    flops.volume = second.reaching({{&change, 1}});
  }
  traced::tape = nullptr;
  return flops;
}

}  // namespace glisson::engine
