// A scene from text, run by somebody else's program.
#include "glisson/scene/scene.h"

#include <cstdio>

int main() {
  const glisson::Scene scene = glisson::load_scene(GLISSON_SCENE);
  std::printf("%zu variants\n", scene.variants.size());
  return scene.variants.empty() ? 1 : 0;
}
