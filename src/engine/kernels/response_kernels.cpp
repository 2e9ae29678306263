// response_kernels.cpp — the stages of response_kernels.h compiled once for each instruction set. kernels.cpp, which is
// compiled for the same ones, hands them out.
#include "engine/kernels/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/response_kernels.cpp"
#include <hwy/foreach_target.h>

#include "engine/kernels/average_nodal-inl.h"
#include "engine/kernels/branch_pace-inl.h"
#include "engine/kernels/compare_linear-inl.h"
#include "engine/kernels/hyper_response-inl.h"
#include "engine/kernels/relaxing_small-inl.h"
#include "engine/kernels/response_kernels.h"
#include "engine/kernels/stiff_list-inl.h"
#include "engine/kernels/viscous_response-inl.h"

HWY_BEFORE_NAMESPACE();
namespace glisson::engine::HWY_NAMESPACE {

const ResponseKernels* response_table();
const ResponseKernels* response_table() {
  static const ResponseKernels table{.tensor_mass = {tensor_mass_stages<false>(), tensor_mass_stages<true>()},
                                     .hyperelastic = hyperelastic_stages(std::type_identity<HyperelasticLaw>()),
                                     .fibres = fibres,
                                     .maxwell = maxwell,
                                     .following = following,
                                     .pace = pace_stages(std::type_identity<TimeLaw>()),
                                     .viscous = viscous,
                                     .relaxing_small = {{relaxing_small<false, false>, relaxing_small<false, true>},
                                                        {relaxing_small<true, false>, relaxing_small<true, true>}},
                                     .stiffest = stiffest,
                                     .list_above = list_above,
                                     .volume_changes = volume_changes,
                                     .spread_to_vertices = spread_to_vertices,
                                     .mean_of_vertices = mean_of_vertices,
                                     .follow_branches = follow_branches,
                                     .relax_all = relax_all,
                                     .compare_linear = compare_linear,
                                     .merge = merge};
  return &table;
}

}  // namespace glisson::engine::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
