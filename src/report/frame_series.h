// frame_series.h — frames.pvd and frames/frame_0000.vtu …: a run as ParaView opens it.
//
// A frame is compressed and written while the run goes on, one at a time, on a thread of its own.
#pragma once

#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "glisson/instruments/instrument.h"
#include "glisson/io.h"
#include "glisson/scene/heat_run.h"
#include "glisson/simulation/simulation.h"
#include "report/tool_surface.h"

namespace glisson {

/// Writes frames one by one; the collection lists those that are whole.
class FrameSeries {
 public:
  /// @param folder  of the variant @param linear  whether to write TetFields::linear
  /// @throws OutputError where the folder of frames cannot be made
  explicit FrameSeries(std::filesystem::path folder, bool linear = false);
  /// Waits for the last frame; what is wrong with it then, only finish() says.
  ~FrameSeries();
  FrameSeries(const FrameSeries&) = delete;
  FrameSeries& operator=(const FrameSeries&) = delete;

  /// Writes the mesh at rest; displacement and velocity at the vertices; stress and strain (nine components), pressure,
  /// von Mises stress, q, s, jacobian, the linear law's share and region at the tets; pressure and traction of contact at the vertices where tools or a
  /// container are attached (docs/output.md).
  /// Beside it the surface of each instrument as frames/tool_NAME_0000.vtp, listed in tool_NAME.pvd.
  /// @throws OutputError where the frame before could not be written
  void add(const Simulation& simulation, const TetFields& fields);
  /// Waits until all frames are written. @throws OutputError where one could not be
  void finish();
  /// The instruments whose surfaces are written.
  void set_instruments(std::vector<std::shared_ptr<Instrument>> instruments) { instruments_ = std::move(instruments); }
  /// The heat whose temperatures are written at the vertices, and the ice of tets.
  void set_heat(std::shared_ptr<HeatCoupling> heat, std::vector<double> isotherms) {
    heat_ = std::move(heat), isotherms_ = std::move(isotherms);
  }

 private:
  using Files = std::vector<std::pair<double, std::filesystem::path>>;  ///< time [s], file relative to the .pvd
  struct Tool {
    std::string name;
    SurfaceMesh surface;
  };
  /// What a frame shows, apart from the run.
  struct Frame {
    double time = 0.0;
    TetMesh mesh;
    std::vector<Field> at_vertices, at_tets;
    std::vector<Tool> tools;
  };
  std::vector<Tool> tools_of(const Simulation& simulation) const;
  void write(const Frame& frame);

  std::filesystem::path folder_;
  bool linear_;
  std::vector<std::shared_ptr<Instrument>> instruments_;
  std::shared_ptr<HeatCoupling> heat_;  ///< null: none
  std::vector<double> isotherms_;
  std::map<std::string, Files> tools_;  ///< by name
  Files frames_;
  std::future<void> writing_;  ///< which has tools_ and frames_ until it is done
};

}  // namespace glisson
