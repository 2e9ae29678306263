// The documentation of FIT.toml is what the reader itself uses.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "fit/fit_spec.h"
#include "fit/section_fit.h"
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

}  // namespace
}  // namespace glisson::fit
