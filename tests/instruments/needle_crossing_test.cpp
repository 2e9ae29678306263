// What a needle's path crosses: slabs, gaps, cavities and pieces, each with its own contact, puncture and cutting; only the shaft
// within tissue rubs.
#include "instruments/needle/crossing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "instruments/needle_lobes.h"

namespace glisson::needle_crossing_test {
namespace {

using test::far_slab;
using test::length_inside;
using test::lobes;
using test::LobeScene;
using test::run_to;
using test::run_until;

constexpr double kFriction = 4.0;  ///< of the scenes, in and out [N/m]

SurfaceHit in(double way) { return {.way = way, .rest = {}, .goes_in = true}; }
SurfaceHit out(double way) { return {.way = way, .rest = {}, .goes_in = false}; }

std::vector<std::pair<double, double>> intervals(std::vector<SurfaceHit> hits, double length, bool inside) {
  put_in_order(hits);
  std::vector<std::pair<double, double>> all;
  for (const TissueInterval& i : find_intervals(hits, length, inside)) all.emplace_back(i.from, i.to);
  return all;
}
using Pairs = std::vector<std::pair<double, double>>;

// Stretches lie between where a line goes in and where it comes out: of two bodies, from within, up to the end, of pieces that overlap,
// and across a closed cut, whose two faces are met in either order; hits on an edge that two triangles share count once.
TEST(Crossing, IsBetweenGoingInAndComingOut) {
  EXPECT_EQ(intervals({out(7), in(1), in(5), out(2)}, 10, false), (Pairs{{1, 2}, {5, 7}}));
  EXPECT_EQ(intervals({out(2), in(5)}, 10, true), (Pairs{{0, 2}, {5, 10}}));
  EXPECT_EQ(intervals({in(0), out(2)}, 10, true), (Pairs{{0, 2}}));
  EXPECT_EQ(intervals({in(1), in(3), out(4), out(6)}, 10, false), (Pairs{{1, 6}}));
  EXPECT_EQ(intervals({in(1), out(3), in(3 + 1e-12), out(6)}, 10, false), (Pairs{{1, 6}}));
  EXPECT_EQ(intervals({in(1), in(3), out(3 + 1e-12), out(6)}, 10, false), (Pairs{{1, 6}}));
  EXPECT_EQ(intervals({in(1), in(1 + 1e-13), out(2), out(2), out(2)}, 10, false), (Pairs{{1, 2}}));
  EXPECT_EQ(intervals({}, 10, true), (Pairs{{0, 10}}));
  EXPECT_TRUE(intervals({}, 10, false).empty());
}

// A line through corners and along edges of the surface of a box, straight and askew, is in it over the length that it has there.
TEST(Crossing, MeetsCornersAndEdgesOnce) {
  const TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {2, 2, 2}});
  const std::vector<Triangle> surface = boundary_triangles(mesh);
  const auto inside = [&](const Vec3d& from, const Vec3d& to) {
    const double length = norm(to - from);
    std::vector<SurfaceHit> hits;
    for (const Triangle& t : surface) {
      const std::array<Vec3d, 3> x{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
      const auto hit = meet(from, (to - from) * (1.0 / length), x, x);
      if (hit && hit->way >= 0.0 && hit->way <= length) hits.push_back(*hit);
    }
    put_in_order(hits);
    double sum = 0.0;
    for (const TissueInterval& i : find_intervals(hits, length, false)) sum += i.to - i.from;
    return sum;
  };
  EXPECT_NEAR(inside({1, 1, -1}, {1, 1, 4}), 2.0, 1e-12);                     // a vertex on either side
  EXPECT_NEAR(inside({0.5, 0.5, -1}, {0.5, 0.5, 4}), 2.0, 1e-12);             // a diagonal edge
  EXPECT_NEAR(inside({-1, -1, -1}, {3, 3, 3}), 2.0 * std::sqrt(3.0), 1e-12);  // two corners of the box
  EXPECT_NEAR(inside({1, -1, -1}, {1, 3, 3}), 2.0 * std::sqrt(2.0), 1e-12);   // two of its edges
  EXPECT_NEAR(inside({0.3, 0.4, -1}, {1.3, 0.9, 3}), 0.5 * std::sqrt(17.25), 1e-12);
  EXPECT_EQ(inside({3, 1, -1}, {3, 1, 4}), 0.0);
}

class NeedleThrough : public testing::TestWithParam<Integrator> {};

LobeScene through_slab(Integrator integrator) {
  LobeScene o;
  o.integrator = integrator;
  o.strokes = {{.to = {0, 0, -0.03}, .velocity = 0.04, .ramp = 0.0, .rest = 0.05},
               {.to = {0, 0, 0.002}, .velocity = 0.04, .ramp = 0.0, .rest = 0.1}};
  return o;
}

// Through a slab of 10 mm: from the exit on the force is friction on what of the shaft is in the slab as it is deformed, found by the test
// from the surface at present; on the way out the same with the other sign until the tip comes back to the far side, then on the rest; and
// 0 with the needle out. 3 %, of a thickness: points of the path are means over a zone of 4 mm.
TEST_P(NeedleThrough, RubsOnTheShaftInTissueAlone) {  // long
  const LobeScene o = through_slab(GetParam());
  test::Lobes run = far_slab(o);
  const std::vector<Triangle> surface = boundary_triangles(run.simulation.mesh());
  double worst_in = 0.0, worst_out = 0.0, most_inside = 0.0, after = 1.0;
  int far_in = 0, far_out = 0, steps = 0;
  run_to(run, [&] {
    after = std::abs(test::pushed(*run.needle));
    if (o.integrator == Integrator::central_difference && ++steps % 20 != 0) return;
    const double t = run.simulation.force_time(), force = test::pushed(*run.needle);
    const double inside = length_inside(surface, run);
    const double depth = run.needle->force_depth();
    if (t < 0.75 && depth > 0.0125) {
      worst_in = std::max(worst_in, std::abs(force - kFriction * inside)), ++far_in;
      most_inside = std::max(most_inside, inside);
      EXPECT_NEAR(run.needle->inserted_length(), inside, 0.03 * 0.01);
    }
    if (t > 0.87 && depth > 0.003 && depth < 0.028) {  // after the turn, in which the tissue is taken along
      worst_out = std::max(worst_out, std::abs(force + kFriction * inside)), ++far_out;
    }
  });
  EXPECT_GT(std::min(far_in, far_out), 10);
  EXPECT_NEAR(most_inside, 0.01, 3e-4);
  EXPECT_LT(worst_in, 0.03 * 0.04);
  EXPECT_LT(worst_out, 0.03 * 0.04);
  EXPECT_EQ(after, 0.0);
  EXPECT_EQ(run.needle->stage(), NeedleStage::outside);
  EXPECT_EQ(run.needle->inserted_length(), 0.0);
  EXPECT_EQ(test::words_of(*run.needle), "contact puncture drop exit withdrawal release");
  const Energies e = run.simulation.energies();
  EXPECT_NEAR(e.imbalance(), 0.0, 1e-6 * e.work_tools);
  RecordProperty("in_percent", std::to_string(100.0 * worst_in / 0.04));
  RecordProperty("out_percent", std::to_string(100.0 * worst_out / 0.04));
}

// Two lobes alike, 6 mm apart: two contacts, punctures and exits; the second puncture at the force of the first and after the same
// indentation, and then friction on both. Out of both again, through both holes once more without a puncture, and the ledger closes.
TEST_P(NeedleThrough, PiercesTwoLobesAlike) {  // long
  LobeScene o;
  o.integrator = GetParam();
  o.strokes = {{.to = {0, 0, -0.0205}, .velocity = 0.04, .ramp = 0.0, .rest = 0.0},
               {.to = {0, 0, 0.002}, .velocity = 0.04, .ramp = 0.0, .rest = 0.1},
               {.to = {0, 0, -0.0185}, .velocity = 0.04, .ramp = 0.0, .rest = 0.0}};
  test::Lobes run = lobes(o);
  std::vector<double> at_puncture;
  std::size_t seen = 0;
  double worst = 0.0, largest_tip_again = 0.0;
  int cutting = 0;
  run_to(run, [&] {
    for (; seen < run.needle->events().size(); ++seen) {
      if (run.needle->events()[seen].event == "puncture") at_puncture.push_back(run.needle->tip_force());
    }
    if (run.simulation.time() > 0.46 && run.simulation.time() < 0.51) {  // sprung back, and before the turn
      EXPECT_EQ(run.needle->crossing().size(), 2U);
      ++cutting;
      const double friction = dot(run.needle->forces().friction, run.needle->direction());
      worst = std::max(worst, std::abs(friction - kFriction * run.needle->inserted_length()));
    }
    if (run.simulation.time() > 1.2) largest_tip_again = std::max(largest_tip_again, run.needle->tip_force());
  });
  ASSERT_EQ(at_puncture.size(), 2U);
  // read in the step in which the surface gives way; in long ones that goes on beyond it, and the indentation has to tell
  const double rise = GetParam() == Integrator::central_difference ? 8e-4 : 0.04;
  for (const double force : at_puncture) EXPECT_NEAR(force, 0.06, rise);
  const auto depths = [&](const std::string& word) {
    std::vector<double> all;
    for (const InstrumentEvent& e : run.needle->events()) {
      if (e.event == word) all.push_back(e.depth);
    }
    return all;
  };
  const std::vector<double> contact = depths("contact"), puncture = depths("puncture"), drop = depths("drop");
  ASSERT_EQ(contact.size(), 4U);
  ASSERT_EQ(drop.size(), 2U);
  for (const std::size_t k : {0U, 1U}) EXPECT_GT(drop[k], puncture[k] + 2e-4);
  EXPECT_NEAR(contact[1] - contact[0], 0.014, 5e-5);
  EXPECT_NEAR(puncture[1] - contact[1], puncture[0] - contact[0], 0.05 * (puncture[0] - contact[0]));
  EXPECT_EQ(test::words_of(*run.needle),
            "contact puncture drop exit contact puncture drop withdrawal release release contact exit contact");
  EXPECT_LT(largest_tip_again, 0.033);  // it cuts no more than before
  EXPECT_EQ(run.needle->crossing().size(), 2U);
  EXPECT_GT(cutting, 5);
  EXPECT_LT(worst, 0.03 * kFriction * 0.016);
  const Energies e = run.simulation.energies();
  EXPECT_NEAR(e.imbalance(), 0.0, 1e-6 * e.work_tools);
  RecordProperty("friction_percent", std::to_string(100.0 * worst / (kFriction * 0.016)));
  RecordProperty("indentation_percent",
                 std::to_string(100.0 * (puncture[1] - contact[1]) / (puncture[0] - contact[0])));
}

INSTANTIATE_TEST_SUITE_P(Integrators, NeedleThrough,
                         testing::Values(Integrator::central_difference, Integrator::implicit,
                                         Integrator::quasi_static),
                         [](const auto& p) { return std::string(word_of(p.param)); });

/// Tets of a block 20 mm thick whose middles lie between −14 and −8 mm, within 8 mm of its axis.
std::vector<std::uint32_t> around_path(const TetMesh& mesh) {
  std::vector<std::uint32_t> all;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3d middle;
    for (const std::uint32_t v : mesh.tets[t]) middle += mesh.vertices[v] * 0.25;
    if (std::max(std::abs(middle.x), std::abs(middle.y)) < 0.008 && middle.z > -0.014 && middle.z < -0.008) {
      all.push_back(t);
    }
  }
  return all;
}

TetMesh block() {
  return box_mesh({.cells = {6, 6, 10},
                   .size = {0.024, 0.024, 0.02},
                   .origin = {-0.012, -0.012, -0.02},
                   .split = BoxSplit::alternating});
}

TetMesh without(const TetMesh& mesh, const std::vector<std::uint32_t>& gone) {
  TetMesh rest;
  rest.vertices = mesh.vertices;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    if (!std::binary_search(gone.begin(), gone.end(), t)) rest.tets.push_back(mesh.tets[t]);
  }
  return rest;
}

// A cavity of 6 mm within tissue has a rear wall: the needle comes out into the cavity, meets the wall 14 mm deep, pierces it at the force of
// the surface, and rubs on both sides of the cavity alone.
TEST(NeedleCavity, HasARearWall) {  // long
  LobeScene o;
  o.integrator = Integrator::implicit;
  o.strokes.front().to.z = -0.0185;
  const TetMesh mesh = block();
  test::Lobes run = test::into(without(mesh, around_path(mesh)), o, 0.012);
  const std::vector<Triangle> surface = boundary_triangles(run.simulation.mesh());
  run_until(run);
  EXPECT_EQ(test::words_of(*run.needle), "contact puncture drop exit contact puncture drop");
  EXPECT_NEAR(run.needle->events()[4].depth, 0.0145, 5e-4);  // friction has drawn the wall down before
  EXPECT_EQ(run.needle->crossing().size(), 2U);
  EXPECT_NEAR(run.needle->inserted_length(), length_inside(surface, run), 3e-4);
  EXPECT_NEAR(test::pushed(*run.needle), 0.03 + kFriction * length_inside(surface, run), 0.03 * 0.06);
}

// Tissue that is removed around the shaft leaves what is above and below it: the needle stays in both, its tip too, with the friction of these
// lengths alone, on the way in and out. Removed around the tip as well, the path ends above.
TEST(NeedleCavity, MayBeMadeAroundTheShaft) {  // long
  for (const bool and_below : {false, true}) {
    LobeScene o;
    o.integrator = Integrator::implicit;
    o.strokes = {{.to = {0, 0, -0.018}, .velocity = 0.04, .ramp = 0.0, .rest = 0.05},
                 {.to = {0, 0, -0.0193}, .velocity = 0.04, .ramp = 0.0, .rest = 0.0},
                 {.to = {0, 0, -0.016}, .velocity = 0.04, .ramp = 0.0, .rest = 0.0},
                 {.to = {0, 0, 0.002}, .velocity = 0.04, .ramp = 0.0, .rest = 0.1}};
    test::Lobes run = test::into(block(), o, 0.012);
    run_until(run, 0.48);
    std::vector<std::uint32_t> gone = around_path(run.simulation.mesh());
    if (and_below) {
      for (std::uint32_t t = 0; t < run.simulation.mesh().tets.size(); ++t) {
        double top = -1.0;
        for (const std::uint32_t v : run.simulation.mesh().tets[t])
          top = std::max(top, run.simulation.mesh().vertices[v].z);
        if (top < -0.0139) gone.push_back(t);
      }
      std::ranges::sort(gone);
    }
    run.simulation.remove_tets(gone);
    EXPECT_EQ(run.needle->crossing().size(), and_below ? 1U : 2U);
    const std::vector<Triangle> surface = boundary_triangles(without(run.simulation.mesh(), gone));
    EXPECT_NEAR(run.needle->inserted_length(), length_inside(surface, run), 3e-4);
    run_until(run, 0.53);
    const double inside = length_inside(surface, run);
    EXPECT_NEAR(test::pushed(*run.needle), (and_below ? 0.0 : 0.03) + kFriction * inside, 0.03 * 0.06) << and_below;
    run_until(run, 0.615);  // 16 mm deep, on the way out
    EXPECT_NEAR(test::pushed(*run.needle), -kFriction * length_inside(surface, run), 0.03 * 0.06) << and_below;
    run_until(run);
    EXPECT_EQ(test::pushed(*run.needle), 0.0);
    EXPECT_EQ(run.needle->stage(), NeedleStage::outside);
  }
}

// Depths of membranes count from the first surface, gaps included: of those at 5, 10 and 16 mm the one in the gap holds nothing, and the last is
// broken 2 mm deep in the second lobe.
TEST(NeedleLobes, MembranesCountFromTheFirstSurface) {  // long
  LobeScene o;
  o.step = test::kShortStep;
  o.needle.membranes = {{.depth = 0.005, .puncture = 0.05, .cutting = {}},
                        {.depth = 0.010, .puncture = 5.0, .cutting = {}},
                        {.depth = 0.016, .puncture = 0.05, .cutting = {}}};
  test::Lobes run = lobes(o);
  std::vector<double> depths;
  std::size_t seen = 0;
  double before = 0.0;
  run_to(run, [&] {
    for (; seen < run.needle->events().size(); ++seen) {
      if (run.needle->events()[seen].event == "inner puncture") depths.push_back(before);
    }
    before = run.needle->path_length();
  });
  ASSERT_EQ(depths.size(), 2U);
  EXPECT_NEAR(depths[0], 0.005, 1e-9);
  EXPECT_NEAR(depths[1], 0.016, 1e-9);
}

// Beyond its last point in tissue a bent needle is straight: the free tip deviates by the slope there, not by the deflection of that point.
TEST(NeedleLobes, FreeEndIsStraight) {  // long
  LobeScene o;
  o.integrator = Integrator::quasi_static;
  o.needle.youngs_modulus = 200e9;
  o.strokes = {{.to = {0, 0, -0.025}, .velocity = 0.04, .ramp = 0.0, .rest = 0.0},
               {.to = {0.003, 0, -0.025}, .velocity = 0.04, .ramp = 0.0, .rest = 0.0}};
  test::Lobes run = far_slab(o);
  run_until(run);
  const std::vector<Vec3d> line = run.needle->centre_line();
  const Vec3d tip = line.back(), last = line[line.size() - 2], before = line[line.size() - 3];
  const double slope = (last.x - before.x) / (before.z - last.z), free = last.z - tip.z;
  EXPECT_GT(free, 0.012);
  EXPECT_GT(std::abs(tip.x - last.x), 1e-4);
  EXPECT_NEAR(tip.x - last.x, slope * free, 0.05 * std::abs(tip.x - last.x));
}

LobeScene in_and_out(Integrator integrator) {
  LobeScene o;
  o.integrator = integrator;
  o.step = integrator == Integrator::central_difference ? test::kShortStep : 0.01;
  o.strokes = {{.to = {0, 0, -0.019}, .velocity = 0.08, .ramp = 0.0, .rest = 0.0},
               {.to = {0, 0, 0.001}, .velocity = 0.08, .ramp = 0.0, .rest = 0.0},
               {.to = {0, 0, -0.0195}, .velocity = 0.08, .ramp = 0.0, .rest = 0.0}};
  return o;
}

// Saved in the gap, on the second lobe, within it, on the way back before it and within the first, and outside, a run
// goes on with the same bytes.
TEST(NeedleLobes, CheckpointsGoOn) {  // verify
  for (const Integrator integrator : {Integrator::central_difference, Integrator::implicit}) {
    const LobeScene o = in_and_out(integrator);
    test::Lobes a = lobes(o);
    constexpr double kOutside = 0.485;
    for (const double at : {0.15, 0.185, 0.22, 0.3, 0.4, kOutside}) {
      run_until(a, at);
      std::stringstream file;
      a.simulation.save(file);
      test::Lobes b = lobes(o);
      b.simulation.load(file);
      const double end = at == kOutside ? a.end : at + 0.03;  // in again to the end of its holes
      run_until(a, end);
      run_until(b, end);
      EXPECT_EQ(a.simulation.state_hash(), b.simulation.state_hash()) << word_of(integrator) << " " << at;
      EXPECT_EQ(test::pushed(*a.needle), test::pushed(*b.needle));
      EXPECT_EQ(test::words_of(*a.needle), test::words_of(*b.needle));
      EXPECT_EQ(a.needle->inserted_length(), b.needle->inserted_length());
    }
  }
}

// Turned and moved as a whole, two lobes give the same force to 1e-6 of the largest at every step, and the same events.
TEST(NeedleLobes, AreTheSameInAnyFrame) {  // long
  const auto curve = [](const Pose& frame) {
    LobeScene o = in_and_out(Integrator::central_difference);
    o.frame = frame;
    test::Lobes run = lobes(o);
    std::vector<double> force;
    run_to(
        run, [&] { force.push_back(test::pushed(*run.needle)); }, 0.35);
    return std::pair(force, run.needle->events());
  };
  const auto [force, events] = curve({});
  const double largest = *std::ranges::max_element(force);
  EXPECT_GE(events.size(), 8U);
  const auto [turned, turned_events] = curve({{0.3, -0.2, 0.1}, test::rotation(unit(Vec3d{1, 2, 3}), 1.1)});
  ASSERT_EQ(turned.size(), force.size());
  double most = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) most = std::max(most, std::abs(turned[i] - force[i]));
  EXPECT_LT(most, 1e-6 * largest);
  ASSERT_EQ(turned_events.size(), events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(turned_events[i].event, events[i].event);
    EXPECT_NEAR(turned_events[i].depth, events[i].depth, 1e-9);
  }
}

}  // namespace
}  // namespace glisson::needle_crossing_test
