// margins.h — how near tests come to their bars: forced in front of every test by -DGLISSON_TEST_MARGINS=ON.
//
// EXPECT_LT, EXPECT_LE, EXPECT_GT, EXPECT_GE and EXPECT_NEAR (ASSERT_ too) on floating-point numbers append a line to the file that
// GLISSON_MARGINS names: test, kind, the expressions, value, bar. scripts/margins runs the tests with each instruction set and lists
// the bars that a value comes near to while it differs between sets.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <type_traits>

namespace glisson::test {

inline void log_margin(const char* kind, const char* value_text, const char* bar_text, double value, double bar) {
  static std::FILE* const file = [] {
    const char* name = std::getenv("GLISSON_MARGINS");
    return name == nullptr ? nullptr : std::fopen(name, "a");
  }();
  if (file == nullptr) return;
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::string name = test == nullptr ? "" : std::string(test->test_suite_name()) + "." + test->name();
  std::fprintf(file, "%s\t%s\t%s\t%s\t%.17g\t%.17g\n", name.c_str(), kind, value_text, bar_text, value, bar);
  std::fflush(file);
}

template <class A, class B>
constexpr bool kLogged = std::is_arithmetic_v<A>&& std::is_arithmetic_v<B> &&
                         (std::is_floating_point_v<A> || std::is_floating_point_v<B>);

#define GLISSON_MARGIN(NAME)                                                                                \
  template <class A, class B>                                                                               \
  testing::AssertionResult margin_##NAME(const char* at, const char* bt, const A& a, const B& b) {          \
    if constexpr (kLogged<A, B>) log_margin(#NAME, at, bt, static_cast<double>(a), static_cast<double>(b)); \
    return testing::internal::CmpHelper##NAME(at, bt, a, b);                                                \
  }
GLISSON_MARGIN(LT)
GLISSON_MARGIN(LE)
GLISSON_MARGIN(GT)
GLISSON_MARGIN(GE)
#undef GLISSON_MARGIN

inline testing::AssertionResult margin_NEAR(const char* at, const char* bt, const char* ct, double a, double b,
                                            double bar) {
  log_margin("NEAR", (std::string(at) + " ~ " + bt).c_str(), ct, std::abs(a - b), bar);
  return testing::internal::DoubleNearPredFormat(at, bt, ct, a, b, bar);
}

}  // namespace glisson::test

#undef EXPECT_LT
#undef EXPECT_LE
#undef EXPECT_GT
#undef EXPECT_GE
#undef EXPECT_NEAR
#undef ASSERT_LT
#undef ASSERT_LE
#undef ASSERT_GT
#undef ASSERT_GE
#undef ASSERT_NEAR
#define EXPECT_LT(a, b) EXPECT_PRED_FORMAT2(::glisson::test::margin_LT, a, b)
#define EXPECT_LE(a, b) EXPECT_PRED_FORMAT2(::glisson::test::margin_LE, a, b)
#define EXPECT_GT(a, b) EXPECT_PRED_FORMAT2(::glisson::test::margin_GT, a, b)
#define EXPECT_GE(a, b) EXPECT_PRED_FORMAT2(::glisson::test::margin_GE, a, b)
#define EXPECT_NEAR(a, b, bar) EXPECT_PRED_FORMAT3(::glisson::test::margin_NEAR, a, b, bar)
#define ASSERT_LT(a, b) ASSERT_PRED_FORMAT2(::glisson::test::margin_LT, a, b)
#define ASSERT_LE(a, b) ASSERT_PRED_FORMAT2(::glisson::test::margin_LE, a, b)
#define ASSERT_GT(a, b) ASSERT_PRED_FORMAT2(::glisson::test::margin_GT, a, b)
#define ASSERT_GE(a, b) ASSERT_PRED_FORMAT2(::glisson::test::margin_GE, a, b)
#define ASSERT_NEAR(a, b, bar) ASSERT_PRED_FORMAT3(::glisson::test::margin_NEAR, a, b, bar)
