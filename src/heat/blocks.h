// blocks.h — loops over vertices in blocks of fixed length, on some threads; sums are added in the order of blocks.
//
// So results are the same bytes on any number of threads. oneTBB lends its workers to whoever has work.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace glisson::heat {

class Blocks {
 public:
  /// @param n  vertices @param threads  1 or more
  Blocks(std::size_t n, int threads);
  ~Blocks();

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
    const std::size_t blocks = count(n);
    parts_.resize(N * blocks);
    each(blocks, [&](std::size_t b) {
      const std::array<double, N> part = work(b * kBlock, std::min(n, (b + 1) * kBlock));
      std::copy(part.begin(), part.end(), parts_.begin() + static_cast<std::ptrdiff_t>(N * b));
    });
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
    const std::size_t blocks = count(n_);
    parts_.resize(N * blocks);
    each(blocks, [&](std::size_t b) {
      const std::array<double, N> part = work(b * kBlock, std::min(n_, (b + 1) * kBlock));
      std::copy(part.begin(), part.end(), parts_.begin() + static_cast<std::ptrdiff_t>(N * b));
    });
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
  struct Arena;

  static std::size_t count(std::size_t n) { return (n + kBlock - 1) / kBlock; }
  template <class Task>
  void each(std::size_t blocks, const Task& task) {
    if (arena_ == nullptr || blocks < 2) {
      for (std::size_t b = 0; b < blocks; ++b) task(b);
    } else {
      run_on_threads(blocks, task);
    }
  }
  void run_on_threads(std::size_t blocks, const std::function<void(std::size_t)>& task);

  std::size_t n_;
  int threads_;
  std::vector<double> parts_;
  std::unique_ptr<Arena> arena_;  ///< none for one thread
};

/// Threads that pay for a body of so many vertices on this machine.
int threads_for(std::size_t vertices);

}  // namespace glisson::heat
