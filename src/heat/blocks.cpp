#include "heat/blocks.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#if defined(__SANITIZE_THREAD__)
#include <atomic>
#include <thread>
#endif

namespace glisson::heat {

/// oneTBB has a worker fewer than the machine has cores unless it is told otherwise.
struct Blocks::Arena {
  explicit Arena(int threads)
      : workers(oneapi::tbb::global_control::max_allowed_parallelism,
                static_cast<std::size_t>(std::max(threads, oneapi::tbb::info::default_concurrency()))),
        arena(threads) {}
  oneapi::tbb::global_control workers;
  oneapi::tbb::task_arena arena;
};

Blocks::Blocks(std::size_t n, int threads) : n_(n), threads_(threads) {
  if (threads > 1) arena_ = std::make_unique<Arena>(threads);
}
Blocks::~Blocks() = default;

#if defined(__SANITIZE_THREAD__)
// Packaged oneTBB is not instrumented: the sanitizer would take everything for a race.
void Blocks::run_on_threads(std::size_t blocks, const std::function<void(std::size_t)>& task) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t b = next++; b < blocks; b = next++) task(b);
  };
  std::vector<std::thread> others;
  for (int t = 1; t < threads_; ++t) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
}
#else
void Blocks::run_on_threads(std::size_t blocks, const std::function<void(std::size_t)>& task) {
  arena_->arena.execute(
      [&] { oneapi::tbb::parallel_for(std::size_t{0}, blocks, task, oneapi::tbb::simple_partitioner()); });
}
#endif

int threads_for(std::size_t vertices) {
  constexpr std::size_t kThreadingVertices = 4096;
  return vertices < kThreadingVertices ? 1 : oneapi::tbb::info::default_concurrency();
}

}  // namespace glisson::heat
