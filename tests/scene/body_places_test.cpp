// body_places_test.cpp — places that a scene finds from the body: where tools press and needles start on any body, however it lies; and what
// passes a body by is said.
#include "glisson/scene/body_places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>

#include "glisson/implicit.h"
#include "scene/scene_text.h"

namespace glisson {
namespace body_places_test {

using test::complaint;
using test::parse;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const MeshLoader kNoFiles;

/// A box of 40 × 40 × 80 mm, whose middle is (20, 20, 40) mm, and an instrument.
std::string with_instrument(const std::string& keys, const std::string& motion = "kind = \"press\"\ndepth_mm = 10\n") {
  return "[mesh]\nkind = \"box\"\ncells = [4, 4, 8]\n[[region]]\nname = \"tumour\"\nbox_m = { min = [0, 0, 0.06], max "
         "= "
         "[0.04, 0.04, 0.08] }\n[[fixed]]\nset = \"z_min\"\n[[instrument]]\n" +
         keys + "[instrument.motion]\n" + motion;
}

Vec3d tip_of(const std::string& scene) {
  const Variant v = parse(scene).variants.at(0);
  return start_pose(v.instruments.at(0), build_mesh(v, kNoFiles)).position;
}

std::string fault_of(const std::string& scene) {
  try {
    build_variant(parse(scene).variants.at(0), kNoFiles);
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

void expect_near(const Vec3d& a, const Vec3d& b, double within) {
  EXPECT_NEAR(norm(a - b), 0.0, within) << a.x << " " << a.y << " " << a.z;
}

// The middle of a body is that of its volume: on the line through it a needle starts at a distance, or before the surface that it meets first.
TEST(Aim, PlacesATipOnTheLineThroughAPointOfTheBody) {
  const std::string needle = "kind = \"needle\"\ndirection = [0, 2, 0]\n";
  expect_near(tip_of(with_instrument(needle + "aim = { distance_mm = 100 }\n")), {0.02, -0.08, 0.04}, 1e-15);
  expect_near(tip_of(with_instrument(needle + "aim = {}\n")), {0.02, -0.005, 0.04}, 1e-12);
  expect_near(tip_of(with_instrument(needle + "aim = { clearance_mm = 2, region = \"tumour\" }\n")),
              {0.02, -0.002, 0.07}, 1e-12);
  expect_near(tip_of(with_instrument(needle + "aim = { clearance_mm = 2, point_m = [0.01, 0.03, 0.05] }\n")),
              {0.01, -0.002, 0.05}, 1e-12);
}

// What touches with its whole shape stays clear of the surface with all of it: a slanted line meets the face before a ball's lowest point does.
// A ball of radius r whose lowest point is on a line at 45° to a face touches it when its centre is r above.
TEST(Aim, KeepsAShapeClearOfTheSurface) {
  const double r = 0.004, back = 0.005;
  const Vec3d tip = tip_of(with_instrument(
      "kind = \"ball\"\nradius_mm = 4\ndirection = [0, 1, 1]\naim = { point_m = [0.02, 0.01, 0.04] }\n"));
  const Vec3d along = unit(Vec3d{0, 1, 1}), centre = tip - along * r + along * back;
  // The line through (10, 40) mm along (1, 1) comes from (−30, 0), below the box: the face y = 0 is met where z = 30 mm.
  EXPECT_NEAR(centre.y, -r, 2e-5) << "the surface is sampled: palpation.h";
  EXPECT_NEAR(tip.z - tip.y, 0.03, 1e-12) << "on the line";
}

/// A potato, meshed coarsely.
TetMesh potato() {
  const Solid one = EllipsoidShape{{0.005, 0, 0}, {0.05, 0.03, 0.025}}, other = BallShape{{0.03, 0.02, 0.01}, 0.02};
  return mesh_regions({region_of("potato", unite({one, other}, 0.01))}, {.edge = 0.012}).mesh;
}

/// Turned at random, mirrored where asked for, and moved.
TetMesh placed(TetMesh mesh, std::mt19937& random, bool mirrored) {
  std::normal_distribution<double> normal;
  const Vec3d x = unit(Vec3d{normal(random), normal(random), normal(random)});
  const Vec3d y = unit(cross(x, Vec3d{normal(random), normal(random), normal(random)})), z = cross(x, y);
  for (Vec3d& p : mesh.vertices) {
    if (mirrored) p.x = -p.x;
    p = Vec3d{dot(x, p), dot(y, p), dot(z, p)} + Vec3d{0.3, -0.2, 0.1};
  }
  orient_and_inspect(mesh);
  return mesh;
}

// However a body lies, a scene that finds its places from it can be built: what is pressed is not what is held, the needle starts outside, and
// its line goes through the middle.
TEST(Aim, FitsABodyHoweverItLies) {
  const Variant v = parse(R"([mesh]
kind = "file"
path = "any.vtu"
[sets.top]
side = { axis = "z", end = "upper", share = 0.2 }
surface_only = true
[sets.press]
facing = { direction = [0, 1, 0], count = 5 }
[[fixed]]
set = "top"
[[tool]]
set = "press"
direction = [0, 1, 0]
[[instrument]]
kind = "needle"
direction = [0, 1, 0]
aim = { distance_mm = 100 }
motion = { kind = "press", depth_mm = 100 }
)")
                        .variants.at(0);
  const TetMesh potato_as_made = potato();
  std::mt19937 random(7);
  for (int i = 0; i < 30; ++i) {
    const TetMesh mesh = placed(potato_as_made, random, i % 2 == 1);
    const auto load = [&](const MeshFile&) { return mesh; };
    const BuiltVariant built = build_variant(v, load);
    const Vec3d middle = body_point(mesh, {}), tip = start_pose(v.instruments[0], mesh).position;
    expect_near(tip + Vec3d{0, 0.1, 0}, middle, 1e-12);
    const auto meeting = meets_body(v.instruments[0], mesh, 100.0);
    EXPECT_TRUE(meeting && meeting->meets);
    const Vec3d met = facing_point(mesh, {}, {0, 1, 0});
    EXPECT_LT(met.y, middle.y);
    for (const std::uint32_t p : built.simulation.mesh().vertex_set("press"))
      EXPECT_LT(norm(mesh.vertices[p] - met), 0.03) << "about where the line meets the surface";
  }
}

// A line that misses, a start inside the body and a region that is not there are said with what to do.
TEST(Aim, ExplainsWhatCannotBe) {
  const std::string needle = "kind = \"needle\"\ndirection = [0, 1, 0]\n";
  EXPECT_THAT(fault_of(with_instrument(needle + "aim = { point_m = [0.1, 0, 0] }\n")),
              AllOf(HasSubstr("s.toml:"), HasSubstr("misses the body, which spans x 0 to 0.04 m"),
                    HasSubstr("another `direction`")));
  EXPECT_THAT(fault_of(with_instrument(needle + "aim = { distance_mm = 15 }\n")),
              AllOf(HasSubstr("`distance_mm` = 15"), HasSubstr("would start inside the body"),
                    HasSubstr("20 mm before that point")));
  EXPECT_THAT(fault_of(with_instrument(needle + "aim = { region = \"stone\" }\n")), HasSubstr("no region \"stone\""));
  EXPECT_THAT(complaint(with_instrument(needle + "aim = {}\ntip_m = [0, 0, 1]\n")), HasSubstr("contradicts `aim`"));
  EXPECT_THAT(complaint(with_instrument(needle)), HasSubstr("give one of `tip_m`, `aim`"));
  EXPECT_THAT(complaint(with_instrument(needle + "aim = { distance_mm = 1, clearance_mm = 1 }\n")),
              HasSubstr("contradicts"));
  EXPECT_THAT(
      complaint(
          "[mesh]\nkind = \"box\"\n[sets.a]\nside = { axis = \"x\", end = \"upper\" }\n[motion]\nduration_s = 1\n"),
      HasSubstr("give one of `depth_m`, `share`"));
}

// A share of the extent is the depth of that many metres.
TEST(Side, TakesAShareOfTheExtent) {
  const std::string scene =
      "[mesh]\nkind = \"box\"\ncells = [4, 4, 8]\n[sets.a]\nside = { axis = \"z\", end = \"upper\", SIZE }\n"
      "[motion]\nduration_s = 1\n";
  const auto set_of = [&](const std::string& size) {
    std::string text = scene;
    text.replace(text.find("SIZE"), 4, size);
    return build_mesh(parse(text).variants[0], kNoFiles).vertex_set("a");
  };
  EXPECT_EQ(set_of("share = 0.25"), set_of("depth_m = 0.02"));
  EXPECT_EQ(set_of("share = 0.25").size(), 75U);
}

/// Whether a variant's instrument meets its body, and by how much not.
std::optional<PathMeeting> meeting_of(const std::string& text) {
  const Variant v = parse(text).variants.at(0);
  return meets_body(v.instruments.at(0), build_mesh(v, kNoFiles), run_duration(v));
}

// Whether a path meets the body is known before it is run: for needles, shapes, blades, straight and turning; pushes depend on forces.
TEST(Meeting, IsKnownFromThePath) {
  const std::string beside = "tip_m = [0.1, 0.02, 0.04]\n", before = "tip_m = [0.02, 0.02, 0.085]\n";
  for (const std::string kind :
       {"kind = \"needle\"\n", "kind = \"ball\"\nradius_mm = 3\n", "kind = \"blade\"\nside = [0, 1, 0]\n"}) {
    const auto misses = meeting_of(with_instrument(kind + beside));
    ASSERT_TRUE(misses) << kind;
    EXPECT_FALSE(misses->meets) << kind;
    EXPECT_NEAR(misses->beside, 0.06, 1e-12) << kind;
    const auto meets = meeting_of(with_instrument(kind + before));
    EXPECT_TRUE(meets && meets->meets) << kind;
    const auto short_of_it = meeting_of(with_instrument(kind + before, "kind = \"press\"\ndepth_mm = 1\n"));
    ASSERT_TRUE(short_of_it) << kind;
    EXPECT_FALSE(short_of_it->meets) << kind;
    EXPECT_NEAR(short_of_it->beside, 0.004, 1e-12) << kind;
  }
  const std::string ball = "kind = \"ball\"\nradius_mm = 3\n" + before;
  const auto there_and_back = meeting_of(with_instrument(ball,
                                                         "kind = \"strokes\"\nstrokes = [{ depth_mm = 2, aside_mm = "
                                                         "[50, 0, 0] }, { depth_mm = 8, aside_mm = [5, 0, 0] }]\n"));
  EXPECT_TRUE(there_and_back && there_and_back->meets);
  EXPECT_FALSE(meeting_of(with_instrument(ball, "kind = \"push\"\nforce_N = 1\nduration_s = 1\n")));
}

// A run whose needle passes the body by ends with its name; one that touches it does not.
TEST(Meeting, IsSaidOfARun) {
  const auto run = [](const std::string& tip, const std::string& more = {}) {
    const std::string needle = "kind = \"needle\"\nname = \"long one\"\n" + tip;
    RunObserver nobody;
    const std::atomic<bool> stop{false};
    return run_variant(parse(with_instrument(needle) + "[output]\nframes = 0\n" + more).variants.at(0), {}, nobody,
                       stop);
  };
  EXPECT_THAT(run("tip_m = [0.1, 0.02, 0.04]\n").never_met, ElementsAre("long one"));
  EXPECT_THAT(run("tip_m = [0.02, 0.02, 0.081]\n").never_met, IsEmpty());
  EXPECT_THAT(run("tip_m = [0.1, 0.02, 0.04]\n", "[motion]\nmax_steps = 3\n").never_met, IsEmpty())
      << "cut off: nothing is known";
}

}  // namespace body_places_test
}  // namespace glisson
