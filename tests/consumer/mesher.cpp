// A body of a shape, meshed by somebody else's program.
#include <cstdio>

#include "glisson/implicit.h"
#include "glisson/region_mesh.h"

int main() {
  const glisson::Solid ball = glisson::BallShape{{0, 0, 0}, 0.02};
  const glisson::RegionMesh made = glisson::mesh_regions({glisson::region_of("ball", ball)}, {.edge = 0.005});
  std::printf("%zu tets\n", made.mesh.tets.size());
  return made.mesh.tets.empty() ? 1 : 0;
}
