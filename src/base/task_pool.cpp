#include "base/task_pool.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#if defined(__SANITIZE_THREAD__)
#include <atomic>
#include <thread>
#include <vector>
#endif

namespace glisson::detail {

/// oneTBB has a worker fewer than the machine has cores unless it is told otherwise.
struct TaskPool::Arena {
  explicit Arena(int threads)
      : workers(oneapi::tbb::global_control::max_allowed_parallelism,
                static_cast<std::size_t>(std::max(threads, oneapi::tbb::info::default_concurrency()))),
        arena(threads) {}
  oneapi::tbb::global_control workers;
  oneapi::tbb::task_arena arena;
};

TaskPool::TaskPool(int threads) : threads_(threads) {
  if (threads > 1) arena_ = std::make_unique<Arena>(threads);
}
TaskPool::~TaskPool() = default;

#if defined(__SANITIZE_THREAD__)
// Packaged oneTBB is not instrumented, so that the thread sanitizer cannot see how tasks begin and end and takes
// everything for a race. Its builds run the tasks on plain threads: what it then finds is ours.
void TaskPool::run(std::size_t n, const std::function<void(std::size_t, std::size_t)>& task) {
  std::atomic<std::size_t> next{0};
  const auto work = [&](std::size_t thread) {
    for (std::size_t i = next++; i < n; i = next++) task(i, thread);
  };
  std::vector<std::thread> others;
  for (int t = 1; t < threads_; ++t) others.emplace_back(work, static_cast<std::size_t>(t));
  work(0);
  for (std::thread& other : others) other.join();
}
#else
void TaskPool::run(std::size_t n, const std::function<void(std::size_t, std::size_t)>& task) {
  if (arena_ == nullptr) {
    for (std::size_t i = 0; i < n; ++i) task(i, 0);
    return;
  }
  arena_->arena.execute([&] {
    oneapi::tbb::parallel_for(
        std::size_t{0}, n,
        [&](std::size_t i) { task(i, static_cast<std::size_t>(oneapi::tbb::this_task_arena::current_thread_index())); },
        oneapi::tbb::simple_partitioner());
  });
}
#endif

int threads_for(std::size_t parts) { return parts < kThreadingParts ? 1 : oneapi::tbb::info::default_concurrency(); }

}  // namespace glisson::detail
