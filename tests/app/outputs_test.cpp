// What `glisson run` leaves behind: the files, their columns and keys, and that they agree with each other.
#include "app/program.h"

namespace glisson::test {
namespace {

using Outputs = ProgramTest;

// forces.csv has the documented columns in the documented order, and supports after them.
TEST_F(Outputs, ForcesHaveTheDocumentedColumns) {
  const Outcome outcome = run({"run", write("s.toml", small_scene()), "--out", "o", "--quiet"});
  ASSERT_THAT(outcome, Exits(0));
  const std::string text = read_text(folder_ / "o/main/forces.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "time_s,depth_m,force_x_N,force_y_N,force_z_N,force_N,elastic_N,viscous_N,damping_N,inertial_N,gravity_N,"
            "load_N,energy_elastic_J,energy_kinetic_J,energy_dissipated_J,work_tools_J,work_loads_J,"
            "support_z_min_x_N,support_z_min_y_N,support_z_min_z_N");
}

// Pressing down costs a positive force, which is the sum of its parts and the reverse of the vector's z component;
// written numbers are exact, so these hold to rounding.
TEST_F(Outputs, ForceIsTheSumOfItsPartsAndPositiveWhenPressing) {
  ASSERT_THAT(run({"run", write("s.toml", small_scene()), "--out", "o", "--quiet"}), Exits(0));
  auto f = read_csv(folder_ / "o/main/forces.csv");
  ASSERT_GE(f["force_N"].size(), 20u) << "50 ms at 500 Hz";
  for (std::size_t i = 0; i < f["force_N"].size(); ++i) {
    const double parts = f["elastic_N"][i] + f["viscous_N"][i] + f["damping_N"][i] + f["inertial_N"][i] +
                         f["gravity_N"][i] + f["load_N"][i];
    EXPECT_NEAR(f["force_N"][i], parts, 1e-12) << "row " << i;
    EXPECT_EQ(f["force_N"][i], -f["force_z_N"][i]) << "row " << i;
  }
  EXPECT_GT(f["force_N"].back(), 0.01);
  EXPECT_NEAR(f["depth_m"].back(), 1e-3, 1e-4);
}

// summary.json has every documented key, and agrees with forces.csv.
TEST_F(Outputs, SummaryHasTheDocumentedKeys) {
  ASSERT_THAT(run({"run", write("s.toml", small_scene()), "--out", "o", "--quiet"}), Exits(0));
  const nlohmann::json summary = read_json(folder_ / "o/main/summary.json");
  for (const char* key : {"vertices",
                          "tets",
                          "steps",
                          "step_s",
                          "stable_step_s",
                          "wall_s",
                          "ns_per_tet_step",
                          "peak_force_N",
                          "energy_elastic_J",
                          "energy_kinetic_J",
                          "energy_dissipated_J",
                          "work_tools_J",
                          "work_loads_J",
                          "state_hash",
                          "version",
                          "end",
                          "time_s",
                          "variant",
                          "scene",
                          "tissue",
                          "inverted_tets_most",
                          "first_inversion_s",
                          "precision",
                          "threads"}) {
    EXPECT_TRUE(summary.contains(key)) << key;
  }
  EXPECT_EQ(summary["vertices"], 27);
  EXPECT_EQ(summary["tets"], 48);
  EXPECT_EQ(summary["end"], "finished");
  EXPECT_EQ(summary["scene"], "s");
  EXPECT_LT(summary["step_s"], summary["stable_step_s"]);
  EXPECT_EQ(summary["state_hash"].get<std::string>().find_first_not_of("0123456789abcdef"), std::string::npos);
  auto f = read_csv(folder_ / "o/main/forces.csv");
  double peak = 0.0;
  for (const double force : f["force_N"]) peak = std::max(peak, std::abs(force));
  EXPECT_DOUBLE_EQ(summary["peak_force_N"], peak);
}

// Every frame that frames.pvd names is there, as many as the scene asks for.
TEST_F(Outputs, FramesAreThereAsTheCollectionSays) {
  ASSERT_THAT(run({"run", write("s.toml", small_scene()), "--out", "o", "--quiet"}), Exits(0));
  const std::string pvd = read_text(folder_ / "o/main/frames.pvd");
  for (const char* frame : {"frames/frame_0000.vtu", "frames/frame_0001.vtu", "frames/frame_0002.vtu"}) {
    EXPECT_NE(pvd.find(frame), std::string::npos) << frame;
    const std::string vtu = read_text(folder_ / "o/main" / frame);
    for (const char* field : {"displacement_m", "velocity_m_s", "\"q\"", "\"s\"", "von_mises_Pa", "region"}) {
      EXPECT_NE(vtu.find(field), std::string::npos) << frame << ": " << field;
    }
  }
  EXPECT_EQ(pvd.find("frame_0003"), std::string::npos);
}

// The report holds the same forces, the surface of the mesh in arrays of the promised lengths, and the scene's text,
// of which nothing can end the data's element.
TEST_F(Outputs, ReportHoldsTheRun) {
  const std::string scene = "description = \"</script><b>not a tag</b>\"\n" + small_scene();
  const Outcome outcome = run({"run", write("s.toml", scene), "--out", "o"});
  ASSERT_THAT(outcome, Exits(0));
  const nlohmann::json report = report_data(folder_ / "o/report.html");
  EXPECT_EQ(report["format"], 1);
  const nlohmann::json& s = report["scenes"][0];
  EXPECT_EQ(s["description"], "</script><b>not a tag</b>");
  EXPECT_EQ(s["source"], scene);
  const nlohmann::json& v = s["variants"][0];
  auto f = read_csv(folder_ / "o/main/forces.csv");
  EXPECT_EQ(v["forces"]["columns"][5], "force_N");
  ASSERT_EQ(v["forces"]["data"][5].size(), f["force_N"].size());
  EXPECT_NEAR(v["forces"]["data"][5].back().get<double>(), f["force_N"].back(), 1e-6 * f["force_N"].back());
  EXPECT_EQ(v["surface"]["vertices"], 26) << "all but the middle one of 3 × 3 × 3";
  EXPECT_EQ(v["surface"]["frames"].size(), 3u);
  EXPECT_EQ(v["surface"]["rest"].get<std::string>().size(), 26u * 3 * 4 / 3 * 4) << "26 × 3 floats in base64";
  EXPECT_EQ(v["law"]["curves"][0]["y"][0], 3600.0);
}

// A second tool has a file of its own with the first twelve columns.
TEST_F(Outputs, SecondToolHasItsOwnFile) {
  const std::string scene = write("s.toml", small_scene(R"([[tool]]
name = "side"
set = "edge"
direction = [1, 0, 0]
velocity_mm_s = 20
depth_mm = 1
[sets.edge]
vertices = [9]
)"));
  const Outcome outcome = run({"run", scene, "--out", "o", "--quiet"});
  ASSERT_THAT(outcome, Exits(0));
  const auto side = read_csv(folder_ / "o/main/forces_side.csv");
  EXPECT_EQ(side.size(), 12u);
  EXPECT_GT(side.at("force_N").back(), 0.0);
}

}  // namespace
}  // namespace glisson::test
