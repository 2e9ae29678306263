// Calls that no program means to make are exceptions that name them: on a simulation that was moved from, with no motion, to a time
// that is none, for another body's probes, with an enumerator that does not exist.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "glisson/glisson.h"

namespace glisson::wrong_calls {
namespace {

/// What a call throws: its text; empty where it throws nothing.
template <class Error>
std::string told(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

Simulation cube() { return {box_mesh({.cells = {2, 2, 2}}), {{0, Tissue{}}}}; }

// A simulation that was moved from says so at every call; it can be assigned to, and the one it was moved to goes on.
TEST(WrongCalls, AMovedFromSimulationSaysSo) {
  Simulation from = cube();
  Simulation to = std::move(from);
  const std::vector<std::uint32_t> some{0};
  const std::vector<Vec3d> zero(27);
  const State state = to.save_state();
  const std::vector<std::function<void()>> calls{
      [&] { from.fix(some); },
      [&] { from.fix("z_min"); },
      [&] { from.drive(some, [](double) { return Vec3d{}; }); },
      [&] { from.drive_rigidly("z_min", [](double) { return Pose{}; }); },
      [&] {
        from.add_load("z_min", {1.0, 0.0, 0.0});
      },
      [&] { from.add_surface_load("z_min", {.pressure = 1.0}); },
      [&] { from.attach(std::make_shared<Capsule>(CapsuleOptions{})); },
      [&] { from.remove_tets(some); },
      [&] { from.split_faces({}); },
      [&] { from.set_tissue(0, {}); },
      [&] { from.set_state(zero, zero); },
      [&] { static_cast<void>(from.step()); },
      [&] { static_cast<void>(from.advance_to(1.0)); },
      [&] { from.set_step_end(1.0); },
      [&] { from.set_interrupt({}); },
      [&] { static_cast<void>(from.save_state()); },
      [&] { from.load_state(state); },
      [&] { from.reset(); },
      [&] {
        std::ostringstream out;
        from.save(out);
      },
      [&] {
        std::istringstream in;
        from.load(in);
      },
      [&] { static_cast<void>(from.time()); },
      [&] { static_cast<void>(from.step_size()); },
      [&] { static_cast<void>(from.stable_step()); },
      [&] { static_cast<void>(from.next_corner(0.0)); },
      [&] { static_cast<void>(from.steps()); },
      [&] { static_cast<void>(from.mesh()); },
      [&] { static_cast<void>(from.masses()); },
      [&] { static_cast<void>(from.displacement()); },
      [&] { static_cast<void>(from.velocity()); },
      [&] { static_cast<void>(from.positions()); },
      [&] { static_cast<void>(from.force({0})); },
      [&] { static_cast<void>(from.torque({0}, {})); },
      [&] { static_cast<void>(from.force_time()); },
      [&] { static_cast<void>(from.energies()); },
      [&] { static_cast<void>(from.stored_energy()); },
      [&] { static_cast<void>(from.energy_drift()); },
      [&] { static_cast<void>(from.linear_share()); },
      [&] { static_cast<void>(from.engine_info()); },
      [&] { static_cast<void>(from.mass_scaling()); },
      [&] { static_cast<void>(from.limiting_tets()); },
      [&] { static_cast<void>(from.tet_fields()); },
      [&] { static_cast<void>(from.contact_fields()); },
      [&] { static_cast<void>(from.state_hash()); },
      [&] { static_cast<void>(from.present_mesh()); },
      [&] { static_cast<void>(from.is_removed(0)); },
      [&] { static_cast<void>(from.tissue(0)); },
      [&] { const Cutter cutter(from); },
      [&] {
        const Probes probes(from, {{"p", ProbeSet{"z_max"}}});
      },
  };
  for (std::size_t k = 0; k < calls.size(); ++k) {
    EXPECT_NE(told<std::logic_error>(calls[k]).find("simulation: it was moved from"), std::string::npos)
        << "call " << k;
  }
  EXPECT_TRUE(to.step().made());
  from = cube();
  EXPECT_TRUE(from.step().made());
}

// Probes read the simulation that they were made for, wherever it is moved to, and no other, even of the same mesh.
TEST(WrongCalls, ProbesReadTheirOwnSimulation) {
  Simulation one = cube(), same = cube(), smaller{box_mesh({.cells = {1, 1, 1}}), {{0, Tissue{}}}};
  Probes probes(one, {{"tip", ProbePoint{{0.02, 0.02, 0.05}}}});
  const std::vector<double> before = probes.read(one);
  for (const Simulation* other : {&same, &smaller}) {
    EXPECT_EQ(told<std::invalid_argument>([&] { probes.read(*other); }),
              "probes: \"tip\" was made for another simulation; make Probes for this one");
  }
  const Simulation moved = std::move(one);
  EXPECT_EQ(probes.read(moved), before);
  EXPECT_TRUE(Probes().read(same).empty());
}

// A motion that is none is refused with the way out, and nothing is held by it; a load without a course is constant.
TEST(WrongCalls, AnEmptyMotionIsRefused) {
  Simulation s = cube();
  const std::vector<std::uint32_t> some{26};
  for (const auto& [name, call] : std::vector<std::pair<std::string, std::function<void()>>>{
           {"drive: ", [&] { s.drive(some, Motion{}); }},
           {"drive: ", [&] { s.drive("z_max", nullptr); }},
           {"drive_rigidly: ", [&] { s.drive_rigidly(some, PoseMotion{}); }},
           {"drive_rigidly: ", [&] { s.drive_rigidly("z_max", nullptr); }},
           {"attach: ", [&] { s.attach(nullptr); }},
           {"path of a tool: ", [] { const PathDriver driver({}, {}); }},
           {"rigid motion of a tool: ", [] { const RigidDriver driver({}, {}); }},
           {"push: ", [] { const PushDriver driver({}, {}); }},
           {"instrument x: ", [] { const ContactTool tool({.name = "x"}, nullptr); }}}) {
    EXPECT_TRUE(told<std::invalid_argument>(call).starts_with(name)) << name << told<std::invalid_argument>(call);
  }
  s.fix("z_max");
  s.add_load(std::vector{0U}, {0.0, 0.0, 1e-3}, {});
  EXPECT_TRUE(s.step().made());
}

// A time that is not finite is refused before a step is made.
TEST(WrongCalls, ATimeThatIsNoneIsRefused) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double time : {std::nan(""), kInf, -kInf}) {
    Simulation s = cube();
    EXPECT_TRUE(
        told<std::invalid_argument>([&] { static_cast<void>(s.advance_to(time)); }).starts_with("advance_to: time"));
    EXPECT_EQ(s.steps(), 0U);
  }
}

/// An enumerator that does not exist.
template <class E>
E none_of() {
  return static_cast<E>(77);
}

// An enumerator that does not exist is refused by the name of its option, with the words that there are.
TEST(WrongCalls, AnEnumeratorThatDoesNotExistIsRefused) {
  const auto simulation = [](auto set) {
    return [set] {
      SimulationOptions o;
      set(o);
      const Simulation s(box_mesh({.cells = {1, 1, 1}}), {{0, Tissue{}}}, o);
    };
  };
  const auto tissue = [](auto set) {
    return [set] {
      Tissue t;
      t.maxwell = {{.share = 0.3, .time = 1.0}};
      t.viscosity = 1.0;
      set(t);
      const Simulation s(box_mesh({.cells = {1, 1, 1}}), {{0, t}});
    };
  };
  const auto driver = std::make_shared<HandDriver>(Pose{});
  const std::vector<std::pair<std::string, std::function<void()>>> calls{
      {"integrator", simulation([](auto& o) { o.integrator = none_of<Integrator>(); })},
      {"implicit.scheme", simulation([](auto& o) { o.implicit.scheme = none_of<TimeScheme>(); })},
      {"implicit.preconditioner", simulation([](auto& o) { o.implicit.preconditioner = none_of<Preconditioner>(); })},
      {"mass_scaling", simulation([](auto& o) { o.mass_scaling = none_of<MassScalingKind>(); })},
      {"branches", simulation([](auto& o) { o.branches = none_of<StaticBranches>(); })},
      {"precision", simulation([](auto& o) { o.precision = none_of<Precision>(); })},
      {"measure", tissue([](auto& t) { t.measure = none_of<DeformationMeasure>(); })},
      {"viscous_tensor", tissue([](auto& t) { t.viscous_tensor = none_of<ViscousTensor>(); })},
      {"kinematics", tissue([](auto& t) { t.kinematics = none_of<Kinematics>(); })},
      {"law_form", tissue([](auto& t) { t.law_form = none_of<LawForm>(); })},
      {"maxwell_part", tissue([](auto& t) { t.maxwell_part = none_of<MaxwellPart>(); })},
      {"volume_change", tissue([](auto& t) { t.volume_change = none_of<VolumeChange>(); })},
      {"split", [] { static_cast<void>(box_mesh({.split = none_of<BoxSplit>()})); }},
      {"tip", [&] { const ContactTool tool({.shape = NeedleShape{.tip = none_of<TipForm>()}}, driver); }},
      {"test",
       [] {
         const std::vector<double> times{0.0, 1.0}, stretch{1.0, 1.1};
         static_cast<void>(material_test({}, none_of<MaterialTest>(), MaterialControl::deformation, times, stretch));
       }},
      {"control",
       [] {
         const std::vector<double> times{0.0, 1.0}, stretch{1.0, 1.1};
         static_cast<void>(material_test({}, MaterialTest::uniaxial, none_of<MaterialControl>(), times, stretch));
       }},
      {"mode", [] { static_cast<void>(oscillation({}, std::vector{1.0}, 1.0, none_of<OscillationMode>())); }},
  };
  for (const auto& [name, call] : calls) {
    const std::string text = told<std::invalid_argument>(call);
    EXPECT_NE(text.find(name + " = 77 is none of its values: "), std::string::npos) << name << ": " << text;
  }
}

}  // namespace
}  // namespace glisson::wrong_calls
