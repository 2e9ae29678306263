// inbox.h — what comes to a source's thread from others: commands, and whether anybody looks. The thread sleeps while there is nothing
// to do, and is woken at once when there is.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

#include "view/state/command.h"
#include "view/thread/ring.h"

namespace glisson::view {

class Inbox {
 public:
  /// From one thread. @return false where there is no room
  bool post(const Command& command) {
    const bool taken = commands_.push(command);
    wake();
    return taken;
  }
  void set_watched(bool watched) {
    watched_.store(watched, std::memory_order_relaxed);
    wake();
  }
  /// By the source's thread.
  bool pop(Command& command) { return commands_.pop(command); }
  bool is_watched() const { return watched_.load(std::memory_order_relaxed); }
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
  Ring<Command, 1024> commands_;
  std::atomic<bool> watched_{true};
  std::mutex mutex_;
  std::condition_variable condition_;
  bool woken_ = false;
};

}  // namespace glisson::view
