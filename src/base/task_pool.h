// task_pool.h — runs numbered tasks on some threads, or all of them here.
//
// oneTBB lends its workers to whoever has tasks, so that two simulations in one program share the cores; the
// caller works too and is never put to sleep while tasks are left. Tasks must not depend on their order.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace glisson::detail {

class TaskPool {
 public:
  /// @param threads  1 or more
  explicit TaskPool(int threads);
  ~TaskPool();

  int threads() const { return threads_; }
  /// Calls task(i, thread) for every i below n; `thread` is below threads() and no two calls share it at a time.
  void run(std::size_t n, const std::function<void(std::size_t, std::size_t)>& task);

 private:
  struct Arena;
  int threads_;
  std::unique_ptr<Arena> arena_;  ///< none for one thread
};

/// Threads that pay on this machine for so many parts of a body: one below kThreadingParts.
int threads_for(std::size_t parts);
/// Tets of the mechanics, vertices of heat. Below this a second thread gains nothing (docs/engine.md, measured for tets).
inline constexpr std::size_t kThreadingParts = 4096;

}  // namespace glisson::detail
