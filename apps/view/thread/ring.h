// ring.h — a queue from one thread to another, without locks; what does not fit is refused.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>

namespace glisson::view {

/// @tparam N  places, a power of two
template <class T, std::size_t N>
class Ring {
  static_assert((N & (N - 1)) == 0, "a power of two");

 public:
  /// Of the writer. @return false where it is full
  bool push(const T& value) {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - head_.load(std::memory_order_acquire) == N) return false;
    slots_[tail % N] = value;
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }
  /// Of the reader. @return false where it is empty
  bool pop(T& value) {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return false;
    value = slots_[head % N];
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

 private:
  std::array<T, N> slots_{};
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

}  // namespace glisson::view
