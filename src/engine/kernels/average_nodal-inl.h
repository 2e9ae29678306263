// average_nodal-inl.h — volume changes that tets share over their vertices (VolumeChange::average_nodal), in lanes.
//
//   V ϑ of each tet ──▶ added up at its four vertices ──▶ over the volume around each: ϑ_a ──▶ mean of four: ϑ̄
//
// A vertex takes one number of a chain, so records would carry three quarters of nothing: lanes go one by one here.
//
// Included once per instruction set, never from outside response_kernels.cpp.
#if defined(GLISSON_SHARED_VOLUME_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GLISSON_SHARED_VOLUME_INL_H_
#undef GLISSON_SHARED_VOLUME_INL_H_
#else
#define GLISSON_SHARED_VOLUME_INL_H_
#endif

#include "engine/kernels/elastic_response-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// tr(U − I), in double where J has fallen below what lanes answer.
HWY_INLINE F stretch_sum(const Tensor& H, F volume_change, const float* gradient) {
  const Lanes d;
  const F J = volume_change + number(1.0F), limit = number(float(kSmallestVolume));
  const RootSeries<float>& series = lane_root_series();
  const Symmetric E = green_strain(H);
  const MeanStretch m = mean_stretch(E);
  const Symmetric X = stretch_deviator(E, m.third, m.per_root * m.per_root);
  const LaneScalar J2(second_invariant(X)), J3(cofactors_of(X).determinant);
  const auto close = hn::Lt(J2.v, number(series.largest_J2));
  F sum = norms_by_series(m, series_at(series.trace, J2, J3).v).trace;
  if (!hn::AllTrue(d, close)) {
    sum = hn::IfThenElse(close, sum, trace_of(stretch_tensors(E, H, volume_change).strain));
  }
  if (hn::AllTrue(d, hn::Gt(J, limit))) return sum;
  alignas(64) float values[kMaxLanes], volume[kMaxLanes];
  hn::Store(sum, d, values);
  hn::Store(J, d, volume);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (!(volume[lane] > float(kSmallestVolume))) values[lane] = rescue_stretch_sum(gradient + lane, kLanes);
  }
  return hn::Load(d, values);
}

/// V of a tet, 0 where there is none: 1/6w.
HWY_INLINE F rest_volume(const float* rest, std::size_t item) {
  const std::size_t row = item / kChainTets * kChainRest + kRestScale + item % kChainTets;
  const F six_w = hn::Load(Lanes(), rest + row * kLanes) * number(6.0F);
  return hn::IfThenElseZero(hn::Gt(six_w, number(0.0F)), number(1.0F) / six_w);
}

/// V ϑ of each item [m³]; `kind` says which ϑ.
inline void volume_changes(const float* gradient, const float* rest, std::size_t items, VolumeKind kind, float* out) {
  const Lanes d;
  for (std::size_t item = 0; item < items; ++item) {
    const float* at = gradient + item * 9 * kLanes;
    const Tensor H = load_tensor(at);
    F theta = trace(H);
    if (kind == VolumeKind::green) theta = trace_of(green_strain(H));
    if (kind == VolumeKind::hyperelastic) theta = invariants(d, H).volume_change;
    if (kind == VolumeKind::corotational) theta = stretch_sum(H, invariants(d, H).volume_change, at);
    hn::Store(rest_volume(rest, item) * theta, d, out + item * kLanes);
  }
}

/// Adds the values of the three tets of each chain to its vertices.
inline void spread_to_vertices(const std::uint16_t* index, std::size_t batches, const float* values, float* vertices) {
  for (std::size_t b = 0; b < batches; ++b) {
    const std::uint16_t* at = index + b * kChainVertices * kLanes;
    const float* A = values + b * kChainTets * kLanes;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const float a = A[lane], m = A[kLanes + lane], c = A[2 * kLanes + lane];
      const auto add = [&](std::size_t vertex, float x) GLISSON_INLINED { vertices[at[vertex * kLanes + lane]] += x; };
      add(0, a + m + c), add(1, a + m + c), add(2, a + m), add(3, m + c), add(4, a), add(5, c);
    }
  }
}

/// The mean over the four vertices of each tet.
inline void mean_of_vertices(const std::uint16_t* index, std::size_t batches, const float* vertices, float* values) {
  for (std::size_t b = 0; b < batches; ++b) {
    const std::uint16_t* at = index + b * kChainVertices * kLanes;
    float* A = values + b * kChainTets * kLanes;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const auto of = [&](std::size_t vertex) GLISSON_INLINED { return vertices[at[vertex * kLanes + lane]]; };
      const float edge = of(0) + of(1), v2 = of(2), v3 = of(3);
      A[lane] = 0.25F * (edge + v2 + of(4));
      A[kLanes + lane] = 0.25F * (edge + v2 + v3);
      A[2 * kLanes + lane] = 0.25F * (edge + v3 + of(5));
    }
  }
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // GLISSON_SHARED_VOLUME_INL_H_
