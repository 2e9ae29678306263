#include "engine/task_pool.h"

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace glisson::engine {

struct TaskPool::Arena {
  oneapi::tbb::task_arena arena;
};

TaskPool::TaskPool(int threads) : threads_(threads) {
  if (threads > 1) arena_ = std::make_unique<Arena>(Arena{oneapi::tbb::task_arena(threads)});
}
TaskPool::~TaskPool() = default;

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

int threads_for(std::size_t tets) { return tets < kThreadingTets ? 1 : oneapi::tbb::info::default_concurrency(); }

}  // namespace glisson::engine
