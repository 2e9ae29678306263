// Instruments, containers and capsules in viscous tissue under `semi_implicit`: the explicit scheme's curves and loads, balances,
// checkpoints.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <sstream>

#include "glisson/instruments/capsule.h"
#include "instruments/contact_scenes.h"
#include "instruments/container_kinds.h"
#include "instruments/needle_scenes.h"

namespace glisson::semi_implicit_instruments_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kPeriod = 0.002;  ///< between samples [s]

/// Values at regular times, by straight lines between steps.
template <class Step, class Value>
std::vector<double> sampled(double end, const Step& step, const Value& value) {
  std::vector<double> samples;
  double time = 0.0, last = 0.0;
  while (static_cast<double>(samples.size() + 1) * kPeriod < end) {
    const double now = step(), here = value();
    while (static_cast<double>(samples.size() + 1) * kPeriod <= now) {
      const double at = static_cast<double>(samples.size() + 1) * kPeriod;
      samples.push_back(last + (here - last) * (at - time) / (now - time));
    }
    time = now, last = here;
  }
  return samples;
}
double peak_of(const std::vector<double>& samples) {
  double peak = 0.0;
  for (const double x : samples) peak = std::max(peak, std::abs(x));
  return peak;
}
/// Largest difference, and its mean square's root.
struct Apart {
  double most = 0.0, rms = 0.0;
};
/// @param loud  events after which there are 20 ms that do not count
Apart apart(const std::vector<double>& a, const std::vector<double>& b, std::span<const InstrumentEvent> loud = {}) {
  Apart of;
  std::size_t count = 0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    const double t = static_cast<double>(k + 1) * kPeriod, difference = std::abs(a[k] - b[k]);
    const auto is_loud = [t](const InstrumentEvent& e) { return t > e.time - 1e-3 && t < e.time + 0.02; };
    if (std::any_of(loud.begin(), loud.end(), is_loud)) continue;
    of.most = std::max(of.most, difference), of.rms += difference * difference, ++count;
  }
  of.rms = std::sqrt(of.rms / static_cast<double>(count));
  return of;
}
double made(Simulation& body) {
  const StepResult r = body.step();
  if (!r.made()) throw std::runtime_error(std::string(r.message));
  return body.force_time();
}

SimulationOptions options(Integrator integrator) {
  SimulationOptions o;
  o.integrator = integrator;
  o.damping_rate = 50.0;
  if (integrator == Integrator::implicit) o.step = 5e-4;
  return o;
}

test::Insertion insertion(Integrator integrator) {
  test::Insertion o;
  o.options = options(integrator);
  o.viscosity = 100.0;
  o.mesh.radial_cells = 5, o.mesh.axial_cells = 6;
  o.strokes = {{.to = {0, 0, -0.012}, .velocity = 0.05, .ramp = 0.02, .rest = 0.05},
               {.to = {0, 0, 0}, .velocity = 0.05, .ramp = 0.02, .rest = 0.0}};
  return o;
}

// In by 12 mm, at rest, and out, η = 100 Pa·s: the explicit scheme's force within 1.5 % of the peak outside 20 ms after events, these
// within 1 ms, its work within 1 %, in a tenth of its steps; and the ledger closes.
TEST(SemiImplicitNeedle, FollowsTheExplicitScheme) {  // long
  int steps_of_reference = 0, steps = 0;
  const auto run = [](test::Inserted& r, int& count) {
    const auto step = [&] {
      ++count;
      return made(r.simulation);
    };
    return sampled(r.end, step, [&] { return test::pushed(*r.needle); });
  };
  test::Inserted reference = test::insert(insertion(Integrator::central_difference));
  test::Inserted own = test::insert(insertion(Integrator::semi_implicit));
  const std::vector<double> exact = run(reference, steps_of_reference), found = run(own, steps);
  const double peak = peak_of(exact);
  const Apart force = apart(exact, found, reference.needle->events());
  EXPECT_GT(peak, 0.25);
  EXPECT_LT(force.most, 0.015 * peak);
  for (const std::string event : {"contact", "puncture", "drop", "withdrawal"}) {
    const InstrumentEvent *there = test::event(*reference.needle, event), *here = test::event(*own.needle, event);
    ASSERT_TRUE(there != nullptr && here != nullptr) << event;
    EXPECT_NEAR(here->time, there->time, 1e-3) << event;
  }
  EXPECT_LT(10 * steps, steps_of_reference);
  const Energies e = own.simulation.energies(), f = reference.simulation.energies();
  EXPECT_NEAR(e.imbalance(), 0.0, 1e-9 * f.work_tools);
  EXPECT_NEAR(e.work_tools, f.work_tools, 0.01 * f.work_tools);
  EXPECT_NEAR(e.friction, f.friction, 0.02 * f.work_tools);
  EXPECT_NEAR(e.fracture, f.fracture, 0.02 * f.work_tools);
  EXPECT_NEAR(e.viscous, f.viscous, 0.02 * f.work_tools);
  RecordProperty("percent_of_peak", std::to_string(100.0 * force.most / peak));
}

/// A cylinder of viscous tissue, 4 cm wide and 3 cm high, in a container, with a punch of 8 mm pressed 3 mm into it within 0.1 s.
struct Pressed {
  Simulation body;
  std::shared_ptr<Container> container;
  std::shared_ptr<ContactTool> punch;

  Pressed(Integrator integrator, ContainerOptions o, double viscosity = 100.0)
      : body(cylinder_mesh({.radius = 0.02, .height = 0.03, .radial_cells = 4, .axial_cells = 5, .grading = 2.0}),
             {{0, tissue(viscosity)}}, options(integrator)) {
    o.vessel = CylinderVessel{.radius = 0.02};
    container = std::make_shared<Container>(o);
    ContactOptions c;
    c.shape = FlatPunch{.radius = 5e-3, .edge_radius = 1e-3};
    punch = std::make_shared<ContactTool>(c, std::make_shared<test::GivenPath>([](double t) {
                                            const double s = std::clamp(t / 0.1, 0.0, 1.0);
                                            return Pose{{0.0, 0.0, 0.03 - 0.003 * s * s * (3.0 - 2.0 * s)}};
                                          }));
    body.attach(container);
    body.attach(punch);
  }
  static Tissue tissue(double viscosity) {
    Tissue t;
    t.youngs_modulus = 5000.0, t.poisson_ratio = 0.4, t.viscosity = viscosity;
    return t;
  }
  double force() const { return -punch->forces().total().z; }
  const ContainerLoads& loads() const { return container->sensor_loads(); }
};

class SemiImplicitContainer : public testing::TestWithParam<ContainerOptions> {};

struct Curves {
  std::vector<double> force;
  ContainerLoads rest{}, largest{};
  double against = 0.0;  ///< most that bottom and side have carried against each other [N]
};
Curves curves(Pressed& p) {
  Curves c;
  const auto look = [&] {
    c.rest = p.loads();
    const double bottom = c.rest.bottom.z, side = c.rest.side.z;
    if (bottom * side < 0.0) c.against = std::max(c.against, std::min(std::abs(bottom), std::abs(side)));
    if (std::abs(c.rest.bottom.z) > std::abs(c.largest.bottom.z)) c.largest = c.rest;
    return p.force();
  };
  c.force = sampled(
      0.16, [&] { return made(p.body); }, look);
  return c;
}

// A press in motion, part of whose force is viscous: that of `implicit` in steps of 0.5 ms within 1 % of the peak rms; the explicit
// scheme's, whose force jumps where vertices come into contact, within 3 %, and its forces and loads at the end within 1 %. Bottom and side
// do not push and pull against each other. The ledger closes.
TEST_P(SemiImplicitContainer, BearsAsInTheExplicitScheme) {  // long
  Pressed reference(Integrator::central_difference, GetParam()), own(Integrator::semi_implicit, GetParam());
  const Curves exact = curves(reference), found = curves(own);
  Pressed implicitly(Integrator::implicit, GetParam());  // which finds contact in the same way
  const Curves same = curves(implicitly);
  const double peak = peak_of(exact.force), rest = exact.force.back();
  EXPECT_GT(peak, 1.15 * rest);  // of the viscous force, which is gone at rest
  EXPECT_LT(apart(same.force, found.force).rms, 0.01 * peak);
  EXPECT_LT(apart(exact.force, found.force).rms, 0.03 * peak);
  EXPECT_NEAR(peak_of(found.force), peak, 0.015 * peak);
  EXPECT_NEAR(found.force.back(), rest, 0.01 * rest);
  EXPECT_NEAR(found.rest.bottom.z, exact.rest.bottom.z, 0.01 * rest);
  EXPECT_NEAR(found.rest.side.z, exact.rest.side.z, 0.01 * rest);
  EXPECT_NEAR(found.rest.side_radial, exact.rest.side_radial, 0.02 * std::abs(exact.rest.side_radial));
  EXPECT_NEAR(found.largest.bottom.z, exact.largest.bottom.z, 0.02 * peak);
  EXPECT_NEAR(found.force.back(), -found.rest.total().z, 1e-3 * rest);
  EXPECT_LT(found.against, exact.against + 0.002 * peak);
  EXPECT_LT(same.against, exact.against + 0.002 * peak);
  const Energies e = own.body.energies();
  EXPECT_NEAR(e.imbalance(), 0.0, 1e-9 * e.work_tools);
  RecordProperty("implicit_rms_percent", std::to_string(100.0 * apart(same.force, found.force).rms / peak));
  RecordProperty("rms_percent", std::to_string(100.0 * apart(exact.force, found.force).rms / peak));
  RecordProperty("rest_percent", std::to_string(100.0 * (found.force.back() / rest - 1.0)));
}

INSTANTIATE_TEST_SUITE_P(Kinds, SemiImplicitContainer,
                         testing::Values(test::with(0.0, false, false), test::with(0.3, false, false),
                                         test::with(test::kInfinite, false, false), test::with(0.0, false, true)),
                         test::kind_of);

// A vertex where floor and wall meet sticks to one of them: they do not hold it by 0.2 N against each other, of which the tissue
// needs none.
TEST(SemiImplicitCorner, IsNotHeldByOneWallAgainstTheOther) {
  Pressed p(Integrator::semi_implicit, test::with(5.0, false, false));
  double time = 0.0;
  while (time < 0.012) {
    time = made(p.body);
    EXPECT_LT(p.loads().bottom.z, 1e-3) << time;
    EXPECT_LT(p.loads().side.z, 1e-3) << time;
    EXPECT_LT(-p.loads().total().z, 1.1 * p.force() + 1e-3) << time;
  }
}

// A capsule adds forces alone, beside a punch: the same, but that the explicit force jumps by a tenth where vertices meet the punch, and
// at rest within 1.5 %.
TEST(SemiImplicitCapsule, PullsAsInTheExplicitScheme) {  // long
  const auto curve = [](Integrator integrator) {
    Pressed p(integrator, test::with(0.0, false, true));
    CapsuleOptions c;
    c.vertices = p.body.mesh().vertex_sets.at("top");
    const auto capsule = std::make_shared<Capsule>(c);
    p.body.attach(capsule);
    std::vector<double> force = sampled(
        0.12, [&] { return made(p.body); }, [&] { return p.force(); });
    const double balanced = integrator == Integrator::implicit ? 1e-5 : 1e-9;  // to what Newton's method leaves
    EXPECT_NEAR(p.body.energies().imbalance(), 0.0, balanced * p.body.energies().work_tools);
    EXPECT_GT(capsule->energy(), 0.0);
    return force;
  };
  const std::vector<double> exact = curve(Integrator::central_difference), found = curve(Integrator::semi_implicit);
  EXPECT_LT(apart(curve(Integrator::implicit), found).rms, 0.01 * peak_of(found));
  EXPECT_LT(apart(exact, found).rms, 0.04 * peak_of(exact));
  EXPECT_NEAR(found.back(), exact.back(), 0.015 * exact.back());
}

// A run that was saved goes on with the same bytes.
TEST(SemiImplicitInstruments, GoOnFromACheckpoint) {
  test::Inserted a = test::insert(insertion(Integrator::semi_implicit)),
                 b = test::insert(insertion(Integrator::semi_implicit));
  while (a.simulation.time() < 0.15) made(a.simulation);
  EXPECT_EQ(a.needle->stage(), NeedleStage::inside);
  std::stringstream file;
  a.simulation.save(file);
  b.simulation.load(file);
  for (int k = 0; k < 100; ++k) made(a.simulation), made(b.simulation);
  EXPECT_EQ(a.simulation.state_hash(), b.simulation.state_hash());
  EXPECT_EQ(a.needle->forces().total(), b.needle->forces().total());
}

// Tissue that loses its viscosity under a punch, and gets it back: they go on acting, and the ledger closes.
TEST(SemiImplicitInstruments, ActWhenTheViscosityGoes) {
  Pressed p(Integrator::semi_implicit, test::with(0.0, false, true));
  for (int k = 0; k < 60; ++k) made(p.body);
  for (const double viscosity : {0.0, 100.0}) {
    p.body.set_tissue(0, Pressed::tissue(viscosity));
    double least = 1.0;
    for (int k = 0; k < 40; ++k) made(p.body), least = std::min(least, p.force());
    EXPECT_GT(least, 0.1) << viscosity;
  }
  EXPECT_NEAR(p.body.energies().imbalance(), 0.0, 1e-9 * p.body.energies().work_tools);
}

// What does not act in steps whose vertices move one another is refused by its name, with the way out.
TEST(SemiImplicitInstruments, RefuseWhatTheyDoNotDo) {
  Pressed p(Integrator::semi_implicit, test::with(0.0, false, true));
  ContactOptions c;
  c.shape = Ball{0.003};
  const auto ball =
      std::make_shared<ContactTool>(c, std::make_shared<test::YieldsInShortSteps>(Pose{{0.0, 0.0, 0.05}}));
  EXPECT_THAT([&] { p.body.attach(ball); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("moved by a force in short steps only")));
}

}  // namespace
}  // namespace glisson::semi_implicit_instruments_test
