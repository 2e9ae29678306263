// frame_series.h — frames.pvd and frames/frame_0000.vtu …: a run as ParaView opens it.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "glisson/instruments/instrument.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// Writes frames one by one; the collection is complete after each of them.
class FrameSeries {
 public:
  /// @param folder  of the variant @throws OutputError where the folder of frames cannot be made
  explicit FrameSeries(std::filesystem::path folder);

  /// Writes the mesh at rest; displacement and velocity at the vertices; stress and strain (nine components), pressure,
  /// von Mises stress, q, s, jacobian and region at the tets; pressure and traction of contact at the vertices where tools or a
  /// container are attached (docs/output.md). @throws OutputError
  /// Beside it the surface of each instrument as frames/tool_NAME_0000.vtp, listed in tool_NAME.pvd.
  void add(const Simulation& simulation, const TetFields& fields);
  /// The instruments whose surfaces are written.
  void set_instruments(std::vector<std::shared_ptr<Instrument>> instruments) { instruments_ = std::move(instruments); }

 private:
  using Files = std::vector<std::pair<double, std::filesystem::path>>;
  void add_tools(const Simulation& simulation);

  std::filesystem::path folder_;
  std::vector<std::shared_ptr<Instrument>> instruments_;
  std::map<std::string, Files> tools_;                            // by name
  std::vector<std::pair<double, std::filesystem::path>> frames_;  // time [s], file relative to the .pvd
};

}  // namespace glisson
