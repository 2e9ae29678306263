// strangers.h — connections that have not shown the token yet: a few at a time, and the oldest gives way to a new one.
//
// Who means it shows the token with its first bytes, within milliseconds. So those who keep silent cannot keep others out, however
// often they come back: to push a visitor out they would have to bring as many connections as there are places within that time.
#pragma once

#include <cstddef>
#include <functional>
#include <list>

namespace glisson::view {

class Strangers {
 public:
  using Key = const void*;
  /// @param most  at a time, ≥ 1
  explicit Strangers(std::size_t most) : most_(most) {}

  /// @param drop  ends that connection, which may take a while and call went()
  void came(Key who, std::function<void()> drop) {
    all_.push_back({who, std::move(drop)});
    if (all_.size() <= most_) return;
    const std::function<void()> oldest = std::move(all_.front().drop);
    all_.pop_front();
    oldest();
  }
  /// It has shown the token, or is no more.
  void went(Key who) {
    all_.remove_if([who](const One& x) { return x.who == who; });
  }
  std::size_t size() const { return all_.size(); }

 private:
  struct One {
    Key who;
    std::function<void()> drop;
  };
  std::size_t most_;
  std::list<One> all_;  // the oldest first
};

}  // namespace glisson::view
