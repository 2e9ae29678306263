// kernels.cpp — the kernels compiled once for each instruction set, and the choice among them at run time.
#include "engine/kernels/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/kernels.cpp"
#include <hwy/foreach_target.h>

#include "engine/kernels/edge_stages-inl.h"
#include "engine/kernels/element_stages-inl.h"
#include "engine/kernels/flops.h"
#include "engine/kernels/law_stages-inl.h"
#include "engine/kernels/vertex_stages-inl.h"
#include "engine/layout/counted.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

/// The stages of large deformation (response_kernels.cpp).
const ResponseKernels* response_table();

const Kernels* kernels() {
  static const Kernels table{
      .instruction_set = hwy::TargetName(HWY_TARGET),
      .lanes = kLanes,
      .response = response_table(),
      .narrow = narrow,
      .narrow_chosen = narrow_chosen,
      .narrow_vectors = narrow_vectors,
      .gather_elastic = gather<false>,
      .gather_viscous = gather<true>,
      .gather_rates = gather_rates,
      .gather_drag = gather_drag,
      .measure = {measure<DeformationMeasure::equivalent_shear_strain>, measure<DeformationMeasure::one_minus_q>,
                  measure<DeformationMeasure::regular_mean_ratio>},
      .law = store_laws(std::type_identity<StiffnessLaw>()),
      .watch_law = watch_laws(std::type_identity<StiffnessLaw>()),
      .watch_lame = watch_lame,
      .list_stiff = list_stiff,
      .push_elastic = push<Push::elastic>,
      .push_viscous = push<Push::viscous>,
      .push_merged = push<Push::merged>,
      .push_piola = push_piola,
      .push_stress = push_stress,
      .push_apart = push_apart,
      .push_piolas_apart = push_piolas_apart,
      .push_stresses_apart = push_stresses_apart,
      .part_forces = part_forces,
      .edges_elastic = edges_elastic,
      .edges_merged = edges_viscous<false>,
      .edges_split = edges_viscous<true>,
      .drag = drag,
      .add = add,
      .all_finite = all_finite,
      .sum_slots = sum_slots,
      .integrate = integrate,
      .integrate_accounted = integrate_accounted};
  return &table;
}

/// Runs each part of the element once on counted numbers.
ElementFlops element_flops() {
  struct Point {
    Counted x, y, z;
  };
  const CountTag d;
  const Counted small{0.01F};
  const Point u{small, small, small};
  const Counted s[3][3] = {{{1.0F}, {0.0F}, {0.0F}}, {{0.0F}, {1.0F}, {0.0F}}, {{0.0F}, {0.0F}, {1.0F}}};
  const auto count = [](const auto& part) {
    Counted::operations = 0;
    part();
    return Counted::operations;
  };
  ElementFlops f;
  Gradient<Counted> g;
  Stress<Counted> t;
  f.gradient = count([&] { g = gradient(u, u, u, s); });
  f.stress = count([&] { t = stress(g, small, small); });
  f.force = count([&] { force<Counted, Point>(t, s[0]); });
  const std::size_t bound =
      count([&] { strain_bound_squared(d, invariants(d, g), 1.0F); }) - count([&] { invariants(d, g); });
  f.measure[0] = count([&] { measure_intensity(d, invariants(d, g), 1.0F); }) - bound;
  f.measure[1] = count([&] { measure_one_minus_q(d, invariants(d, g), 1.0F); }) - bound;
  f.measure[2] = count([&] { measure_regular_mean_ratio(d, g, invariants(d, g), s, 1.0F); }) - bound;
  return f;
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace glisson::engine {

HWY_EXPORT(kernels);
HWY_EXPORT(element_flops);

ElementFlops count_element_flops() { return HWY_STATIC_DISPATCH(element_flops)(); }

const Kernels& best_kernels() { return *HWY_DYNAMIC_DISPATCH(kernels)(); }

std::vector<const Kernels*> all_kernels() {
  std::vector<const Kernels*> all;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    all.push_back(HWY_DYNAMIC_DISPATCH(kernels)());
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return all;
}

}  // namespace glisson::engine
#endif
