// Checks and maps that cannot be what is meant are named with their place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene_text.h"

namespace glisson {
namespace check_test {

using testing::HasSubstr;

std::string check(const std::string& keys) {
  return test::complaint("[[check]]\nwhat = \"w\"\ncolumn = \"force_N\"\n" + keys + "\n" + test::kSmallScene);
}

// A check without a bound could not fail; one whose bounds cross could not pass.
TEST(Check, HasBoundsThatCanBeMetAndMissed) {
  EXPECT_EQ(check("at_least = 1"), "");
  EXPECT_EQ(check("at = \"least\"\nat_most = -1"), "");
  EXPECT_THAT(check(""), HasSubstr("has no bound; give `at_least`, `at_most` or both"));
  EXPECT_THAT(check("at_least = 2\nat_most = 1"), HasSubstr("`at_least` is above `at_most`"));
  EXPECT_THAT(check("at_least = 1\nat = \"first\""), HasSubstr("s.toml:5"));
  EXPECT_THAT(check("at_least = 1\nvariants = [\"other\"]"),
              HasSubstr("check.0.variants: no variant \"other\"; the scene has: main"));
}

// Measured points have no place on a map.
TEST(Check, MapsShowNoMeasuredPoints) {
  const std::string map = "[[chart]]\ntitle = \"t\"\nx = \"position_x_m\"\ny = \"position_y_m\"\nvalue = \"force_N\"\n";
  EXPECT_EQ(test::complaint(map + test::kSmallScene), "");
  EXPECT_THAT(test::complaint(map + "measured = [{ path = \"a.csv\", x = \"x\", y = \"y\" }]\n" + test::kSmallScene),
              HasSubstr("a map shows no measured points"));
}

}  // namespace check_test
}  // namespace glisson
