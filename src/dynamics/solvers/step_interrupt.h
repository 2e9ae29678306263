// step_interrupt.h — whether a long step is to end before it is made: asked of the program some times a second.
//
// The parts of a long step that may take long (Newton's and Krylov's iterations, line searches, panels of a factor, trials of
// contact) ask wanted() between pieces of work, which is nearly free. Once it has said so it goes on saying so until the next step,
// so that all of them come to an end; the scheme then goes back to where the step began.
#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <utility>

#include "glisson/simulation/simulation.h"

namespace glisson {

class StepInterrupt {
 public:
  void set(std::function<bool(const StepProgress&)> asks) { asks_ = std::move(asks); }
  /// A step begins, in which it may be wanted, or has ended.
  void begin() { within_ = true, wanted_ = false; }
  void end() { within_ = false; }
  /// Where the step is, for who is asked.
  void set_progress(const StepProgress& progress) { progress_ = progress; }
  void set_iteration(int iteration) { progress_.iteration = iteration; }

  /// Asks, where that was some time ago. Cost: a look at the clock.
  bool wanted() {
    if (wanted_ || !within_ || !asks_) return wanted_;
    const Clock::time_point now = Clock::now();
    if (now < next_) return false;
    next_ = now + kPeriod;
    try {
      wanted_ = asks_(progress_);
    } catch (...) {  // once the state is again that of before the step
      raised_ = std::current_exception();
      wanted_ = true;
    }
    return wanted_;
  }
  /// Whether it was wanted in this step.
  bool is_wanted() const { return wanted_; }
  const StepProgress& progress() const { return progress_; }
  /// Throws what the program's function threw in this step.
  void rethrow() {
    if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kPeriod{100};

  std::function<bool(const StepProgress&)> asks_;
  StepProgress progress_{};
  Clock::time_point next_{};
  std::exception_ptr raised_;
  bool within_ = false, wanted_ = false;
};

}  // namespace glisson
