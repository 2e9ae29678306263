// laws_test.cpp — a law is known to scenes by its own description alone.
#include <gtest/gtest.h>

#include <type_traits>

#include "scene/parse/document.h"
#include "scene/scene_text.h"

namespace glisson {
namespace {

using test::complaint;
using test::parse;

/// A value for a field that lies in its range: the i-th of an increasing list.
double sample_value(const FieldText& field, int i) {
  const double low = std::isfinite(field.range.min) ? field.range.min : -3.0;
  const double high = std::isfinite(field.range.max) ? field.range.max : low + 8.0;
  return low + (high - low) * (0.25 + 0.125 * i);
}

template <class Law>
std::string field_text(const FieldOf<Law, double>& field) {
  return field.key() + " = " + scene::show(sample_value(field, 0)) + "\n";
}
template <class Law>
std::string field_text(const FieldOf<Law, std::vector<double>>& field) {
  return field.key() + " = [" + scene::show(sample_value(field, 0)) + ", " + scene::show(sample_value(field, 1)) +
         "]\n";
}

template <class Law>
void expect_field(const Law& law, const FieldOf<Law, double>& field) {
  EXPECT_EQ(law.*field.member, sample_value(field, 0)) << Law::kName << "." << field.name;
}
template <class Law>
void expect_field(const Law& law, const FieldOf<Law, std::vector<double>>& field) {
  EXPECT_EQ(law.*field.member, (std::vector{sample_value(field, 0), sample_value(field, 1)}))
      << Law::kName << "." << field.name;
}

template <class Law>
void read_back() {
  std::string text = test::kSmallScene + "[tissue.law]\nkind = \"" + std::string(Law::kName) + "\"\n";
  each_field<Law>([&](const auto& field) { text += field_text(field); });
  const Scene scene = parse(text);
  const auto* law = std::get_if<Law>(&scene.variants.at(0).tissue.law);
  ASSERT_TRUE(law) << text;
  each_field<Law>([&](const auto& field) { expect_field(*law, field); });
}

template <class Law>
void refuse_bad_fields() {
  each_field<Law>([]<class T>(const FieldOf<Law, T>& field) {
    std::string text = test::kSmallScene + "[tissue.law]\nkind = \"" + std::string(Law::kName) + "\"\n";
    if (field.required) {
      const std::string missing = complaint(text);
      EXPECT_NE(missing.find("missing key `" + field.key() + "`"), std::string::npos) << missing;
    }
    const std::string wrong = complaint(text + field.key() + " = \"much\"\n");
    EXPECT_NE(wrong.find("tissue.law." + field.key() + ": expected a "), std::string::npos) << wrong;
    if (std::isfinite(field.range.min)) {
      const std::string below = scene::show(field.range.min - 1.0);
      const bool list = !std::is_same_v<T, double>;
      const std::string low = complaint(text + field.key() + " = " + (list ? "[" + below + "]" : below) + "\n");
      EXPECT_NE(low.find(below), std::string::npos) << low;
      EXPECT_NE(low.find("is out of range; allowed: "), std::string::npos) << low;
    }
  });
}

template <class... Laws>
void for_each_law(std::type_identity<std::variant<Laws...>>) {
  (read_back<Laws>(), ...);
  (refuse_bad_fields<Laws>(), ...);
}

// Every law in the list can be written in a scene by its fields, and its fields are checked, without code of its own.
TEST(Laws, AreReadAndCheckedFromTheirOwnDescription) { for_each_law(std::type_identity<StiffnessLaw>{}); }

// Parameters that contradict each other are refused with the law's own words, at the table's line.
TEST(Laws, AreCheckedAsAWhole) {
  const std::string table = test::kSmallScene + "[tissue.law]\nkind = \"table\"\n";
  EXPECT_EQ(complaint(table + "arguments = [0, 0.2, 0.1]\nmoduli_Pa = [1, 2, 3]\n"),
            "s.toml:16:1: tissue.law: `arguments` must be strictly increasing");
  EXPECT_EQ(complaint(table + "arguments = [0, 0.2]\nmoduli_Pa = [1, 2, 3]\n"),
            "s.toml:16:1: tissue.law: `arguments` and `moduli_Pa` must be equally long");
}

// λ and μ in place of E and ν give the same tissue, to rounding.
TEST(Laws, LameParametersStandForYoungAndPoisson) {
  const Tissue t = parse(test::kSmallScene + "[tissue]\nlambda_Pa = 5142.857142857143\nmu_Pa = 1285.7142857142858\n")
                       .variants[0]
                       .tissue;
  EXPECT_NEAR(t.youngs_modulus, 3600.0, 1e-9);
  EXPECT_NEAR(t.poisson_ratio, 0.4, 1e-13);
}

}  // namespace
}  // namespace glisson
