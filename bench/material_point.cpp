// material_point.cpp — what a step of a material point costs, in processor time and in allocations.
//
//   material_point_bench
//
// Each test goes to and fro between rest and its end. The sum of all driven stresses is printed to the last digit: an equal
// sum means that the same steps were made.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include "glisson/material_point.h"

// Every allocation of the program is counted: of glibc's malloc, which Eigen and operator new call.
static std::size_t allocations = 0;
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) noexcept {
  ++allocations;
  return __libc_malloc(size);
}

namespace glisson {
namespace {

constexpr int kRounds = 9, kSteps = 20000, kWay = 100;  // a way takes 100 steps

void measure(const char* what, const Tissue& tissue, MaterialTest test, double rest, double end) {
  std::vector<double> times;
  double total = 0.0;
  std::size_t most = 0;
  for (int round = 0; round < kRounds + 1; ++round) {
    MaterialPoint point(tissue);
    const std::size_t i = test == MaterialTest::simple_shear ? 0 : 2;
    const std::size_t before = allocations;
    total = 0.0;
    const std::clock_t start = std::clock();
    for (int step = 1; step <= kSteps; ++step) {
      const int at = step % (2 * kWay);
      const double share = static_cast<double>(at <= kWay ? at : 2 * kWay - at) / kWay;
      total += point.advance(0.01, test_targets(test, MaterialControl::deformation, rest + share * (end - rest)))
                   .nominal(i, 2);
    }
    const double ns = 1e9 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    most = allocations - before;
    if (round > 0) times.push_back(ns / kSteps);  // the first one warms up
  }
  std::sort(times.begin(), times.end());
  std::printf("%-32s %8.0f ns/step (%.0f to %.0f)  %6.2f allocations/step  sum %a\n", what, times[times.size() / 2],
              times.front(), times.back(), static_cast<double>(most) / kSteps, total);
}

}  // namespace
}  // namespace glisson

int main() {
  using namespace glisson;
  Tissue ogden, branches, viscous;
  ogden.hyperelastic = Ogden{{842.0}, {-4.7}, 2e5};
  branches = ogden;
  branches.maxwell = {{0.3, 0.5}, {0.2, 20.0}};
  viscous.kinematics = Kinematics::green, viscous.viscosity = 20.0;
  measure("linear, simple shear", Tissue{}, MaterialTest::simple_shear, 0.0, 0.3);
  measure("Ogden, simple shear", ogden, MaterialTest::simple_shear, 0.0, 0.3);
  measure("Ogden, uniaxial", ogden, MaterialTest::uniaxial, 1.0, 0.7);
  measure("Ogden, 2 branches, uniaxial", branches, MaterialTest::uniaxial, 1.0, 0.7);
  measure("Green, viscous, uniaxial", viscous, MaterialTest::uniaxial, 1.0, 1.2);
  return 0;
}
