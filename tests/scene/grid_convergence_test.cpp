// The extrapolation from several meshes: exact for f₀ + C h^p, wide where it is not, and true to three closed forms of
// elasticity, whose force lies within the interval that it gives.
#include "glisson/scene/convergence.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <numbers>

#include "glisson/mesh_refinement.h"
#include "glisson/scene/convergence_order.h"
#include "glisson/scene/convergence_variant.h"
#include "scene/scene_text.h"

namespace glisson {
namespace {

using Verdict = GridConvergence::Verdict;

GridConvergence of(double f0, double C, double p, std::array<double, 3> sizes) {
  std::vector<MeshResult> results;
  for (const double h : sizes) results.push_back({h, f0 + C * std::pow(h, p)});
  return grid_convergence(results);
}

// f₀ + C h^p is found to rounding, by sizes that fall by one factor or by two; the interval holds f₀.
TEST(GridConvergence, FindsThePowerLaw) {
  for (const double p : {0.6, 1.0, 1.7, 2.0}) {
    for (const auto& sizes : {std::array{4.0, 2.0, 1.0}, std::array{3.0, 2.0, 1.2}, std::array{1.0, 0.8, 0.7}}) {
      const GridConvergence g = of(2.0, 0.3, p, sizes);
      EXPECT_EQ(g.verdict, Verdict::converging) << p;
      EXPECT_NEAR(g.order, p, 1e-9);
      EXPECT_NEAR(g.extrapolated, 2.0, 1e-9);
      EXPECT_LT(g.low, 2.0);
      EXPECT_GT(g.high, 2.0);
      EXPECT_NEAR(g.error_of(2.3), 0.15, 1e-9);
    }
  }
}

// An observed order is believed up to what the geometry allows, and the interval reaches from that to what was observed. Here the
// singular part, 0.1 h, is hidden behind 0.2 h² on these meshes.
TEST(GridConvergence, BelievesNoOrderAboveThatOfTheEdges) {
  std::vector<MeshResult> results;
  for (const double h : {4.0, 2.0, 1.0}) results.push_back({h, 2.0 + 0.1 * h + 0.2 * h * h});
  const GridConvergence smooth = grid_convergence(results), edge = grid_convergence(results, 1.0);
  EXPECT_NEAR(smooth.order, smooth.seen_order, 1e-12);
  EXPECT_GT(smooth.seen_order, 1.7);
  EXPECT_EQ(edge.order, 1.0);
  EXPECT_LT(edge.low, 2.0);
  EXPECT_GT(edge.high, 2.0);
  EXPECT_GT(edge.high - edge.low, 1.5 * (smooth.high - smooth.low));
  EXPECT_NE(verdict_text(edge), "") << "says which order is possible";
  EXPECT_EQ(verdict_text(smooth), "");
  EXPECT_THROW(grid_convergence(results, 0.9), std::invalid_argument);
  EXPECT_THROW(grid_convergence(results, 2.1), std::invalid_argument);
}

// What is no power law is said to be none: where nothing is extrapolated the interval is three times the largest difference, or
// reaches as far as changes that grow may go on; slow changes are extrapolated roughly, alternating ones not at all.
TEST(GridConvergence, SaysWhatItCannot) {
  EXPECT_EQ(of(5.0, 0.0, 1.0, {4.0, 2.0, 1.0}).verdict, Verdict::independent);
  const GridConvergence up_and_down = grid_convergence(std::array<MeshResult, 3>{{{4.0, 1.0}, {2.0, 1.4}, {1.0, 1.1}}});
  EXPECT_EQ(up_and_down.verdict, Verdict::not_monotone);
  EXPECT_NEAR(up_and_down.low, 1.1 - 3.0 * 0.4, 1e-12);
  const GridConvergence growing = grid_convergence(std::array<MeshResult, 3>{{{4.0, 1.0}, {2.0, 1.1}, {1.0, 1.3}}});
  EXPECT_EQ(growing.verdict, Verdict::not_monotone);
  EXPECT_NEAR(growing.low, 1.3 - 0.2, 1e-12);
  EXPECT_NEAR(growing.high, 1.3 + 4.0 * 0.2, 1e-12);
  for (const GridConvergence& g : {up_and_down, growing}) EXPECT_FALSE(g.extrapolates());
  EXPECT_NE(verdict_text(up_and_down), verdict_text(growing));

  const GridConvergence fading = grid_convergence(std::array<MeshResult, 3>{{{4.0, 1.0}, {2.0, 1.4}, {1.0, 1.3}}});
  EXPECT_EQ(fading.verdict, Verdict::alternating);
  EXPECT_EQ(fading.extrapolated, 1.3);
  EXPECT_NEAR(fading.low, 1.3 - 0.15 - 0.4 / 3.0, 1e-12);
  const GridConvergence fast = of(1.0, 1.0, 4.0, {4.0, 2.0, 1.0});
  EXPECT_EQ(fast.order, 2.0) << "linear tets have no higher one";
  EXPECT_NEAR(fast.seen_order, 4.0, 1e-9);
  EXPECT_LT(fast.low, 1.0);
  EXPECT_NEAR(fast.high, 2.0 + 240.0 / 3.0, 1e-9) << "errors of two signs may cancel";
  const GridConvergence slow = of(1.0, 1.0, 0.3, {4.0, 2.0, 1.0});
  EXPECT_EQ(slow.verdict, Verdict::slow);
  EXPECT_LT(slow.extrapolated, slow.high);
  EXPECT_GT(slow.extrapolated, slow.low);
  const std::array<MeshResult, 2> two{{{2.0, 1.2}, {1.0, 1.1}}};
  EXPECT_EQ(grid_convergence(two).verdict, Verdict::two_meshes);
  EXPECT_NEAR(grid_convergence(two).extrapolated, 1.0, 1e-12) << "order 1";
  EXPECT_NEAR(grid_convergence(two).low, 1.1 - 0.3, 1e-12);
  for (const Verdict v : {Verdict::independent, Verdict::two_meshes, Verdict::alternating, Verdict::slow}) {
    EXPECT_NE(verdict_text({.verdict = v}), "");
    EXPECT_TRUE(GridConvergence{.verdict = v}.extrapolates());
  }
  EXPECT_THROW(grid_convergence(std::vector<MeshResult>{{1.0, 1.0}}), std::invalid_argument);
  EXPECT_THROW(grid_convergence(std::vector<MeshResult>{{1.0, 1.0}, {2.0, 1.0}}), std::invalid_argument);
}

// The exponents at the edges are those of [Williams1952]: a bonded face beside a free one at 90° has 0.711 at ν = 0.3 and 0.595 at ½,
// a flat one ½; a re-entrant edge of 270° has 0.5445, a crack ½.
TEST(EdgeOrder, ExponentsAreThoseOfWedges) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_NEAR(bonded_edge_exponent(0.5 * kPi, 0.3), 0.7112, 2e-4);
  EXPECT_NEAR(bonded_edge_exponent(0.5 * kPi, 0.49999), 0.5946, 2e-4);
  EXPECT_EQ(bonded_edge_exponent(0.2 * kPi, 0.3), 1.0);
  EXPECT_EQ(bonded_edge_exponent(0.95 * kPi, 0.3), 0.5) << "complex, of this real part";
  EXPECT_EQ(bonded_edge_exponent(kPi, 0.3), 0.5);
  EXPECT_NEAR(free_edge_exponent(1.5 * kPi), 0.5445, 2e-4);
  EXPECT_NEAR(free_edge_exponent(2.0 * kPi), 0.5, 1e-6);
  EXPECT_EQ(free_edge_exponent(0.5 * kPi), 1.0);
}

double order_of(const std::string& text, const std::vector<Override>& overrides = {}) {
  const Variant variant = test::parse(text, overrides).variants.front();
  return largest_order(variant, build_mesh(variant, {}));
}

// A pad within a face allows the order 1, plates bonded to whole faces that of their corners, plates without friction 2.
TEST(EdgeOrder, IsThatOfTheWorstEdge) {
  EXPECT_NEAR(order_of(test::kSmallScene), 2.0 * bonded_edge_exponent(0.5 * std::numbers::pi, 0.4), 1e-12);
  EXPECT_NEAR(order_of(test::kSmallScene, {{"tissue.poisson_ratio", "0.3"}}), 1.4224, 4e-4);
  EXPECT_EQ(order_of(test::kSmallScene, {{"tool.0.sideways", "\"free\""}, {"fixed.0.axes", "\"z\""}}), 2.0);
  const std::string half = "{ min = [0, 0, 0.02], max = [0.01, 0.02, 0.02] }";
  for (const char* sideways : {"\"free\"", "\"blocked\""}) {
    EXPECT_EQ(order_of(test::kSmallScene, {{"sets.top", "{ box_m = " + half + " }"}, {"tool.0.sideways", sideways}}),
              1.0);
  }
}

/// Keeps the largest force of the first tool.
class Peak : public RunObserver {
 public:
  void on_sample(const Sample& s) override { force = std::max(force, norm(s.instruments.front().force)); }
  double force = 0.0;
};

/// The tool's force on the mesh as given and on finer ones.
GridConvergence converge(const Variant& variant, int levels, const MeshLoader& load = {}) {
  std::vector<MeshResult> results;
  for (int k = 0; k < levels; ++k) {
    const RefinedVariant fine = refined_variant(variant, k, load);
    Peak peak;
    const std::atomic<bool> stop{false};
    EXPECT_EQ(run_variant(fine.variant, fine.load, peak, stop).end, RunSummary::End::finished);
    results.push_back({cell_size(build_mesh(fine.variant, fine.load)), peak.force});
  }
  return grid_convergence(results, largest_order(variant, build_mesh(variant, load)));
}

void expect_within(const GridConvergence& g, double exact, const std::string& what) {
  EXPECT_LE(g.low, exact) << what << ": " << g.extrapolated << " by order " << g.order;
  EXPECT_GE(g.high, exact) << what << ": " << g.extrapolated << " by order " << g.order;
}

constexpr const char* kQuasiStatic = R"(
[motion]
integrator = "quasi_static"
step_s = 0.1
duration_s = 0.1
[output]
frames = 0
)";

// The confined column is uniform, which every mesh has exactly: F = E (1 − ν)/((1 + ν)(1 − 2ν)) A d/H.
TEST(Converge, ConfinedColumnDoesNotDependOnTheMesh) {
  const Scene scene = test::parse(std::string(R"([mesh]
kind = "box"
cells = [1, 1, 2]
size_m = [0.02, 0.02, 0.04]
[tissue]
youngs_modulus_Pa = 3000
poisson_ratio = 0.3
[[fixed]]
set = "z_min"
axes = "z"
[[fixed]]
set = "x_min"
axes = "x"
[[fixed]]
set = "x_max"
axes = "x"
[[fixed]]
set = "y_min"
axes = "y"
[[fixed]]
set = "y_max"
axes = "y"
[[tool]]
set = "z_max"
sideways = "free"
velocity_mm_s = 10
depth_mm = 1
)") + kQuasiStatic);
  const double exact = 3000.0 * 0.7 / (1.3 * 0.4) * 4e-4 * 0.001 / 0.04;
  const GridConvergence g = converge(scene.variants.front(), 3);
  EXPECT_EQ(g.verdict, Verdict::independent);
  EXPECT_NEAR(g.extrapolated, exact, 1e-6 * exact);
}

/// Complete elliptic integral K of modulus k, by the arithmetic and geometric mean.
double complete_K(double k) {
  double a = 1.0, b = std::sqrt(1.0 - k * k);
  for (int i = 0; i < 30; ++i) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 0.5 * std::numbers::pi / a;
}

// A pad on half the width of a square block, moved along its edge, in antiplane shear: μ ∇²w = 0 with w = d under the pad and 0
// at the bottom. By two conformal maps of the square to rectangles, with k = 1/√2 and k₁ = k sn(K/2) = k/√(1 + k'),
//   F = μ T d K(k₁)/K(k₁').
// The stress at the pad's edge is singular as 1/√r, as it is under any pad, so that the force falls with h.
TEST(Converge, BracketsAPadInAntiplaneShear) {  // long
  const Scene scene = test::parse(std::string(R"([mesh]
kind = "box"
cells = [4, 1, 4]
size_m = [0.04, 0.005, 0.04]
[sets.all]
box_m = { min = [-1, -1, -1], max = [1, 1, 1] }
[sets.pad]
box_m = { min = [-1, -1, 0.0399], max = [0.0201, 1, 1] }
[tissue]
youngs_modulus_Pa = 3000
poisson_ratio = 0.25
[[fixed]]
set = "all"
axes = "xz"
[[fixed]]
set = "z_min"
axes = "y"
[[tool]]
set = "pad"
direction = [0, 1, 0]
sideways = "free"
velocity_mm_s = 1
depth_mm = 0.1
)") + kQuasiStatic);
  const double k = std::sqrt(0.5), k1 = k / std::sqrt(1.0 + k);
  const double mu = 3000.0 / 2.5;
  const double exact = mu * 0.005 * 1e-4 * complete_K(k1) / complete_K(std::sqrt(1.0 - k1 * k1));
  const GridConvergence g = converge(scene.variants.front(), 4);
  EXPECT_EQ(g.verdict, Verdict::converging);
  EXPECT_NEAR(g.largest, 1.0, 1e-6) << "the arc cosine of a flat angle";
  EXPECT_NEAR(g.seen_order, 1.0, 0.15) << "of a square-root singularity";
  expect_within(g, exact, "pad");
  EXPECT_NEAR(g.extrapolated, exact, 0.01 * exact);
}

/// An L of three squares of edge w and two more, each `n` cells wide, with the vertex sets all, foot and head at its ends.
TetMesh bend(int n, double w) {
  const TetMesh box = box_mesh({.cells = {3 * n, 3 * n, 1}, .size = {3.0 * w, 3.0 * w, w / n}});
  TetMesh mesh;
  std::vector<std::uint32_t> number(box.vertices.size(), ~0u);
  for (const Tet& t : box.tets) {
    Vec3d centre{};
    for (const std::uint32_t v : t) centre += box.vertices[v] * 0.25;
    if (centre.x > w && centre.y > w) continue;
    Tet& own = mesh.tets.emplace_back();
    for (std::size_t a = 0; a < 4; ++a) {
      if (number[t[a]] == ~0u) {
        number[t[a]] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(box.vertices[t[a]]);
      }
      own[a] = number[t[a]];
    }
  }
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    mesh.vertex_sets["all"].push_back(v);
    if (mesh.vertices[v].x > 3.0 * w - 1e-9) mesh.vertex_sets["foot"].push_back(v);
    if (mesh.vertices[v].y > 3.0 * w - 1e-9) mesh.vertex_sets["head"].push_back(v);
  }
  return mesh;
}

// Antiplane shear around the bend of a strip: by the map of Schwarz and Christoffel its corner is as long as 1 − 2 ln 2/π
// squares, so that two arms of two squares give F = μ T d / (5 − 2 ln 2/π), but for e^(−4π). The mesh is given, and split.
TEST(Converge, BracketsABendThatIsSplit) {  // long
  const Scene scene = test::parse(std::string(R"([mesh]
kind = "file"
path = "bend.vtu"
[tissue]
youngs_modulus_Pa = 3000
poisson_ratio = 0.25
[[fixed]]
set = "all"
axes = "xy"
[[fixed]]
set = "foot"
axes = "z"
[[tool]]
set = "head"
direction = [0, 0, 1]
sideways = "free"
velocity_mm_s = 1
depth_mm = 0.1
)") + kQuasiStatic);
  const double thickness = 0.01 / 3.0, mu = 3000.0 / 2.5;
  const double exact = mu * thickness * 1e-4 / (5.0 - 2.0 * std::numbers::ln2 / std::numbers::pi);
  const GridConvergence g = converge(scene.variants.front(), 3, [](const MeshFile&) { return bend(3, 0.01); });
  EXPECT_EQ(g.verdict, Verdict::converging);
  EXPECT_NEAR(g.largest, 4.0 / 3.0, 1e-9) << "of a corner of 270°";
  EXPECT_NEAR(g.order, 4.0 / 3.0, 0.3) << "on coarse meshes";
  expect_within(g, exact, "bend");
  EXPECT_NEAR(g.extrapolated, exact, 2e-3 * exact);
}

// Sets by number or nearness would be others on a finer mesh: the given mesh is split then, with them and with its regions.
TEST(Converge, KeepsWhatIsChosenByNumber) {
  Scene scene =
      test::parse(test::kSmallScene, {{"sets.top", "{ nearest_m = { point = [0.01, 0.01, 0.02], count = 3 } }"}});
  Variant& variant = scene.variants.front();
  variant.regions.push_back({"core", Selection::Sphere{{0.01, 0.01, 0.01}, 0.0101}, variant.tissue, ""});
  const RefinedVariant fine = refined_variant(variant, 1, {});
  EXPECT_TRUE(fine.split);
  const TetMesh given = build_mesh(variant, {}), mesh = build_mesh(fine.variant, fine.load);
  EXPECT_EQ(mesh.tets.size(), 8 * given.tets.size());
  EXPECT_NEAR(tool_area(fine.variant, mesh), tool_area(variant, given), 1e-15);
  EXPECT_EQ(std::count(mesh.regions.begin(), mesh.regions.end(), 1),
            8 * std::count(given.regions.begin(), given.regions.end(), 1));
  EXPECT_FALSE(refined_variant(test::parse(test::kSmallScene).variants.front(), 1, {}).split);
}

}  // namespace
}  // namespace glisson
