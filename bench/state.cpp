// state.cpp — what it costs to go back in time: docs/integrators.md quotes the medians.
//
//   state_bench
//
// A block of 10 368 tets with a needle in it and a capsule around it, one thread: a state saved and loaded where the body is the same,
// across a removal of tets, and by a file. Every state that is loaded is checked by its hash.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "glisson/instruments/capsule.h"
#include "glisson/instruments/needle.h"
#include "glisson/instruments/tool_motion.h"
#include "support/must_step.h"

namespace glisson {
namespace {

constexpr int kTimes = 21;
constexpr double kSize = 0.06;

/// Runs it. @return how long that takes [ms]
template <class Run>
double milliseconds(Run run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

struct Kept {
  State state;
  std::uint64_t hash;
};

Kept keep(const Simulation& s) { return {s.save_state(), s.state_hash()}; }

/// @return how long it takes [ms]
double go_to(Simulation& s, const Kept& kept) {
  const double time = milliseconds([&] { s.load_state(kept.state); });
  if (s.state_hash() != kept.hash) throw std::runtime_error("a state is another one after it was loaded");
  return time;
}

void measure(Integrator integrator, bool branches) {
  Tissue tissue{.youngs_modulus = 3000.0};
  if (branches) tissue.maxwell = {{0.3, 5e-3}, {0.2, 0.1}};
  SimulationOptions o{.integrator = integrator, .damping_rate = 20.0, .threads = 1};
  const TetMesh mesh = box_mesh({.cells = {12, 12, 12}, .size = {kSize, kSize, kSize}});
  Simulation s(mesh, {{0, tissue}}, o);
  s.fix("z_min");
  NeedleOptions needle;
  needle.rupture.force = 0.02, needle.tip.cutting = 0.01;
  const Pose start{.position = {0.5 * kSize, 0.52 * kSize, kSize + 1e-4}};
  s.attach(std::make_shared<Needle>(needle, std::make_shared<PathDriver>(start, steady_path({.velocity = 0.1}))));
  s.attach(std::make_shared<Capsule>(CapsuleOptions{.thickness = 1e-4, .youngs_modulus = 2e4}));
  const bool is_long = capabilities(integrator).any_step_is_stable;
  const auto run = [&](double time) {
    while (s.time() < time) test::must_step(s);
  };
  run(is_long ? 0.05 : 0.08);
  const Kept first = keep(s);
  const double straight = milliseconds([&] { test::must_step(s); });
  run(s.time() + (is_long ? 0.02 : 0.005));
  const Kept second = keep(s);
  std::vector<double> saves, loads, again, written, read, across;
  for (int i = 0; i < kTimes; ++i) {
    loads.push_back(go_to(s, i % 2 == 0 ? first : second));
    saves.push_back(milliseconds([&] { static_cast<void>(s.save_state()); }));
    const double step = milliseconds([&] { test::must_step(s); });
    if (i % 2 == 0) again.push_back(step);
    std::stringstream file;
    written.push_back(milliseconds([&] { s.save(file); }));
    read.push_back(milliseconds([&] { s.load(file); }));
  }
  const Kept before = keep(s);
  const double change = milliseconds([&] { s.remove_tets(std::vector<std::uint32_t>{5000, 5001, 5002}); });
  test::must_step(s);
  const Kept behind = keep(s);
  for (int i = 0; i < kTimes; ++i) across.push_back(go_to(s, i % 2 == 0 ? before : behind));
  std::printf(
      "%-19s%-9s save %.2f  load %.2f  across a cut %.1f (first removal %.1f)  a step %.1f, again after a load %.1f  "
      "file %.1f, %.1f ms\n",
      std::string(word_of(integrator)).c_str(), branches ? "branches" : "", median(saves), median(loads),
      median(across), change, straight, median(again), median(written), median(read));
}

}  // namespace
}  // namespace glisson

int main() {
  using glisson::Integrator;
  for (const Integrator integrator :
       {Integrator::central_difference, Integrator::semi_implicit, Integrator::implicit}) {
    for (const bool branches : {false, true}) glisson::measure(integrator, branches);
  }
}
