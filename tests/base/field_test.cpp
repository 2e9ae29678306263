// field_test.cpp — one description of a member gives its key, its check and its message.
#include "glisson/field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/require_fields.h"

namespace glisson {
namespace {

struct Bit {
  double share = 0.5;
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("share", &Bit::share, "-", strictly_between(0, 1), "share"));
  }
};
struct Drilling {
  double depth = 0.01;
  std::optional<double> end{};
  Vec3d way{0, 0, 1};
  std::vector<Bit> parts{};
  double friction = 0.0;
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("depth", &Drilling::depth, "mm", between(1, 20), "depth").advise("press less deep"),
                field("end", &Drilling::end, "s", above(0), "end"),
                field("way", &Drilling::way, "-", "way").direction(), field("parts", &Drilling::parts, "parts"),
                field("friction", &Drilling::friction, "-", at_least(0), "μ").or_infinite("it never slips"));
  }
  Fault check() const { return {depth < 0.015 || parts.empty() ? "" : "is too deep for parts", "depth"}; }
};
struct Forgetful {
  double first = 0.0, second = 0.0;
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("first", &Forgetful::first, "first"));
  }
};
struct Shuffled {
  double number = 0.0;
  bool flag = false;
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("flag", &Shuffled::flag, "flag"), field("number", &Shuffled::number, "number"));
  }
};

std::string refusal_of(const Drilling& options) {
  try {
    detail::require_fields("tool", options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

// A member without a description, or out of the struct's order, does not compile where the fields are used.
TEST(Field, DescribesEveryMember) {
  static_assert(kDescribesAll<Drilling>);
  static_assert(!kDescribesAll<Forgetful>);
  static_assert(!kDescribesAll<Shuffled>);
}

// The unit ends the key as it is written in scenes, or a field gives its own.
TEST(Field, KeyIsNameAndUnit) {
  const auto key = [](const char* unit) { return FieldText{.name = "x", .unit = unit}.key(); };
  const std::pair<const char*, const char*> keys[] = {
      {"", "x"},          {"-", "x"},         {"Pa", "x_Pa"},       {"kg/m³", "x_kg_m3"},  {"Pa·s", "x_Pa_s"},
      {"mm/s", "x_mm_s"}, {"m/s²", "x_m_s2"}, {"1/s", "x_per_s"},   {"Hz", "x_hz"},        {"J/m²", "x_J_m2"},
      {"N/m", "x_N_m"},   {"rad", "x_rad"},   {"N s/m", "x_N_s_m"}, {"N s/m²", "x_N_s_m2"}};
  for (const auto& [unit, expected] : keys) EXPECT_EQ(key(unit), expected) << unit;
  EXPECT_EQ((FieldText{.name = "x", .unit = "kg/s", .own_key = "x_kg_per_s"}.key()), "x_kg_per_s");
}

// What is not allowed is refused with its place, its value in SI, the range and the way out.
TEST(Field, RefusalsNameValueAndRange) {
  EXPECT_EQ(refusal_of({}), "accepted");
  EXPECT_EQ(refusal_of({.depth = 0.03}),
            "tool: depth [m] = 0.03 is outside the allowed range, 0.001 to 0.02; press less deep");
  EXPECT_EQ(refusal_of({.end = 0.0}), "tool: end [s] = 0 is outside the allowed range, > 0 and ≤ 1e+09");
  EXPECT_EQ(refusal_of({.way = {}}),
            "tool: way: (0, 0, 0) has no length; give a vector that is not zero, such as (0, 0, -1)");
  EXPECT_EQ(refusal_of({.way = {0, NAN, 0}}), "tool: way.y = nan is outside the allowed range, -1e+12 to 1e+12");
  EXPECT_EQ(refusal_of({.parts = {{}, {1.0}}}), "tool: parts[1].share = 1 is outside the allowed range, > 0 and < 1");
  EXPECT_EQ(refusal_of({.depth = 0.018, .parts = {{}}}), "tool: depth: is too deep for parts");
  EXPECT_EQ(refusal_of({.friction = INFINITY}), "accepted");
  EXPECT_EQ(refusal_of({.friction = 2e12}),
            "tool: friction = 2e+12 is outside the allowed range, 0 to 1e+12; infinite: it never slips");
  EXPECT_EQ(refusal_of({.end = INFINITY}), "tool: end [s] = inf is outside the allowed range, > 0 and ≤ 1e+09");
  EXPECT_EQ(refusal_of({.way = {0, 1e-200, 0}}),
            "tool: way: (0, 1e-200, 0) has no length; give a vector that is not zero, such as (0, 0, -1)");
  EXPECT_EQ(refusal_of({.friction = NAN}),
            "tool: friction = nan is outside the allowed range, 0 to 1e+12; infinite: it never slips");
}

}  // namespace
}  // namespace glisson
