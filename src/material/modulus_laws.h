// modulus_laws.h — λ and μ of a tissue as functions of the measure, their laws' numbers worked out once.
#pragma once

#include <variant>
#include <vector>

#include "glisson/material/tissue.h"

namespace glisson {

/// λ and μ, and their slopes by the measure [Pa].
template <class T>
struct Moduli {
  T lambda, mu, lambda_slope, mu_slope;
};

/// A law on a modulus, made ready for many arguments.
class ReadyLaw {
 public:
  /// @param base  modulus at rest [Pa]
  ReadyLaw(const StiffnessLaw& law, double base) : law_(law) {
    std::visit(
        [&](const auto& l) {
          const auto c = l.numbers(base);
          numbers_.assign(c.begin(), c.end());
        },
        law);
  }
  template <class T>
  ValueSlope<T> at(T x) const {
    return std::visit([&](const auto& l) { return l.at(numbers_, x); }, law_);
  }

 private:
  StiffnessLaw law_;
  std::vector<double> numbers_;
};

class ModulusLaws {
 public:
  explicit ModulusLaws(const Tissue& t) : ModulusLaws(t, t.lame(), t.lambda_law || t.mu_law) {}

  template <class T>
  Moduli<T> at(T x) const {
    const ValueSlope<T> a = first_.at(x);
    if (apart_) {
      const ValueSlope<T> b = second_.at(x);
      return {a.value, b.value, a.slope, b.slope};
    }
    const T l(lambda_of_young_), m(mu_of_young_);
    return {l * a.value, m * a.value, l * a.slope, m * a.slope};
  }

 private:
  ModulusLaws(const Tissue& t, const LameParameters& rest, bool apart)
      : apart_(apart), lambda_of_young_(rest.lambda / t.youngs_modulus), mu_of_young_(rest.mu / t.youngs_modulus),
        first_(apart ? t.lambda_law.value_or(ConstantLaw{}) : t.law, apart ? rest.lambda : t.youngs_modulus),
        second_(t.mu_law.value_or(ConstantLaw{}), rest.mu) {}

  bool apart_;
  double lambda_of_young_, mu_of_young_;  ///< of a law on E, which scales both
  ReadyLaw first_, second_;               ///< on λ and μ, or the first on E
};

}  // namespace glisson
