// latest.h — one writer hands one reader its latest value, without locks: neither ever waits for the other.
//
//   writer: back ──publish──▶ middle ──take──▶ front : reader        three slots, their numbers swapped atomically
//
// What the reader did not take in time is overwritten: latest wins.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace glisson::view {

template <class T>
class Latest {
 public:
  /// The writer's slot; it holds some older value.
  T& back() { return slots_[back_]; }
  /// Hands over the writer's slot.
  void publish() { back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kSlot; }
  /// The newest value, the reader's until its next call; null where there is none since the last.
  const T* take() {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return nullptr;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kSlot;
    return &slots_[front_];
  }

 private:
  static constexpr std::uint8_t kFresh = 4, kSlot = 3;
  std::array<T, 3> slots_{};
  std::uint8_t back_ = 0, front_ = 2;
  std::atomic<std::uint8_t> middle_{1};
};

}  // namespace glisson::view
