// A needle in soft tissue: it presses, breaks through at the stated force, cuts, rubs, rests and comes out, and every force on
// the hand is borne by what holds the tissue.
#include "glisson/instruments/needle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "needle_scenes.h"

namespace glisson {
namespace {

using test::event;
using test::insert;
using test::Inserted;
using test::Insertion;
using test::pushed;
using test::run_to;

/// Time means of forces while the motion goes on: the tissue swings a little.
struct Means {
  double tip = 0.0, friction = 0.0, push = 0.0, support = 0.0, inserted = 0.0;
};
Means means(Inserted& run, double from, double to) {
  Means m;
  double n = 0.0;
  run_to(run, from);
  run_to(run, to, [&] {
    m.tip += run.needle->tip_force();
    m.friction += dot(run.needle->forces().friction, run.needle->direction());
    m.push += pushed(*run.needle);
    m.support += run.simulation.force(run.held).total().z;
    m.inserted += run.needle->inserted_length();
    n += 1.0;
  });
  return {m.tip / n, m.friction / n, m.push / n, m.support / n, m.inserted / n};
}

// The surface breaks at the stated force of the tip: within what the force rises by in a step, some 0.1 %.
TEST(Needle, BreaksThroughAtTheStatedForce) {
  Inserted run = insert({});
  double last = 0.0;
  while (run.needle->stage() != NeedleStage::inside) {
    run_to(run, run.simulation.time() + 1e-6);
    if (run.needle->stage() == NeedleStage::pressing) last = run.needle->tip_force();
    ASSERT_LT(run.simulation.time(), run.end);
  }
  EXPECT_NEAR(run.needle->tip_force(), 0.3, 0.3 * 2e-3);
  EXPECT_LT(last, 0.3);  // a step before: 0.07 % below
  ASSERT_NE(event(*run.needle, "contact"), nullptr);
  EXPECT_NEAR(event(*run.needle, "contact")->depth, 0.0005, 1e-5);  // the tip starts half a mm above the surface
  EXPECT_EQ(run.needle->events().back().event, "puncture");
}

/// Depth at which a waiting needle meets a body that is carried aside by so much until what was at its axis is under the tip [m].
double contact_of_carried_body(double way) {
  Insertion o;
  o.start = {way, 0.0, 0.0405};
  o.needle.rupture.force = 10.0;
  const TetMesh mesh = mesh_of(o);
  Tissue tissue;
  tissue.youngs_modulus = o.youngs_modulus;
  tissue.poisson_ratio = 0.45;
  Simulation simulation(mesh, {{0, tissue}}, o.options);
  std::vector<std::uint32_t> carried = mesh.vertex_sets.at("bottom");
  carried.insert(carried.end(), mesh.vertex_sets.at("wall").begin(), mesh.vertex_sets.at("wall").end());
  std::sort(carried.begin(), carried.end());
  carried.erase(std::unique(carried.begin(), carried.end()), carried.end());
  constexpr double kCarried = 0.4, kWaits = 0.7, kSpeed = 0.01;  // [s], [s], [m/s]
  simulation.drive(carried, [way](double t) {
    const double share = std::clamp(t / kCarried, 0.0, 1.0);
    return Vec3d{way * share * share * (3.0 - 2.0 * share), 0.0, 0.0};
  });
  const ToolPath path{.displacement =
                          [](double t) {
                            return Vec3d{0.0, 0.0, -kSpeed * std::max(0.0, t - kWaits)};
                          },
                      .end = {}};
  const auto needle = std::make_shared<Needle>(o.needle, std::make_shared<PathDriver>(Pose{o.start}, path));
  simulation.attach(needle);
  while (simulation.time() < 0.9) EXPECT_TRUE(simulation.step().made());
  const InstrumentEvent* contact = event(*needle, "contact");
  return contact != nullptr && needle->stage() == NeedleStage::pressing ? contact->depth : -1.0;
}

// The tip meets what has come under it, 15 mm from what was there at first, and where nothing was, 40 mm beside the body, at the
// surface's height. Named are only vertices near the needle's line, so they have to be named anew as the tissue moves.
TEST(Needle, MeetsASurfaceThatIsCarriedAside) {
  EXPECT_NEAR(contact_of_carried_body(0.015), 0.0005, 5e-5);
  EXPECT_NEAR(contact_of_carried_body(0.07), 0.0005, 5e-5);
}

// In steady cutting the tip bears the cutting force and the shaft C + b v per metre in tissue; the hand feels the sum, and
// the container all of it. 1 % for what still swings.
TEST(Needle, CutsAndRubsByTheLaw) {  // long
  Inserted run = insert({});
  const Means m = means(run, 1.6, 2.0);
  const double per_metre = 10.0 + 200.0 * 0.01;
  EXPECT_NEAR(m.tip, 0.1, 0.001);
  EXPECT_NEAR(m.friction, per_metre * m.inserted, 0.01 * per_metre * m.inserted);
  EXPECT_GT(m.inserted, 0.012);
  EXPECT_NEAR(m.push, m.tip + m.friction, 1e-12);
  EXPECT_NEAR(m.support, m.push, 0.01 * m.push);
}

// After the puncture the tissue springs back along the shaft: the force drops, the tip goes into the tissue while the hand hardly
// moves, and the surface comes up to meet the shaft.
TEST(Needle, TissueSpringsBackAlongTheShaft) {
  Inserted run = insert({});
  const auto broken = [&] { return run.needle->stage() == NeedleStage::inside; };
  while (!broken()) run_to(run, run.simulation.time() + 1e-6);
  const double at = run.simulation.time(), pressed = run.needle->depth() - 0.0005;
  run_to(run, at + 0.1);
  ASSERT_NE(event(*run.needle, "drop"), nullptr);
  EXPECT_LT(event(*run.needle, "drop")->time, at + 0.1);
  EXPECT_LT(pushed(*run.needle), 0.2);
  EXPECT_GT(run.needle->inserted_length(), 0.4 * pressed);  // the hand went 1 mm, the tip some mm
}

// Out again: no tip force, friction the other way by C + b v of withdrawal per metre, then free.
TEST(Needle, WithdrawalReversesFriction) {
  Insertion o;
  o.strokes = {{.to = {0, 0, -0.02}, .velocity = 0.01, .ramp = 0.0, .rest = 0.2},
               {.to = {0, 0, 0.002}, .velocity = 0.01, .ramp = 0.0, .rest = 0.1}};
  Inserted run = insert(o);
  const Means m = means(run, 3.0, 3.3);
  EXPECT_EQ(m.tip, 0.0);
  EXPECT_NEAR(m.friction, -(12.0 + 200.0 * 0.01) * m.inserted,
              0.03 * 14.0 * m.inserted);  // the tissue follows a little
  EXPECT_NEAR(m.support, m.push, 0.02 * std::abs(m.push));
  EXPECT_GT(m.inserted, 0.004);
  run_to(run, run.end);
  EXPECT_EQ(run.needle->stage(), NeedleStage::outside);
  EXPECT_EQ(norm(run.needle->forces().total()), 0.0);
  ASSERT_NE(event(*run.needle, "withdrawal"), nullptr);
  EXPECT_NEAR(event(*run.needle, "withdrawal")->time, 2.2 + 0.15, 0.15);  // the tissue follows some mm first
  EXPECT_EQ(run.needle->events().back().event, "release");
}

// A hole stays: the second way in needs no puncture, and up to its end no cutting force.
TEST(Needle, GoesBackIntoItsHole) {
  Insertion o;
  o.strokes = {{.to = {0, 0, -0.015}, .velocity = 0.02, .ramp = 0.0, .rest = 0.0},
               {.to = {0, 0, 0.002}, .velocity = 0.02, .ramp = 0.0, .rest = 0.3},
               {.to = {0, 0, -0.018}, .velocity = 0.02, .ramp = 0.0, .rest = 0.0}};
  Inserted run = insert(o);
  double most_before = 0.0;
  run_to(run, 0.75 + 0.85 + 0.3);
  const std::size_t events = run.needle->events().size();
  run_to(run, run.end, [&] {
    if (run.needle->depth() < 0.006) most_before = std::max(most_before, run.needle->tip_force());
  });
  EXPECT_EQ(most_before, 0.0);
  EXPECT_NEAR(run.needle->tip_force(), 0.1, 0.01);  // beyond its end it cuts again
  for (std::size_t k = events; k < run.needle->events().size(); ++k) {
    EXPECT_NE(run.needle->events()[k].event, "puncture");
  }
}

// A membrane inside, at the boundary of two regions: the tip is held there until its puncture force, and what is behind it
// is cut at its own force.
TEST(Needle, PiercesInnerMembranes) {  // long
  Insertion o;
  o.inner_boundary = 0.028;
  o.needle.regions[1] = {.cutting = 0.05, .puncture = 0.25};
  o.strokes.front().to.z = -0.024;
  Inserted run = insert(o);
  double most = 0.0;
  run_to(run, run.end, [&] {
    if (event(*run.needle, "drop") != nullptr) most = std::max(most, run.needle->tip_force());
  });
  const InstrumentEvent* inner = event(*run.needle, "inner puncture");
  ASSERT_NE(inner, nullptr);
  EXPECT_NEAR(most, 0.25, 0.25 * 5e-3);
  EXPECT_NEAR(run.needle->tip_force(), 0.05, 0.002);
  EXPECT_GT(inner->depth, 0.0125);  // the boundary lies 12 mm deep and was pushed ahead of the tip
}

// Hardly any force: the needle goes in as it touches, and through the far side.
TEST(Needle, GoesOutAtTheFarSide) {
  Insertion o;
  o.needle.rupture = {};
  o.needle.tip.cutting = 0.005;
  o.needle.friction = {};
  o.strokes.front() = {.to = {0, 0, -0.05}, .velocity = 0.02, .ramp = 0.0, .rest = 0.0};
  Inserted run = insert(o);
  run_to(run, run.end);
  ASSERT_NE(event(*run.needle, "exit"), nullptr);
  EXPECT_NEAR(event(*run.needle, "exit")->depth, 0.0405, 0.0015);
  EXPECT_LT(pushed(*run.needle), 0.002);
}

// The energy that springing back sets free decides: measured from outside, ∫ f dδ down to the cutting force is what the
// toughness asks for, and more toughness needs more depth.
TEST(Needle, ToughnessIsTheEnergySetFree) {
  double last_depth = 0.0;
  for (const double toughness : {800.0, 3000.0}) {
    Insertion o;
    o.needle.rupture = {.force = {}, .toughness = toughness, .membrane_thickness = 1e-4};
    Inserted run = insert(o);
    double work = 0.0, depth = 0.0, force = 0.0;
    while (run.needle->stage() != NeedleStage::inside) {
      run_to(run, run.simulation.time() + 1e-6);
      ASSERT_LT(run.simulation.time(), run.end);
      const double f = run.needle->tip_force(), d = run.needle->depth();
      if (f > 0.1) work += (0.5 * (f + force) - 0.1) * (d - depth);
      force = f, depth = d;
    }
    const double area = 1.27e-3 * 1e-4;
    EXPECT_NEAR(work, toughness * area, 0.02 * toughness * area);
    EXPECT_GT(depth, last_depth);
    last_depth = depth;
  }
}

// Relaxing tissue lets go of a needle that rests; the force falls, and never rises again.
TEST(Needle, ForceRelaxesWhenItRests) {  // long
  Insertion o;
  o.maxwell = {{.share = 0.5, .time = 0.2}};
  o.needle.rupture.force = 10.0;  // the surface holds
  o.strokes = {{.to = {0, 0, -0.006}, .velocity = 0.02, .ramp = 0.0, .rest = 1.2}};
  Inserted run = insert(o);
  run_to(run, 0.35);
  const double early = pushed(*run.needle);
  run_to(run, 0.3 + 1.2);
  const double late = pushed(*run.needle);
  // linear tissue, pressed at one speed from 0.025 s to 0.3 s:  F ∝ (1 − g) T + g τ e^(−s/τ) (1 − e^(−T/τ)), s after it
  const auto after = [](double s) {
    return 0.5 * 0.275 + 0.5 * 0.2 * std::exp(-s / 0.2) * (1.0 - std::exp(-0.275 / 0.2));
  };
  EXPECT_NEAR(late / early, after(1.2) / after(0.05), 0.005);
}

// Faster is stiffer in relaxing tissue: the same depth needs more force.
TEST(Needle, FasterNeedsMoreForce) {  // long
  double last = 0.0;
  for (const double velocity : {0.002, 0.006, 0.02}) {
    Insertion o;
    o.maxwell = {{.share = 0.5, .time = 0.5}};
    o.needle.rupture.force = 10.0;
    o.strokes = {{.to = {0, 0, -0.005}, .velocity = velocity, .ramp = 0.0, .rest = 0.0}};
    Inserted run = insert(o);
    run_to(run, run.end);
    EXPECT_GT(pushed(*run.needle), 1.02 * last);
    last = pushed(*run.needle);
  }
}

// Moved aside in the tissue, the needle takes the tissue along: every point of the path stays on it, and the hand feels it.
TEST(Needle, TakesTissueAlongSideways) {
  Insertion o;
  o.strokes = {{.to = {0, 0, -0.015}, .velocity = 0.02, .ramp = 0.0, .rest = 0.1},
               {.to = {0.003, 0, -0.015}, .velocity = 0.01, .ramp = 0.05, .rest = 0.2}};
  Inserted run = insert(o);
  run_to(run, run.end);
  const std::vector<Vec3d> path = run.needle->path();
  ASSERT_GT(path.size(), 3U);
  for (const Vec3d& x : path) EXPECT_NEAR(x.x, 0.003, 2e-5);
  EXPECT_GT(run.needle->forces().total().x, 0.05);
  EXPECT_NEAR(run.simulation.force(run.held).total().x, -run.needle->forces().total().x,
              0.03 * run.needle->forces().total().x);
}

/// Deflection of a needle across, along x, at the first point of its shaft in tissue: of its centre line, and of a cantilever that bears
/// nothing before that point, EI y = M x²/2 + F x³/6, with force and moment of the hand.
std::pair<double, double> deflection_at_entry(const Needle& needle) {
  const std::vector<Vec3d> line = needle.centre_line();
  const double x = line[0].z - line[1].z, bending = needle.options().youngs_modulus.value() * std::numbers::pi *
                                                    std::pow(needle.options().diameter, 4) / 64.0;
  return {line[1].x - line[0].x,
          (0.5 * needle.handle_torque().y * x * x + needle.forces().total().x * x * x * x / 6.0) / bending};
}

// A thin needle of steel bends where a rigid one does not, and a stiffer needle less. Where it enters the tissue its deflection is that of a
// cantilever under the force and the moment that the hand bears.
TEST(Needle, BendsUnderTheTissue) {  // long
  double last = 0.01;
  for (const double diameter : {1.0e-3, 1.5e-3, 2.41e-3}) {
    Insertion o;
    o.needle.youngs_modulus = 200e9;
    o.needle.diameter = diameter;
    o.needle.friction = {},
    o.needle.tip.cutting = 1e-3;  // what acts along the needle has a moment about the hand, too, once it is bent
    o.strokes = {{.to = {0, 0, -0.015}, .velocity = 0.02, .ramp = 0.0, .rest = 0.1},
                 {.to = {0.003, 0, -0.015}, .velocity = 0.01, .ramp = 0.05, .rest = 0.3}};
    Inserted run = insert(o);
    run_to(run, run.end);
    const double bent = 0.003 - run.needle->centre_line().back().x;
    EXPECT_LT(bent, 0.7 * last);
    EXPECT_GT(bent, 1e-5);
    const auto [found, exact] = deflection_at_entry(*run.needle);
    EXPECT_NEAR(found, exact, 0.01 * std::abs(exact));
    EXPECT_LT(exact, -0.3 * bent);
    last = bent;
  }
}

// A bevelled tip steers a needle that bends, to the side it points to, and no rigid one.
TEST(Needle, BevelSteers) {  // long
  const auto aside = [](double share, std::optional<double> modulus) {
    Insertion o;
    o.needle.diameter = 0.4e-3;
    o.needle.youngs_modulus = modulus;
    o.needle.bevel_share = share;
    o.needle.bevel_side = {0, 1, 0};
    Inserted run = insert(o);
    run_to(run, run.end);
    return run.needle->centre_line().back().y;
  };
  const double plain = aside(0.0, 200e9);
  EXPECT_GT(aside(0.3, 200e9), plain + 2e-4);
  EXPECT_NEAR(plain, 0.0,
              6e-5);  // the mesh is not quite symmetric: 0.03 to 0.06 mm over steps of 20 µs to the automatic one
  EXPECT_EQ(aside(0.3, {}), 0.0);
}

// A needle held still in swinging tissue gives it no energy: kinetic and elastic energy only fall. From one step to the next
// they may rise by the work of impulses that are booked half before and half after; over 20 ms that is gone.
TEST(Needle, AtRestGivesNoEnergy) {
  Insertion o;
  o.options.damping_rate = 0.0;
  o.strokes = {{.to = {0, 0, -0.015}, .velocity = 0.05, .ramp = 0.0, .rest = 0.5}};
  Inserted run = insert(o);
  run_to(run, 0.301);
  double last = 1e300;
  for (int k = 0; k < 25; ++k) {
    run_to(run, 0.32 + 0.02 * k);
    const Energies e = run.simulation.energies();
    EXPECT_LT(e.kinetic + e.elastic, last);
    last = e.kinetic + e.elastic;
    EXPECT_NEAR(e.imbalance(), 0.0, 1e-9 * e.work_tools);
  }
  EXPECT_GT(last, 1e-6);
}

// A run that goes on from a checkpoint has the bytes of the one that was saved, in every stage.
TEST(Needle, CheckpointContinuesToTheByte) {
  Insertion o;
  o.strokes = {{.to = {0, 0, -0.015}, .velocity = 0.02, .ramp = 0.0, .rest = 0.1},
               {.to = {0, 0, 0.002}, .velocity = 0.02, .ramp = 0.0, .rest = 0.1}};
  o.needle.youngs_modulus = 200e9;
  o.needle.bevel_share = 0.2;
  for (const double at : {0.01, 0.2, 0.45, 0.8, 1.2}) {
    Inserted a = insert(o);
    run_to(a, at);
    std::stringstream file;
    a.simulation.save(file);
    Inserted b = insert(o);
    b.simulation.load(file);
    run_to(a, at + 0.3);
    run_to(b, at + 0.3);
    EXPECT_EQ(a.simulation.state_hash(), b.simulation.state_hash()) << at;
    EXPECT_EQ(norm(a.needle->forces().total() - b.needle->forces().total()), 0.0);
    ASSERT_EQ(a.needle->events().size(), b.needle->events().size());
    for (std::size_t k = 0; k < a.needle->events().size(); ++k) {
      EXPECT_EQ(a.needle->events()[k].event, b.needle->events()[k].event);
      EXPECT_EQ(a.needle->events()[k].time, b.needle->events()[k].time);
    }
  }
}

TEST(Needle, SameBytesOnTwoThreads) {
  std::uint64_t hash = 0;
  for (const int threads : {1, 2}) {
    Insertion o;
    o.options.threads = threads;
    Inserted run = insert(o);
    run_to(run, run.end);
    if (threads == 1) hash = run.simulation.state_hash();
    EXPECT_EQ(run.simulation.state_hash(), hash);
  }
}

// Tets that vanish around the shaft and the tip take their share of the force with them: friction acts on what is left, the tip presses on
// the far wall of the hole until it is punctured, too, and goes on. The support bears all of it.
TEST(Needle, BearsChangesOfTheMesh) {
  Insertion o;
  o.strokes = {{.to = {0, 0, -0.024}, .velocity = 0.01, .ramp = 0.0, .rest = 0.0}};
  Inserted run = insert(o);
  run_to(run, 1.5);
  std::vector<std::uint32_t> gone;
  const TetMesh& mesh = run.simulation.mesh();
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3d middle;
    for (const std::uint32_t v : mesh.tets[t]) middle += mesh.vertices[v] * 0.25;
    if (norm(middle - Vec3d{0, 0, 0.03}) < 0.005) gone.push_back(t);
  }
  ASSERT_GT(gone.size(), 20U);
  const double inside = run.needle->inserted_length();
  run.simulation.remove_tets(gone);
  // 10 N/m and 200 N s/m² at 10 mm/s; tissue that is carried along slips by a little less
  const auto expect_shares = [&](NeedleStage stage, std::size_t stretches, double tip) {
    const Needle& needle = *run.needle;
    const double force = pushed(needle), friction = 12.0 * needle.inserted_length();
    EXPECT_EQ(needle.stage(), stage);
    EXPECT_EQ(needle.crossing().size(), stretches);
    EXPECT_NEAR(needle.tip_force(), tip, 0.01 * tip);
    EXPECT_NEAR(force - needle.tip_force(), friction, 0.04 * friction);
    EXPECT_NEAR(run.simulation.force(run.held).total().z, force, 0.02 * force);
  };
  run_to(run, 1.98);
  expect_shares(NeedleStage::pressing, 1, run.needle->tip_force());
  EXPECT_LT(run.needle->inserted_length(), 0.5 * inside);
  EXPECT_GT(run.needle->tip_force(), 0.25) << "0.3 N break the wall";
  run_to(run, 2.38);
  expect_shares(NeedleStage::inside, 2, 0.1);
}

// A tip that starts in the tissue is a mistake of the one who set it up, and is told so; at the surface it may start.
TEST(Needle, RefusesToStartInside) {
  Insertion o;
  o.start.z = 0.03;
  try {
    insert(o);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("10 mm behind the surface"), std::string::npos) << error.what();
  }
  o.start.z = 0.04;
  EXPECT_NO_THROW(insert(o));
}

TEST(Needle, RefusesBadOptions) {
  const auto refuses = [](auto change, const char* said) {
    NeedleOptions o;
    change(o);
    try {
      Needle(o, std::make_shared<PathDriver>(Pose{}, steady_path({})));
      FAIL() << said;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
  };
  refuses([](auto& o) { o.diameter = 0.0; }, "diameter");
  refuses([](auto& o) { o.length = -1.0; }, "length");
  refuses([](auto& o) { o.direction = {}; }, "direction");
  refuses([](auto& o) { o.zone = std::nan(""); }, "zone");
  refuses([](auto& o) { o.rupture.force = 0.0; }, "rupture.force");
  refuses([](auto& o) { o.rupture = {.force = 1.0, .toughness = 1.0, .membrane_thickness = 1e-4}; }, "one of the two");
  refuses([](auto& o) { o.regions[3].cutting = -1.0; }, "regions[3]");
  refuses([](auto& o) { o.friction.dynamic_out = 1.0; }, "dynamic_out");
  refuses([](auto& o) { o.inner_diameter = 0.01; }, "inner_diameter");
  EXPECT_THROW(Needle(NeedleOptions{}, nullptr), std::invalid_argument);
}

}  // namespace
}  // namespace glisson
