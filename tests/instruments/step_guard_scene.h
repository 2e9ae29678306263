// step_guard_scene.h — a scene that calls out of its steps from every place there is, and the members that are called from there.
#pragma once

#include <gtest/gtest.h>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include "glisson/instruments/contact.h"
#include "glisson/instruments/cutting.h"
#include "glisson/instruments/rigid_motion.h"
#include "glisson/instruments/tool_motion.h"
#include "glisson/simulation/probe.h"
#include "instruments/needle_scenes.h"
#include "support/integrators.h"
#include "support/must_step.h"

namespace glisson::step_guard {

inline constexpr int kSteps = 6;
inline constexpr double kLongStep = 1e-3;  ///< of the integrators whose steps may have any length [s]
inline constexpr double kRadius = 3e-3;    ///< of the balls [m]

/// Called from every place that calls out; acts at one of them, once in each phase of a run.
struct Asker {
  std::string place;  ///< where it acts
  std::function<void()> act{};
  int phase = 0, last_phase = -1, asked = 0;
  std::set<std::string> seen{};

  void at(const char* here) {
    seen.insert(here);
    if (!act || here != place || phase == last_phase) return;
    last_phase = phase;
    ++asked;
    act();
  }
};

/// An interaction each of whose members calls out.
struct Own final : Interaction {
  std::shared_ptr<Asker> asker;
  std::uint32_t vertex;

  Own(std::shared_ptr<Asker> a, std::uint32_t v) : asker(std::move(a)), vertex(v) {}
  void attached(const BodyView&, double) override { asker->at("attached"); }
  void body_changed(const BodyView&, std::span<const std::uint32_t>) override { asker->at("body_changed"); }
  std::span<const std::uint32_t> reach(double, double) override {
    asker->at("reach");
    return {&vertex, 1};
  }
  std::optional<std::span<const std::uint32_t>> keeps() override {
    asker->at("keeps");
    return {};
  }
  std::optional<std::span<const std::uint32_t>> rests() override {
    asker->at("rests");
    return {};
  }
  void state_set(std::span<const Vec3d>) override { asker->at("state_set"); }
  void add_forces(const InteractionStep&) override { asker->at("add_forces"); }
  void declare(const InteractionStep&, StepRows&, int) override { asker->at("declare"); }
  void solved(const InteractionStep&, const StepRows&) override { asker->at("solved"); }
  void moved(const InteractionStep&) override { asker->at("moved"); }
  void add_forces_at(std::span<const Vec3d>, std::span<Vec3d>) override { asker->at("add_forces_at"); }
  void add_stiffness(std::vector<TriangleStiffness>&) const override { asker->at("add_stiffness"); }
  bool overshoots(const InteractionStep&) override {
    asker->at("overshoots");
    return false;
  }
  std::string refuses_long_steps() const override { return {}; }
  double squared_frequency() const override {
    asker->at("squared_frequency");
    return 0.0;
  }
  double next_corner(double) const override {
    asker->at("next_corner");
    return std::numeric_limits<double>::infinity();
  }
  double energy() const override {
    asker->at("energy");
    return 0.0;
  }
  double released_energy() const override {
    asker->at("released_energy");
    return 0.0;
  }
  double tool_energy() const override {
    asker->at("tool_energy");
    return 0.0;
  }
  bool add_contact(std::span<Vec3d>, std::span<double>) const override {
    asker->at("add_contact");
    return false;
  }
  void archive(Archive&) override { asker->at("archive"); }
  std::shared_ptr<const void> save_state() const override {
    asker->at("save_state");
    return {};
  }
  void load_state(const std::shared_ptr<const void>&, const BodyView*) override { asker->at("load_state"); }
};

/// Down at 20 mm/s.
struct OwnDriver final : ToolDriver {
  std::shared_ptr<Asker> asker;
  Pose from;

  OwnDriver(std::shared_ptr<Asker> a, const Pose& start) : asker(std::move(a)), from(start) {}
  Pose start() const override { return from; }
  Pose advance(double time, double h, const Wrench&) override {
    asker->at("driver");
    Pose pose = from;
    pose.position.z -= 0.02 * (time + h);
    return pose;
  }
};

inline std::shared_ptr<ContactTool> ball(const char* name, std::shared_ptr<ToolDriver> driver) {
  return std::make_shared<ContactTool>(ContactOptions{.name = name, .shape = Ball{kRadius}}, std::move(driver));
}

/// A cube of 2 cm that is held, driven, turned, loaded, pressed by two balls, cut into and read.
struct Scene {
  std::shared_ptr<Asker> asker;
  TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  Simulation body;
  std::shared_ptr<ContactTool> led, pushed;
  std::optional<Cutter> cutter;
  Probes probes;
  State before_steps{};
  std::string file{}, cutter_file{};

  static Tissue tissue() {
    Tissue t;
    t.viscosity = 1.0;  // semi_implicit solves for contact with it
    return t;
  }
  static SimulationOptions options(Integrator integrator) {
    SimulationOptions o;
    o.integrator = integrator;
    if (capabilities(integrator).any_step_is_stable) o.step = kLongStep;
    return o;
  }
  std::uint32_t vertex_at(const Vec3d& x) const {
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      if (norm(mesh.vertices[v] - x) < 1e-9) return v;
    }
    throw std::logic_error("the cube has no vertex there");
  }

  Scene(Integrator integrator, std::shared_ptr<Asker> a, const std::function<void(Scene&)>& act)
      : asker(std::move(a)), body(mesh, {{0, tissue()}}, options(integrator)) {
    if (act) asker->act = [this, act] { act(*this); };
    body.fix("z_min");
    const auto motion = [x = asker](double t) {
      x->at("motion");
      return Vec3d{0.01 * t, 0.0, 0.0};
    };
    body.drive(std::vector{vertex_at({0.0, 0.0, 0.02})}, motion);
    body.drive_rigidly(std::vector{vertex_at({0.02, 0.0, 0.02}), vertex_at({0.02, 0.01, 0.02})}, [x = asker](double t) {
      x->at("pose motion");
      return Pose{{0.0, 0.0, -0.01 * t}, identity<double>()};
    });
    const auto scale = [x = asker](double t) {
      x->at("scale");
      return 1.0 + t;
    };
    body.add_load("z_max", {0.0, 0.0, -1e-3}, scale);
    body.add_surface_load("x_min", {.pressure = 10.0, .follows = true}, scale);
    led = ball("led", std::make_shared<OwnDriver>(asker, Pose{{0.006, 0.01, 0.020001}, identity<double>()}));
    PushMotion push;
    push.force = [x = asker](double) {
      x->at("push");
      return 0.01;
    };
    pushed = ball("pushed",
                  std::make_shared<PushDriver>(Pose{{0.014, 0.014, 0.020001}, identity<double>()}, std::move(push)));
    for (const auto& tool : {led, pushed}) body.attach(tool);
    body.attach(std::make_shared<Own>(asker, vertex_at({0.01, 0.02, 0.02})));
    cutter.emplace(body);
    cutter->place({{-0.01, 0.0051, 0.03}, {0.03, 0.0051, 0.03}});
    probes = Probes(body, {{"middle", ProbePoint{{0.01, 0.01, 0.01}}}});
    before_steps = body.save_state();
    std::ostringstream out, of_cutter;
    body.save(out), cutter->save(of_cutter);
    file = out.str(), cutter_file = of_cutter.str();
  }

  /// All that calls out: steps, a tet removed, a state set, saved and loaded, readings. @return hash of what came of it
  std::vector<double> run() {
    std::uint64_t hashes = 0;
    for (int k = 0; k < kSteps; ++k) {
      ++asker->phase;
      test::must_step(body);
      hashes = 31 * hashes + body.state_hash();  // before anything else looks at the state
      if (k == 1) body.remove_tets(std::vector{3U});
      if (k == 2) {
        const std::vector<Vec3d> u(body.displacement().begin(), body.displacement().end());
        const std::vector<Vec3d> v(body.velocity().begin(), body.velocity().end());
        body.set_state(u, v);
      }
      if (k == 3) body.load_state(body.save_state());
      std::ostringstream out;
      body.save(out);
      static_cast<void>(body.stored_energy()), static_cast<void>(body.contact_fields());
      static_cast<void>(body.next_corner(0.0));
    }
    ++asker->phase;
    const Energies e = body.energies();
    const ForceParts f = body.force({1});
    return {static_cast<double>(hashes >> 12U),
            body.time(),
            e.elastic,
            e.kinetic,
            e.work_tools,
            e.contact,
            norm(led->forces().total()),
            norm(pushed->forces().total()),
            f.total().x,
            f.total().z,
            probes.read(body)[2]};
  }
};

using Member = std::pair<const char*, std::function<void(Scene&)>>;

/// All members that change something.
inline std::vector<Member> changing() {
  const auto still = [](double) { return Vec3d{}; };
  const std::vector<std::uint32_t> free{26};
  return {
      {"fix", [=](Scene& s) { s.body.fix(free); }},
      {"fix", [=](Scene& s) { s.body.fix("z_min"); }},
      {"drive", [=](Scene& s) { s.body.drive(free, still); }},
      {"drive", [=](Scene& s) { s.body.drive("x_max", still, {.x = true, .y = false, .z = false}, 1.0); }},
      {"drive_rigidly", [=](Scene& s) { s.body.drive_rigidly(free, [](double) { return Pose{}; }); }},
      {"add_load",
       [=](Scene& s) {
         s.body.add_load(free, {0.0, 0.0, 1.0});
       }},
      {"add_load", [](Scene& s) { s.body.add_surface_load("z_max", {.pressure = 1e3}); }},
      {"attach",
       [](Scene& s) {
         s.body.attach(ball("late", std::make_shared<HandDriver>(Pose{{0, 0, 0.05}, identity<double>()})));
       }},
      {"remove_tets",
       [](Scene& s) {
         s.body.remove_tets(std::vector{0U, 5U, 9U});
       }},
      {"split_faces", [](Scene& s) { s.body.split_faces(std::vector<Triangle>{}); }},
      {"set_tissues", [](Scene& s) { s.body.set_tissue(0, Tissue{.youngs_modulus = 1e5}); }},
      {"set_tissues",
       [](Scene& s) {
         s.body.set_tissues({{0, Tissue{.youngs_modulus = 1e5}}});
       }},
      {"step", [](Scene& s) { static_cast<void>(s.body.step()); }},
      {"advance_to", [](Scene& s) { static_cast<void>(s.body.advance_to(1.0)); }},
      {"set_step_end", [](Scene& s) { s.body.set_step_end(1e-4); }},
      {"set_interrupt", [](Scene& s) { s.body.set_interrupt([](const StepProgress&) { return true; }); }},
      {"set_state",
       [](Scene& s) {
         const std::vector<Vec3d> moved(s.mesh.vertices.size(), Vec3d{0.0, 0.0, 1e-4});
         s.body.set_state(moved, moved);
       }},
      {"save_state", [](Scene& s) { static_cast<void>(s.body.save_state()); }},
      {"load_state", [](Scene& s) { s.body.load_state(s.before_steps); }},
      {"reset", [](Scene& s) { s.body.reset(); }},
      {"save",
       [](Scene& s) {
         std::ostringstream out;
         s.body.save(out);
       }},
      {"load",
       [](Scene& s) {
         std::istringstream in(s.file);
         s.body.load(in);
       }},
      {"Cutter", [](Scene& s) { const Cutter other(s.body); }},
      {"Cutter::place",
       [](Scene& s) {
         s.cutter->place({{}, {0.0, 0.01, 0.0}});
       }},
      {"Cutter::advance",
       [](Scene& s) {
         s.cutter->advance({{-0.01, 0.0051, 0.0}, {0.03, 0.0051, 0.0}});
       }},
      {"Cutter::load",
       [](Scene& s) {
         std::istringstream in(s.cutter_file);
         s.cutter->load(in);
       }},
  };
}

/// All members that read, and what the balls tell.
inline void read_all(Scene& s) {
  const Simulation& body = s.body;
  const auto read = [](const auto&... all) { (static_cast<void>(all), ...); };
  read(body.time(), body.step_size(), body.next_corner(0.0), body.stable_step(), body.steps(), body.mass_scaling(),
       body.limiting_tets(), body.mesh(), body.masses(), body.displacement(), body.velocity(), body.positions(),
       body.force({0}), body.torque({0}, {}), body.force_time(), body.energies(), body.stored_energy(),
       body.energy_drift(), body.linear_share(), body.engine_info(), body.tet_fields(), body.contact_fields(),
       body.state_hash(), body.present_mesh(), body.is_removed(3), body.tissue(0));
  if (!s.probes.empty()) read(s.probes.read(body));
  if (s.cutter) read(s.cutter->contact());
  for (const auto& tool : {s.led, s.pushed}) {
    if (!tool) continue;
    read(tool->pose(), tool->forces(), tool->contact_area(), tool->largest_pressure(), tool->contact_pressure());
    for (const InstrumentColumn& column : tool->columns()) read(column.read(*tool));
  }
}

/// Each call of a member that changes something, from inside a step; what was not refused as it should be is told.
inline void call_all(Scene& s, std::vector<std::string>& faults) {
  for (const auto& [name, call] : changing()) {
    if (!s.cutter && std::string_view(name).starts_with("Cutter")) continue;  // it is still being set up
    const std::string where = std::string(name) + " from " + s.asker->place;
    try {
      call(s);
      faults.push_back(where + " was not refused");
    } catch (const std::logic_error& error) {
      const std::string text = error.what();
      if (!text.starts_with(name) || text.find("inside a step or a change") == std::string::npos) {
        faults.push_back(where + ": " + text);
      }
    }
  }
}

/// Every place that calls out under an integrator.
inline std::set<std::string> places(Integrator integrator) {
  const auto asker = std::make_shared<Asker>();
  Scene(integrator, asker, {}).run();
  return asker->seen;
}

}  // namespace glisson::step_guard
