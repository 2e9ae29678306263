// Frames come back as they were written: the mesh in its present shape, tets turned inside out left so, fields, and the
// collection in order; what is damaged is refused with its name, and a collection leads nowhere but below itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "glisson/io.h"
#include "io/sample_meshes.h"
#include "support/folder.h"

namespace glisson {
namespace {

using ::testing::HasSubstr;

class Frames : public test::InFolder {
 protected:
  std::string bytes(const char* name) {
    std::ifstream stream(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  template <class Read>
  std::string why(Read read) {
    try {
      read();
    } catch (const FileError& error) {
      return error.what();
    }
    return "nothing was refused";
  }
};

TEST_F(Frames, ComeBackWithTheirFields) {
  TetMesh mesh = testing::two_tets();
  mesh.vertex_sets["held"] = {0, 2};
  std::vector<Vec3d> positions = mesh.vertices;
  for (Vec3d& x : positions) x.z = -2.0 * x.z;  // turned inside out
  Field u{.name = "displacement_m", .components = 3, .values = {}};
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3d d = positions[v] - mesh.vertices[v];
    u.values.insert(u.values.end(), {d.x, d.y, d.z});
  }
  const Field s{.name = "s", .components = 1, .values = {0.25, 1.0 / 3.0}}, other{"other", 1, {1.0, 2.0}};
  write_vtu(folder_ / "f.vtu", mesh, positions, std::span(&u, 1), std::vector<Field>{s, other});

  const std::vector<std::string> wanted{"displacement_m", "s", "not_there"};
  const ReadFrame frame = read_frame(folder_ / "f.vtu", wanted);
  EXPECT_EQ(frame.mesh.tets, mesh.tets) << "read_mesh would turn them";
  EXPECT_EQ(frame.mesh.vertices, positions);
  EXPECT_EQ(frame.mesh.vertex_sets.at("held"), mesh.vertex_sets.at("held"));
  ASSERT_EQ(frame.vertex_fields.size(), 1u);
  EXPECT_EQ(frame.vertex_fields[0].components, 3);
  EXPECT_EQ(frame.vertex_fields[0].values, u.values) << "all bits";
  ASSERT_EQ(frame.tet_fields.size(), 1u);
  EXPECT_EQ(frame.tet_fields[0].name, "s");
  EXPECT_EQ(frame.tet_fields[0].values, s.values);
}

// A file that was cut off anywhere is refused by name, never read as something else.
TEST_F(Frames, HalfAFileIsRefused) {
  const TetMesh mesh = testing::two_tets();
  const Field u{
      .name = "displacement_m", .components = 3, .values = std::vector<double>(3 * mesh.vertices.size(), 0.5)};
  write_vtu(folder_ / "whole.vtu", mesh, {}, std::span(&u, 1));
  const std::string whole = bytes("whole.vtu");
  const std::vector<std::string> wanted{"displacement_m"};
  for (std::size_t length = 1; length + 20 < whole.size(); length += 97) {
    write("half.vtu", whole.substr(0, length));
    EXPECT_THAT(why([&] { read_frame(folder_ / "half.vtu", wanted); }), HasSubstr("half.vtu")) << length << " bytes";
  }
}

TEST_F(Frames, CollectionComesBack) {
  const std::vector<std::pair<double, std::filesystem::path>> frames{{0.0, "frames/frame_0000.vtu"},
                                                                     {1.0 / 3.0, "frames/a & b.vtu"}};
  write_pvd(folder_ / "frames.pvd", frames);
  EXPECT_EQ(read_pvd(folder_ / "frames.pvd"), frames);
}

TEST_F(Frames, CollectionLeadsNowhereElse) {
  for (const char* file : {"/etc/passwd", "../other/frame.vtu", "frames/../../x.vtu"}) {
    write_pvd(folder_ / "c.pvd", std::vector<std::pair<double, std::filesystem::path>>{{0.0, "a.vtu"}, {1.0, file}});
    EXPECT_EQ(read_pvd(folder_ / "c.pvd").size(), 1u) << file;
  }
}

TEST_F(Frames, WhatIsNoCollectionIsRefused) {
  write("broken.pvd", "<VTKFile><Collection>");
  EXPECT_THAT(why([&] { read_pvd(folder_ / "broken.pvd"); }), HasSubstr("broken.pvd"));
  write("other.pvd", "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\"></VTKFile>");
  EXPECT_THAT(why([&] { read_pvd(folder_ / "other.pvd"); }), HasSubstr("no collection"));
  EXPECT_THAT(why([&] { read_pvd(folder_ / "none.pvd"); }), HasSubstr("no such file"));
}

// Elements that nest without end are refused; built and freed by recursion they would overflow the stack from some 150 000
// levels on. What nests as deep as is allowed is read.
TEST_F(Frames, EndlessNestingIsRefused) {
  const auto nested = [](int levels) {
    std::string text = "<VTKFile type=\"Collection\"><Collection>";
    for (int i = 0; i < levels; ++i) text += "<a>";
    for (int i = 0; i < levels; ++i) text += "</a>";
    return text + "</Collection></VTKFile>";
  };
  for (const int levels : {63, 300'000}) {
    write("f.pvd", nested(levels));
    write("f.vtu", nested(levels));
    EXPECT_THAT(why([&] { read_pvd(folder_ / "f.pvd"); }), HasSubstr("f.pvd: its XML elements nest deeper than 64"));
    EXPECT_THAT(why([&] { read_frame(folder_ / "f.vtu", {}); }), HasSubstr("f.vtu: its XML elements nest deeper than"));
    EXPECT_THAT(why([&] { read_mesh(folder_ / "f.vtu"); }), HasSubstr("f.vtu: its XML elements nest deeper than 64"));
  }
  write("f.pvd", nested(62));
  EXPECT_TRUE(read_pvd(folder_ / "f.pvd").empty());
}

}  // namespace
}  // namespace glisson
