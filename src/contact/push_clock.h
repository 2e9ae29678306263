// push_clock.h — when which place was last pushed: a row whose places no other has pushed since it was solved is solved still.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace glisson {

class PushClock {
 public:
  using Time = std::uint64_t;
  /// There are so many places. Those known keep their time.
  void fit(std::size_t places) { last_.resize(places, 1); }
  Time now() const { return now_; }
  /// Pushes places, later than all that was pushed before.
  void push(std::span<const std::uint32_t> places) {
    ++now_;
    for (const std::uint32_t place : places) last_[place] = now_;
  }
  /// When one of the places was last pushed.
  Time latest(std::span<const std::uint32_t> places) const {
    Time latest = 0;
    for (const std::uint32_t place : places) latest = std::max(latest, last_[place]);
    return latest;
  }

 private:
  std::vector<Time> last_;
  Time now_ = 1;
};

}  // namespace glisson
