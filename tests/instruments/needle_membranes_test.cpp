// A membrane below the surface holds the tip at its depth until the tip pushes with its force, as a region's boundary there does;
// drawn membranes have the stated statistics, and the same bytes everywhere.
#include "glisson/instruments/needle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <sstream>

#include "needle_scenes.h"

namespace glisson::needle_membranes_test {
namespace {

using test::event;
using test::insert;
using test::Inserted;
using test::Insertion;
using test::pushed;
using test::run_to;

constexpr double kDepth = 8e-3, kForce = 0.25, kBeyond = 0.15;

Insertion past_one() {
  Insertion o;
  o.needle.membranes = {{.depth = kDepth, .puncture = kForce, .cutting = kBeyond}};
  return o;
}

// The tip waits at the membrane's depth with less than the membrane's force, and passes in the step in which it pushes with that.
// Beyond, it cuts at the force given there; 1 % for what still swings.
TEST(NeedleMembranes, HoldTheTipUntilTheirForce) {
  Inserted run = insert(past_one());
  double most = 0.0, at_break = 0.0, waited = 0.0, cuts = 0.0;
  int count = 0;
  run_to(run, run.end, [&] {
    const bool passed = event(*run.needle, "inner puncture") != nullptr;
    const bool there = std::abs(run.needle->path_length() - kDepth) < 1e-9;
    if (passed && at_break == 0.0) at_break = run.needle->tip_force();
    if (!passed && there) most = std::max(most, run.needle->tip_force()), waited = run.needle->depth();
    if (!passed) {
      EXPECT_LT(run.needle->path_length(), kDepth + 1e-9);
    }
    if (run.simulation.time() > run.end - 0.2) cuts += run.needle->tip_force(), ++count;
  });
  const InstrumentEvent* broke = event(*run.needle, "inner puncture");
  ASSERT_NE(broke, nullptr);
  EXPECT_NEAR(at_break, kForce, 1e-9);
  EXPECT_LT(most, kForce);
  EXPECT_GT(most, 0.98 * kForce);  // of the step before
  EXPECT_NEAR(broke->depth, waited, 1e-4);
  EXPECT_GT(run.needle->path_length(), kDepth + 1e-3);
  EXPECT_NEAR(cuts / count, kBeyond, 0.01 * kBeyond);
}

// A membrane at the depth of a boundary with the same forces gives the boundary's curve: the path to it is found by bisection to
// 0.5 µm, and a stiffness of some 100 N/m turns that into 0.05 mN; 1 mN allows for steps that fall elsewhere.
TEST(NeedleMembranes, DoAsTheBoundaryOfARegion) {
  Insertion by_region;
  by_region.inner_boundary = 0.03;
  const TetMesh mesh = test::mesh_of(by_region);
  double top = 0.0;  // of the tets of region 1: the boundary runs along a layer of the mesh
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (const std::uint32_t v : mesh.tets[t]) top = mesh.regions[t] == 1 ? std::max(top, mesh.vertices[v].z) : top;
  }
  by_region.needle.regions[1] = {.cutting = kBeyond, .puncture = kForce};
  Insertion by_membrane = past_one();
  by_membrane.needle.membranes[0].depth = by_region.mesh.height - top;
  Inserted a = insert(by_region), b = insert(by_membrane);
  for (double time = 0.05; time < a.end; time += 0.05) {
    run_to(a, time);
    run_to(b, time);
    EXPECT_NEAR(pushed(*a.needle), pushed(*b.needle), 1e-3) << time;
  }
  ASSERT_NE(event(*a.needle, "inner puncture"), nullptr);
  ASSERT_NE(event(*b.needle, "inner puncture"), nullptr);
  EXPECT_NEAR(event(*a.needle, "inner puncture")->depth, event(*b.needle, "inner puncture")->depth, 1e-5);
}

// A broken membrane stays broken: the second way through the hole meets none.
TEST(NeedleMembranes, StayBroken) {
  Insertion o = past_one();
  o.strokes = {{.to = {0, 0, -0.02}, .velocity = 0.02, .ramp = 0.0, .rest = 0.0},
               {.to = {0, 0, 0.002}, .velocity = 0.02, .ramp = 0.0, .rest = 0.2},
               {.to = {0, 0, -0.02}, .velocity = 0.02, .ramp = 0.0, .rest = 0.0}};
  Inserted run = insert(o);
  run_to(run, run.end);
  const auto inner = std::count_if(run.needle->events().begin(), run.needle->events().end(),
                                   [](const InstrumentEvent& e) { return e.event == "inner puncture"; });
  EXPECT_EQ(inner, 1);
}

// A membrane without a force of its own only changes the cutting force, and is no event.
TEST(NeedleMembranes, OfNoForceOnlyChangeTheCutting) {
  Insertion o = past_one();
  o.needle.membranes[0].puncture = 0.0;
  o.needle.membranes[0].cutting = 0.05;
  Inserted run = insert(o);
  run_to(run, run.end);
  EXPECT_EQ(event(*run.needle, "inner puncture"), nullptr);
  EXPECT_NEAR(run.needle->tip_force(), 0.05, 5e-3);
}

// From a checkpoint before, at and beyond the membranes the run has the bytes of the one that was saved.
TEST(NeedleMembranes, AreKeptByCheckpoints) {
  Insertion o = past_one();
  o.needle.drawn_membranes = MembraneProcess{.spacing = 3e-3, .puncture = 0.2, .spread = 0.3, .seed = 5};
  for (const double at : {0.2, 1.2, 1.5, 1.8}) {
    Inserted a = insert(o);
    run_to(a, at);
    std::stringstream file;
    a.simulation.save(file);
    Inserted b = insert(o);
    b.simulation.load(file);
    run_to(a, at + 0.2);
    run_to(b, at + 0.2);
    EXPECT_EQ(a.simulation.state_hash(), b.simulation.state_hash()) << at;
    EXPECT_EQ(a.needle->events().size(), b.needle->events().size()) << at;
    EXPECT_EQ(a.needle->tip_force(), b.needle->tip_force()) << at;
  }
}

NeedleOptions long_needle(std::uint64_t seed) {
  NeedleOptions o;
  o.length = 20.0;
  o.drawn_membranes = MembraneProcess{.spacing = 5e-3, .puncture = 2.0, .spread = 0.2, .seed = seed};
  return o;
}

// Some 4000 membranes of a mean distance of 5 mm and of 2 N ± 20 %: means and deviations within four standard errors, and of
// exponential distances a share of exp(−2) beyond twice the mean.
TEST(NeedleMembranes, DrawnOnesHaveTheStatedStatistics) {
  const std::vector<InnerMembrane> all = membranes_of(long_needle(3));
  const auto n = static_cast<double>(all.size());
  double last = 0.0, gaps = 0.0, squares = 0.0, force = 0.0, force_squares = 0.0, wide = 0.0;
  for (const InnerMembrane& m : all) {
    const double gap = m.depth - last;
    gaps += gap, squares += gap * gap;
    force += m.puncture, force_squares += m.puncture * m.puncture;
    wide += gap > 0.01 ? 1.0 : 0.0;
    last = m.depth;
  }
  const double mean = force / n, error = 4.0 / std::sqrt(n);
  EXPECT_NEAR(gaps / n, 5e-3, error * 5e-3);
  EXPECT_NEAR(std::sqrt(squares / n - gaps / n * gaps / n), 5e-3, 2.0 * error * 5e-3);
  EXPECT_NEAR(wide / n, std::exp(-2.0), error * std::sqrt(std::exp(-2.0)));
  EXPECT_NEAR(mean, 2.0, error * 0.4);
  EXPECT_NEAR(std::sqrt(force_squares / n - mean * mean), 0.4, error * 0.4);
}

// The same seed gives the same bytes on every machine, other seeds other membranes; given ones stand among them by depth.
TEST(NeedleMembranes, DrawnOnesAreThoseOfTheSeed) {
  const std::vector<InnerMembrane> one = membranes_of(long_needle(1)), two = membranes_of(long_needle(2));
  EXPECT_EQ(one[0].depth, 0x1.734d425d87b41p-9);
  EXPECT_EQ(one[0].puncture, 0x1.382ae1e129b03p+1);
  EXPECT_EQ(one[1].depth, 0x1.af4ff74098e8ep-7);
  EXPECT_NE(one[0].depth, two[0].depth);
  NeedleOptions o = long_needle(1);
  o.membranes = {{.depth = 1.0, .puncture = 7.0, .cutting = {}}};
  const std::vector<InnerMembrane> all = membranes_of(o);
  EXPECT_EQ(all.size(), one.size() + 1);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.depth < b.depth; }));
}

// Wrong membranes are named.
TEST(NeedleMembranes, MistakesAreNamed) {
  const auto complaint = [](const NeedleOptions& o) -> std::string {
    try {
      Insertion insertion;
      insertion.needle = o;
      insert(insertion);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "nothing";
  };
  NeedleOptions o;
  o.membranes = {{.depth = 2e-3, .puncture = 1.0, .cutting = {}}, {.depth = 2e-3, .puncture = 1.0, .cutting = {}}};
  EXPECT_NE(complaint(o).find("membranes: number 2, at 2 mm, is not below the one before it"), std::string::npos)
      << complaint(o);
  o.membranes = {{.depth = 2e-3, .puncture = -1.0, .cutting = {}}};
  EXPECT_NE(complaint(o).find("membranes[0].puncture"), std::string::npos) << complaint(o);
  o.membranes.clear();
  o.drawn_membranes = MembraneProcess{.spacing = 0.0, .puncture = 1.0, .spread = 0.2, .seed = 1};
  EXPECT_NE(complaint(o).find("drawn_membranes.spacing"), std::string::npos) << complaint(o);
}

}  // namespace
}  // namespace glisson::needle_membranes_test
