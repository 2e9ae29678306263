// mesh_cache.cpp — see mesh_cache.h.
#include "program/mesh_cache.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "glisson/io.h"
#include "program/standard_streams.h"

namespace glisson::app {

TetMesh MeshCache::load(const MeshFile& file) {
  const std::lock_guard lock(mutex_);
  const std::string key = fmt::format("{} × {:a}", file.path.string(), file.scale.value_or(0.0));
  const auto known = meshes_.find(key);
  if (known != meshes_.end()) return known->second;
  if (!std::filesystem::exists(file.path)) {
    throw FileError(file.path.string() + ": there is no such mesh; name one by --mesh FILE or --set mesh.path=FILE");
  }
  ImportedMesh imported = read_mesh(file.path, file.scale);
  if (!quiet_) {
    for (const std::string& warning : imported.report.warnings) tell("warning: {}\n", warning);
  }
  return meshes_.emplace(key, std::move(imported.mesh)).first->second;
}

}  // namespace glisson::app
