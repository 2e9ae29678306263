// Poses of a file move a tool of a scene; a file that holds none is refused with its line.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "scene/scene_text.h"
#include "support/folder.h"

namespace glisson {
namespace {

class Poses : public test::InFolder {
 protected:
  void write(const std::string& text) const { InFolder::write("hand.csv", text); }
  std::string refusal() const {
    try {
      load_poses(folder_ / "hand.csv");
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return {};
  }
};

// A quarter turn about z and a lift of 2 mm, from 0.5 s on: the set is there at the end, turned about the tool's origin.
TEST_F(Poses, MoveATool) {
  write("time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz\n3,10,0,0,1,0,0,0\n4,10,0,2,1,0,0,1\n");
  const std::string text =
      "[mesh]\nkind = \"box\"\ncells = [2, 2, 2]\nsize_m = [0.02, 0.02, 0.02]\n[motion]\nintegrator = "
      "\"static\"\n[[fixed]]\nset = \"z_min\"\n[[tool]]\nset = \"z_max\"\nposes = { path = "
      "\"hand.csv\", start_s = 0.5 }\n";
  const Variant v = parse_scene(text, "s.toml", folder_).variants.at(0);
  EXPECT_EQ(run_duration(v), 1.5);
  const Pose pose = turning_path(v.tools.at(0))->pose(2.0);
  EXPECT_LE(norm(pose.to_space({0.02, 0.0, 0.02}) - Vec3d{0.01, 0.01, 0.022}), 1e-15);
  const MeshLoader none;
  BuiltVariant built = build_variant(v, none);
  ASSERT_TRUE(built.simulation.advance_to(1.5).made());
  for (const std::uint32_t i : built.simulation.mesh().vertex_sets.at("z_max")) {
    const Vec3d& x = built.simulation.mesh().vertices[i];
    EXPECT_LE(norm(x + built.simulation.displacement()[i] - pose.to_space(x)), 1e-12);
  }
}

TEST_F(Poses, SayWhatIsWrong) {
  const auto has = [&](const char* part) { return refusal().find(part) != std::string::npos; };
  write("time_s,x_m,y_m,z_m,qw,qx,qy\n0,0,0,0,1,0,0\n1,0,0,0,1,0,0\n");
  EXPECT_TRUE(has("hand.csv:1: no column `qz`")) << refusal();
  write("time_s,x_m,z_m,qw,qx,qy,qz\n0,0,0,1,0,0,0\n1,0,0,1,0,0,0\n");
  EXPECT_TRUE(has("no column `y_m` (or _mm)")) << refusal();
  write("time_s,x_m,y_m,z_m,qw,qx,qy,qz\n1,0,0,0,1,0,0,0\n1,0,0,0,1,0,0,0\n");
  EXPECT_TRUE(has("hand.csv:3") && has("not later")) << refusal();
  write("time_s,x_m,y_m,z_m,qw,qx,qy,qz\n1,0,0,0,1,0,0,0\n");
  EXPECT_TRUE(has("fewer than two poses")) << refusal();
  write("time_s,x_m,y_m,z_m,qw,qx,qy,qz\n1,0,0,0,1,0,0,0\n2,0,0,0,0,0,0,0\n");
  EXPECT_TRUE(has("hand.csv:3: the quaternion is 0")) << refusal();
  write("time_s,x_m,y_m,z_m,qw,qx,qy,qz\n1,0,0,0,1,0,0,0\n2,0,0,0,one,0,0,0\n");
  EXPECT_TRUE(has("hand.csv:3") && has("one")) << refusal();
}

}  // namespace
}  // namespace glisson
