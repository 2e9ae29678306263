// The README's program: a box of tissue, held below, pressed from above.
#include "glisson/glisson.h"

#include <cstdio>
#include <string>

int main() {
  const glisson::TetMesh box = glisson::box_mesh({});
  glisson::Simulation simulation(box, {{0, glisson::Tissue{}}}, {.damping_rate = 50.0});
  simulation.fix("z_min");
  const auto tool = simulation.drive("z_max", glisson::press({.velocity = 0.01, .depth = 0.005}));
  if (const glisson::StepResult last = simulation.advance_to(1.0); !last.made()) {
    std::fprintf(stderr, "%s\n", std::string(last.message).c_str());  // why, and what to do
    return 1;
  }
  std::printf("%.4f N\n", -simulation.force(tool).total().z);
}
