// mesh_command_test.cpp — glisson mesh: the mesh of a scene as a file, and its figures.
#include <cmath>

#include "app/program.h"
#include "glisson/io.h"
#include "glisson/simulation/mesh_step.h"
#include "support/surface_files.h"

namespace glisson::test {
namespace {

using MeshCommand = ProgramTest;
using ::testing::HasSubstr;

const std::string kTwoRegions = R"(
[mesh]
kind = "implicit"
edge_mm = 6
[[mesh.shape]]
name = "core"
kind = "ball"
radius_mm = 15
[[mesh.shape]]
name = "body"
kind = "box"
size_mm = [60, 50, 40]
[[mesh.region]]
name = "core"
[[mesh.region]]
name = "body"
)";

// The file holds the regions as integers with their names, the JSON the figures under the names that scripts read.
TEST_F(MeshCommand, WritesMeshAndFigures) {
  const Outcome outcome = run({"mesh", write("s.toml", kTwoRegions), "--out", (folder_ / "m.vtu").string(), "--json",
                               (folder_ / "m.json").string()});
  ASSERT_THAT(outcome, Exits(0)) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("dihedral angles"));
  const TetMesh mesh = read_mesh(folder_ / "m.vtu").mesh;
  EXPECT_EQ(mesh.region_names.at(1), "core");
  EXPECT_EQ(mesh.region_names.at(2), "body");
  const nlohmann::json figures = read_json(folder_ / "m.json");
  EXPECT_EQ(figures.at("tets"), mesh.tets.size());
  EXPECT_GE(figures.at("min_dihedral_deg").get<double>(), 10.0);
  EXPECT_LE(figures.at("max_dihedral_deg").get<double>(), 165.0);
  EXPECT_GT(figures.at("seconds").get<double>(), 0.0);
  EXPECT_NEAR(figures.at("relative_stable_step").get<double>(), relative_stable_step(mesh, 0.006), 1e-12);
  EXPECT_THAT(outcome.out, HasSubstr(" of that of regular tets with edges of 6 mm\n"));
  ASSERT_EQ(figures.at("regions").size(), 2u);
  EXPECT_EQ(figures.at("regions")[0].at("name"), "core");
  EXPECT_NEAR(figures.at("regions")[0].at("volume_ml").get<double>(), 4.0 / 3.0 * M_PI * 1.5 * 1.5 * 1.5, 0.3);
  EXPECT_NEAR(
      figures.at("regions")[0].at("volume_ml").get<double>() + figures.at("regions")[1].at("volume_ml").get<double>(),
      120.0, 1.0);
  const Outcome info = run({"info", (folder_ / "m.vtu").string()});
  EXPECT_THAT(info.out, HasSubstr("Dihedral angles:\n"));
}

// A scene without shapes has a mesh as well.
TEST_F(MeshCommand, WritesGeneratedMeshes) {
  const Outcome outcome =
      run({"mesh", write("s.toml", small_scene()), "--out", (folder_ / "box.vtu").string(), "--quiet"});
  ASSERT_THAT(outcome, Exits(0)) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(read_mesh(folder_ / "box.vtu").mesh.tets.size(), 48u);
}

// What cannot be done is said, with the way out, and no file is left.
TEST_F(MeshCommand, ExplainsWhatItRefuses) {
  const std::string scene = write("s.toml", kTwoRegions);
  const Outcome name = run({"mesh", scene, "--out", (folder_ / "m.stl").string()});
  EXPECT_THAT(name, Exits(2));
  EXPECT_THAT(name.err, HasSubstr("give a name that ends in .vtu"));
  const Outcome coarse = run({"mesh", scene, "--set", "mesh.edge_mm=80", "--out", (folder_ / "m.vtu").string()});
  EXPECT_THAT(coarse, Exits(2));
  EXPECT_THAT(coarse.err, HasSubstr("smaller edge"));
  const Outcome place = run({"mesh", scene, "--out", (folder_ / "none" / "m.vtu").string()});
  EXPECT_THAT(place, Exits(2));
  EXPECT_THAT(place.err, HasSubstr("does not exist; create it first"));
  const Outcome fine = run({"mesh", scene, "--set", "mesh.edge_mm=0.1", "--out", (folder_ / "m.vtu").string()});
  EXPECT_THAT(fine, Exits(2));
  EXPECT_THAT(fine.err, HasSubstr("give an edge of"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "m.vtu"));
}

// Tets of a file are written as they are, in metres; an edge to be made of them is refused.
TEST_F(MeshCommand, TakesTetsOfAFile) {
  const std::string file = write(
      "mm.inp",
      "*NODE\n1, 0, 0, 0\n2, 20, 0, 0\n3, 0, 20, 0\n4, 0, 0, 20\n*ELEMENT, TYPE=C3D4, ELSET=all\n1, 1, 2, 3, 4\n");
  ASSERT_THAT(run({"mesh", file, "--scale", "0.001", "--out", "tet.vtu"}), Exits(0));
  const TetMesh mesh = read_mesh(folder_ / "tet.vtu").mesh;
  ASSERT_EQ(mesh.tets.size(), 1U);
  EXPECT_NEAR(volume(mesh), 8e-6 / 6.0, 1e-15);
  const Outcome refused = run({"mesh", file, "--edge-mm", "3", "--out", "tet.vtu"});
  EXPECT_THAT(refused, Exits(2));
  EXPECT_THAT(refused.err, HasSubstr("holds tets, which are written as they are: leave out --edge-mm"));
}

// A closed surface is meshed without a scene; its region has the file's name.
TEST_F(MeshCommand, MeshesSurfaces) {
  const std::string ball = write("ball.stl", stl_binary(icosphere(30.0, 3)));
  const std::string out = (folder_ / "ball.vtu").string(), json = (folder_ / "ball.json").string();
  const Outcome outcome = run({"mesh", ball, "--scale", "0.001", "--edge-mm", "6", "--out", out, "--json", json});
  ASSERT_THAT(outcome, Exits(0)) << outcome.err;
  EXPECT_EQ(read_mesh(out).mesh.region_names.at(1), "ball");
  const nlohmann::json figures = read_json(json);
  EXPECT_GE(figures.at("min_dihedral_deg").get<double>(), 10.0);
  const double exact_ml = 1e-3 * volume_within(icosphere(30.0, 3));
  EXPECT_NEAR(figures.at("regions")[0].at("volume_ml").get<double>(), exact_ml, 0.005 * exact_ml);

  const auto refusal = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "mesh");
    arguments.insert(arguments.end(), {"--out", (folder_ / "no.vtu").string()});
    const Outcome refused = run(arguments);
    EXPECT_THAT(refused, Exits(2));
    return refused.err;
  };
  EXPECT_THAT(refusal({ball}), HasSubstr("ball.stl: a surface needs --edge-mm E"));
  EXPECT_THAT(refusal({ball, "--edge-mm", "6"}), HasSubstr("--scale 0.001"));
  EXPECT_THAT(refusal({ball, "--edge-mm", "0"}), HasSubstr("--edge-mm 0 is out of range; allowed: > 0"));
  EXPECT_THAT(refusal({ball, "--scale", "-1", "--edge-mm", "6"}),
              HasSubstr("scale = -1 is out of range; allowed: > 0"));
  EXPECT_THAT(refusal({ball, "--scale", "0.001", "--edge-mm", "90"}),
              ::testing::AllOf(HasSubstr("ball.stl: "), HasSubstr("\"ball\""), HasSubstr("smaller edge")));
  EXPECT_THAT(refusal({ball, "--edge-mm", "6", "--set", "mesh.edge_mm=3"}), HasSubstr("are for scenes"));
  EXPECT_THAT(refusal({write("s.toml", kTwoRegions), "--edge-mm", "6"}), HasSubstr("--set mesh.edge_mm=6"));
  EXPECT_THAT(refusal({(folder_ / "none.obj").string(), "--edge-mm", "6"}), HasSubstr("there is no such file"));
  TriangleSurface open = icosphere(30.0, 0);
  open.triangles.resize(18);
  EXPECT_THAT(refusal({write("open.obj", obj_text(open)), "--edge-mm", "6"}),
              ::testing::AllOf(HasSubstr("open.obj: the surface has a hole of "), HasSubstr(" edges around (")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "no.vtu"));
}

// A surface with a triangle missing is meshed, and how it was closed is printed and kept.
TEST_F(MeshCommand, SaysWhatItDidToASurface) {
  TriangleSurface open = icosphere(30.0, 2);
  open.triangles.pop_back();
  const std::string json = (folder_ / "figures.json").string();
  const Outcome done = run({"mesh", write("open.obj", obj_text(open)), "--scale", "0.001", "--edge-mm", "8", "--out",
                            (folder_ / "m.vtu").string(), "--json", json});
  EXPECT_THAT(done, Exits(0));
  EXPECT_THAT(done.out, ::testing::AllOf(HasSubstr("open.obj: 1 hole was closed"), HasSubstr(" m\n")));
}

TEST_F(MeshCommand, ExplainsThatMemoryIsTooLittle) {
  if (!kMemoryHasLimits) GTEST_SKIP() << "the address sanitizer cannot run within a limit of addresses";
  const std::string scene = write("s.toml", kTwoRegions);
  const Outcome little = run_in({.memory_bytes = 400UL << 20},
                                {"mesh", scene, "--set", "mesh.edge_mm=0.8", "--out", (folder_ / "m.vtu").string()});
  EXPECT_THAT(little, Exits(2));
  EXPECT_THAT(little.err, HasSubstr("MB are available: give an edge of"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "m.vtu"));
}

}  // namespace
}  // namespace glisson::test
