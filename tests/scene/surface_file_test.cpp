// Closed surfaces from files: every format gives the same triangles, a scene meshes the body within, alone and among other shapes, and
// what is wrong with a file is said with the place.
#include "glisson/scene/surface_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "glisson/surface_region.h"
#include "scene/scene_text.h"
#include "scene/surface/surface_source.h"
#include "support/folder.h"
#include "support/surface_files.h"

namespace glisson {
namespace surface_file_test {

using test::cube_surface;
using test::icosphere;
using test::parse;
using test::torus_surface;
using ::testing::AllOf;
using ::testing::HasSubstr;

// One ball in each format and encoding: the same corners of the same triangles, to the precision that the format has.
TEST(SurfaceFile, ReadsEveryFormat) {
  const TriangleSurface ball = icosphere(20.0, 1);
  const struct {
    const char* name;
    std::string bytes;
  } files[] = {{"a.stl", test::stl_text(ball)},
               {"b.STL", test::stl_binary(ball)},
               {"a.obj", test::obj_text(ball)},
               {"a.ply", test::ply_text(ball)},
               {"b.ply", test::ply_binary(ball, std::endian::little)},
               {"c.ply", test::ply_binary(ball, std::endian::big)}};
  for (const auto& file : files) {
    SCOPED_TRACE(file.name);
    const TriangleSurface read = surface_file::parse(file.bytes, file.name, 0.001);
    ASSERT_EQ(read.triangles.size(), 80u);
    for (std::size_t t = 0; t < 80; ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d off = read.points[read.triangles[t][i]] - ball.points[ball.triangles[t][i]] * 0.001;
        EXPECT_LT(norm(off), 1e-8) << t;
      }
    }
    EXPECT_NO_THROW(surface_solid(read.points, read.triangles)) << "points written again are one";
  }
}

// Line ends of another system, a polygon, capitals and exponents.
TEST(SurfaceFile, ReadsWhatOtherProgramsWrite) {
  const TriangleSurface quad =
      surface_file::parse("v 0 0 0\r\nv +1e0 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4\r\n", "a.obj", 1.0);
  ASSERT_EQ(quad.triangles.size(), 2u);
  EXPECT_EQ(quad.triangles[1], (Triangle{0, 2, 3}));
  const std::string stl =
      "SOLID\nFACET NORMAL nan nan nan\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 "
      "0\nENDLOOP\nENDFACET\nENDSOLID\n";
  EXPECT_EQ(surface_file::parse(stl, "a.stl", 1.0).triangles.size(), 1u);
}

std::string refusal(const std::string& bytes, const std::string& name) {
  try {
    surface_file::parse(bytes, name, 1.0);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// A fault is told with file and line, or byte, what is wrong and the way out.
TEST(SurfaceFile, SaysWhereAFileIsWrong) {
  const TriangleSurface cube = cube_surface(1.0);
  const std::string stl = test::stl_text(cube), obj = test::obj_text(cube), ply = test::ply_text(cube),
                    binary = test::stl_binary(cube), little = test::ply_binary(cube, std::endian::little);
  EXPECT_EQ(refusal("", "a.stl"), "a.stl: the file is empty");
  EXPECT_THAT(refusal(stl, "a.off"), HasSubstr("surfaces are read from .stl, .obj and .ply"));
  EXPECT_THAT(refusal("solid\nendsolid\n", "a.stl"), HasSubstr("a.stl: has no triangles"));
  EXPECT_THAT(refusal(stl.substr(0, 300), "a.stl"), AllOf(HasSubstr("a.stl:18: "), HasSubstr("cut off")));
  EXPECT_THAT(refusal(replaced(stl, "vertex 0 1 0", "vertex 0 x 0"), "a.stl"),
              HasSubstr("a.stl:5: expected y of a vertex, a number, found \"x\""));
  EXPECT_THAT(refusal(replaced(stl, "vertex 0 1 0", "vertex 0 nan 0"), "a.stl"),
              AllOf(HasSubstr("a.stl:5: y of a vertex is \"nan\""), HasSubstr("repair")));
  EXPECT_THAT(
      refusal(binary.substr(0, binary.size() - 1), "a.stl"),
      AllOf(HasSubstr("a.stl, byte 84: the head announces 12 triangles, 600 bytes, and 599"), HasSubstr("cut off")));
  std::string infinite = binary;
  const float huge = std::numeric_limits<float>::infinity();
  std::memcpy(infinite.data() + 84 + 3 * 50 + 12, &huge, sizeof(huge));
  EXPECT_THAT(refusal(infinite, "a.stl"), HasSubstr("triangle 3 has a corner that is not finite"));
  EXPECT_THAT(refusal(replaced(obj, "f 1/1", "f 9/1"), "a.obj"),
              HasSubstr("a.obj:14: refers to vertex 9; 8 vertices came before"));
  EXPECT_THAT(refusal(obj + "f 1 2\n", "a.obj"), HasSubstr("a.obj:26: a face of 2 vertices; it needs three"));
  EXPECT_THAT(refusal(obj + "v 1 2\n", "a.obj"), HasSubstr("a.obj:26: the line ends before z of a vertex"));
  EXPECT_THAT(refusal(obj + "v 1 2 3 \\\n", "a.obj"), HasSubstr("write it in one line"));
  EXPECT_THAT(refusal(ply.substr(0, ply.size() - 9), "a.ply"),
              AllOf(HasSubstr("a.ply:"), HasSubstr("face 11"), HasSubstr("cut off")));
  EXPECT_THAT(refusal(replaced(ply, "3 0 2 1", "3 0 2 8"), "a.ply"),
              HasSubstr("a.ply:21: a vertex of face 0 is 8; allowed: whole numbers from 0 to 7"));
  EXPECT_THAT(refusal(replaced(ply, "element vertex 8", "element vertex 8000000000"), "a.ply"),
              HasSubstr("a.ply:4: \"8000000000\" elements \"vertex\" is no count, or more than the file has room for"));
  EXPECT_THAT(refusal(replaced(ply, "property double z\n", ""), "a.ply"), HasSubstr("has no property z"));
  EXPECT_THAT(refusal(little.substr(0, little.size() - 3), "a.ply"),
              AllOf(HasSubstr("a.ply, byte "), HasSubstr("face 11"), HasSubstr("cut off")));
}

class SurfaceScene : public test::InFolder {
 protected:
  /// A mesh of shapes and regions.
  static RegionMesh meshed(const std::string& edge_mm, const std::string& shapes) {
    const Variant variant =
        parse("[motion]\nduration_s = 1\n[mesh]\nkind = \"implicit\"\nedge_mm = " + edge_mm + "\n" + shapes)
            .variants.at(0);
    return implicit_mesh(std::get<ImplicitBody>(variant.mesh));
  }
  static std::string surface(const std::string& name, const std::string& path) {
    return "[[mesh.shape]]\nname = \"" + name + "\"\nkind = \"surface\"\npath = '" + path + "'\nscale = 0.001\n";
  }
};

double p95(std::vector<double> distances) {
  std::sort(distances.begin(), distances.end());
  return distances[distances.size() * 95 / 100];
}

/// Corners and middles of a surface's triangles, their distances from a shape.
double p95_from(std::span<const Vec3d> points, std::span<const Triangle> triangles, const Solid& shape) {
  std::vector<double> off;
  for (const Triangle& t : triangles) {
    const Vec3d &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    for (const Vec3d& p : {a, b, c, (a + b + c) * (1.0 / 3.0)}) off.push_back(std::abs(shape.distance(p)));
  }
  return p95(std::move(off));
}

// A ball and a torus written to files are meshed at ten edges across: volume to half a percent of the surface's, 95 % of the mesh's
// surface within a tenth of an edge of the file's, and of the file's of the mesh's; angles between 10° and 165°.
TEST_F(SurfaceScene, MeshesTheBodyWithin) {
  const struct {
    TriangleSurface surface;
    const char* edge_mm;
    double edge;
  } bodies[] = {{icosphere(50.0, 4), "10", 0.01}, {torus_surface(60.0, 30.0, 80, 40), "6", 0.006}};
  for (const auto& body : bodies) {
    const std::string path = write("organ.stl", test::stl_binary(body.surface));
    const RegionMesh made = meshed(body.edge_mm, surface("organ", path) + "[[mesh.region]]\nname = \"organ\"\n");
    const double exact = 1e-9 * test::volume_within(body.surface);
    EXPECT_NEAR(made.report.regions.at(0).volume / exact, 1.0, 5e-3);
    const SurfaceShape file = load_surface(path, 0.001);
    const std::vector<Triangle> skin = boundary_triangles(made.mesh);
    EXPECT_LT(p95_from(made.mesh.vertices, skin, *file.solid), 0.1 * body.edge);
    const TriangleSurface read = read_surface(path, 0.001);
    EXPECT_LT(p95_from(read.points, read.triangles, surface_solid(made.mesh.vertices, skin)), 0.1 * body.edge);
    EXPECT_GE(made.report.min_dihedral_deg, 10.0);
    EXPECT_LE(made.report.max_dihedral_deg, 165.0);
  }
}

// A cube from a file keeps its corners and edges: its eight corners are vertices, and nothing is off the cube by more than a fifth of
// an edge, where a face bridges an edge near its end.
TEST_F(SurfaceScene, KeepsSharpEdges) {
  const std::string path = write("cube.obj", test::obj_text(cube_surface(60.0)));
  const RegionMesh made = meshed("8", surface("cube", path) + "[[mesh.region]]\nname = \"cube\"\n");
  const Solid cube = *load_surface(path, 0.001).solid;
  double most = 0.0;
  for (const Triangle& t : boundary_triangles(made.mesh)) {
    for (const std::uint32_t v : t) most = std::max(most, std::abs(cube.distance(made.mesh.vertices[v])));
  }
  EXPECT_LT(most, 0.2 * 0.008);
  for (const Vec3d& corner : read_surface(path, 0.001).points) {
    double nearest = 1.0;
    for (const Vec3d& v : made.mesh.vertices) nearest = std::min(nearest, norm(v - corner));
    EXPECT_LT(nearest, 0.02 * 0.008);
  }
  EXPECT_NEAR(made.report.regions.at(0).volume, 216e-6, 1e-6);
}

// A surface combines with other shapes and is a region among others: joined with a tube, and as a tumour in a box.
TEST_F(SurfaceScene, CombinesWithShapes) {
  const std::string ball = surface("ball", write("ball.ply", test::ply_text(icosphere(25.0, 3))));
  const RegionMesh joined = meshed(
      "5", ball +
               "[[mesh.shape]]\nname = \"stalk\"\nkind = \"tube\"\npoints = [{ at_mm = [0, 0, 0], radius_mm = 8 }, { "
               "at_mm = [0, 0, "
               "60], radius_mm = 8 }]\n[[mesh.shape]]\nname = \"all\"\nkind = \"union\"\nof = [\"ball\", \"stalk\"]\n"
               "[[mesh.region]]\nname = \"all\"\n");
  // Ball, and of the tube of radius 8 mm what is beyond it: from the circle at √(25² − 8²) on, and its round end.
  const double pi = std::numbers::pi, ring = std::sqrt(25.0 * 25.0 - 64.0), cap = 25.0 - ring;
  const double ball_ml = test::volume_within(icosphere(25.0, 3)) * 1e-3;
  const double stalk_ml =
      1e-3 * (pi * 64.0 * (60.0 - ring) + 2.0 / 3.0 * pi * 512.0 - pi * cap * cap * (25.0 - cap / 3.0));
  EXPECT_NEAR(1e6 * joined.report.regions.at(0).volume, ball_ml + stalk_ml, 0.01 * (ball_ml + stalk_ml));
  const RegionMesh two =
      meshed("6", ball +
                      "[[mesh.shape]]\nname = \"box\"\nkind = \"box\"\nsize_mm = [80, 70, 64]\n[[mesh.region]]\n"
                      "name = \"tumour\"\nshape = \"ball\"\n[[mesh.region]]\nname = \"box\"\n");
  EXPECT_NEAR(1e6 * two.report.regions.at(0).volume, ball_ml, 0.005 * ball_ml);
  EXPECT_NEAR(1e6 * (two.report.regions[0].volume + two.report.regions[1].volume), 358.4, 1.0);
  EXPECT_GE(std::min(joined.report.min_dihedral_deg, two.report.min_dihedral_deg), 10.0);
}

// What is wrong with a surface is said at the key of the scene, with the file, how much and where; a scene without the file says so.
TEST_F(SurfaceScene, ExplainsWhatBoundsNoBody) {
  const auto complaint_of = [&](const TriangleSurface& s) {
    const std::string path = write("s.ply", test::ply_text(s));
    return test::complaint("[motion]\nduration_s = 1\n[mesh]\nkind = \"implicit\"\n" + surface("s", path) +
                           "[[mesh.region]]\nname = \"s\"\n");
  };
  TriangleSurface open = cube_surface(10.0);
  open.triangles.erase(open.triangles.begin(), open.triangles.begin() + 2);
  EXPECT_THAT(complaint_of(open), AllOf(HasSubstr("s.toml:8:8: mesh.shape.0.path: "),
                                        HasSubstr("s.ply: the surface has a hole of 20 % of its area"),
                                        HasSubstr("close it in the program")));
  TriangleSurface turned = cube_surface(10.0);
  std::swap(turned.triangles[4][0], turned.triangles[4][1]);
  EXPECT_THAT(complaint_of(turned), AllOf(HasSubstr("turn against their neighbours at 3 edges"), HasSubstr("orient")));
  TriangleSurface sheet = cube_surface(10.0);
  sheet.triangles.push_back({0, 2, 7});  // into the body
  EXPECT_THAT(complaint_of(sheet),
              AllOf(HasSubstr("three or more triangles that bound nothing at 1 edge"), HasSubstr("non-manifold")));
  EXPECT_THAT(test::complaint("[mesh]\nkind = \"implicit\"\n" + surface("s", "/nowhere/s.stl") +
                              "[[mesh.region]]\nname = \"s\"\n"),
              HasSubstr("/nowhere/s.stl: there is no such file"));
  EXPECT_THAT(test::complaint("[mesh]\nkind = \"implicit\"\n[[mesh.shape]]\nname = \"s\"\nkind = "
                              "\"surface\"\n[[mesh.region]]\nname = \"s\"\n"),
              HasSubstr("path"));
}

}  // namespace surface_file_test
}  // namespace glisson
