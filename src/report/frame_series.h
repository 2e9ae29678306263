// frame_series.h — frames.pvd and frames/frame_0000.vtu …: a run as ParaView opens it.
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "glisson/simulation/simulation.h"

namespace glisson {

/// Writes frames one by one; the collection is complete after each of them.
class FrameSeries {
 public:
  /// @param folder  of the variant @throws OutputError where the folder of frames cannot be made
  explicit FrameSeries(std::filesystem::path folder);

  /// Writes the mesh at rest; displacement and velocity at the vertices; stress and strain (nine components), pressure,
  /// von Mises stress, q, s, jacobian and region at the tets (docs/output.md). @throws OutputError
  void add(const Simulation& simulation, const TetFields& fields);

 private:
  std::filesystem::path folder_;
  std::vector<std::pair<double, std::filesystem::path>> frames_;  // time [s], file relative to the .pvd
};

}  // namespace glisson
