// read_pace.h — counts the bytes that a viewer sends. Messages are counted one by one (Pacer), but a fragment without content is
// none, and beast reads any number of those without a word; what they cannot do without is bytes.
#pragma once

#include <boost/beast/core/rate_policy.hpp>
#include <chrono>
#include <cstddef>
#include <limits>

#include "view/server/access.h"

namespace glisson::view {

/// A rate policy of beast that holds nothing up; whoever looks at exceeded() decides.
class ReadPace {
 public:
  explicit ReadPace(double bytes_per_second) : left_(bytes_per_second, bytes_per_second, Pacer::Clock::now()) {}
  /// Whether more has come than the rate and a second of it in store allow.
  bool exceeded() const { return exceeded_; }

 private:
  friend class boost::beast::rate_policy_access;
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

  std::size_t available_read_bytes() const { return kAll; }
  std::size_t available_write_bytes() const { return kAll; }
  void transfer_read_bytes(std::size_t bytes) {
    exceeded_ = exceeded_ || !left_.take(Pacer::Clock::now(), static_cast<double>(bytes));
  }
  void transfer_write_bytes(std::size_t) {}
  void on_timer() {}

  Pacer left_;
  bool exceeded_ = false;
};

}  // namespace glisson::view
