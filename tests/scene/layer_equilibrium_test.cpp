// In equilibrium each layer of a pressed block carries the tool's force: what frames tell of stress adds up to what the tool
// tells of its force, for every tissue that ships.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "glisson/instruments/motion.h"
#include "glisson/scene/tissue_presets.h"

namespace glisson {
namespace {

constexpr double kEdge = 0.04;  // of the block [m]

/// A block held at its bottom, a pad on its top pressed in.
struct Pressed {
  TetMesh mesh;
  int cells;
  Simulation simulation;
  ConstraintId tool;

  Pressed(const Tissue& tissue, int n, double depth, const SimulationOptions& options, double time)
      : mesh(box_mesh({.cells = {n, n, n}, .size = {kEdge, kEdge, kEdge}})), cells(n),
        simulation(mesh, {{0, tissue}}, options) {
    simulation.fix(mesh.vertex_sets.at("z_min"));
    std::vector<std::uint32_t> pad;
    for (const std::uint32_t v : mesh.vertex_sets.at("z_max")) {
      const Vec3d& x = mesh.vertices[v];
      if (std::max(std::abs(x.x - 0.5 * kEdge), std::abs(x.y - 0.5 * kEdge)) < 0.26 * kEdge) pad.push_back(v);
    }
    tool = simulation.drive(pad, press({.velocity = depth / 0.1, .depth = depth}));
    const StepResult last = simulation.advance_to(time);
    EXPECT_TRUE(last.made()) << last.message;
  }

  /// ∫ P_zz over a section of each layer of cells, over the force of the tool. P_zz is per area at rest, as the section is.
  std::vector<double> shares() const {
    const TetFields fields = simulation.tet_fields();
    std::vector<double> sum(static_cast<std::size_t>(cells), 0.0);
    const double height = kEdge / cells;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const auto x = [&](std::size_t a) { return mesh.vertices[mesh.tets[t][a]]; };
      const double volume = dot(x(1) - x(0), cross(x(2) - x(0), x(3) - x(0))) / 6.0;
      const double middle = 0.25 * (x(0) + x(1) + x(2) + x(3)).z;
      sum[static_cast<std::size_t>(middle / height)] += volume * fields.piola[9 * t + 8] / height;
    }
    const double force = simulation.force(tool).total().z;
    for (double& s : sum) s /= force;
    return sum;
  }
};

void expect_ones(const std::vector<double>& shares, double tolerance, const std::string& what) {
  for (std::size_t k = 0; k < shares.size(); ++k) EXPECT_NEAR(shares[k], 1.0, tolerance) << what << ", layer " << k;
}

// Newton's method ends at 1e-10 of the forces: 1e-6 of the tool's is far from that, and far from 2.17, which was.
TEST(LayerEquilibrium, HoldsForEveryPresetAtRest) {
  const SimulationOptions options{
      .integrator = Integrator::quasi_static, .step = 0.05, .implicit = {.tolerance = 1e-10}};
  for (const TissuePreset& preset : tissue_presets()) {
    expect_ones(Pressed(preset.tissue, 4, 0.001, options, 0.1).shares(), 1e-6, preset.name);
  }
}

TEST(LayerEquilibrium, HoldsForLiverInEightLayers) {
  const SimulationOptions options{
      .integrator = Integrator::quasi_static, .step = 0.1, .implicit = {.tolerance = 1e-10}};
  expect_ones(Pressed(tissue_preset("liver_mre").tissue, 8, 0.001, options, 0.1).shares(), 1e-6, "liver_mre");
}

// Branches relax in the stress as they do in the force: long after the press the layers carry what the tool feels. The body
// has come to rest to 1e-3 by then.
TEST(LayerEquilibrium, HoldsWhileBranchesRelax) {
  Tissue tissue;
  tissue.youngs_modulus = 3000.0, tissue.poisson_ratio = 0.4;
  tissue.maxwell = {{.share = 0.4, .time = 0.1}, {.share = 0.2, .time = 1.0}};
  tissue.volume_change = VolumeChange::average_nodal;
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    const Pressed body(tissue, 4, 0.002, {.precision = precision, .damping_rate = 100.0}, 0.6);
    expect_ones(body.shares(), 1e-3, precision == Precision::single_precision ? "float" : "double");
  }
}

}  // namespace
}  // namespace glisson
