// A mesh written and read back by somebody else's program.
#include "glisson/io.h"

#include <cstdio>

int main() {
  const glisson::TetMesh box = glisson::box_mesh({});
  glisson::write_vtu("box.vtu", box);
  const glisson::ImportedMesh read = glisson::read_mesh("box.vtu");
  std::printf("%zu tets\n", read.mesh.tets.size());
  return read.mesh.tets.size() == box.tets.size() ? 0 : 1;
}
