#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "glisson/io.h"
#include "io/raw_mesh.h"
#include "io/sample_meshes.h"
#include "support/folder.h"

namespace glisson {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class Write : public test::InFolder {
 protected:
  TetMesh round_trip(const TetMesh& mesh) {
    write_vtu(folder_ / "mesh.vtu", mesh);
    return read_mesh(folder_ / "mesh.vtu").mesh;
  }

  std::size_t files() const {
    const std::filesystem::directory_iterator begin(folder_);
    return static_cast<std::size_t>(std::distance(begin, std::filesystem::directory_iterator()));
  }

  /// Two threads leave a gate together, write a file each and read it; false where one came back different.
  bool round_trips_side_by_side() {
    const TetMesh mesh = testing::two_tets();
    std::atomic<int> at_gate{0}, same{0};
    const auto round_trip = [&](const char* name) {
      ++at_gate;
      while (at_gate < 2) {  // spinning: a thread that has to be woken comes too late to meet the other
      }
      write_vtu(folder_ / name, mesh);
      if (read_mesh(folder_ / name).mesh == mesh) ++same;
    };
    std::thread other(round_trip, "other.vtu");
    round_trip("one.vtu");
    other.join();
    return same == 2;
  }
};

using WriteDeathTest = Write;  // by that name GoogleTest runs it first, before VTK has threads that a fork would lose

// A mesh that goes through a file comes back the same: doubles to the last bit, regions, names and sets.
TEST_F(Write, VtuRoundTripIsExact) {
  TetMesh box = box_mesh({});
  for (Vec3d& x : box.vertices) x += Vec3d{0.1, 1.0 / 3.0, 1e-17};
  TetMesh odd = testing::two_tets();
  odd.region_names = {{7, "a<b & \"c\" 100 %41\n"}, {-3, "Läsion (µm)"}, {9, ""}, {10, ""}};
  odd.regions = {7, -3};
  odd.vertex_sets = {{"", {0}}, {"empty", {}}, {"naïve <set>", {1, 4}}};
  TetMesh zero = testing::two_tets();
  zero.regions = {0, 0};
  zero.fibres = {{1.0 / 3.0, 0.0, -2.0}, {}};
  BoxOptions many;  // more than one compressed block of 32 KiB an array
  many.cells = {12, 12, 12};
  for (const TetMesh& mesh : {box, box_mesh(many), cylinder_mesh({}), testing::two_tets(), odd, zero}) {
    EXPECT_TRUE(round_trip(mesh) == mesh) << mesh.tets.size() << " tets";
  }
  EXPECT_EQ(files(), 1u);  // no temporary file is left
}

// Deformed positions are written in place of the rest positions, next to fields of one or three components.
TEST_F(Write, VtuHoldsPositionsAndFields) {
  const TetMesh mesh = testing::two_tets();
  std::vector<Vec3d> moved = mesh.vertices;
  for (Vec3d& x : moved) x.z += 0.05;
  const Field displacement{"displacement_m", 3, std::vector<double>(15, 0.05)};
  const Field q{"q", 1, {0.9, 0.8}};
  write_vtu(folder_ / "frame.vtu", mesh, moved, std::span(&displacement, 1), std::span(&q, 1));
  EXPECT_EQ(read_mesh(folder_ / "frame.vtu").mesh.vertices, moved);
  const std::string text = contents(folder_ / "frame.vtu");
  EXPECT_THAT(text, HasSubstr("Name=\"displacement_m\" NumberOfComponents=\"3\""));
  EXPECT_THAT(text, HasSubstr("Name=\"q\""));
  EXPECT_THAT(text, HasSubstr("format=\"appended\""));
  EXPECT_THAT(text, HasSubstr("vtkZLibDataCompressor"));
}

// Sizes that do not fit the mesh are the caller's mistake: field, its size and the size needed are named.
TEST_F(Write, VtuRefusesFieldsOfAnotherSize) {
  const TetMesh mesh = testing::two_tets();
  const Field q{"q", 1, {0.9, 0.8, 0.7}};
  try {
    write_vtu(folder_ / "frame.vtu", mesh, {}, {}, std::span(&q, 1));
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("field \"q\" has 3 values of 1 components; it needs one for each of the 2 tets"));
  }
  const std::vector<Vec3d> positions(4);
  EXPECT_THROW(write_vtu(folder_ / "frame.vtu", mesh, positions), std::invalid_argument);
  EXPECT_EQ(files(), 0u);
}

// A folder that is not there is refused by name, and a failing write leaves the old file as it was.
TEST_F(Write, FailuresLeaveTheOldFile) {
  try {
    write_vtu(folder_ / "missing" / "mesh.vtu", testing::two_tets());
    FAIL() << "accepted";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("missing does not exist; create it first"));
  }
  write_vtu(folder_ / "mesh.vtu", testing::two_tets());
  std::filesystem::create_directories(folder_ / "mesh.vtu.part" / "in the way");
  EXPECT_THROW(write_vtu(folder_ / "mesh.vtu", box_mesh({})), FileError);
  EXPECT_EQ(read_mesh(folder_ / "mesh.vtu").mesh, testing::two_tets());
}

// The first files of a process may be written and read in several threads at once. What can go wrong is what VTK makes
// on its first use, so every try has a process of its own; the leak sanitizer says at its end what was made twice.
TEST_F(WriteDeathTest, FirstFilesMayBeWrittenSideBySide) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    EXPECT_EXIT(std::exit(round_trips_side_by_side() ? 0 : 3), ::testing::ExitedWithCode(0), "");
  }
}

// A collection lists its frames with times that read back exactly and names safe in XML.
TEST_F(Write, PvdListsFrames) {
  const std::vector<std::pair<double, std::filesystem::path>> frames{{0.0, "frames/f_0000.vtu"},
                                                                     {0.1, "a&b/f_0001.vtu"}};
  write_pvd(folder_ / "frames.pvd", frames);
  EXPECT_EQ(contents(folder_ / "frames.pvd"),
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n"
            "    <DataSet timestep=\"0\" part=\"0\" file=\"frames/f_0000.vtu\"/>\n"
            "    <DataSet timestep=\"0.1\" part=\"0\" file=\"a&amp;b/f_0001.vtu\"/>\n  </Collection>\n</VTKFile>\n");
  write_pvd(folder_ / "frames.pvd", std::span(frames).first(1));
  EXPECT_THAT(contents(folder_ / "frames.pvd"), Not(HasSubstr("f_0001")));
  EXPECT_EQ(files(), 1u);
}

// A triangle of a point that is not there is refused by its number; a sound surface is a PolyData file.
using WriteVtp = test::InFolder;

TEST_F(WriteVtp, RefusesWhatHasNoPoint) {
  const std::filesystem::path file = folder_ / "surface.vtp";
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  try {
    write_vtp(file, points, std::vector<Triangle>{{0, 1, 3}});
    ADD_FAILURE() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("a triangle has point 3; there are 3"), std::string::npos);
  }
  write_vtp(file, points, std::vector<Triangle>{{0, 1, 2}});
  EXPECT_GT(std::filesystem::file_size(file), 100u);
}

}  // namespace
}  // namespace glisson
