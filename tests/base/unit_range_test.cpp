// Every number has two ends: its own, or those of its unit.
#include <gtest/gtest.h>

#include <cmath>

#include "base/unit_range.h"

namespace glisson {
namespace {

using detail::within_unit;

// A range keeps the ends it has and takes the unit's where it has none; millimetres are a thousandth.
TEST(UnitRange, ClosesWhatIsOpen) {
  EXPECT_EQ(within_unit({}, "N").text(), "-1e+09 to 1e+09");
  EXPECT_EQ(within_unit(at_least(0), "Pa").text(), "0 to 1e+12");
  EXPECT_EQ(within_unit(above(0), "mm").text(), "> 0 and ≤ 1e+07");
  EXPECT_EQ(within_unit(above(0), "mm²").text(), "> 0 and ≤ 1e+14");
  EXPECT_EQ(within_unit(above(0), "mm/s").text(), "> 0 and ≤ 1e+09");
  EXPECT_EQ(within_unit(strictly_between(-1, 0.5), "-").text(), "> -1 and < 0.5");
  EXPECT_EQ(within_unit(at_least(0.1), "mm").text(), "0.1 to 1e+07");
  EXPECT_EQ(within_unit(above(0), "parsecs").text(), "> 0");
}

// What is divided by has a smallest number, too, where its unit says so.
TEST(UnitRange, HasASmallestDivisor) {
  EXPECT_EQ(within_unit(above(0), "kg/m³").text(), "0.001 to 1e+09");
  EXPECT_EQ(within_unit(above(0), "Pa").text(), "1e-06 to 1e+12");
}

// Squares and products of two numbers of a unit, as stresses and masses are multiplied, stay within single precision.
TEST(UnitRange, ProductsFitSinglePrecision) {
  for (const detail::UnitRange& x : detail::unit_ranges())
    EXPECT_TRUE(std::isfinite(float(x.largest * x.largest))) << x.unit;
}

}  // namespace
}  // namespace glisson
