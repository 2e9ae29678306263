// check_clock.h — the time that `glisson check` takes: ten seconds at most, whatever the scene.
//
//   parts that may be left out ask has_time() ──▶ what they leave out is said at the end
//   the whole runs in a thread ──▶ where a part cannot be ended (a mesher, a search of the stable step), the program ends without it
#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "glisson/scene/advice.h"

namespace glisson::app {

/// Safe to call from both threads.
class CheckClock : public TrialTime {
 public:
  /// @param variants  names of those that are to be checked
  explicit CheckClock(std::vector<std::string> variants) : open_(std::move(variants)) {}

  /// Whether a part that may be left out can be begun. @param seconds  that it may take
  bool has_time(double seconds = 0.0) const override { return elapsed() + seconds < kOptional; }
  double elapsed() const override;
  /// Says what is being done now.
  void begin(const std::string& part) override;
  void leave_out(const std::string& what) override;
  /// A variant has been checked, or left out.
  void done(const std::string& variant);
  /// "left out for want of time: …", a line; empty: nothing was.
  std::string left_out() const;

  /// What a check that has not looked at every variant says at its end, with the way out.
  static std::string not_a_pass();

  /// Does the work. Where it does not end in time, says so and ends the program with kUnfinished. @return what it returned @throws what it threw
  int run(const std::function<int()>& work);

 private:
  static constexpr double kOptional = 5.0, kMost = 9.0;  ///< [s]

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  mutable std::mutex mutex_;
  std::string part_ = "reading the scene";
  std::vector<std::string> open_, left_out_;
};

}  // namespace glisson::app
