// ogden.h — powers of the principal stretches; what brain and phantoms are most often fitted to.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "glisson/material/hyperelastic/bulk_modulus.h"

namespace glisson {

/// W = Σ_k 2 μ_k/α_k² (λ̄₁^α_k + λ̄₂^α_k + λ̄₃^α_k − 3) + κ/2 (J − 1)²,  λ̄ = J^(−⅓) λ,  μ = Σ μ_k     [Ogden1972]
/// In Ogden's own letters the k-th pair is (2 μ_k/α_k, α_k).
struct Ogden {
  std::vector<double> mu;     ///< μ_k [Pa], one to three
  std::vector<double> alpha;  ///< α_k [-], not 0
  double bulk_modulus = 0.0;  ///< κ [Pa]

  static constexpr std::size_t kMostTerms = 3;
  static constexpr double kLargestExponent = 60.0;
  static constexpr std::string_view kName = "ogden";
  static constexpr std::string_view kHelp = "W = Σ 2 μₖ/αₖ² (λ̄₁^αₖ + λ̄₂^αₖ + λ̄₃^αₖ − 3) + κ/2 (J − 1)², μ = Σ μₖ";
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("mu", &Ogden::mu, "Pa", "μₖ, one to three").must(),
                field("alpha", &Ogden::alpha, "-", between(-100, 100), "αₖ, as many, none 0").must(),
                bulk_modulus_field<Ogden>());
  }

  double shear_modulus() const {
    double sum = 0.0;
    for (const double m : mu) sum += m;
    return sum;
  }
  /// @param l  ln λ̄_i, of sum 0
  template <class T>
  T energy(const std::array<T, 3>& l) const;
  /// ∂W/∂ln λ_i [Pa], of sum 0.
  template <class T>
  std::array<T, 3> slopes(const std::array<T, 3>& l) const;
  std::string check() const {
    if (mu.empty() || mu.size() > kMostTerms)
      return "mu has " + std::to_string(mu.size()) + " terms; allowed: 1 to " + std::to_string(kMostTerms);
    if (mu.size() != alpha.size()) {
      return "mu has " + std::to_string(mu.size()) + " terms and alpha " + std::to_string(alpha.size()) +
             "; they go in pairs";
    }
    for (const double a : alpha) {
      if (a == 0.0) return "alpha must not be 0";
    }
    return shear_modulus() > 0.0 ? "" : "the sum of mu must be above 0, it is the shear modulus at rest";
  }

  bool operator==(const Ogden&) const = default;

 private:
  /// λ̄^α − 1, the exponent limited.
  template <class T>
  static T growth(double a, T l);
};

}  // namespace glisson
