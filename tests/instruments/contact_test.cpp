// A rigid tool: nothing passes through it however fast it is, its force and torque are what the body's momentum changes by, and
// it follows the body when that is cut.
#include <gmock/gmock.h>

#include <sstream>

#include "instruments/contact_scenes.h"

namespace glisson {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

Tissue tissue() {
  Tissue t;
  t.youngs_modulus = 5000.0, t.poisson_ratio = 0.3;
  return t;
}

/// 4 × 4 × 2 cm, its top at z = 0.
TetMesh slab(int cells = 8) {
  return box_mesh({.cells = {cells, cells, cells / 2}, .size = {0.04, 0.04, 0.02}, .origin = {-0.02, -0.02, -0.02}});
}

std::shared_ptr<ContactTool> tool(const Shape& shape, double friction, std::function<Pose(double)> pose) {
  ContactOptions o;
  o.shape = shape, o.friction = friction;
  return std::make_shared<ContactTool>(o, std::make_shared<test::GivenPath>(std::move(pose)));
}

std::function<Pose(double)> down(const Vec3d& from, double speed) {
  return [=](double t) { return Pose{from - Vec3d{0.0, 0.0, speed * t}}; };
}

/// Least φ over the surface: at vertices, and at points of every triangle.
double least_gap(const Simulation& s, const ContactTool& t) {
  double least = 1.0;
  const std::vector<Vec3d> x = s.positions();
  const Mat3d back = inverse(t.pose().axes);
  for (const Triangle& f : boundary_triangles(s.present_mesh())) {
    for (int i = 0; i <= 6; ++i) {
      for (int j = 0; i + j <= 6; ++j) {
        const Vec3d p = (x[f[0]] * i + x[f[1]] * j + x[f[2]] * (6 - i - j)) * (1.0 / 6.0);
        least = std::min(least, distance_to(t.options().shape, back * (p - t.pose().position)).distance);
      }
    }
  }
  return least;
}

Vec3d angular_momentum(const Simulation& s, const Vec3d& about) {
  Vec3d L;
  const std::vector<Vec3d> x = s.positions();
  for (std::size_t i = 0; i < x.size(); ++i) L += cross(x[i] - about, s.velocity()[i] * s.masses()[i]);
  return L;
}

// A tool that is led into two bodies at once had the first one's triangles in the second one's hands: it is refused by name,
// and the first goes on as if nobody had asked.
TEST(Contact, BelongsToOneSimulation) {
  const auto pressed = [](const std::shared_ptr<ContactTool>& t) {
    Simulation s(slab(), {{0, tissue()}});
    s.attach(t);
    return s;
  };
  const auto ball = [] { return tool(Ball{0.005}, 0.3, down({0.0, 0.0, 0.005}, 0.1)); };
  const std::shared_ptr<ContactTool> first = ball(), second = ball();
  Simulation a = pressed(first), alone = pressed(second), b(slab(4), {{0, tissue()}});
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(a.step().made() && alone.step().made());
  for (Simulation* s : {&a, &b}) {
    EXPECT_THAT([&] { s->attach(first); }, ::testing::ThrowsMessage<std::invalid_argument>(
                                               ::testing::HasSubstr("instrument \"" + first->name() + "\"")));
  }
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(a.step().made() && b.step().made() && alone.step().made());
  EXPECT_EQ(a.state_hash(), alone.state_hash());
}

// A free body that is struck: momentum changes by the tool's force alone, step by step, and angular momentum by its torque.
// Rounding of float forces, which add up to none: 1e-6 of the largest.
TEST(Contact, ForceAndTorqueAreChangesOfMomentum) {
  Tissue turning = tissue();
  turning.kinematics = Kinematics::corotational;  // small-strain forces have a moment when tissue turns
  Simulation s(slab(4), {{0, turning}});
  const auto t = tool(Block{.size = {0.01, 0.015, 0.02}}, 0.4, [](double time) {
    return Pose{{0.006 + 0.1 * time, 0.003, 1e-4 - 0.5 * time}, test::rotation({0.6, 0.0, 0.8}, 2.0 * time)};
  });
  s.attach(t);
  Vec3d p = test::momentum(s), L = angular_momentum(s, {});
  double largest = 0.0, torque = 0.0;
  for (int k = 0; k < 60; ++k) {
    // angular momentum is that of x(t) and v(t − h/2); a kick changes it by x(t) × J, a drift by none of it
    const double h = s.step_size();
    const Vec3d origin = t->pose().position;
    ASSERT_EQ(s.step().status, StepStatus::ok);
    const Vec3d p_after = test::momentum(s), L_after = angular_momentum(s, {});
    const Vec3d force = t->forces().total(), about_zero = t->forces().torque + cross(origin, force);
    EXPECT_NEAR(norm((p_after - p) * (1.0 / h) - force), 0.0, 1e-5 * (norm(force) + 0.1));
    EXPECT_NEAR(norm((L_after - L) * (1.0 / h) - about_zero), 0.0, 1e-5 * (norm(about_zero) + 1e-3));
    p = p_after, L = L_after;
    largest = std::max(largest, norm(force)), torque = std::max(torque, norm(about_zero));
  }
  EXPECT_GT(largest, 0.05);
  EXPECT_GT(torque, 1e-4);
}

// A driver hears what the tissue exerted: the opposite of what the tool did, one step later.
TEST(Contact, DriverFeelsTheOpposite) {
  Simulation s(slab(4), {{0, tissue()}});
  const auto path = std::make_shared<test::GivenPath>(down({}, 0.05));
  const auto t = std::make_shared<ContactTool>(ContactOptions{}, path);
  s.attach(t);
  test::advance_to(s, 0.02);
  const Vec3d force = t->forces().total(), torque = t->forces().torque;
  ASSERT_EQ(s.step().status, StepStatus::ok);
  EXPECT_EQ(path->felt.back().force, -force);
  EXPECT_EQ(path->felt.back().torque, -torque);
  EXPECT_LT(force.z, 0.0);
}

struct Fast {
  const char* name;
  Shape shape;
  double speed;
};

class FastMotion : public testing::TestWithParam<Fast> {};

// Nothing tunnels: a tool that goes 9 mm in a step, 4 and 9 times its own thickness, between the vertices of a fixed slab, leaves
// no surface behind it. After it has stopped 1.3 mm deep, no point of any triangle is inside by more than what a triangle
// may be between its corners, a tenth of the tool's thickness, and some.
TEST_P(FastMotion, LeavesNothingBehind) {
  const Fast& f = GetParam();
  SimulationOptions o;
  o.damping_rate = 50.0;
  Tissue rubber = tissue();
  rubber.hyperelastic = NeoHookean{.mu = 2000.0, .bulk_modulus = 10000.0};
  Simulation s(slab(8), {{0, rubber}}, o);
  s.fix(s.mesh().vertex_sets.at("z_min"));
  const auto t = tool(f.shape, 0.2, [&](double time) {
    return Pose{{0.0013, 0.0017, std::max(-1.3e-3, 8e-3 - f.speed * time)}};
  });
  s.attach(t);
  const double thickness = f.shape.index() == 1 ? 2e-3 : 1e-3;
  EXPECT_GT(f.speed * s.step_size(), 9.3e-3);  // all of the way in the first step
  for (int k = 0; k < 400; ++k) ASSERT_NE(s.step().status, StepStatus::not_finite);
  EXPECT_NEAR(t->pose().position.z, -1.3e-3, 1e-12);
  EXPECT_GT(least_gap(s, *t), -0.12 * thickness);
  EXPECT_LT(t->forces().total().z, -0.01);
}

INSTANTIATE_TEST_SUITE_P(Tools, FastMotion,
                         testing::Values(Fast{"ball", Ball{.radius = 1e-3}, 50.0},
                                         Fast{"flat_block", Block{.size = {4e-3, 4e-3, 1e-3}}, 30.0},
                                         Fast{"needle", NeedleShape{.diameter = 1e-3, .tip = TipForm::blunt}, 30.0}),
                         [](const auto& p) { return std::string(p.param.name); });

// A ball smaller than the triangles presses in the middle of one: no vertex is near, and it is held out all the same. Its force
// is that of the three corners being pushed together.
TEST(Contact, PressesBetweenVertices) {
  SimulationOptions o;
  o.damping_rate = 100.0;
  Simulation s(slab(4), {{0, tissue()}}, o);
  s.fix(s.mesh().vertex_sets.at("z_min"));
  const auto t = tool(Ball{.radius = 5e-4}, 0.0, [](double time) {
    return Pose{{0.0031, 0.0062, std::max(-1e-3, 1e-4 - 0.01 * time)}};
  });
  s.attach(t);
  test::advance_to(s, 0.3);
  EXPECT_EQ(t->effort().vertices, 0u);
  EXPECT_GE(t->effort().triangles, 1u);
  EXPECT_GT(least_gap(s, *t), -1.05e-4);  // a tenth of its thickness
  EXPECT_LT(t->forces().normal.z, -1e-3);
  EXPECT_EQ(t->contact_pressure().vertices.size(), 3u);
}

// A ball that wraps itself in the triangles around a vertex is solved for to the end: at rest its force stands still, from one
// half second to the next to 0.1 %, nothing is solved twice, and friction makes it larger.
TEST(Contact, RestsAmongTriangles) {
  double before = 0.0;
  for (const double friction : {0.0, 0.3}) {
    SimulationOptions o;
    o.damping_rate = 50.0;
    Simulation s(slab(8), {{0, tissue()}}, o);
    s.fix(s.mesh().vertex_sets.at("z_min"));
    const auto t = tool(Ball{.radius = 3e-3}, friction, [](double time) {
      return Pose{{0.0, 0.0, -std::min(2e-3, 0.01 * time)}};
    });
    s.attach(t);
    test::advance_to(s, 0.5);
    const double force = -t->forces().total().z;
    EXPECT_GE(t->effort().triangles, 3u);
    test::advance_to(s, 1.0);
    EXPECT_NEAR(-t->forces().total().z, force, 1e-3 * force);
    EXPECT_FALSE(t->effort().corrected);
    EXPECT_GT(force, 1.01 * before);
    before = force;
  }
}

// Found inside a tool, tissue comes out at a limited speed, and ends up outside.
TEST(Contact, ComesOutSlowlyWhenFoundInside) {
  Simulation s(slab(4), {{0, tissue()}});
  s.fix(s.mesh().vertex_sets.at("z_min"));
  ContactOptions o;
  o.shape = Plate{}, o.push_out_speed = 0.02;
  const auto t = std::make_shared<ContactTool>(o, test::standing({{0.0, 0.0, -2e-3}}));
  s.attach(t);
  double fastest = 0.0;
  while (s.time() < 0.3) {
    ASSERT_EQ(s.step().status, StepStatus::ok);
    for (const std::uint32_t v : s.mesh().vertex_sets.at("z_max")) fastest = std::max(fastest, -s.velocity()[v].z);
  }
  EXPECT_NEAR(fastest, 0.02, 1e-9);
  EXPECT_GT(least_gap(s, *t), -1e-6);
}

// Held vertices stay held: a support bears what the tool pushes them with, and friction with it.
TEST(Contact, SupportsBearWhatTheToolPushes) {
  Simulation s(slab(4), {{0, tissue()}});
  const ConstraintId all = s.fix(test::all_vertices(s.mesh()), {true, true, false});
  const ConstraintId floor = s.fix(s.mesh().vertex_sets.at("z_min"), {false, false, true});
  const auto t = tool(Plate{}, 0.5, [](double time) { return Pose{{0.01 * time, 0.0, -0.01 * time}}; });
  s.attach(t);
  for (int k = 0; k < 200; ++k) ASSERT_EQ(s.step().status, StepStatus::ok);
  const ToolForces f = t->forces();
  EXPECT_LT(f.normal.z, -0.1);
  EXPECT_NEAR(f.friction.x, -0.5 * f.normal.z, 1e-6 * -f.normal.z);
  EXPECT_NEAR(s.force(all).total().x, -f.friction.x, 1e-6 * f.friction.x);
  EXPECT_GT(s.force(floor).total().z, 0.0);
}

// Free and bonded are the ends of μ: a plate that is dragged sideways takes nothing along at μ = 0, some where it slips, and
// all the surface where μ is infinite or it is bonded; the rim, which shaking lifts off now and then, makes 1 %.
TEST(Contact, FrictionGoesFromFreeToBonded) {
  const auto dragged = [](double friction, bool bonded) {
    SimulationOptions o;
    o.damping_rate = 50.0;
    Simulation s(slab(4), {{0, tissue()}}, o);
    s.fix(s.mesh().vertex_sets.at("z_min"));
    ContactOptions c;
    c.shape = Plate{}, c.friction = friction, c.bonded = bonded;
    const auto t = std::make_shared<ContactTool>(
        c, std::make_shared<test::GivenPath>([](double time) {
          return Pose{{0.02 * std::max(0.0, time - 0.1), 0.0, -0.01 * std::min(time, 0.1)}};
        }));
    s.attach(t);
    test::advance_to(s, 0.25);
    double moved = 0.0;
    const auto& top = s.mesh().vertex_sets.at("z_max");
    for (const std::uint32_t v : top) moved += s.displacement()[v].x / static_cast<double>(top.size());
    const ToolForces f = t->forces();
    EXPECT_LE(norm(f.friction), (std::isinf(friction) || bonded ? 1e9 : friction + 1e-9) * norm(f.normal));
    return moved;
  };
  const double way = 0.02 * 0.15, free = dragged(0.0, false), some = dragged(0.15, false),
               rough = dragged(kInfinite, false), bonded = dragged(0.0, true);
  EXPECT_NEAR(free, 0.0, 0.02 * way);
  EXPECT_GT(some, 0.1 * way);
  EXPECT_LT(some, 0.9 * way);
  EXPECT_NEAR(rough, way, 0.02 * way);
  EXPECT_NEAR(bonded, rough, 0.02 * way);
}

// A bonded tool pulls; one that is not lets go, and says so.
TEST(Contact, BondedPullsAndFreeLetsGo) {
  for (const bool bonded : {false, true}) {
    SimulationOptions o;
    o.damping_rate = 50.0;
    Simulation s(slab(4), {{0, tissue()}}, o);
    s.fix(s.mesh().vertex_sets.at("z_min"));
    ContactOptions c;
    c.shape = FlatPunch{.radius = 8e-3}, c.bonded = bonded;
    const auto t = std::make_shared<ContactTool>(
        c, std::make_shared<test::GivenPath>([](double time) {
          return Pose{{0.0, 0.0, time < 0.1 ? 1e-4 - 0.01 * time : -9e-4 + 0.02 * (time - 0.1)}};
        }));
    s.attach(t);
    test::advance_to(s, 0.25);
    EXPECT_EQ(t->forces().total().z > 0.01, bonded);
    ASSERT_FALSE(t->events().empty());
    EXPECT_EQ(t->events()[0].event, "contact");
    EXPECT_NEAR(t->events()[0].depth, 1e-4, 2e-5);
    if (bonded) continue;
    ASSERT_EQ(t->events().size(), 2u);
    EXPECT_EQ(t->events()[1].event, "release");
    EXPECT_FALSE(t->touches());
    EXPECT_EQ(norm(t->forces().total()), 0.0);
  }
}

// A bonded tool that begins at a gap of exactly zero has touched: lifted off at once, it takes the tissue along. One a hair above
// the surface has not.
TEST(Contact, BondedGripsWhatItTouchesAtTheStart) {
  for (const auto& [shape, gap] :
       {std::pair<Shape, double>{Plate{}, 0.0}, {FlatPunch{.radius = 8e-3}, 0.0}, {Plate{}, 1e-6}}) {
    SimulationOptions o;
    o.damping_rate = 50.0;
    Simulation s(slab(4), {{0, tissue()}}, o);
    s.fix(s.mesh().vertex_sets.at("z_min"));
    ContactOptions c;
    c.shape = shape, c.bonded = true;
    const auto t = std::make_shared<ContactTool>(c, std::make_shared<test::GivenPath>([gap = gap](double time) {
                                                   return Pose{{0.0, 0.0, gap + 0.01 * time}};
                                                 }));
    s.attach(t);
    test::advance_to(s, 0.1);
    EXPECT_EQ(t->forces().total().z > 0.05, gap == 0.0);
    EXPECT_EQ(t->touches(), gap == 0.0);
    const std::uint32_t top = s.mesh().vertex_sets.at("z_max")[12];  // the middle one
    EXPECT_NEAR(s.displacement()[top].z, gap == 0.0 ? 0.01 * s.time() : 0.0, 1e-9);
  }
}

// The same bytes on one thread and two, with contact, friction, and vertices that come to hand as the tool goes.
TEST(Contact, SameBytesOnTwoThreads) {
  const auto run = [](int threads) {
    SimulationOptions o;
    o.threads = threads;
    Simulation s(slab(16), {{0, tissue()}}, o);
    s.fix(s.mesh().vertex_sets.at("z_min"));
    s.attach(tool(Ball{.radius = 4e-3}, 0.3, [](double t) { return Pose{{-0.01 + 0.3 * t, 0.0, 1e-3 - 0.1 * t}}; }));
    test::advance_to(s, 0.05);
    return s.state_hash();
  };
  EXPECT_EQ(run(1), run(2));
}

// Vertices far from the tool are not brought to hand: a ball on a large surface knows a small part of it. Seen by what it
// costs nothing to ask: a patch is named once.
TEST(Contact, NamesOnlyWhatIsNear) {
  Simulation s(slab(32), {{0, tissue()}});
  const auto t = tool(Ball{.radius = 2e-3}, 0.0, down({0.0, 0.0, 1e-3}, 0.05));
  s.attach(t);
  std::size_t named = 0;
  struct Counter final : Interaction {
    std::size_t* most;
    explicit Counter(std::size_t* m) : most(m) {}
    void attached(const BodyView&, double) override {}
    void body_changed(const BodyView&, std::span<const std::uint32_t>) override {}
    std::span<const std::uint32_t> reach(double, double) override { return {}; }
    void moved(const InteractionStep& step) override { *most = std::max(*most, step.vertices.size()); }
  };
  s.attach(std::make_shared<Counter>(&named));
  test::advance_to(s, 0.04);
  EXPECT_TRUE(t->touches());
  EXPECT_GT(named, 100u);
  EXPECT_LT(named, 1500u);  // of 4226 on the surface
}

// What a ball has left behind it is let go: dragged along the surface it has no more active vertices at the end than at the
// start, and lifted off just the sentinels of the patches.
TEST(Contact, LetsGoWhatItHasLeft) {
  struct Counter final : Interaction {
    std::size_t active = 0;
    void attached(const BodyView&, double) override {}
    void body_changed(const BodyView&, std::span<const std::uint32_t>) override {}
    std::span<const std::uint32_t> reach(double, double) override { return {}; }
    void moved(const InteractionStep& step) override { active = step.vertices.size(); }
  };
  Simulation s(slab(32), {{0, tissue()}});
  s.attach(tool(Ball{.radius = 2e-3}, 0.2, [](double t) {
    const double along = std::clamp(t - 0.02, 0.0, 0.06), up = std::max(0.0, t - 0.08);
    return Pose{{-0.015 + 0.5 * along, 0.0, 1e-3 - 0.05 * std::min(t, 0.02) + up}};
  }));
  const auto counter = std::make_shared<Counter>();
  s.attach(counter);
  test::advance_to(s, 0.02);
  const std::size_t first = counter->active;
  test::advance_to(s, 0.08);
  EXPECT_GT(first, 200u);
  EXPECT_LT(counter->active, first + first / 4);
  test::advance_to(s, 0.12);
  Simulation far_away(slab(32), {{0, tissue()}});
  far_away.attach(tool(Ball{.radius = 2e-3}, 0.2, down({0.0, 0.0, 0.1}, 0.0)));
  const auto sentinels = std::make_shared<Counter>();
  far_away.attach(sentinels);
  ASSERT_TRUE(far_away.step().made());
  EXPECT_EQ(counter->active, sentinels->active);
}

// A run goes on from a checkpoint with the same bytes, forces and events' state included.
TEST(Contact, CheckpointGoesOn) {
  for (const bool bonded : {false, true}) {
    const auto made = [&](Simulation& s) {
      ContactOptions c;
      c.shape = Ball{.radius = 6e-3}, c.friction = 0.3, c.bonded = bonded;
      const auto t =
          std::make_shared<ContactTool>(c, std::make_shared<test::GivenPath>(down({0.001, 0.002, -1e-4}, 0.05)));
      s.attach(t);
      return t;
    };
    Simulation a(slab(8), {{0, tissue()}}), b(slab(8), {{0, tissue()}});
    const auto ta = made(a), tb = made(b);
    test::advance_to(a, 0.02);
    std::stringstream file;
    a.save(file);
    test::advance_to(a, 0.04);
    b.load(file);
    test::advance_to(b, 0.04);
    EXPECT_EQ(a.state_hash(), b.state_hash());
    EXPECT_EQ(ta->forces().total(), tb->forces().total());
  }
}

// When tets under the tool are taken out, the new surface is the one it presses on; split apart, both sides are.
TEST(Contact, FollowsTheSurfaceOfAChangedBody) {
  SimulationOptions o;
  o.damping_rate = 50.0;
  TetMesh mesh = slab(8);
  Simulation s(mesh, {{0, tissue()}}, o);
  s.fix(mesh.vertex_sets.at("z_min"));
  const auto t = tool(FlatPunch{.radius = 4e-3}, 0.2, [](double time) {
    return Pose{{0.0, 0.0, std::max(-7e-3, 2e-4 - 0.05 * time)}};
  });
  s.attach(t);
  test::advance_to(s, 0.03);
  EXPECT_TRUE(t->touches());
  std::vector<std::uint32_t> gone;  // a hole, 5 mm deep, wider than the punch
  for (std::uint32_t e = 0; e < mesh.tets.size(); ++e) {
    Vec3d centre;
    for (const std::uint32_t v : mesh.tets[e]) centre += mesh.vertices[v] * 0.25;
    if (std::abs(centre.x) < 0.01 && std::abs(centre.y) < 0.01 && centre.z > -0.005) gone.push_back(e);
  }
  s.remove_tets(gone);
  for (int k = 0; k < 3; ++k) ASSERT_EQ(s.step().status, StepStatus::ok);
  EXPECT_FALSE(t->touches());
  test::advance_to(s, 0.3);
  EXPECT_TRUE(t->touches());  // the bottom of the hole
  EXPECT_LT(t->forces().normal.z, -1e-3);

  std::vector<Triangle> cut;  // the middle plane, below the hole
  for (std::uint32_t e = 0; e < mesh.tets.size(); ++e) {
    for (std::size_t k = 0; k < 4; ++k) {
      Triangle f{mesh.tets[e][(k + 1) % 4], mesh.tets[e][(k + 2) % 4], mesh.tets[e][(k + 3) % 4]};
      const auto on = [&](std::uint32_t v) {
        const Vec3d x = mesh.vertices[v];
        return std::abs(x.x) < 1e-9 && std::abs(x.y) < 0.0101 && x.z < -0.0049 && x.z > -0.0151;
      };
      std::sort(f.begin(), f.end());
      if (on(f[0]) && on(f[1]) && on(f[2])) cut.push_back(f);
    }
  }
  EXPECT_GT(s.split_faces(cut).origins.size(), 5u);
  test::advance_to(s, 0.4);
  EXPECT_GT(least_gap(s, *t), -2e-4);
  EXPECT_LT(t->forces().normal.z, -1e-3);
}

// A tool whose driver gives no pose any more stays where it was; the free slab that it has pushed goes on.
TEST(Contact, KeepsAToolWithoutAPose) {
  Simulation s(slab(4), {{0, tissue()}});
  const auto t = tool(Plate{}, 0.3, [](double time) {
    return Pose{{0.0, 0.0, time < 0.02 ? -0.01 * time : std::nan("")}};
  });
  s.attach(t);
  test::advance_to(s, 0.05);
  EXPECT_NEAR(t->pose().position.z, -2e-4, 2e-5);
  EXPECT_GT(t->rejected(), 0U);
  EXPECT_TRUE(std::isfinite(norm(s.displacement()[0])));
}

TEST(Contact, RefusesBadOptions) {
  const auto refused = [](auto change) {
    ContactOptions o;
    change(o);
    EXPECT_THROW(ContactTool(o, test::standing({})), std::invalid_argument);
  };
  refused([](ContactOptions& o) { o.friction = -1.0; });
  refused([](ContactOptions& o) { o.friction = std::nan(""); });
  refused([](ContactOptions& o) { o.push_out_speed = 0.0; });
  refused([](ContactOptions& o) { o.shape = Ball{.radius = 0.0}; });
  refused([](ContactOptions& o) { o.direction = {}; });
  refused([](ContactOptions& o) { o.direction = {kInfinite, 0.0, 0.0}; });
  EXPECT_THROW(ContactTool({}, nullptr), std::invalid_argument);
  EXPECT_THROW(ContactTool({}, test::standing({{std::nan(""), 0.0, 0.0}})), std::invalid_argument);
  Pose turned;
  turned.axes(0, 0) = 2.0;
  EXPECT_THROW(ContactTool({}, test::standing(turned)), std::invalid_argument);
}

}  // namespace
}  // namespace glisson
