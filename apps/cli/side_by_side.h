// side_by_side.h — runs work items on a number of threads until the stop flag is set.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "program/interrupt.h"

namespace glisson::app {

/// Runs `work(i)` for every i in `order`, `threads` at a time, until the stop flag is set. The first exception
/// sets it and is thrown again at the end.
template <class Work>
void run_side_by_side(const std::vector<std::size_t>& order, int threads, Work work) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto worker = [&] {
    for (std::size_t i = next++; i < order.size() && !stop_flag(); i = next++) {
      try {
        work(order[i]);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        stop_flag() = true;
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back(worker);
    worker();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace glisson::app
