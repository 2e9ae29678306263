// Loads on faces: constant stress on an irregular mesh, closed forms of pressure and foundations, energy, refusals.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "dynamics/surface_load.h"
#include "support/integrators.h"
#include "support/must_step.h"
#include "support/octant.h"

namespace glisson::surface_load_test {
namespace {

using test::must_step;

const std::array<const char*, 6> kSides{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
Vec3d outward(std::size_t side) {
  Vec3d n{};
  n[side / 2] = side % 2 == 0 ? -1.0 : 1.0;
  return n;
}

// A box bears on each side the traction of one stress; every tet of an irregular mesh has that stress.
TEST(SurfaceLoad, PatchTest) {
  const Mat3d tension{{{{0, 0, 0}, {0, 0, 0}, {0, 0, 100}}}}, shear{{{{0, 30, 0}, {30, 0, -70}, {0, -70, 0}}}},
      all{{{{120, 30, 5}, {30, -60, -70}, {5, -70, 100}}}};
  for (const Mat3d& stress : {tension, shear, all}) {
    std::mt19937 random(7);
    const Vec3d size{0.03, 0.04, 0.05};
    Simulation s(test::jittered_box({3, 4, 5}, 0.01, 0.3, random), {{0, linear_tissue()}},
                 with(Integrator::quasi_static));
    hold_three_corners(s, size);
    for (std::size_t i = 0; i < 6; ++i) s.add_surface_load(kSides[i], {.traction = stress * outward(i)});
    must_step(s);
    const std::vector<double> piola = s.tet_fields().piola;
    for (std::size_t k = 0; k < piola.size(); ++k) ASSERT_NEAR(piola[k], stress(k % 9 / 3, k % 3), 1e-9 * 120.0);
  }
}

// Pressure on all sides is the stress −p I; a bar between planes without friction, pulled at its end, is there longer by t L / E.
TEST(SurfaceLoad, PressureAndTensionArePatchesToo) {
  std::mt19937 random(8);
  const Vec3d size{0.02, 0.02, 0.04};
  const TetMesh mesh = test::jittered_box({3, 3, 6}, 0.02 / 3.0, 0.3, random);
  Simulation pressed(mesh, {{0, linear_tissue()}}, with(Integrator::quasi_static));
  hold_three_corners(pressed, size);
  for (const char* side : kSides) pressed.add_surface_load(side, {.pressure = 50.0});
  must_step(pressed);
  const std::vector<double> piola = pressed.tet_fields().piola;
  for (std::size_t k = 0; k < piola.size(); ++k) ASSERT_NEAR(piola[k], k % 9 % 4 == 0 ? -50.0 : 0.0, 1e-9 * 50.0);
  Simulation pulled(mesh, {{0, linear_tissue()}}, with(Integrator::quasi_static));
  pulled.fix("z_min", {false, false, true});
  pulled.fix("x_min", {true, false, false});
  pulled.fix("y_min", {false, true, false});
  pulled.add_surface_load("z_max", {.traction = {0.0, 0.0, 100.0}});
  must_step(pulled);
  for (const std::uint32_t v : mesh.vertex_sets.at("z_max")) {
    EXPECT_NEAR(pulled.displacement()[v].z, 0.4e-3, 1e-9 * 0.4e-3);
  }
}

// The same load comes to rest at the same place under every integrator.
TEST(SurfaceLoad, AllIntegratorsComeToTheSameRest) {
  std::mt19937 random(9);
  const TetMesh mesh = test::jittered_box({2, 2, 3}, 0.01, 0.3, random);
  const SurfaceLoad load{
      .traction = {20.0, 0.0, 50.0}, .moment = {0.0, 1e-4, 2e-4}, .spring_per_area = {1e4, 2e4, 3e4}};
  std::vector<Vec3d> rest;
  for (const Integrator integrator : test::every_integrator()) {
    SimulationOptions o = with(integrator);
    o.damping_rate = 60.0;
    Simulation s(mesh, {{0, linear_tissue()}}, o);
    s.fix("z_min");
    s.add_surface_load("z_max", load);
    ASSERT_TRUE(s.advance_to(1.5).made());
    if (rest.empty()) rest.assign(s.displacement().begin(), s.displacement().end());
    EXPECT_LE(test::relative_difference(s.displacement(), rest), 1e-6) << static_cast<int>(integrator);
    EXPECT_LE(std::abs(s.energies().imbalance()), 1e-9 * std::abs(s.energies().elastic));
  }
}

// A solid ball under pressure that follows shrinks uniformly: to 0.7 of its size (30 % strain) at p = −P(λ)/λ² of its law.
TEST(SurfaceLoad, FollowingPressureShrinksABall) {
  const NeoHookean law{.mu = 1000.0, .bulk_modulus = 5000.0};
  const double stretch = 0.7, J = stretch * stretch * stretch;
  const double pressure =
      -law.bulk_modulus * (J - 1.0);  // W = μ/2 (J^(−⅔) I₁ − 3) + κ/2 (J − 1)²: the shape has no share
  const Tissue tissue = neo_hookean(law.mu, law.bulk_modulus);
  const test::Octant ball = test::octant(4, 4, 0.0, 0.01);
  Simulation s(ball.mesh, {{0, tissue}}, with(Integrator::quasi_static));
  ball.hold_planes(s);
  s.add_surface_load("outside", {.pressure = pressure, .follows = true}, [](double t) { return std::min(1.0, t); });
  ASSERT_TRUE(s.advance_to(1.0).made());
  for (std::uint32_t v = 0; v < ball.mesh.vertices.size(); ++v) {
    EXPECT_LE(norm(s.displacement()[v] - ball.mesh.vertices[v] * (stretch - 1.0)), 1e-7 * 0.01);
  }
}

// A thick shell of nearly incompressible rubber blown up to 30 % hoop strain inside bears
//   p = μ/2 [ (4/b + 1/b⁴) − (4/a + 1/a⁴) ],   a, b the stretches inside and outside.
TEST(SurfaceLoad, FollowingPressureBlowsUpAShell) {  // long
  const double mu = 1000.0, inside = 0.01, outside = 0.02, a = 1.3;
  const double b = std::cbrt(1.0 + (a * a * a - 1.0) * std::pow(inside / outside, 3));
  const auto part = [](double x) { return 4.0 / x + 1.0 / (x * x * x * x); };
  const double exact = 0.5 * mu * (part(b) - part(a));
  Tissue tissue = neo_hookean(mu, 1000.0 * mu);
  tissue.volume_change = VolumeChange::average_nodal;
  const test::Octant shell = test::octant(5, 5, inside, outside);
  SimulationOptions o = with(Integrator::quasi_static);
  o.step = 0.2;
  Simulation s(shell.mesh, {{0, tissue}}, o);
  shell.hold_planes(s);
  s.add_surface_load("inside", {.pressure = 1.2 * exact, .follows = true}, [](double t) { return std::min(1.0, t); });
  const auto hoop = [&] {
    double sum = 0.0;
    const auto& set = shell.mesh.vertex_sets.at("inside");
    for (const std::uint32_t v : set) sum += norm(shell.mesh.vertices[v] + s.displacement()[v]) / inside;
    return sum / static_cast<double>(set.size());
  };
  double before = 1.0, at = 0.0;
  while (hoop() < a) {
    before = hoop(), at = s.time();
    ASSERT_TRUE(s.step().made()) << s.time();
  }
  const double there = at + (s.time() - at) * (a - before) / (hoop() - before);
  EXPECT_NEAR(1.2 * exact * there, exact, 0.01 * exact);
  RecordProperty("pressure_over_exact", std::to_string(1.2 * there));
}

// Pressure that follows has no force and no moment on a closed surface, however bent; a moment that follows is what was given,
// without a force; the stiffness is the derivative of the force.
TEST(SurfaceLoad, FollowsTheSurface) {
  std::mt19937 random(10);
  const TetMesh mesh = test::jittered_box({2, 2, 2}, 0.01, 0.3, random);
  const std::vector<Vec3d> u = test::random_field(mesh.vertices.size(), 0.003, random);
  const auto sums = [&](std::span<const Vec3d> f) {
    std::array<Vec3d, 2> sum{};
    for (std::size_t v = 0; v < f.size(); ++v) {
      sum[0] += f[v];
      sum[1] += cross(mesh.vertices[v] + u[v], f[v]);
    }
    return sum;
  };
  Loaded closed(mesh);
  closed.loads.add(closed.body, test::all_vertices(mesh), {.pressure = 1000.0, .follows = true}, {});
  for (const Vec3d& sum : sums(closed.loads.at(0.0, closed.body, u))) EXPECT_LE(norm(sum), 1e-14);

  Loaded turned(mesh);
  const Vec3d moment{1e-4, -2e-4, 3e-4};
  turned.loads.add(turned.body, mesh.vertex_sets.at("z_max"), {.moment = moment, .follows = true}, {});
  const auto [force, torque] = sums(turned.loads.at(0.0, turned.body, u));
  EXPECT_LE(norm(force), 1e-15);
  EXPECT_LE(norm(torque - moment), 1e-12 * norm(moment));

  Loaded pulled(mesh);
  pulled.loads.add(pulled.body, mesh.vertex_sets.at("x_max"),
                   {.traction = {300.0, -200.0, 500.0}, .pressure = 100.0, .follows = true}, {});
  const std::vector<Vec3d> way = test::random_field(u.size(), 1.0, random);
  const auto ahead = [&](double d) {
    std::vector<Vec3d> there = u;
    for (std::size_t v = 0; v < u.size(); ++v) there[v] += way[v] * d;
    const std::span<const Vec3d> f = pulled.loads.at(0.0, pulled.body, there);
    return std::vector<Vec3d>(f.begin(), f.end());
  };
  const double d = 1e-7;
  const std::vector<Vec3d> more = ahead(d), less = ahead(-d);
  std::vector<Vec3d> slope(u.size()), numeric(u.size());
  for (const FaceStiffness& face : pulled.loads.stiffness(0.0, pulled.body, u)) {
    for (const std::uint32_t v : face.corners) {
      for (std::size_t k = 0; k < 3; ++k) slope[v] += face.slope[k] * way[face.corners[k]];
    }
  }
  for (std::size_t v = 0; v < u.size(); ++v) numeric[v] = (more[v] - less[v]) * (0.5 / d);
  EXPECT_LE(test::relative_difference(slope, numeric), 1e-7);
}

// A traction that follows turns with the body: turned as a whole, the body bears the turned forces.
TEST(SurfaceLoad, FollowingTractionTurnsWithTheBody) {
  std::mt19937 random(11);
  const TetMesh mesh = test::jittered_box({2, 2, 2}, 0.01, 0.3, random);
  const double c = std::cos(1.0), s = std::sin(1.0);
  const Mat3d turn{{{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}}};
  std::vector<Vec3d> u;
  for (const Vec3d& x : mesh.vertices) u.push_back(turn * x - x);
  Loaded body(mesh);
  body.loads.add(body.body, mesh.vertex_sets.at("x_max"), {.traction = {300.0, -200.0, 500.0}, .follows = true}, {});
  Loaded still(mesh);
  still.loads.add(still.body, mesh.vertex_sets.at("x_max"), {.traction = {300.0, -200.0, 500.0}}, {});
  const std::span<const Vec3d> turned = body.loads.at(0.0, body.body, u), rest = still.loads.at(0.0, still.body, u);
  for (std::size_t v = 0; v < u.size(); ++v) EXPECT_LE(norm(turned[v] - turn * rest[v]), 1e-15);
}

// A stiff slab on springs and dashpots swings as a mass on a spring, x = e^(−δt) cos ωt; what the dashpots take is dissipated.
TEST(SurfaceLoad, FoundationSwingsAsAnOscillator) {
  for (const Integrator integrator :
       {Integrator::central_difference, Integrator::semi_implicit, Integrator::implicit}) {
    SimulationOptions o = with(integrator);
    o.implicit.scheme = TimeScheme::newmark;
    if (integrator == Integrator::implicit) o.step = 2e-4;
    Tissue stiff = linear_tissue();
    stiff.youngs_modulus = 1e6;
    const TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
    Simulation s(mesh, {{0, stiff}}, o);
    double mass = 0.0;
    for (const double m : s.masses()) mass += m;
    const double k = 4.0, c = 0.02, delta = 0.5 * c / mass, omega = std::sqrt(k / mass - delta * delta);
    s.add_surface_load("z_min", {.spring = {k, k, k}, .dashpot = {c, c, c}});
    std::vector<Vec3d> u(mesh.vertices.size(), {0, 0, 1e-4}), v(u.size(), {0, 0, -delta * 1e-4});
    s.set_state(u, v);
    double worst = 0.0;
    while (s.time() < 0.5) {
      must_step(s);
      double mean = 0.0;
      for (std::size_t i = 0; i < u.size(); ++i) mean += s.masses()[i] * s.displacement()[i].z / mass;
      const double t = s.time();
      worst = std::max(worst, std::abs(mean - 1e-4 * std::exp(-delta * t) * std::cos(omega * t)));
    }
    EXPECT_LE(worst, 0.01 * 1e-4) << static_cast<int>(integrator);
    const Energies e = s.energies();
    const double stored = 0.5 * k * 1e-8;
    EXPECT_LE(std::abs(e.imbalance()), 1e-8 * stored);
    EXPECT_GT(e.dissipated, 0.1 * stored);
    EXPECT_LT(e.dissipated, stored);
  }
}

// The ledger closes with the work of every kind of load and of a tool that turns, and its elastic energy is the stored one
// W(u): what is left of both is below a thousandth of the work of tools and loads.
TEST(SurfaceLoad, LedgerClosesWithTheStoredEnergy) {  // long
  const Tissue tissue = neo_hookean(2000.0, 10000.0);
  const double pi = std::numbers::pi;
  for (const Integrator integrator : test::every_integrator()) {
    SimulationOptions o;  // the engine in float, as scenes run
    o.integrator = integrator;
    o.implicit.scheme = TimeScheme::newmark;
    o.damping_rate = 10.0;
    if (capabilities(integrator).any_step_is_stable) o.step = 1e-3;
    std::mt19937 random(12);
    Simulation s(test::jittered_box({3, 3, 4}, 0.01, 0.2, random), {{0, tissue}}, o);
    s.add_surface_load("z_min", {.spring_per_area = {2e5, 2e5, 4e5}, .dashpot_per_area = {50.0, 50.0, 100.0}});
    const auto grows = [](double t) { return std::min(1.0, t / 0.2); };
    s.add_surface_load("x_max", {.pressure = 300.0, .follows = true}, grows);
    s.add_surface_load("y_max", {.traction = {0.0, 100.0, 200.0}, .moment = {0.0, 1e-3, 0.0}, .follows = true}, grows);
    s.add_surface_load("x_min", {.traction = {0.0, 0.0, 100.0}, .moment = {1e-3, 0.0, 0.0}}, grows);
    s.drive_rigidly("z_max", [&](double t) {
      const double a = pi / 6.0 * grows(t), c = std::cos(a), d = std::sin(a);
      return Pose{.position = {0.015 * (1.0 - c + d), 0.015 * (1.0 - c - d), 0.0},
                  .axes = {{{{c, -d, 0}, {d, c, 0}, {0, 0, 1}}}}};
    });
    ASSERT_TRUE(s.advance_to(0.3).made()) << s.time();
    const Energies e = s.energies();
    const double work = std::abs(e.work_tools) + std::abs(e.work_loads);
    EXPECT_LE(std::abs(e.imbalance()), 1e-3 * work) << static_cast<int>(integrator);
    EXPECT_LE(std::abs(e.imbalance() - s.energy_drift().value()), 1e-3 * work) << static_cast<int>(integrator);
    EXPECT_GT(std::abs(e.work_loads), 0.01 * work) << "loads have a share";
    RecordProperty("imbalance_" + std::to_string(static_cast<int>(integrator)), std::to_string(e.imbalance() / work));
    RecordProperty("drift_" + std::to_string(static_cast<int>(integrator)),
                   std::to_string(s.energy_drift().value() / work));
    RecordProperty("loads_" + std::to_string(static_cast<int>(integrator)), std::to_string(e.work_loads / work));
  }
}

// On springs alone a body is held for statics: the slab sinks by F/k.
TEST(SurfaceLoad, SpringsHoldABodyAtRest) {
  const TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  Simulation s(mesh, {{0, linear_tissue()}}, with(Integrator::quasi_static));
  s.add_surface_load("z_min", {.spring_per_area = {1e4, 1e4, 2e4}});
  s.add_surface_load("z_min", {.traction = {0.0, 0.0, -1000.0}});
  must_step(s);
  for (const Vec3d& u : s.displacement()) EXPECT_NEAR(u.z, -1000.0 / 2e4, 1e-9);
}

// A vertex that is named twice counts once.
TEST(SurfaceLoad, AVertexNamedTwiceCountsOnce) {
  const TetMesh mesh = test::paper_mesh();
  std::array<std::uint64_t, 2> hash{};
  for (std::size_t twice = 0; twice < 2; ++twice) {
    Simulation s(mesh, {{0, Tissue{}}});
    s.fix("z_min");
    std::vector<std::uint32_t> set{211, 212, 207};
    if (twice == 1) set.insert(set.end(), {212, 212, 211});
    s.add_load(set, {0.0, 0.0, -0.1});
    for (int i = 0; i < 20; ++i) must_step(s);
    hash[twice] = s.state_hash();
  }
  EXPECT_EQ(hash[0], hash[1]);
}

// A moment twists a round bar by M L / (G J), within the mesh's error; no rigid motion is loaded.
TEST(SurfaceLoad, MomentTwistsARoundBar) {  // long
  CylinderOptions bar;
  bar.radius = 0.01, bar.height = 0.006, bar.radial_cells = 12, bar.axial_cells = 16;
  const TetMesh mesh = cylinder_mesh(bar);
  Simulation s(mesh, {{0, linear_tissue()}}, with(Integrator::quasi_static));
  s.fix("bottom");
  const double moment = 1e-4, G = 10000.0 / 2.6;
  s.add_surface_load("top", {.moment = {0.0, 0.0, moment}});
  must_step(s);
  double angle = 0.0, weight = 0.0, I = 0.0;
  for (const std::uint32_t v : mesh.vertex_sets.at("top")) {
    const Vec3d &x = mesh.vertices[v], &u = s.displacement()[v];
    angle += x.x * u.y - x.y * u.x, weight += x.x * x.x + x.y * x.y;
  }
  for (const Triangle& t : boundary_triangles(mesh)) {  // the polygon's own ∫ r² dA
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    if (std::min({a.z, b.z, c.z}) < bar.height - 1e-9) continue;
    const double area = 0.5 * norm(cross(b - a, c - a));
    for (const auto& [p, q] : {std::pair{a, a}, {b, b}, {c, c}, {a, b}, {b, c}, {c, a}}) {
      I += area / 6.0 * (p.x * q.x + p.y * q.y);
    }
  }
  RecordProperty("angle_over_exact", std::to_string(angle / weight / (moment * bar.height / (G * I))));
  EXPECT_NEAR(angle / weight, moment * bar.height / (G * I), 0.01 * moment * bar.height / (G * I));
}

// Mistakes are named, with the way out.
TEST(SurfaceLoad, RefusesWhatItCannotBear) {
  Simulation s(test::paper_mesh(), {{0, Tissue{}}});
  const auto said = [&](const std::vector<std::uint32_t>& set, const SurfaceLoad& load) {
    try {
      s.add_surface_load(set, load);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  const std::string no_face = said({212, 213}, {.pressure = 10.0});
  EXPECT_TRUE(has(no_face, "spans no face") && has(no_face, "choose a set that has whole faces")) << no_face;
  EXPECT_TRUE(has(said({212}, {.moment = {0, 0, 1}}), "spans no face"));
  EXPECT_TRUE(has(said({}, {.pressure = 10.0}), "the vertex set is empty"));
  EXPECT_TRUE(has(said({100000}, {.pressure = 10.0}), "outside the mesh"));
  const std::string negative = said({212}, {.spring = {-1, 0, 0}});
  EXPECT_TRUE(has(negative, "spring") && has(negative, "0 to 1e+12")) << negative;
  EXPECT_TRUE(has(said({212}, {.force = {std::numeric_limits<double>::quiet_NaN(), 0, 0}}), "force"));
  EXPECT_TRUE(has(said({212}, {.force = {1, 0, 0}, .follows = true}), "follows"));
}

}  // namespace
}  // namespace glisson::surface_load_test
