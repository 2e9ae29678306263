// What of a body can be drawn: its outer faces are skin until something cuts them, and inner regions are closed.
#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include "app/program.h"
#include "glisson/io.h"
#include "glisson/scene/scene.h"
#include "report/body_surface.h"
#include "report/frame_series.h"
#include "report/surface_recorder.h"
#include "view/engine/live_body.h"
#include "view/protocol/messages.h"
#include "view/state/surface.h"

namespace glisson::test {
namespace {

/// A cube of 30 mm with a stiff ball of 8 mm radius in it, held below.
Variant nodule_block(const std::string& more = "") {
  return parse_scene(R"([mesh]
kind = "box"
cells = [9, 9, 9]
size_m = [0.03, 0.03, 0.03]
[tissue]
youngs_modulus_Pa = 3600
poisson_ratio = 0.4
[[region]]
name = "nodule"
sphere_m = { center = [0.015, 0.015, 0.015], radius = 0.008 }
tissue.youngs_modulus_Pa = 36000
[motion]
damping_rate_per_s = 20
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
direction = [0, 0, -1]
velocity_mm_s = 10
depth_mm = 1
)" + more,
                     "nodule.toml", ".")
      .variants.front();
}

/// Volume within a closed surface, by the flux of x/3 through it; and whether every edge has its opposite.
struct Enclosed {
  double volume = 0.0;
  bool closed = true;
};
Enclosed enclosed(const TetMesh& mesh, const std::vector<Triangle>& triangles) {
  Enclosed result;
  std::map<std::array<std::uint32_t, 2>, int> edges;
  for (const Triangle& t : triangles) {
    result.volume += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]])) / 6.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  for (const auto& [ends, balance] : edges) result.closed = result.closed && balance == 0;
  return result;
}

std::size_t count(const BodySurface& surface, SurfaceKind kind) {
  return static_cast<std::size_t>(std::count(surface.kinds.begin(), surface.kinds.end(), kind));
}

// The outer faces are those of the boundary, all of them skin; the nodule's own are closed and hold its tets' volume.
TEST(BodySurface, HasTheBoundaryAndClosedRegions) {
  const TetMesh mesh = build_mesh(nodule_block(), {});
  const BodySurface surface = SkinFaces(mesh).surface(mesh);
  EXPECT_EQ(surface.outer, boundary_triangles(mesh));
  EXPECT_EQ(count(surface, SurfaceKind::skin), surface.outer.size());
  ASSERT_EQ(surface.regions.size(), 1u);
  EXPECT_EQ(surface.regions[0].name, "nodule");
  double volume = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.region_of(t) != 0) volume += six_rest_volume(mesh, t) / 6.0;
  }
  const Enclosed nodule = enclosed(mesh, surface.regions[0].triangles);
  EXPECT_TRUE(nodule.closed);
  EXPECT_GT(volume, 0.5 * 2.1e-6) << "of the ball's 2.1 mL";
  EXPECT_NEAR(nodule.volume, volume, 1e-12 * 2.7e-5) << "outward oriented";
}

// Of tets that are gone, neighbours show a cut face each, and the body is closed still.
TEST(BodySurface, ShowsWhatRemovedTetsUncover) {
  const TetMesh mesh = build_mesh(nodule_block(), {});
  const BodySurface whole = SkinFaces(mesh).surface(mesh);
  const auto gone = [](std::uint32_t tet) { return tet < 6; };  // a corner's cube
  const BodySurface open = SkinFaces(mesh).surface(mesh, gone);
  EXPECT_EQ(count(open, SurfaceKind::skin), whole.outer.size() - 6) << "three faces of two triangles";
  EXPECT_EQ(count(open, SurfaceKind::cut), 6u);
  const Enclosed body = enclosed(mesh, open.outer);
  EXPECT_TRUE(body.closed);
  EXPECT_NEAR(body.volume, 2.7e-5 * (1.0 - 1.0 / 729.0), 1e-15);
}

// A stroke through the block leaves two faces of its section, and skin of as much area as before.
TEST(BodySurface, KnowsBothFacesOfACut) {
  view::LiveBody body(nodule_block(), {});
  const auto areas = [&] {
    const std::shared_ptr<const view::BodyShape> shape = body.shape();
    const view::Surface surface(shape);
    std::array<double, 3> area{};
    for (std::size_t t = 0; t < surface.kinds().size(); ++t) {
      const auto at = [&](std::size_t k) { return surface.rest(surface.triangles()[3 * t + k]); };
      area[surface.kinds()[t]] += 0.5 * norm(cross(at(1) - at(0), at(2) - at(0)));
    }
    return area;
  };
  const double skin = areas()[0];
  EXPECT_NEAR(skin, 6.0 * 9e-4, 1e-12);
  EXPECT_EQ(areas()[1], 0.0);
  body.cut()->begin({{-0.1, -0.1, 0.0162}, {-0.1, 0.1, 0.0162}});
  body.cut()->draw({{0.1, -0.1, 0.0162}, {0.1, 0.1, 0.0162}});
  while (body.cut()->waits()) body.work_on_cut(view::HandCut::Clock::now());
  const std::array<double, 3> cut = areas();
  EXPECT_NEAR(cut[1], 2.0 * 9e-4, 0.02 * 2.0 * 9e-4) << "each side is the section of 9 cm²";
  EXPECT_NEAR(cut[0], skin, 0.01 * skin);
}

/// The numbers in the base64 that a report holds.
template <class T>
std::vector<T> numbers_in(const std::string& text) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t held = 0, bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    held = held << 6 | static_cast<std::uint32_t>(kDigits.find(c));
    if ((bits += 6) >= 8) bytes.push_back(static_cast<char>(held >> (bits -= 8) & 255u));
  }
  std::vector<T> numbers(bytes.size() / sizeof(T));
  std::memcpy(numbers.data(), bytes.data(), sizeof(T) * numbers.size());
  return numbers;
}

// In a report the nodule that a cut goes through has the triangles of both its halves from then on: closed, and of its volume.
TEST(BodySurface, ReportKeepsInnerRegionsClosedThroughACut) {
  view::LiveBody body(nodule_block(), {});
  Simulation& simulation = body.built().simulation;
  const auto state = [&] { return surface_state(simulation, simulation.tet_fields()); };
  SurfaceRecorder recorder(body.variant(), state(), 1'000'000);
  recorder.add(state());
  body.cut()->begin({{-0.1, -0.1, 0.0162}, {-0.1, 0.1, 0.0162}});
  body.cut()->draw({{0.1, -0.1, 0.0162}, {0.1, 0.1, 0.0162}});
  while (body.cut()->waits()) body.work_on_cut(view::HandCut::Clock::now());
  recorder.add(state());
  recorder.add(state());
  const nlohmann::json surface = recorder.json();
  EXPECT_FALSE(surface["frames"][0].contains("regions"));
  EXPECT_FALSE(surface["frames"][2].contains("regions")) << "nothing has changed since";
  const nlohmann::json& frame = surface["frames"][1];
  ASSERT_TRUE(frame.contains("regions"));
  ASSERT_EQ(frame["regions"].size(), 1u);

  TetMesh drawn;  // places of the surface's vertices in that frame
  const auto rest = numbers_in<float>(surface["rest"].get<std::string>());
  const auto moved = numbers_in<std::int16_t>(frame["displacement"].get<std::string>());
  const double scale = frame["displacement_scale_m"].get<double>() / 32767.0;
  for (std::size_t i = 0; i + 2 < rest.size(); i += 3) {
    Vec3d& x = drawn.vertices.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) x[k] = static_cast<double>(rest[i + k]) + scale * moved.at(i + k);
  }
  const auto enclosed_by = [&](const std::string& base64) {
    std::vector<Triangle> triangles;
    const auto corners = numbers_in<std::uint32_t>(base64);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
      triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    return enclosed(drawn, triangles);
  };
  const TetMesh& mesh = simulation.mesh();
  double volume = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    volume += mesh.region_of(t) != 0 ? six_rest_volume(mesh, t) / 6.0 : 0.0;
  const Enclosed now = enclosed_by(frame["regions"][0].get<std::string>());
  EXPECT_TRUE(now.closed);
  EXPECT_NEAR(now.volume, volume, 1e-4 * volume);
  EXPECT_GT(numbers_in<std::uint32_t>(frame["regions"][0].get<std::string>()).size(),
            numbers_in<std::uint32_t>(surface["regions"][0]["triangles"].get<std::string>()).size())
      << "both faces of the cut";
}

// Skin under an opened triangle of a capsule is torn, that one alone, and the live view's shape becomes another.
TEST(BodySurface, ShowsWhereACapsuleIsTorn) {
  view::LiveBody body(nodule_block("[[capsule]]\nset = \"z_max\"\nyoungs_modulus_Pa = 1e5\n"), {});
  const std::size_t key = body.shape_key();
  Capsule& capsule = *body.built().capsules.front();
  capsule.tear(7);
  EXPECT_NE(body.shape_key(), key);
  const view::Surface surface(body.shape());
  ASSERT_EQ(std::count(surface.kinds().begin(), surface.kinds().end(), 2), 1);
  const std::size_t torn =
      static_cast<std::size_t>(std::find(surface.kinds().begin(), surface.kinds().end(), 2) - surface.kinds().begin());
  Triangle found{};
  for (std::size_t k = 0; k < 3; ++k) found[k] = surface.mesh_vertex(surface.triangles()[3 * torn + k]);
  Triangle expected = capsule.triangles()[7];
  std::sort(found.begin(), found.end());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(found, expected);
}

// The keyframe ends with kinds, names and regions, and its vertices hold those of the nodule.
TEST(BodySurface, TravelsInTheKeyframe) {
  view::LiveBody body(nodule_block(), {});
  const view::Surface surface(body.shape());
  const std::string bytes = view::keyframe_message(surface, 3);
  const auto u32 = [&](std::size_t at) {
    std::uint32_t x = 0;
    for (std::size_t k = 0; k < 4; ++k)
      x |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << 8 * k;
    return x;
  };
  const std::size_t vertices = u32(8), triangles = u32(12);
  EXPECT_EQ(triangles, 6u * 9 * 9 * 2);
  std::size_t at = 16 + 13 * vertices + 13 * triangles;
  at = (at + 3) / 4 * 4;
  EXPECT_EQ(u32(at), 0u) << "the tissue has no name";
  EXPECT_EQ(u32(at + 4), 1u) << "one region";
  EXPECT_EQ(bytes.substr(at + 12, u32(at + 8)), "nodule");
  const std::size_t corners = 3 * u32(at + 20);
  EXPECT_EQ(bytes.size(), at + 24 + 4 * corners);
  for (std::size_t i = 0; i < corners; ++i) ASSERT_LT(u32(at + 24 + 4 * i), vertices);
}

class FramesOfAChangedBody : public InFolder {};

// A frame names the tets that were removed: no other array tells them from those that are there. Before that it has no such array.
TEST_F(FramesOfAChangedBody, NameRemovedTets) {
  BuiltVariant built = build_variant(nodule_block(), {});
  FrameSeries frames(folder_);
  frames.add(built.simulation, built.simulation.tet_fields());
  const std::vector<std::uint32_t> gone{0, 17, 200};
  built.simulation.remove_tets(gone);
  frames.add(built.simulation, built.simulation.tet_fields());
  frames.finish();
  const std::vector<std::string> wanted{"removed"};
  const auto files = read_pvd(folder_ / "frames.pvd");
  ASSERT_EQ(files.size(), 2U);
  EXPECT_TRUE(read_frame(folder_ / files[0].second, wanted).tet_fields.empty());
  const ReadFrame frame = read_frame(folder_ / files[1].second, wanted);
  ASSERT_EQ(frame.tet_fields.size(), 1U);
  std::vector<std::uint32_t> named;
  for (std::uint32_t t = 0; t < frame.mesh.tets.size(); ++t) {
    if (frame.tet_fields[0].values[t] != 0.0) named.push_back(t);
  }
  EXPECT_EQ(named, gone);
}

}  // namespace
}  // namespace glisson::test
