// branch_pace.h — how fast the Maxwell branches of a tissue relax at a deformation: 1/τ(x) of each.
//
// A branch whose time follows the measure x goes by a clock of its own, ξ = ∫ dt/τ(x(t)), in which it is a plain branch of
// time 1: dq/dξ = S − q. Over a step of h the trapezoid rule takes ξ on by ½ h (1/τ(x₀) + 1/τ(x₁)), and q follows by the
// weights of a plain branch, exact for S linear in ξ, or in explicit steps by those that take energy in each of them
// (docs/theory.md §7).
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include "glisson/material/tissue.h"
#include "material/branch_weights.h"
#include "material/dual.h"
#include "material/time_formulas.h"

namespace glisson {

/// What a step solves for: a state that its forces balance, or the next one from forces that are known.
enum class StepKind { implicit, central_difference };

class BranchPaces {
 public:
  explicit BranchPaces(const std::vector<MaxwellBranch>& branches) {
    for (const MaxwellBranch& b : branches) {
      paces_.push_back({1.0 / b.time, b.time_law, {}});
      if (!b.time_law) continue;
      follows_ = true;
      std::visit(
          [&](const auto& law) {
            const auto c = law.numbers();
            paces_.back().numbers.assign(c.begin(), c.end());
          },
          *b.time_law);
    }
  }

  /// Whether the time of some branch follows the deformation.
  bool follows() const { return follows_; }

  /// 1/τ of the k-th branch at measure x [1/s].
  template <class T>
  T at(std::size_t k, T x) const {
    using std::exp;
    const Pace& pace = paces_[k];
    if (!pace.law) return T(pace.plain);
    const T logarithm = std::visit([&](const auto& law) { return law.at(pace.numbers, x).value; }, *pace.law);
    return T(pace.plain) * exp(-logarithm);
  }

  /// Weights of the k-th branch over a step of h [s] from a pace `before` to that at measure x.
  template <class T>
  BranchWeights<T> weights(std::size_t k, double h, double before, T x, StepKind step = StepKind::implicit) const {
    if (std::isinf(h)) return {T(0.0), T(0.0), T(1.0)};
    const T passed = T(0.5 * h) * (T(before) + at(k, x));
    return step == StepKind::implicit ? weights_over(passed) : passive_weights_over(passed);
  }

 private:
  struct Pace {
    double plain;  ///< 1/τ of the branch without its law [1/s]
    std::optional<TimeLaw> law;
    std::vector<double> numbers;
  };
  std::vector<Pace> paces_;
  bool follows_ = false;
};

}  // namespace glisson
