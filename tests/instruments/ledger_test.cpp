// The ledger closes over the whole scene: what the hand puts in, force times the motion of the tool, is found again as stored energy
// W(u), motion, and what viscosity, friction, contact and cutting dissipate, within 1e-3 of the work of the tools.
//
// The work of the hand is summed up here from what an instrument reports, its force and its pose. The time integration is what is
// allowed for: the work of the elastic forces differs from W(u) by a drift.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <sstream>

#include "glisson/instruments/blade.h"
#include "glisson/instruments/capsule.h"
#include "glisson/instruments/contact.h"
#include "instruments/contact_scenes.h"
#include "instruments/needle_scenes.h"
#include "support/must_step.h"

namespace glisson::ledger_test {
namespace {

constexpr double kBar = 1e-3;  // of the work of the tools

/// Work of a hand by what its instrument reports: ∫ F·dX + T·dω with the trapezoidal rule, up to the time of the forces.
class Hand {
 public:
  explicit Hand(const Instrument& tool) : tool_(tool), at_(tool.pose()) {}
  void see() {
    const Pose next = tool_.pose();
    const auto along = [&](const Pose& from, const Pose& to) {
      return 0.5 * dot(tool_.force(), to.position - from.position) + 0.5 * dot(tool_.forces().torque, turn(from, to));
    };
    done_ += pending_ + along(before_.value_or(at_), at_);
    pending_ = along(at_, next);
    most_ = std::max(most_, 2.0 * std::abs(pending_));
    before_ = at_, at_ = next;
  }
  double work() const { return done_; }
  /// The most of one step: where the step changes, the scheme's v₋ and v₊ count by other lengths than the rule's.
  double most_of_a_step() const { return most_; }

 private:
  /// Small rotation from one pose to another: ½ Σ a_i × b_i over the axes [rad].
  static Vec3d turn(const Pose& from, const Pose& to) {
    Vec3d sum;
    for (std::size_t i = 0; i < 3; ++i) {
      sum += cross(Vec3d{from.axes(0, i), from.axes(1, i), from.axes(2, i)},
                   Vec3d{to.axes(0, i), to.axes(1, i), to.axes(2, i)});
    }
    return sum * 0.5;
  }

  const Instrument& tool_;
  Pose at_;
  std::optional<Pose> before_;
  double done_ = 0.0, pending_ = 0.0, most_ = 0.0;
};

/// The account of a run.
struct Account {
  Energies e;
  double hand = 0.0, step = 0.0;  ///< work by the hand's own sum, and the most of one step [J]
  double stored = 0.0;            ///< W(u) [J]
  Account(const Simulation& body, const Hand& by)
      : e(body.energies()), hand(by.work()), step(by.most_of_a_step()), stored(body.stored_energy().value()) {}
  /// What is left of the balance with W(u) in the place of the work of the elastic forces, as a share of the hand's work.
  double left() const { return (e.imbalance() - e.elastic + stored) / hand; }
};

template <class Until>
Account run(Simulation& body, const Instrument& tool, const Until& until) {
  Hand hand(tool);
  while (!until()) {
    test::must_step(body);
    hand.see();
  }
  return {body, hand};
}
Account run_to(Simulation& body, const Instrument& tool, double end) {
  return run(body, tool, [&] { return body.time() >= end; });
}

/// The ledger closes, the hand agrees, and each of these terms is so large that the ledger could not close without it.
void expect_closed(const Account& a, std::initializer_list<double Energies::*> terms) {
  EXPECT_GT(a.hand, 0.0);
  EXPECT_NEAR(a.e.work_tools, a.hand, 1e-9 * a.hand + a.step);
  EXPECT_LE(std::abs(a.e.imbalance()), 1e-6 * a.hand);  // elements in float
  EXPECT_LE(std::abs(a.left()), kBar);
  for (const auto term : terms) {
    EXPECT_GT(std::abs(a.left() - a.e.*term / a.hand), 2.0 * kBar) << "without term " << a.e.*term << " of " << a.hand;
  }
}

Tissue soft(double nu = 0.4) {
  Tissue t;
  t.youngs_modulus = 5000.0, t.poisson_ratio = nu;
  return t;
}

/// A block of 4 × 4 × 2 cm on a floor, with a tool over it.
struct Block {
  Simulation body;
  std::shared_ptr<ContactTool> tool;

  Block(const Tissue& tissue, const ContactOptions& options, std::function<Pose(double)> path, double damping = 20.0)
      : body(box_mesh({.cells = {10, 10, 5}, .size = {0.04, 0.04, 0.02}}), {{0, tissue}}, {.damping_rate = damping}),
        tool(std::make_shared<ContactTool>(options, std::make_shared<test::GivenPath>(std::move(path)))) {
    body.fix("z_min");
    body.attach(tool);
  }
};

double ramp(double t, double from, double to) { return std::clamp((t - from) / (to - from), 0.0, 1.0); }

TEST(Ledger, ClosesOverAPress) {
  const auto path = [](double t) {
    return Pose{{0.02, 0.02, 0.0201 - 0.004 * (ramp(t, 0.0, 0.08) - ramp(t, 0.1, 0.18))}};
  };
  Tissue tissue = soft();
  tissue.viscosity = 20.0;
  Block pressed(tissue, {.shape = FlatPunch{.radius = 8e-3}}, path);
  Hand hand(*pressed.tool);
  const auto to = [&](double end) {
    while (pressed.body.time() < end) test::must_step(pressed.body), hand.see();
    return Account(pressed.body, hand);
  };
  const Account deep = to(0.09), back = to(0.2);
  expect_closed(deep, {&Energies::elastic, &Energies::viscous, &Energies::damping});
  expect_closed(back, {&Energies::viscous, &Energies::damping});
  EXPECT_LT(back.hand, 0.8 * deep.hand);  // most of it comes back
}

// A ball that is pressed in and dragged: most of its work is friction, μ times what presses times the way.
TEST(Ledger, ClosesOverADraggedBall) {
  const double mu = 0.4, speed = 0.1;
  const auto path = [=](double t) {
    return Pose{{0.012 + speed * std::max(0.0, t - 0.05), 0.02, 0.0201 - 0.002 * ramp(t, 0.0, 0.05)}};
  };
  Block dragged(soft(), {.shape = Ball{.radius = 6e-3}, .friction = mu}, path);
  Hand hand(*dragged.tool);
  double friction = 0.0, pressed = 0.0;
  while (dragged.body.time() < 0.2) {
    test::must_step(dragged.body);
    hand.see();
    if (dragged.body.time() < 0.15) friction = dragged.body.energies().friction;
    if (dragged.body.time() >= 0.15) pressed += norm(dragged.tool->forces().normal) * dragged.body.step_size();
  }
  const Account a(dragged.body, hand);
  EXPECT_NEAR(a.e.friction - friction, mu * pressed * speed, 0.1 * mu * pressed * speed);
  expect_closed(a, {&Energies::elastic, &Energies::friction, &Energies::damping});
  EXPECT_GT(a.e.friction, 0.3 * a.hand);
}

// A tool that turns on the spot under friction: its work is that of a torque.
TEST(Ledger, ClosesOverATurningPunch) {
  const auto path = [](double t) {
    return Pose{{0.02, 0.02, 0.0201 - 0.002 * ramp(t, 0.0, 0.05)},
                test::rotation({0.0, 0.0, 1.0}, 1.5 * ramp(t, 0.05, 0.2))};
  };
  Block turned(soft(), {.shape = FlatPunch{.radius = 8e-3}, .friction = 0.3}, path);
  const Account pressed = run_to(turned.body, *turned.tool, 0.05);
  const double before = turned.body.energies().work_tools;
  EXPECT_NEAR(before, pressed.hand, 1e-9 * pressed.hand);
  Block whole(soft(), {.shape = FlatPunch{.radius = 8e-3}, .friction = 0.3}, path);
  const Account a = run_to(whole.body, *whole.tool, 0.2);
  EXPECT_NEAR(a.e.work_tools, a.hand, 1e-5 * a.hand);  // a turn is not quite its sine
  EXPECT_GT(a.hand, 1.2 * pressed.hand);
  EXPECT_LE(std::abs(a.left()), kBar);
}

// Relaxation under a tool at rest: what the branches took is in the account, and the hand does no more work.
TEST(Ledger, ClosesOverARelaxation) {
  Tissue tissue = soft();
  tissue.maxwell = {{0.5, 0.05}};
  const auto path = [](double t) { return Pose{{0.02, 0.02, 0.0201 - 0.004 * ramp(t, 0.0, 0.05)}}; };
  Block held(tissue, {.shape = FlatPunch{.radius = 8e-3}, .bonded = true}, path);
  const Account a = run_to(held.body, *held.tool, 0.25);
  expect_closed(a, {&Energies::elastic, &Energies::maxwell});
  EXPECT_EQ(a.e.viscous, 0.0);
  EXPECT_NEAR(a.e.dissipated, a.e.maxwell + a.e.damping, 1e-12 * a.hand);
}

TEST(Ledger, ClosesOverANeedle) {
  test::Insertion o;
  o.strokes = {{.to = {0, 0, -0.015}, .velocity = 0.05, .ramp = 0.0, .rest = 0.05},
               {.to = {0, 0, 0.002}, .velocity = 0.05, .ramp = 0.0, .rest = 0.0}};
  test::Inserted in = test::insert(o);
  Hand hand(*in.needle);
  const auto account = [&] { return Account(in.simulation, hand); };
  test::run_to(in, 0.3, [&] { hand.see(); });
  ASSERT_NE(test::event(*in.needle, "puncture"), nullptr);
  expect_closed(account(), {&Energies::elastic, &Energies::friction, &Energies::fracture, &Energies::damping});
  test::run_to(in, in.end, [&] { hand.see(); });
  ASSERT_NE(test::event(*in.needle, "withdrawal"), nullptr);
  expect_closed(account(), {&Energies::friction, &Energies::fracture, &Energies::damping});
  EXPECT_EQ(account().e.instruments, 0.0);
}

// A needle that bends stores ½ y F of a cantilever.
TEST(Ledger, ClosesOverABentNeedle) {
  test::Insertion o;
  o.needle.youngs_modulus = 2e9, o.needle.diameter = 0.8e-3, o.needle.length = 0.08;
  o.needle.bevel_share = 0.5;
  o.strokes = {{.to = {0, 0, -0.02}, .velocity = 0.05, .ramp = 0.0, .rest = 0.0},
               {.to = {0.004, 0, -0.02}, .velocity = 0.05, .ramp = 0.0, .rest = 0.1}};
  test::Inserted in = test::insert(o);
  Hand hand(*in.needle);
  test::run_to(in, in.end, [&] { hand.see(); });
  const Account a(in.simulation, hand);
  expect_closed(a, {&Energies::elastic, &Energies::friction, &Energies::fracture, &Energies::instruments});
  EXPECT_GT(a.e.instruments, 0.0);
}

// A cut: what the edge dissipates is the toughness times the area it cut.
TEST(Ledger, ClosesOverACut) {
  const double toughness = 5.0;
  std::mt19937 random(2);
  const TetMesh mesh = test::jittered_box({8, 8, 8}, 0.005, 0.1, random);
  SimulationOptions options;
  options.damping_rate = 30.0;
  Simulation body(mesh, {{0, soft()}}, options);
  body.fix(mesh.vertex_sets.at("z_min"));
  const auto blade = std::make_shared<Blade>(
      BladeOptions{.edge_from = {0, -0.03, 0}, .edge_to = {0, 0.03, 0}, .toughness = toughness, .cut_every = 0.0},
      std::make_shared<PathDriver>(Pose{{0.0213, 0.02, 0.0405}}, steady_path({.velocity = 0.1})));
  body.attach(blade);
  const Account a = run(body, *blade, [&] { return blade->depth() > 0.025; });
  expect_closed(a, {&Energies::fracture});
  EXPECT_GT(blade->area(), 0.02 * 0.04);
  EXPECT_NEAR(a.e.fracture, blade->work_of_cut(), 0.05 * blade->work_of_cut());
}

// A capsule's energy is in W(u), what it stored when it was attached came with it, and what a hole released is fracture.
TEST(Ledger, ClosesOverACapsuleThatIsOpened) {
  const auto path = [](double t) { return Pose{{0.02, 0.02, 0.0201 - 0.004 * ramp(t, 0.0, 0.08)}}; };
  Block covered(soft(), {.shape = FlatPunch{.radius = 8e-3}, .friction = 0.3}, path);
  const auto capsule = std::make_shared<Capsule>(CapsuleOptions{.youngs_modulus = 1e5, .prestretch = 1.05});
  covered.body.attach(capsule);
  Hand hand(*covered.tool);
  while (covered.body.time() < 0.1) {
    if (capsule->open_area() == 0.0 && covered.body.time() > 0.07) capsule->open_at({0.02, 0.02, 0.016}, 0.008);
    test::must_step(covered.body);
    hand.see();
  }
  const Account a(covered.body, hand);
  expect_closed(a, {&Energies::elastic, &Energies::fracture, &Energies::changed});
  EXPECT_EQ(a.e.fracture, capsule->released_energy());
}

// All of it is in a checkpoint.
TEST(Ledger, GoesOnFromACheckpoint) {
  const auto path = [](double t) {
    return Pose{{0.012 + 0.1 * std::max(0.0, t - 0.05), 0.02, 0.0201 - 0.002 * ramp(t, 0.0, 0.05)}};
  };
  Block whole(soft(), {.shape = Ball{.radius = 6e-3}, .friction = 0.4}, path),
      gone_on(soft(), {.shape = Ball{.radius = 6e-3}, .friction = 0.4}, path);
  test::advance_to(whole.body, 0.08);
  std::stringstream file;
  whole.body.save(file);
  gone_on.body.load(file);
  test::advance_to(whole.body, 0.1), test::advance_to(gone_on.body, 0.1);
  const Energies a = whole.body.energies(), b = gone_on.body.energies();
  EXPECT_GT(a.friction, 0.0);
  for (const auto term : {&Energies::friction, &Energies::contact, &Energies::fracture, &Energies::instruments,
                          &Energies::work_tools, &Energies::damping, &Energies::viscous, &Energies::maxwell}) {
    EXPECT_EQ(a.*term, b.*term);
  }
}

}  // namespace
}  // namespace glisson::ledger_test
