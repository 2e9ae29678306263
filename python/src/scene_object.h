// scene_object.h — a scene as Python holds it: its variants are objects of their own, to be changed before a run.
#pragma once

#include <memory>
#include <vector>

#include "glisson/scene/scene.h"

namespace glisson::python {

struct SceneObject {
  explicit SceneObject(Scene read) : scene(std::move(read)) {
    for (const Variant& v : scene.variants) variants.push_back(std::make_shared<Variant>(v));
  }
  Scene scene;
  std::vector<std::shared_ptr<Variant>> variants;  ///< in place of scene.variants
};

}  // namespace glisson::python
