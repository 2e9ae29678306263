// expected_time.cpp — see expected_time.h.
#include "compare/expected_time.h"

#include <chrono>
#include <cmath>
#include <thread>

namespace glisson::app {
namespace {

constexpr double kTaste = 0.1, kLongestTaste = 60.0;  // [s]

/// Runs a model until a time by the clock has passed, or to its end.
models::Answer run_for(double seconds, const models::Rival& rival, const models::Problem& problem,
                       const std::atomic<bool>& stop) {
  std::atomic<bool> enough{false};
  const auto begin = std::chrono::steady_clock::now();
  const std::jthread clock([&](const std::stop_token& ended) {
    const auto passed = [&] { return std::chrono::steady_clock::now() - begin; };
    while (!ended.stop_requested() && !stop && passed() < std::chrono::duration<double>(seconds))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    enough = true;
  });
  return rival.run(problem, rival.efforts.front(), enough);
}

}  // namespace

ExpectedTime expected_time(const models::Rival& rival, const models::Problem& coarsest, int meshes,
                           const std::atomic<bool>& stop) {
  ExpectedTime expected{.model = std::string(rival.name)};
  if (!rival.explicit_steps) return expected;
  models::Answer answer;
  // The time counts from before the model is made, which may take longer than the taste.
  for (double seconds = kTaste; answer.share_done <= 0.0 && seconds < kLongestTaste && !stop; seconds *= 4.0) {
    answer = run_for(seconds, rival, coarsest, stop);
    if (!answer.trouble.empty()) return expected;
  }
  if (answer.share_done <= 0.0) return expected;
  for (int k = 0; k < meshes; ++k) {
    expected.steps += std::ldexp(static_cast<double>(answer.steps) / answer.share_done, k);
    expected.wall_s += std::ldexp(answer.run_s / answer.share_done, 4 * k);
  }
  return expected;
}

}  // namespace glisson::app
