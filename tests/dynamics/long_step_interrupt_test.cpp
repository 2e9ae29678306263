// A long step that is interrupted is not made: all is as before it, and made anew it ends where it would have.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "glisson/mesh.h"
#include "glisson/simulation/simulation.h"

namespace glisson::long_step_interrupt_test {
namespace {

struct Case {
  const char* name;
  Integrator integrator;
  StaticBranches branches = StaticBranches::automatic;
  Preconditioner preconditioner = Preconditioner::automatic;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

/// A block of neo-Hookean tissue pressed by a quarter of its height within one step.
Simulation pressed(const Case& c, int cells) {
  Tissue tissue;
  tissue.hyperelastic = NeoHookean{.mu = 1000.0, .bulk_modulus = 5000.0};
  if (c.branches == StaticBranches::follow) tissue.maxwell = {{.share = 0.5, .time = 0.1}};
  SimulationOptions options;
  options.integrator = c.integrator;
  options.branches = c.branches;
  options.step = 0.1;
  options.implicit.preconditioner = c.preconditioner;
  Simulation body(box_mesh({.cells = {cells, cells, cells}, .size = {0.04, 0.04, 0.04}}), {{0, tissue}}, options);
  body.fix("z_min");
  body.drive("z_max", [](double t) { return Vec3d{0.0, 0.0, -0.1 * t}; });
  return body;
}

class LongStepInterrupt : public testing::TestWithParam<Case> {};

// Interrupted at the first, the second, … question, a step changes nothing; undisturbed it is then made, and ends within Newton's
// tolerance of one that nobody interrupted (the factor may be another one).
TEST_P(LongStepInterrupt, LeavesAllAsItWas) {
  const int cells = GetParam().branches == StaticBranches::follow ? 6 : 9;
  Simulation undisturbed = pressed(GetParam(), cells), body = pressed(GetParam(), cells);
  for (int step = 0; step < 2; ++step) {
    ASSERT_TRUE(undisturbed.step().made());
    int interrupted = 0;
    for (int at = 1; at < 1000; ++at) {
      int asked = 0;
      body.set_interrupt([&](const StepProgress& p) {
        EXPECT_GE(p.time, body.time());
        EXPECT_GT(p.h, 0.0);
        EXPECT_GE(p.iteration, 0);
        return ++asked == at;
      });
      const std::uint64_t hash = body.state_hash();
      const double time = body.time(), elastic = body.energies().elastic, force = body.force({1}).total().z;
      const double h = body.step_size();
      const StepResult result = body.step();
      if (result.made()) break;
      ++interrupted;
      ASSERT_EQ(result.status, StepStatus::interrupted);
      EXPECT_NE(std::string(result.message).find("nothing has changed"), std::string::npos);
      EXPECT_EQ(body.state_hash(), hash);
      EXPECT_EQ(body.time(), time);
      EXPECT_EQ(body.step_size(), h);
      EXPECT_EQ(body.energies().elastic, elastic);
      EXPECT_EQ(body.force({1}).total().z, force);
      EXPECT_EQ(body.steps(), static_cast<std::uint64_t>(step));
    }
    EXPECT_GE(interrupted, 1) << "it was asked";
    EXPECT_EQ(body.time(), undisturbed.time());
    double apart = 0.0;
    for (std::size_t i = 0; i < body.masses().size(); ++i) {
      apart = std::max(apart, norm(body.displacement()[i] - undisturbed.displacement()[i]));
    }
    EXPECT_LT(apart, 1e-6 * 0.01) << "of the way of the plate; 1e-8 of the force is Newton's tolerance";
  }
}

INSTANTIATE_TEST_SUITE_P(All, LongStepInterrupt,  // long
                         testing::Values(Case{"implicit", Integrator::implicit},
                                         Case{"iterated", Integrator::implicit, StaticBranches::automatic,
                                              Preconditioner::block_diagonal},
                                         Case{"relaxed", Integrator::quasi_static},
                                         Case{"follow", Integrator::quasi_static, StaticBranches::follow}),
                         [](const auto& c) { return c.param.name; });

// Once it has answered, nothing more is begun that would ask again, wherever the step is: at its first question, within its first iterations,
// and later. 41 000 tets.
TEST(LongStepInterrupt, EndsSoon) {  // long
  for (const Preconditioner p : {Preconditioner::factorised, Preconditioner::block_diagonal}) {
    for (const int at : {1, 2, 3}) {
      Simulation body = pressed({"", Integrator::quasi_static, StaticBranches::automatic, p}, 19);
      int asked = 0;
      body.set_interrupt([&](const StepProgress&) { return ++asked >= at; });
      const StepResult result = body.step();
      ASSERT_EQ(result.status, StepStatus::interrupted) << "the step asks less often than " << at << " times";
      EXPECT_EQ(asked, at);
    }
  }
}

// What the program's function throws comes out of step() once all is as before; a function that is taken away asks no more.
TEST(LongStepInterrupt, HandsExceptionsOn) {
  Simulation body = pressed({"", Integrator::implicit}, 4);
  const std::uint64_t hash = body.state_hash();
  body.set_interrupt([](const StepProgress&) -> bool { throw std::runtime_error("Ctrl-C"); });
  EXPECT_THROW(static_cast<void>(body.step()), std::runtime_error);
  EXPECT_EQ(body.state_hash(), hash);
  body.set_interrupt({});
  EXPECT_TRUE(body.step().made());
}

}  // namespace
}  // namespace glisson::long_step_interrupt_test
