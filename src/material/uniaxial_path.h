// uniaxial_path.h — a specimen with free sides taken along a history of stretches: what elasticity, Kelvin–Voigt
// viscosity and Maxwell branches answer, step by step.
//
// Free sides are an equation for the stretch a across, at each instant:
//
//   0 = P_side(a, c) + P_viscous,side(a, c, ȧ, ċ) − carry( Σ g_i q_i )side,      q_i′ = (S − q_i)/τ_i
//
// Without viscosity it is algebraic. With it, it is a stiff differential equation for a; two implicit stages, at
// t + γh and t + h with γ = 1 − 1/√2, are of second order and damp what they do not resolve [Alexander1977]. The branches
// go by their exact weights for S linear over the step, or in a branch's own time where that follows the deformation
// (branch_pace.h).
#pragma once

#include <array>

#include "material/axial_response.h"
#include "material/branch_weights.h"

namespace glisson {

/// A stretch along z and how fast it changes.
struct StretchRate {
  double stretch = 1.0, rate = 0.0;  ///< λ [-], > 0; λ̇ [1/s]
};

struct UniaxialState {
  double stress = 0.0;           ///< nominal stress along z, P_zz [Pa]
  double lateral_stretch = 1.0;  ///< across [-]
  bool converged = false;        ///< false: no lateral stretch between 0.05 and 20 leaves the sides free
};

class UniaxialPath {
 public:
  static constexpr double kMiddle = 0.29289321881345254;  ///< γ: where the first stage of a step is, in its length

  /// @throws std::invalid_argument as AxialResponse
  explicit UniaxialPath(const Tissue& tissue);

  /// Whether the stress depends on more than the present stretch.
  bool has_past() const { return response_.is_viscous() || branches_ > 0; }

  /// Starts at rest, with the rate that the motion begins with; back to it.
  UniaxialState start(double rate);
  /// Goes on to the end of a step. @param h  [s], > 0 @param middle  at t + γh @param end  at t + h
  UniaxialState advance(double h, StretchRate middle, StretchRate end);
  /// The same for a tissue without a past.
  UniaxialState at(double stretch);

 private:
  using Branches = std::array<Axial<double>, kMostBranches>;
  using Paces = std::array<double, kMostBranches>;

  /// What a stage knows beside the stretch across.
  struct Stage {
    StretchRate z;
    double from = 1.0;    ///< a − (weight h) ȧ of the stage
    double weight = 0.0;  ///< γh [s]; 0: no viscosity
    double length = 0.0;  ///< time from the state before to the stage [s]
    Axial<double>
        kept;  ///< Σ g (decay q + from S(t)), of branches whose weights do not depend on the stage's deformation
    double share = 0.0;  ///< Σ g to, likewise
  };
  template <class T>
  Axial<T> stress(const Stage& stage, T side) const;
  UniaxialState solve(const Stage& stage, double guess);
  void weigh(double h, Stage& stage) const;
  void set_paces(Axial<double> h);
  void update_branches(double h, double side, double stretch);

  AxialResponse response_;
  std::size_t branches_ = 0;
  double side_ = 1.0, side_rate_ = 0.0, last_slope_ = 0.0, stretch_ = 1.0;
  Axial<double> relaxing_{};  ///< S at the end of the last step
  Branches q_{};
  Paces pace_{};  ///< 1/τ there of branches whose times follow the deformation [1/s]
};

}  // namespace glisson
