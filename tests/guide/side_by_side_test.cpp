// The C++ column of the table of the commonest tasks (docs/python.md) stands in this file, word for word, and runs.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "fit/run_fit.h"
#include "glisson/instruments/motion.h"
#include "glisson/instruments/needle.h"
#include "glisson/instruments/tool_motion.h"
#include "glisson/io.h"
#include "glisson/material_point.h"
#include "glisson/oscillation.h"
#include "glisson/scene/scene.h"
#include "glisson/scene/tissue_presets.h"
#include "glisson/simulation/probe.h"
#include "glisson/simulation/simulation.h"
#include "glisson/torsion.h"
#include "support/folder.h"
#include "support/must_step.h"
#include "support/places.h"

namespace glisson {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// What stands between backticks in the second column of the table under "Side by side".
std::vector<std::string> cpp_column() {
  std::istringstream page(text_of(test::shipped("docs/python.md")));
  std::vector<std::string> snippets;
  bool in_table = false;
  for (std::string line; std::getline(page, line);) {
    in_table = line.starts_with("## ") ? line == "## Side by side" : in_table;
    if (!in_table || !line.starts_with("| ") || line.starts_with("| |")) continue;
    const std::size_t from = line.find(" | "), to = line.find(" | ", from + 3);
    std::istringstream cell(line.substr(from, to - from));
    std::string text;
    for (bool code = false; std::getline(cell, text, '`'); code = !code) {
      if (code) snippets.push_back(text);
    }
  }
  return snippets;
}

/// What the lines below need beside themselves, in a folder of its own for each test: they run side by side.
class Files : public test::InFolder {
 protected:
  std::filesystem::path before = std::filesystem::current_path();
  void SetUp() override {
    std::filesystem::current_path(folder_);
    write_vtu("liver.vtu", box_mesh({.size = {40, 40, 80}}));
    const auto fits = test::shipped("scenes/fit");
    std::filesystem::copy_file(fits / "phantom_mean.csv", "phantom_mean.csv",
                               std::filesystem::copy_options::overwrite_existing);
    std::ofstream("fit.toml") << text_of(fits / "phantom_mean.toml")
                              << "\n[search]\nstarts = 2\n\n[proof]\nprofiles = false\nbootstrap = 0\n";
  }
  void TearDown() override { std::filesystem::current_path(before); }
};

TEST(SideBySide, ColumnStandsInThisFile) {
  const std::string here = text_of(test::shipped("tests/guide/side_by_side_test.cpp"));
  const std::vector<std::string> snippets = cpp_column();
  EXPECT_EQ(snippets.size(), 16U);
  for (const std::string& snippet : snippets) EXPECT_NE(here.find(snippet), std::string::npos) << snippet;
}

using SideBySideRuns = Files;

// A box, a tissue with a law, a side held, a press, a needle, a step, another tissue.
TEST_F(SideBySideRuns, BuildsAndSteps) {
  const TetMesh mesh = box_mesh({.cells = {4, 4, 8}});
  EXPECT_EQ(mesh.tets.size(), 768U);
  Tissue tissue = Tissue{.youngs_modulus = 3600, .law = LinearLaw{18000}};
  EXPECT_EQ(lame_at(tissue, 0.1).mu, lame_from_young(5400, 0.4).mu);
  EXPECT_NE(tissue_preset("paper_liver").tissue, tissue);

  const std::vector<double> times{1.0, 2.0}, stretches{1.05, 1.1};
  EXPECT_GT(material_test(tissue, MaterialTest::uniaxial, MaterialControl::deformation, times, stretches)
                .back()
                .nominal(2, 2),
            0.1 * 3600.0);  // it stiffens
  const std::vector<double> frequencies{1.0, 10.0}, twists{5.0, 10.0};
  EXPECT_NEAR(oscillation(tissue, frequencies).back().storage, tissue.lame().mu, 1e-6);
  EXPECT_LT(torsion(tissue, 0.01, times, twists).back().axial_force, 1e-12);

  Simulation simulation(mesh, {{0, tissue}});
  simulation.fix("z_min");
  const std::vector<std::uint32_t> set{207, 211, 212};
  const ConstraintId tool = simulation.drive(set, press({.depth = 0.008}));
  const NeedleOptions options;
  const auto driver = std::make_shared<PathDriver>(Pose{{0.005, 0.005, 0.081}}, steady_path({}));
  simulation.attach(std::make_shared<Needle>(options, driver));
  for (int i = 0; i < 20; ++i) test::must_step(simulation);
  EXPECT_TRUE(simulation.step().made());
  EXPECT_LT(simulation.force(tool).total().z, 0.0);
  const Vec3d x{0.01, 0.01, 0.05};
  const std::vector<double> read = Probes(simulation, {{"tip", ProbePoint{x}}}).read(simulation);
  EXPECT_LT(read.at(2), 0.0);  // tip_displacement_z_m, under a press from above
  tissue.youngs_modulus = 7200;
  simulation.set_tissue(0, tissue);
  EXPECT_EQ(simulation.tissue(0).youngs_modulus, 7200.0);
}

TEST_F(SideBySideRuns, ReadsAMesh) { EXPECT_NEAR(read_mesh("liver.vtu", 0.001).mesh.vertices.back().z, 0.08, 1e-9); }

TEST_F(SideBySideRuns, RunsAScene) {
  const Scene scene = parse_scene(
      "mesh = { kind = \"box\", cells = [1, 1, 2] }\n[[fixed]]\nset = \"z_min\"\n"
      "[[tool]]\nset = \"z_max\"\nvelocity_mm_s = 20\ndepth_mm = 1\n",
      "scene.toml", ".");
  const Variant& variant = scene.variants.at(0);
  const MeshLoader load = [](const MeshFile&) { return TetMesh{}; };
  RunObserver observer;
  const std::atomic<bool> stop{false};
  EXPECT_EQ(run_variant(variant, load, observer, stop).end, RunSummary::End::finished);
}

TEST_F(SideBySideRuns, Fits) {
  const fit::FitResult result = fit::run_fit("fit.toml");
  EXPECT_NEAR(result.parameters.at(0).value, 1800.0, 1200.0);
}

}  // namespace
}  // namespace glisson
