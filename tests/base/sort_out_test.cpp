// sort_out_test.cpp — lists come out ascending and each once, by whichever way they are brought there.
#include "base/sort_out.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace glisson {
namespace {

TEST(SortOut, GivesEachOnceAscending) {
  std::mt19937 random(3);
  for (const std::size_t size : {0, 1, 2, 31, 32, 33, 1000}) {
    for (const std::uint32_t largest : {5U, 63U, 64U, 4000U, 4'000'000'000U}) {
      std::uniform_int_distribution<std::uint32_t> any(0, largest);
      std::vector<std::uint32_t> list(size);
      for (std::uint32_t& n : list) n = any(random);
      const std::set<std::uint32_t> set(list.begin(), list.end());
      const std::vector<std::uint32_t> exact(set.begin(), set.end());
      detail::sort_out(list);
      EXPECT_EQ(list, exact) << size << " up to " << largest;
      detail::sort_out(list);
      EXPECT_EQ(list, exact) << "in order already";
    }
  }
}

}  // namespace
}  // namespace glisson
