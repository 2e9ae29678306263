// A box that cools, in somebody else's program.
#include <cstdio>

#include "glisson/heat/heat_simulation.h"

int main() {
  glisson::HeatSimulation box(glisson::box_mesh({}), {{0, glisson::ThermalTissue{}}}, {.temperature = 37.0});
  const bool made = box.step().status == glisson::HeatStatus::ok;
  std::printf("%g s\n", box.time());
  return made ? 0 : 1;
}
