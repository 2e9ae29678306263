// The documentation of FIT.toml is what the reader itself uses.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "fit/spec/fit_spec.h"
#include "fit/spec/section_fit.h"
#include "scene/parse/allowed_range.h"
#include "support/places.h"

namespace glisson::fit {
namespace {

TEST(FitReference, IsUpToDate) {
  std::ifstream stream(test::shipped("docs/fit_file.md"));
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_TRUE(text == fit_reference_markdown())
      << "docs/fit_file.md differs from the schema; write it again with: glisson schema fit > docs/fit_file.md";
}

TEST(FitReference, HasEveryKeyOfTheFile) {
  const std::string text = fit_reference_markdown();
  for (const auto& key : fit_section().keys) {
    EXPECT_NE(text.find("| `" + key.name + "`"), std::string::npos) << key.name;
    EXPECT_FALSE(key.help.empty()) << key.name;
  }
}

void expect_ends(const scene::SectionSpec& section) {
  for (const scene::KeySpec& key : section.keys) {
    if (key.section) expect_ends(*key.section);
    if (key.type != scene::ValueType::number) continue;
    const Range range = scene::allowed_range(key);
    EXPECT_TRUE(std::isfinite(range.min) && std::isfinite(range.max)) << section.name << "." << key.name;
  }
  for (const scene::KindSpec& kind : section.kinds) expect_ends(kind.section);
}

// Every number of a fit has a least and a largest value.
TEST(FitReference, EveryNumberHasTwoEnds) { expect_ends(fit_section()); }

}  // namespace
}  // namespace glisson::fit
