// ice_bench [TETS] [SHARE] — what it costs to freeze a share of the tets of a box, to change their ice, and to step with it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "glisson/instruments/ice.h"
#include "glisson/simulation/simulation.h"
#include "support/must_step.h"

namespace {

using namespace glisson;
using Clock = std::chrono::steady_clock;

template <class Act>
double least_ms(int times, const Act& act) {
  double least = 1e30;
  for (int k = 0; k < times; ++k) {
    const auto begin = Clock::now();
    act(k);
    least = std::min(least, std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
  }
  return least;
}

}  // namespace

int main(int argc, char** argv) {
  const double wanted = argc > 1 ? std::atof(argv[1]) : 50000.0, part = argc > 2 ? std::atof(argv[2]) : 0.1;
  const int cells = std::max(1, static_cast<int>(std::lround(std::cbrt(wanted / 6.0))));
  SimulationOptions options;
  options.threads = 1;
  Simulation s(box_mesh({.cells = {cells, cells, cells}, .size = {0.05, 0.05, 0.05}}), {{0, Tissue{}}}, options);
  s.fix("z_min");
  const auto ice = std::make_shared<Ice>();
  s.attach(ice);
  std::vector<std::pair<double, std::uint32_t>> by_distance;  // a ball, as around a probe
  for (std::uint32_t t = 0; t < s.mesh().tets.size(); ++t) {
    Vec3d sum{};
    for (const std::uint32_t v : s.mesh().tets[t]) sum += s.mesh().vertices[v];
    by_distance.emplace_back(norm(sum * 0.25 - Vec3d{0.025, 0.025, 0.025}), t);
  }
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<std::uint32_t> tets;
  for (std::size_t k = 0; k < static_cast<std::size_t>(part * static_cast<double>(by_distance.size())); ++k)
    tets.push_back(by_distance[k].second);
  const double bare = least_ms(200, [&](int) { test::must_step(s); });
  const auto set = [&](double share) { ice->set_shares(s, tets, std::vector<double>(tets.size(), share)); };
  const double first = least_ms(5, [&](int k) {
    if (k > 0) set(0.0);
    set(0.5);
  });
  const double change = least_ms(20, [&](int k) { set(k % 2 == 0 ? 1.0 : 0.5); });
  const double frozen = least_ms(200, [&](int) { test::must_step(s); });
  std::printf(
      "%zu tets, %zu frozen: to freeze them %.2f ms, to change their ice %.2f ms; a step %.3f ms, with ice %.3f ms\n",
      s.mesh().tets.size(), tets.size(), first, change, bare, frozen);
}
