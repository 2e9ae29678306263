// mesh_cache.h — mesh files of the variants: each read once, its warnings said once.
#pragma once

#include <map>
#include <mutex>
#include <string>

#include "glisson/scene/scene.h"

namespace glisson::app {

/// Safe to call from all runs at once.
class MeshCache {
 public:
  /// @param quiet  warnings of the reader are not printed
  explicit MeshCache(bool quiet) : quiet_(quiet) {}

  /// @throws FileError where the file cannot be used
  TetMesh load(const MeshFile& file);
  MeshLoader loader() {
    return [this](const MeshFile& file) { return load(file); };
  }

 private:
  bool quiet_;
  std::mutex mutex_;
  std::map<std::string, TetMesh> meshes_;
};

}  // namespace glisson::app
