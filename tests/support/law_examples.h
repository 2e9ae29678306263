// law_examples.h — each law with parameters of tissue: what the tests run over, in the order of the lists.
//
// A law that has no example here does not compile into the tests.
#pragma once

#include <type_traits>
#include <variant>
#include <vector>

#include "glisson/material/hyperelastic_law.h"
#include "glisson/material/stiffness_law.h"
#include "support/random.h"

namespace glisson::test {

inline constexpr double kExampleModulus = 3000.0;  ///< at rest [Pa]

/// law(): for a modulus of kExampleModulus at rest; kModulus: worked out by hand for x = kAt; random(base): any, for a
/// modulus of `base` at rest. A hyperelastic law has laws(), of about 1.3 kPa shear and 6 kPa bulk modulus.
template <class Law>
struct LawExample;

template <>
struct LawExample<ConstantLaw> {
  static ConstantLaw law() { return {}; }
  static constexpr double kAt = 0.7, kModulus = 3000.0;
  static ConstantLaw random(double) { return {}; }
};
template <>
struct LawExample<StepLaw> {
  static StepLaw law() { return {.threshold = 0.3, .above = 9000.0, .width = 0.5}; }
  static constexpr double kAt = 0.3, kModulus = 6000.0;  // half of the way up
  /// No steeper than rounding in x allows.
  static StepLaw random(double base) {
    return {.threshold = number(0.01, 0.2), .above = base * number(0.5, 3.0), .width = number(0.01, 0.1)};
  }
};
template <>
struct LawExample<LinearLaw> {
  static LinearLaw law() { return {4000.0}; }
  static constexpr double kAt = 0.5, kModulus = 5000.0;
  static LinearLaw random(double base) { return {base * number(-2.0, 10.0)}; }
};
template <>
struct LawExample<PolynomialLaw> {
  static PolynomialLaw law() { return {{2000.0, 3000.0}}; }
  static constexpr double kAt = 0.5, kModulus = 4750.0;
  static PolynomialLaw random(double base) { return {{base * number(-1.0, 4.0), base * number(0.0, 20.0)}}; }
};
template <>
struct LawExample<ExponentialLaw> {
  static ExponentialLaw law() { return {.amplitude = 800.0, .rate = 3.0}; }
  static constexpr double kAt = 1.0 / 3.0, kModulus = 2200.0 + 800.0 * 2.718281828459045;
  static ExponentialLaw random(double base) { return {base * number(0.1, 1.0), number(1.0, 12.0)}; }
};
template <>
struct LawExample<TableLaw> {
  static TableLaw law() { return {{0.0, 0.2, 0.7, 1.1}, {3000.0, 4000.0, 9000.0, 9500.0}}; }
  static constexpr double kAt = 0.45, kModulus = 6500.0;
  static TableLaw random(double base) {
    return {{0.0, 0.05, 0.3, 1.0}, {base, base * number(1.0, 2.0), base * number(2.0, 4.0), base * 5.0}};
  }
};

inline constexpr double kExampleBulk = 6000.0;

template <>
struct LawExample<NeoHookean> {
  static std::vector<NeoHookean> laws() { return {{.mu = 1300.0, .bulk_modulus = kExampleBulk}}; }
};
template <>
struct LawExample<MooneyRivlin> {
  static std::vector<MooneyRivlin> laws() { return {{.c10 = 400.0, .c01 = 250.0, .bulk_modulus = kExampleBulk}}; }
};
template <>
struct LawExample<Yeoh> {
  static std::vector<Yeoh> laws() { return {{.c1 = 650.0, .c2 = 120.0, .c3 = 15.0, .bulk_modulus = kExampleBulk}}; }
};
template <>
struct LawExample<Fung> {
  static std::vector<Fung> laws() { return {{.mu = 1300.0, .b = 0.8, .bulk_modulus = kExampleBulk}}; }
};
template <>
struct LawExample<VerondaWestmann> {
  static std::vector<VerondaWestmann> laws() { return {{.c = 1600.0, .b = 0.8, .bulk_modulus = kExampleBulk}}; }
};
template <>
struct LawExample<Ogden> {
  static std::vector<Ogden> laws() {
    return {{{1300.0}, {-4.7}, kExampleBulk},
            {{900.0, 400.0}, {2.0, -2.0}, kExampleBulk},
            {{700.0, 500.0, 100.0}, {1.3, 5.0, -2.0}, kExampleBulk}};
  }
};
template <>
struct LawExample<Gent> {
  static std::vector<Gent> laws() { return {{.mu = 1300.0, .limit = 20.0, .bulk_modulus = kExampleBulk}}; }
};
/// The polynomial; the exponentials of Ī₂ alone; all terms.
template <>
struct LawExample<Invariants> {
  static std::vector<Invariants> laws() {
    Invariants polynomial{.c10 = 400.0, .c01 = 250.0, .c20 = 60.0, .c11 = 30.0, .c02 = 20.0, .c30 = 10.0};
    Invariants second{.a2 = 1300.0, .b2 = 0.6, .q2 = 200.0, .r2 = 0.02};
    Invariants all{.c10 = 150.0, .c01 = 100.0, .c20 = 40.0, .c11 = -10.0, .c02 = 15.0, .c30 = 5.0};
    all.a1 = 500.0, all.b1 = 0.6, all.a2 = 300.0, all.b2 = 0.4;
    all.q1 = 100.0, all.r1 = 0.03, all.q2 = 60.0, all.r2 = 0.02;
    for (Invariants* law : {&polynomial, &second, &all}) law->bulk_modulus = kExampleBulk;
    return {polynomial, second, all};
  }
};

namespace detail {

template <class... Laws>
std::vector<StiffnessLaw> stiffness_examples(std::type_identity<std::variant<Laws...>>) {
  return {LawExample<Laws>::law()...};
}
template <class... Laws>
std::vector<HyperelasticLaw> hyperelastic_examples(std::type_identity<std::variant<Laws...>>) {
  std::vector<HyperelasticLaw> all;
  const auto add = [&](const auto& laws) { all.insert(all.end(), laws.begin(), laws.end()); };
  (add(LawExample<Laws>::laws()), ...);
  return all;
}
template <class... Laws>
StiffnessLaw random_law(std::type_identity<std::variant<Laws...>>, double base) {
  using Make = StiffnessLaw (*)(double);
  constexpr Make kMakers[] = {[](double b) -> StiffnessLaw { return LawExample<Laws>::random(b); }...};
  return kMakers[integer(0, sizeof...(Laws))](base);
}

}  // namespace detail

inline std::vector<StiffnessLaw> every_stiffness_law() {
  return detail::stiffness_examples(std::type_identity<StiffnessLaw>());
}
inline std::vector<HyperelasticLaw> every_hyperelastic_law() {
  return detail::hyperelastic_examples(std::type_identity<HyperelasticLaw>());
}
/// Any of the laws, for a modulus `base` at rest.
inline StiffnessLaw random_law(double base) { return detail::random_law(std::type_identity<StiffnessLaw>(), base); }

}  // namespace glisson::test
