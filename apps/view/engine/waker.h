// waker.h — lets a source's thread sleep while there is nothing to do, and wakes it at once when there is.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace glisson::view {

class Waker {
 public:
  /// From any thread. What comes before a sleep ends that sleep.
  void wake() {
    {
      const std::lock_guard lock(mutex_);
      woken_ = true;
    }
    condition_.notify_one();
  }
  /// Sleeps until it is woken, or for so long.
  void sleep(std::chrono::milliseconds most) {
    std::unique_lock lock(mutex_);
    condition_.wait_for(lock, most, [this] { return woken_; });
    woken_ = false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable condition_;
  bool woken_ = false;
};

}  // namespace glisson::view
