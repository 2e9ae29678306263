// tissue_plan.h — how a tissue block is evaluated in lanes: its moduli and laws as the kernels take them, and the stages that it
// needs. Worked out when the tissue is set.
#pragma once

#include <memory>

#include "engine/kernels/kernels.h"
#include "engine/kernels/response_kernels.h"

namespace glisson::engine {

/// Of a tissue beyond the paper's.
struct ResponsePlan {
  Response response;
  LaneResponse lanes;
  RespondStage respond;
  MaxwellStep maxwell;
  bool one_pass = false, measured = false;  ///< in_one_pass(); whether a law or a branch's time reads the measure

  /// Weights of all branches for a step of h from the state that is asked for.
  /// @param since  time since their memory was kept [s]; infinite: they have relaxed
  void set_step(double h, double since);
};

struct TissuePlan {
  LaneTissue tissue;
  std::array<LaneLaw, 2> law;
  std::size_t laws = 1;  ///< 2: apart on λ and μ
  std::size_t measure = 0;
  bool viscous = false, drags = false;     ///< drags: it has a Kelvin–Voigt viscosity
  std::unique_ptr<ResponsePlan> response;  ///< none where the tissue is the paper's
};

TissuePlan tissue_plan(const TissueBlock& block, const ResponseKernels& kernels);

}  // namespace glisson::engine
