#include "cli/check_clock.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <future>
#include <thread>
#include <utility>

#include "program/exit_code.h"
#include "program/standard_streams.h"

namespace glisson::app {

double CheckClock::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void CheckClock::begin(const std::string& part) {
  const std::lock_guard lock(mutex_);
  part_ = part;
}

void CheckClock::leave_out(const std::string& what) {
  const std::lock_guard lock(mutex_);
  left_out_.push_back(what);
}

void CheckClock::done(const std::string& variant) {
  const std::lock_guard lock(mutex_);
  std::erase(open_, variant);
}

std::string CheckClock::left_out() const {
  const std::lock_guard lock(mutex_);
  return left_out_.empty() ? "" : fmt::format("Left out for want of time: {}.\n", fmt::join(left_out_, "; "));
}

std::string CheckClock::not_a_pass() {
  return "This is not a pass (exit status 4). `--variant NAME` checks one variant alone, a coarser mesh takes less "
         "time, "
         "and `glisson run`\nbuilds the rest and says whether it can be run.\n";
}

int CheckClock::run(const std::function<int()>& work) {
  std::packaged_task<int()> task(work);
  std::future<int> result = task.get_future();
  std::thread worker(std::move(task));
  const double left = kMost - elapsed();
  if (result.wait_for(std::chrono::duration<double>(left)) == std::future_status::ready) {
    worker.join();
    return result.get();
  }
  const std::string others = left_out();
  const std::lock_guard lock(mutex_);
  say("\nThe check ends after {:.0f} s, within {}. Not known: whether {} can be run, and what that would cost.\n{}{}",
      kMost, part_, fmt::join(open_, ", "), others, not_a_pass());
  std::_Exit(end_output(kUnfinished));
}

}  // namespace glisson::app
