// cutter_fuzz.cpp — what a Cutter saved, damaged behind its checksum: one that fits goes on cutting, any other is refused.
//
// The first byte is the mode of forged_file.h. The simulation's own checkpoint is sound.
#include <array>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "forged_file.h"
#include "glisson/instruments/cutting.h"
#include "glisson/simulation/simulation.h"
#include "support.h"

namespace {

using namespace glisson;
using fuzz::require;

Simulation made() {
  TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  const std::vector<std::uint32_t> bottom = mesh.vertex_sets.at("z_min");
  SimulationOptions options;
  options.threads = 1;
  Simulation simulation(std::move(mesh), {{0, Tissue{}}}, options);
  simulation.fix(bottom);
  return simulation;
}

/// Across the body at a height.
BladeEdge edge_at(double z) { return {{0.011, -0.01, z}, {0.012, 0.03, z}}; }

struct Saved {
  std::string simulation, cutter;  ///< whole file, content
};

/// A cut that is half done: tets are crossed that the edge has not left.
const Saved& saved() {
  static const Saved both = [] {
    Simulation simulation = made();
    Cutter cutter(simulation);
    cutter.place(edge_at(0.025));
    for (const double z : {0.019, 0.015, 0.012}) {
      require(simulation.step().status == StepStatus::ok, "the body can be stepped");
      cutter.advance(edge_at(z));
    }
    std::ostringstream body, blade;
    simulation.save(body);
    cutter.save(blade);
    return Saved{body.str(), fuzz::content_of(blade.str())};
  }();
  return both;
}

void load(std::string_view content) {
  Simulation simulation = made();
  std::istringstream body(saved().simulation), blade(fuzz::file_of(content));
  simulation.load(body);
  Cutter cutter(simulation);
  try {
    cutter.load(blade);
  } catch (const std::runtime_error& error) {
    require(content != saved().cutter, "what was saved is loaded");
    require(std::string_view(error.what()).substr(0, 10) == "checkpoint", "a refusal says of what");
    return;
  }
  for (const double z : {0.011, 0.009, 0.004}) {
    for (const EdgePiece& piece : cutter.contact()) {
      require(piece.tet < simulation.mesh().tets.size(), "the edge is in tets of the body");
    }
    try {
      cutter.advance(edge_at(z));
    } catch (const std::invalid_argument&) {
      return;  // it was never placed
    }
    static_cast<void>(simulation.step());
  }
}

}  // namespace

/// What is saved today (fuzz_replay_cutter --seeds FOLDER).
void write_seeds(const std::filesystem::path& folder) {
  fuzz::write_file(folder / "content", std::string(1, '\0') + saved().cutter);
  fuzz::write_file(folder / "edits", "\1");
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  load(fuzz::forged_content(saved().cutter, data[0], {reinterpret_cast<const char*>(data) + 1, size - 1}));
  return 0;
}
