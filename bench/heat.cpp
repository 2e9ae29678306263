// heat.cpp — what freezing costs: docs/heat.md quotes it.
//
//   heat_bench [tets] [probes] [threads] [jitter]      196608 tets, 3 probes, threads as the body asks for, 0.2 of a cell
//
// A box of 10 cm of tissue with blood, whose inner vertices are moved at random so that a good part of the edges are obtuse; probes of 30 mm
// that take 400 W/m for 10 min, rest 3 min 20 s, freeze again for 10 min, and thaw: 25 min. Seconds are CPU time of all threads, so
// that another program on the machine does not count. Ends with an error where the balance or the range of temperatures is broken.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>

#include "glisson/heat/heat_simulation.h"
#include "support/bodies.h"

namespace glisson {
namespace {

constexpr double kSide = 0.1, kEnd = 1500.0;  // [m], [s]

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Two cycles of a probe [W/m].
TimeFunction<double> two_cycles() {
  return {[](double t) { return t <= 600.0 || (t > 800.0 && t <= 1400.0) ? -400.0 : 0.0; },
          CornerTimes({600.0, 800.0, 1400.0})};
}

HeatSimulation probes_in_a_box(int cells, int probes, int threads, double jitter) {
  std::mt19937 random(1);
  ThermalTissue tissue;
  tissue.perfusion = 5e-4;
  HeatSimulation s(test::jittered_box({cells, cells, cells}, kSide / cells, jitter, random), {{0, tissue}},
                   {.threads = threads});
  for (int p = 0; p < probes; ++p) {
    const double angle = 2.0 * 3.14159265358979 * p / 3.0, x = 0.5 * kSide + 0.01 * std::cos(angle),
                 y = 0.5 * kSide + 0.01 * std::sin(angle);
    s.add_line_source({{x, y, 0.035}, {x, y, 0.065}, two_cycles()});
  }
  return s;
}

int measure(int cells, int probes, int threads, double jitter) {
  const double before = cpu_seconds();
  HeatSimulation s = probes_in_a_box(cells, probes, threads, jitter);
  const double setup = cpu_seconds() - before;
  s.count_time();
  const double start = cpu_seconds();
  const auto wall = std::chrono::steady_clock::now();
  if (s.advance_to(kEnd).status != HeatStatus::ok) return std::puts("a step did not converge"), 1;
  const double total = cpu_seconds() - start,
               waited = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  const HeatWork& w = s.work();
  const double tets = static_cast<double>(s.mesh().tets.size()), all = static_cast<double>(w.products) * tets;
  const auto count = [](std::size_t n) { return static_cast<unsigned long>(n); };
  std::printf("%.0f tets, %d probes: %lu steps (%lu tried), %lu Newton and %lu linear iterations, %lu limiter rounds\n",
              tets, probes, count(s.steps()), count(w.steps), count(w.iterations), count(w.linear_iterations),
              count(w.limiter_rounds));
  std::printf("CPU s: states %.2f, limiter %.2f, residual %.2f, solves %.2f (products %.2f: %.2f ns a tet)\n",
              w.state_seconds, w.limiter_seconds, w.residual_seconds, w.solve_seconds, w.product_seconds,
              1e9 * w.product_seconds / all);
  std::printf("total %.2f s of CPU time, %.2f s of wall time, set up in %.2f s\n", total, waited, setup);
  const auto [low, high] = std::minmax_element(s.temperature().begin(), s.temperature().end());
  const HeatLedger l = s.ledger();
  const double through = std::abs(l.stored) + std::abs(l.sources) + std::abs(l.blood);
  std::printf("ice %.3f cm³, %.2f to %.6f °C, imbalance %.1e of %.0f J\n", 1e6 * s.frozen_volume(), *low, *high,
              l.imbalance(), through);
  return *high > 37.0 + 1e-9 || std::abs(l.imbalance()) > 1e-10 * through ? 1 : 0;
}

}  // namespace
}  // namespace glisson

int main(int count, char** arguments) {
  const auto number = [&](int k, double without) { return k < count ? std::atof(arguments[k]) : without; };
  const int cells = std::max(2, static_cast<int>(std::lround(std::cbrt(number(1, 196608) / 6.0))));
  return glisson::measure(cells, static_cast<int>(number(2, 3)), static_cast<int>(number(3, 0)), number(4, 0.2));
}
