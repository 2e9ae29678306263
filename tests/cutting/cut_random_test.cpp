// Hundreds of random cuts through random bodies, curved ones and one through a real organ: nothing is lost, nothing breaks.
#include <filesystem>
#include <sstream>

#include "cutting/cut_body.h"
#include "glisson/instruments/motion.h"

namespace glisson::test::cut_random_test {
namespace {

constexpr double kCell = 0.01;

TetMesh random_mesh(std::mt19937& random) {
  const auto cells = [&](int low, int high) {
    return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
  };
  switch (random() % 3) {
    case 0: {
      const std::array<int, 3> n{cells(2, 6), cells(2, 6), cells(2, 6)};
      return box_mesh({n, {n[0] * kCell, n[1] * kCell, n[2] * kCell}, {}, BoxSplit::alternating});
    }
    case 1:
      return jittered_box({cells(2, 6), cells(2, 6), cells(2, 6)}, kCell, 0.2, random);
    default:
      return cylinder_mesh({.radius = 0.02 + 0.005 * (random() % 3),
                            .height = 0.05,
                            .radial_cells = cells(2, 4),
                            .axial_cells = cells(3, 6),
                            .grading = 1.0 + 0.5 * (random() % 3)});
  }
}

Kind random_kind(std::mt19937& random) {
  const std::vector<Kind> all = every_kind();
  return all[random() % all.size()];
}

struct Outcome {
  std::uint64_t hash = 0;
  std::vector<Tet> tets;
  double mass_lost = 0.0, volume_lost = 0.0, quality = 1.0;
  bool finite = true, sets_kept = true;
  std::size_t cuts = 0, faces = 0;
  bool operator==(const Outcome&) const = default;
};

/// Every vertex of each set before, and every copy of one, is in the set; on a box each is still on its side.
bool sets_are_kept(const TetMesh& before, const TetMesh& after) {
  for (const auto& [name, set] : before.vertex_sets) {
    const auto& now = after.vertex_sets.at(name);
    if (!std::is_sorted(now.begin(), now.end()) || !std::includes(now.begin(), now.end(), set.begin(), set.end())) {
      return false;
    }
    for (const std::uint32_t v : now) {
      if (v >= after.vertices.size()) return false;
    }
  }
  return after.vertex_sets.size() == before.vertex_sets.size();
}

/// Some cuts by bent strokes of a blade that turns, through a body in motion, some tets removed in between.
Outcome cut_at_random(unsigned seed, int threads) {
  std::mt19937 random(seed);
  const TetMesh mesh = random_mesh(random);
  const Kind kind = random_kind(random);
  SimulationOptions options = kind.options(std::nullopt);
  options.threads = threads;
  options.gravity = {0.0, 0.0, -9.81};
  Simulation body(mesh, {{0, kind.tissue}}, options);
  const char* held = mesh.vertex_sets.count("z_min") != 0 ? "z_min" : "bottom";
  body.fix(mesh.vertex_sets.at(held));
  Vec3d low{1, 1, 1}, high{-1, -1, -1};
  for (const Vec3d& x : mesh.vertices) {
    for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], x[a]), high[a] = std::max(high[a], x[a]);
  }
  const double size = norm(high - low), mass_before = mass(body);
  double removed = 0.0;
  Outcome out;
  Cutter cutter(body);
  for (int stroke = 0; stroke < 2; ++stroke) {
    CutPlane plane = random_plane((low + high) * 0.5 + random_field(1, 0.2 * size, random)[0], random);
    const double reach = random() % 2 == 0 ? size : 0.2 * size;
    const Vec3d bend = random_field(1, 0.15, random)[0];
    double way = -0.6 * size;
    cutter.place(edge_on(plane, reach, way));
    const int advances = 3 + static_cast<int>(random() % 10);
    for (int i = 0; i < advances; ++i) {
      way += 1.2 * size / advances * (random() % 8 == 0 ? -0.5 : 1.0);
      plane.across = unit(plane.across + cross(bend, plane.across) * (1.0 / advances));
      plane.point += bend * (0.1 * size / advances);
      const CutReport report = cutter.advance(edge_on(plane, reach, way));
      out.faces += report.faces;
      ++out.cuts;
      if (i == 2) {
        const RemovalReport gone = body.remove_tets(choose(2, mesh.tets.size(), random));
        removed += gone.mass;
      }
      for (int k = 0; k < 2; ++k) out.finite = out.finite && body.step().status != StepStatus::not_finite;
    }
  }
  for (const Vec3d& u : body.displacement()) out.finite = out.finite && std::isfinite(norm(u));
  const TetMesh present = body.present_mesh();
  out.hash = body.state_hash();
  out.tets = present.tets;
  out.mass_lost = mass(body) + removed - mass_before;
  out.volume_lost = (volume(present) + removed / kind.tissue.density - volume(mesh)) / volume(mesh);
  out.mass_lost /= mass_before;
  out.quality = worst_quality(present) / std::min(CutOptions{}.least_quality, worst_quality(mesh));
  out.sets_kept = sets_are_kept(mesh, body.mesh());
  return out;
}

// A few hundred strokes: no crash, nothing that is not a number, no lost vertex set, mass and volume as they were.
TEST(RandomCuts, LoseNothing) {
  std::size_t cuts = 0, faces = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Outcome out = cut_at_random(seed, 1);
    EXPECT_TRUE(out.finite) << seed;
    EXPECT_TRUE(out.sets_kept) << seed;
    EXPECT_LE(std::abs(out.mass_lost), 1e-13) << seed;
    EXPECT_LE(std::abs(out.volume_lost), 1e-13) << seed;
    EXPECT_GE(out.quality, 1.0 - 1e-12) << seed;
    cuts += out.cuts, faces += out.faces;
  }
  EXPECT_GT(cuts, 2000U);
  EXPECT_GT(faces, 10000U);
}

// The same bytes on one thread and on two.
TEST(RandomCuts, GiveTheSameBytesOnTwoThreads) {
  for (unsigned seed = 1; seed <= 200; seed += 8) EXPECT_EQ(cut_at_random(seed, 2), cut_at_random(seed, 1)) << seed;
}

// Round about the axis of a block, a blade takes out a core: a cylinder as far as flat faces can be one.
TEST(CurvedCuts, TakeOutACore) {
  const int n = 14;
  const double cell = 0.06 / n, radius = 0.0183;
  std::mt19937 random(1);
  const TetMesh mesh = jittered_box({n, n, 6}, cell, 0.15, random);
  Simulation body(mesh, {{0, linear_tissue()}}, {});
  Cutter cutter(body);
  const auto edge = [&](double turn) {
    const Vec3d at{0.03 + radius * std::cos(turn), 0.03 + radius * std::sin(turn), -0.01};
    return BladeEdge{at, at + Vec3d{0, 0, 0.06}};
  };
  cutter.place(edge(0.1));
  CutReport sum;
  const int steps = 90;
  for (int i = 1; i <= steps + 3; ++i) add(sum, cutter.advance(edge(0.1 + 2.0 * M_PI * i / steps)));
  const TetMesh cut = body.present_mesh();
  const std::vector<std::size_t> pieces = piece_sizes(cut);
  ASSERT_EQ(pieces.size(), 2U);
  double core = 0.0;
  const std::vector<std::uint32_t> piece = pieces_of(cut);
  const std::uint32_t middle =
      piece[tets_where(cut, [&](const Vec3d& x) { return std::hypot(x.x - 0.03, x.y - 0.03) < cell; }).front()];
  for (std::size_t t = 0; t < cut.tets.size(); ++t) core += piece[t] == middle ? six_rest_volume(cut, t) / 6.0 : 0.0;
  const double height = 6 * cell, exact = M_PI * radius * radius * height;
  // chords of two cells lose (2 cell / radius)²/24 of the area of a circle: 1 %; what is held back adds to it
  EXPECT_NEAR(core, exact, 0.03 * exact);
  EXPECT_NEAR(sum.area, 2.0 * M_PI * radius * height, 0.03 * 2.0 * M_PI * radius * height);
  EXPECT_LE(sum.largest_offset, cell);
  EXPECT_NEAR(volume(cut), volume(mesh), 1e-13 * volume(mesh));
  EXPECT_GE(worst_quality(cut), std::min(CutOptions{}.least_quality, worst_quality(mesh)));
}

// Two cuts that cross make four pieces, a third makes eight.
TEST(CrossingCuts, MakeFourAndEightPieces) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const TetMesh mesh = jittered_box({6, 6, 6}, kCell, 0.15, random);
    Simulation body(mesh, {{0, linear_tissue()}}, {});
    Cutter cutter(body);
    std::size_t expected = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Vec3d normal = random_field(1, 0.2, random)[0];
      normal[axis] += 1.0;
      cut_along(cutter, plane_at(Vec3d{0.03, 0.03, 0.03} + random_field(1, 0.003, random)[0], normal), 0.2, 0.2, 4);
      expected *= 2;
      std::size_t large = 0;  // splinters of a few tets may come off where three cuts meet
      for (const std::size_t n : piece_sizes(body.present_mesh())) large += n >= 20 ? 1 : 0;
      EXPECT_EQ(large, expected) << seed;
    }
    EXPECT_GE(worst_quality(body.present_mesh()), std::min(CutOptions{}.least_quality, worst_quality(mesh))) << seed;
    EXPECT_NEAR(mass(body), linear_tissue().density * volume(mesh), 1e-12);
  }
}

}  // namespace
}  // namespace glisson::test::cut_random_test
