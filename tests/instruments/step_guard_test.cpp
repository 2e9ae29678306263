// What a program's own functions call from inside a step changes nothing: members that would are refused, those that read answer,
// and the run goes on to the same bytes. Interaction::between_steps may change the body.
#include "instruments/step_guard_scene.h"

namespace glisson::step_guard {
namespace {

class StepGuard : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Every, StepGuard, testing::ValuesIn(test::every_integrator()),
                         [](const auto& each) { return std::string(word_of(each.param)); });

// A member that changes something throws std::logic_error by its name wherever it is called inside a step, a reading or a change,
// and the run has the bytes of one in which nothing was called.
TEST_P(StepGuard, RefusesEachMemberFromEachCallback) {
  const std::vector<double> expected = Scene(GetParam(), std::make_shared<Asker>(), {}).run();
  for (const std::string& place : places(GetParam())) {
    std::vector<std::string> faults;
    const auto asker = std::make_shared<Asker>(Asker{.place = place});
    EXPECT_EQ(Scene(GetParam(), asker, [&](Scene& s) { call_all(s, faults); }).run(), expected) << place;
    EXPECT_GT(asker->asked, 0) << place;
    for (const std::string& fault : faults) ADD_FAILURE() << fault;
  }
}

// Readings answer from every callback and leave no trace in the run.
TEST_P(StepGuard, ReadingsFromEachCallbackChangeNothing) {
  const std::vector<double> expected = Scene(GetParam(), std::make_shared<Asker>(), {}).run();
  for (const std::string& place : places(GetParam())) {
    const auto asker = std::make_shared<Asker>(Asker{.place = place});
    EXPECT_EQ(Scene(GetParam(), asker, read_all).run(), expected) << place;
    EXPECT_GT(asker->asked, 0) << place;
  }
}

// The tests above go through every place there is: all of them but those of other instruments are called by some integrator.
TEST(StepGuardPlaces, AreAllCalled) {
  std::set<std::string> all;
  for (const Integrator integrator : test::every_integrator()) all.merge(places(integrator));
  EXPECT_EQ(all,
            (std::set<std::string>{"motion",      "pose motion",       "scale",           "push",        "driver",
                                   "attached",    "body_changed",      "reach",           "keeps",       "rests",
                                   "state_set",   "add_forces",        "declare",         "solved",      "moved",
                                   "energy",      "add_forces_at",     "add_stiffness",   "overshoots",  "archive",
                                   "next_corner", "squared_frequency", "released_energy", "tool_energy", "add_contact",
                                   "save_state",  "load_state"}));
}

/// Acts between steps, once.
struct Between final : Interaction {
  std::function<void(Simulation&)> act;
  int steps = 0;  ///< after which it acts

  Between(std::function<void(Simulation&)> a, int after) : act(std::move(a)), steps(after) {}
  void attached(const BodyView&, double) override {}
  void body_changed(const BodyView&, std::span<const std::uint32_t>) override {}
  std::span<const std::uint32_t> reach(double, double) override { return {}; }
  std::string refuses_long_steps() const override { return {}; }
  void between_steps(Simulation& s) override {
    if (steps-- == 0) act(s);
  }
};

/// A cube that is held and pressed, with something that acts between its steps; or the program does, after the same step.
std::uint64_t hash_with(Integrator integrator, const std::function<void(Simulation&)>& act, bool by_program) {
  Simulation s(box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}}), {{0, Scene::tissue()}},
               Scene::options(integrator));
  s.fix("z_min");
  s.add_load("z_max", {0.0, 0.0, -0.01});
  s.attach(std::make_shared<Between>(by_program ? [](Simulation&) {} : act, 3));  // 0 is when it is attached
  for (int k = 1; k <= kSteps; ++k) {
    test::must_step(s);
    if (by_program && k == 3) act(s);
  }
  return s.state_hash();
}

// Between steps an interaction may change the body as the program may after the step: the same bytes.
TEST_P(StepGuard, LetsBetweenStepsChangeTheBody) {
  const std::vector<std::uint32_t> free{26};
  const auto still = [](double) { return Vec3d{}; };
  const std::vector<std::pair<const char*, std::function<void(Simulation&)>>> allowed{
      {"remove_tets", [](Simulation& s) { s.remove_tets(std::vector{3U}); }},
      {"split_faces",
       [](Simulation& s) {
         const Tet& t = s.mesh().tets[0];
         for (std::size_t skip = 0; skip < 4; ++skip) {
           Triangle face{};
           for (std::size_t c = 0, k = 0; c < 4; ++c) {
             if (c != skip) face[k++] = t[c];
           }
           try {
             s.split_faces(std::vector{face});
             return;
           } catch (const std::invalid_argument&) {  // at the boundary
           }
         }
         ADD_FAILURE() << "no face was split";
       }},
      {"set_tissues",
       [](Simulation& s) {
         s.set_tissues({{0, Tissue{.youngs_modulus = 5e3, .viscosity = 1.0}}});
       }},
      {"fix", [&](Simulation& s) { s.fix(free); }},
      {"drive", [&](Simulation& s) { s.drive(free, still); }},
      {"add_load",
       [&](Simulation& s) {
         s.add_load(free, {0.0, 1e-3, 0.0});
       }},
      {"attach",
       [](Simulation& s) {
         s.attach(ball("late", std::make_shared<HandDriver>(Pose{{0.01, 0.01, 0.0201}, identity<double>()})));
       }},
  };
  std::set<std::uint64_t> hashes{hash_with(
      GetParam(), [](Simulation&) {}, true)};
  for (const auto& [name, act] : allowed) {
    const std::uint64_t hash = hash_with(GetParam(), act, true);
    EXPECT_EQ(hash_with(GetParam(), act, false), hash) << name;
    hashes.insert(hash);
  }
  // a motion that stands holds as a support; a tool that does not touch, and a split whose rim is closed, move nothing
  EXPECT_GE(hashes.size(), 5U);
}

// What goes to another state, or makes a step, is refused there, too, and changes nothing.
TEST_P(StepGuard, RefusesStepsAndStatesBetweenSteps) {
  const std::uint64_t expected = hash_with(
      GetParam(), [](Simulation&) {}, true);
  const auto saved = std::make_shared<State>();
  const std::vector<std::pair<std::string, std::function<void(Simulation&)>>> refused{
      {"step", [](Simulation& s) { static_cast<void>(s.step()); }},
      {"advance_to", [](Simulation& s) { static_cast<void>(s.advance_to(1.0)); }},
      {"set_state",
       [](Simulation& s) {
         const std::vector<Vec3d> moved(s.mesh().vertices.size(), Vec3d{0.0, 0.0, 1e-4});
         s.set_state(moved, moved);
       }},
      {"save_state", [](Simulation& s) { static_cast<void>(s.save_state()); }},
      {"load_state", [](Simulation& s) { s.load_state({}); }},
      {"reset", [](Simulation& s) { s.reset(); }},
      {"save",
       [](Simulation& s) {
         std::ostringstream out;
         s.save(out);
       }},
      {"load",
       [](Simulation& s) {
         std::istringstream in;
         s.load(in);
       }},
  };
  for (const auto& [name, act] : refused) {
    std::string told;
    const auto asks = [&, name = name, act = act](Simulation& s) {
      try {
        act(s);
      } catch (const std::logic_error& error) {
        told = error.what();
      }
    };
    EXPECT_EQ(hash_with(GetParam(), asks, false), expected) << name;
    EXPECT_TRUE(told.starts_with(name + ": it was called from Interaction::between_steps")) << name << ": " << told;
  }
}

// An interaction that attaches itself between steps is refused, not attached for ever.
TEST(StepGuardCalls, RefusesAnInteractionThatAttachesItself) {
  Simulation s(box_mesh({}), {{0, Tissue{}}});
  std::shared_ptr<Between> own;
  own = std::make_shared<Between>([&own](Simulation& body) { body.attach(own); }, 0);
  EXPECT_THROW(s.attach(own), std::invalid_argument);
  own->act = [](Simulation&) {};
  test::must_step(s);
}

// A needle calls out when it pierces the surface: from there, too, the body may only be read.
TEST(StepGuardCalls, RefusesChangesAtAPuncture) {
  test::Insertion insertion;
  insertion.mesh = {.radius = 0.02, .height = 0.02, .radial_cells = 3, .axial_cells = 3};
  insertion.needle.rupture.force = 0.01;
  insertion.start = {0.0, 0.0, 0.0201};
  insertion.strokes = {{.to = {0.0, 0.0, -0.01}, .velocity = 0.1}};
  std::uint64_t hashes[2];
  int punctures = 0, refused = 0;
  for (const bool asks : {false, true}) {
    test::Inserted run = test::insert(insertion);
    run.needle->on_puncture([&](const Vec3d&, double) {
      ++punctures;
      if (!asks) return;
      try {
        run.simulation.remove_tets(std::vector{0U, 1U, 2U});
      } catch (const std::logic_error&) {
        ++refused;
      }
    });
    test::run_to(run, 0.05);
    hashes[asks ? 1 : 0] = run.simulation.state_hash();
  }
  EXPECT_EQ(punctures, 2);
  EXPECT_EQ(refused, 1);
  EXPECT_EQ(hashes[0], hashes[1]);
}

// A motion that throws where it is asked at once holds nothing: the same vertices can be driven after it.
TEST(StepGuardCalls, AMotionThatThrowsIsNotKept) {
  Simulation s(box_mesh({}), {{0, Tissue{}}}), other(box_mesh({}), {{0, Tissue{}}});
  const auto throws = [](double) -> Vec3d { throw std::runtime_error("no motion"); };
  EXPECT_THROW(s.drive("z_max", throws), std::runtime_error);
  for (Simulation* x : {&s, &other}) {
    x->drive("z_max", [](double t) { return Vec3d{0.0, 0.0, -0.01 * t}; });
    for (int k = 0; k < kSteps; ++k) test::must_step(*x);
  }
  EXPECT_EQ(s.state_hash(), other.state_hash());
}

}  // namespace
}  // namespace glisson::step_guard
