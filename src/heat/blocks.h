// blocks.h — loops over vertices in blocks of fixed length, on some threads; sums are added in the order of blocks.
//
// So results are the same bytes on any number of threads.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "base/task_pool.h"

namespace glisson::heat {

class Blocks {
 public:
  /// @param n  vertices @param threads  1 or more
  Blocks(std::size_t n, int threads) : n_(n), pool_(threads) {}

  /// Calls work(begin, end) for every block of [0, n).
  template <class Work>
  void run(const Work& work) {
    run(n_, work);
  }
  template <class Work>
  void run(std::size_t n, const Work& work) {
    const std::size_t blocks = count(n);
    each(blocks, [&](std::size_t b) { work(b * kBlock, std::min(n, (b + 1) * kBlock)); });
  }
  /// Adds what work(begin, end) returns, an array of sums, block by block.
  template <std::size_t N, class Work>
  std::array<double, N> sums(std::size_t n, const Work& work) {
    const std::size_t blocks = find_parts<N>(n, work);
    std::array<double, N> all{};
    for (std::size_t b = 0; b < blocks; ++b) {
      for (std::size_t k = 0; k < N; ++k) all[k] += parts_[N * b + k];
    }
    return all;
  }
  template <std::size_t N, class Work>
  std::array<double, N> sums(const Work& work) {
    return sums<N>(n_, work);
  }
  /// The largest of what work(begin, end) returns, component by component; NaN where there is one.
  template <std::size_t N, class Work>
  std::array<double, N> largest(const Work& work) {
    const std::size_t blocks = find_parts<N>(n_, work);
    std::array<double, N> all{};
    for (std::size_t b = 0; b < blocks; ++b) {
      for (std::size_t k = 0; k < N; ++k) {
        if (!(parts_[N * b + k] <= all[k])) all[k] = parts_[N * b + k];
      }
    }
    return all;
  }

 private:
  static constexpr std::size_t kBlock = 1024;

  static std::size_t count(std::size_t n) { return (n + kBlock - 1) / kBlock; }
  /// What work gives of each block, side by side. @return how many
  template <std::size_t N, class Work>
  std::size_t find_parts(std::size_t n, const Work& work) {
    const std::size_t blocks = count(n);
    parts_.resize(N * blocks);
    each(blocks, [&](std::size_t b) {
      const std::array<double, N> part = work(b * kBlock, std::min(n, (b + 1) * kBlock));
      std::copy(part.begin(), part.end(), parts_.begin() + static_cast<std::ptrdiff_t>(N * b));
    });
    return blocks;
  }
  template <class Task>
  void each(std::size_t blocks, const Task& task) {
    if (pool_.threads() == 1 || blocks < 2) {
      for (std::size_t b = 0; b < blocks; ++b) task(b);
    } else {
      pool_.run(blocks, [&](std::size_t b, std::size_t) { task(b); });
    }
  }

  std::size_t n_;
  detail::TaskPool pool_;
  std::vector<double> parts_;
};

}  // namespace glisson::heat
