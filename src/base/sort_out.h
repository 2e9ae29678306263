// sort_out.h — lists of vertex numbers, ascending and each once.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace glisson::detail {

/// Brings numbers into ascending order, each once. Long lists are marked in a field of bits and read off, in a time that grows with their
/// length and the largest number; lists that are in order already are left as they are.
inline void sort_out(std::vector<std::uint32_t>& numbers) {
  constexpr std::size_t kFew = 32, kBits = 64;
  if (std::is_sorted(numbers.begin(), numbers.end(), std::less_equal<>())) return;  // strictly ascending
  const std::uint32_t largest = *std::max_element(numbers.begin(), numbers.end());
  if (numbers.size() < kFew || largest / kBits > kBits * numbers.size()) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    return;
  }
  std::vector<std::uint64_t> marks(largest / kBits + 1, 0);
  for (const std::uint32_t n : numbers) marks[n / kBits] |= std::uint64_t{1} << (n % kBits);
  numbers.clear();
  for (std::uint32_t word = 0; word < marks.size(); ++word) {
    for (std::uint64_t left = marks[word]; left != 0; left &= left - 1) {
      numbers.push_back(word * kBits + static_cast<std::uint32_t>(std::countr_zero(left)));
    }
  }
}

}  // namespace glisson::detail
