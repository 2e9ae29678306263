// Each model beside the engine does what is published of it: its stiffness at rest, its Poisson's ratio, and what it does not converge to.
#include "compare/models/rival.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <set>

#include "compare/experiments.h"
#include "compare/models/engine.h"
#include "glisson/mesh_refinement.h"

namespace glisson::models {
namespace {

const Stop kNever{false};
constexpr double kArea = kEdge * kEdge;

// Σ f·x over the vertices of a body that is dilated by e is twice its energy over e. Springs by volume store ½ E V Σ (n·εn)² a tet,
// 3 E e² by volume: exactly what a body of ν = 1/4 stores, K = 2 E/3, on every mesh. Springs by length have no such measure.
TEST(SpringMass, ByVolumeHasTheBulkModulusOfAQuarterOnEveryMesh) {
  constexpr double kStrain = 1e-5;
  constexpr std::array kCubes{2, 2, 2}, kFlat{2, 2, 4};
  const auto bulk = [&](Answer (*model)(const Problem&, const Effort&, const Stop&), std::array<int, 3> cells) {
    double virial = 0.0;
    const std::size_t n = cube(cells).mesh.vertices.size();
    for (std::uint32_t v = 0; v < n; ++v) {
      Problem p = dilated(kStrain, v, cells);
      p.stations = {p.duration};
      virial += dot(model(p, {}, kNever).forces.back(), p.mesh.vertices[v]);
    }
    return virial / (9.0 * kStrain * kEdge * kEdge * kEdge);
  };
  EXPECT_NEAR(bulk(spring_mass_by_volume, kCubes) / (kYoung / 1.5), 1.0, 1e-4);
  EXPECT_NEAR(bulk(spring_mass_by_volume, kFlat) / (kYoung / 1.5), 1.0, 1e-4);
  // what the springs lack of λ is given to the volumes: K = 2 E/3 + λ − 0.4 E
  const double lambda = lame_from_young(kYoung, kPoisson).lambda;
  EXPECT_NEAR(bulk(spring_mass_with_volume, kFlat) / (kYoung / 1.5 + lambda - 0.4 * kYoung), 1.0, 1e-4);
  EXPECT_GT(std::abs(bulk(spring_mass_by_length, kCubes) / bulk(spring_mass_by_length, kFlat) - 1.0), 0.05)
      << "by length it depends on the shape of the cells";
}

// Whatever ν is, a network of springs contracts by about a quarter; with volumes by more.
TEST(SpringMass, ContractsByAQuarter) {
  const Problem p = stretched(0.02);
  const double springs = contraction(p, spring_mass_by_volume(p, {}, kNever), 0.02);
  EXPECT_NEAR(springs, 0.25, 0.08);
  EXPECT_GT(contraction(p, spring_mass_with_volume(p, {}, kNever), 0.02), springs + 0.05);
}

// A stretch that is uniform is exact: F = E A ε, and the sides come in by ν.
TEST(LinearFem, StretchIsExact) {
  const Problem p = stretched(0.1);
  const Answer answer = linear_fem(p, {}, kNever);
  ASSERT_EQ(answer.forces.size(), 2U);
  EXPECT_NEAR(answer.forces[0].z, kYoung * kArea * 0.05, 1e-9);
  EXPECT_NEAR(answer.forces[1].z, kYoung * kArea * 0.1, 1e-9);
  EXPECT_NEAR(contraction(p, answer, 0.1), kPoisson, 1e-9);
}

// Explicit steps of the engine with the same linear tissue come to it.
TEST(LinearFem, IsWhatTheTensorMassModelComesTo) {
  Problem p = cube({3, 3, 3});
  p.supports.push_back({p.mesh.vertex_set("z_min"), {}});
  p.tools.push_back({p.mesh.vertex_set("z_max"), {}, ramp_to({0.002, 0, -0.002}, 1.0)});
  const Answer statics = linear_fem(p, {}, kNever), steps = linear_tensor_mass(p, {}, kNever);
  ASSERT_EQ(steps.forces.size(), 2U) << steps.trouble;
  EXPECT_LE(norm(steps.forces[1] - statics.forces[1]), 2e-3 * norm(statics.forces[1]));
}

// In motion that rings, too: the error of backward Euler halves with its steps.
TEST(LinearFem, InMotionIsWhatTheTensorMassModelComesTo) {
  Problem p = cube({3, 3, 3});
  p.duration = 0.2;
  p.stations = {0.04, 0.08, 0.12, 0.16, 0.2};
  p.supports.push_back({p.mesh.vertex_set("z_min"), {}});
  const auto swing = [](double t) { return Vec3d{0.002 * std::pow(std::sin(20.0 * t), 2), 0, 0}; };
  p.tools.push_back({p.mesh.vertex_set("z_max"), {}, Motion(swing)});
  const Answer statics = linear_fem(p, {}, kNever);
  const Answer steps = run_engine(p, p.tissues, {.step = 1e-5, .precision = Precision::double_precision}, kNever);
  ASSERT_EQ(steps.forces.size(), 5U) << steps.trouble;
  const auto off = [&](const Answer& other) {
    double most = 0.0;
    for (std::size_t i = 0; i < 5; ++i) most = std::max(most, norm(other.forces[i] - steps.forces[i]));
    return most / norm(statics.forces[1]);
  };
  EXPECT_GE(off(statics), 0.1) << "inertia matters here";
  const double coarse = off(linear_fem_implicit(p, {1600, 0}, kNever));
  const double fine = off(linear_fem_implicit(p, {3200, 0}, kNever));
  EXPECT_LE(fine, 0.002);
  EXPECT_NEAR(coarse / fine, 2.0, 0.2);
}

// Turned by a right angle as a whole, a linear body exerts forces; a corotational or neo-Hookean one does not.
TEST(LinearFem, SwellsWhereItIsTurned) {
  Problem p = cube();
  const auto quarter = [](double t) {
    const double a = 0.5 * 3.14159265358979323846 * std::min(1.0, t);
    Pose pose;
    pose.axes = {{{{std::cos(a), -std::sin(a), 0}, {std::sin(a), std::cos(a), 0}, {0, 0, 1}}}};
    return pose;
  };
  p.tools.push_back({p.mesh.vertex_set("z_max"), {}, PoseMotion(quarter)});
  p.tools.push_back({p.mesh.vertex_set("z_min"), {}, PoseMotion(quarter)});
  EXPECT_GT(norm(linear_fem(p, {}, kNever).forces[1]), 0.1 * kYoung * kArea);
  EXPECT_LT(norm(corotational(p, {}, kNever).forces[1]), 0.002 * kYoung * kArea);
  EXPECT_LT(norm(neo_hookean(p, {}, kNever).forces[1]), 0.002 * kYoung * kArea);
  EXPECT_LT(norm(projective_dynamics(p, {200, 20}, kNever).forces[1]), 0.01 * kYoung * kArea);
}

// Condensed or not, a linear body is the same: at the tool, where the halves meet and inside the condensed half.
TEST(Hybrid, IsTheLinearBody) {
  Problem p = cube({3, 3, 6});
  p.motion.gravity = {0, -2.0, 0};
  p.supports.push_back({p.mesh.vertex_set("z_min"), {}});
  p.tools.push_back({p.mesh.vertex_set("z_max"), {}, ramp_to({0.001, 0, -0.002}, 1.0)});
  const Answer whole = linear_fem(p, {}, kNever), halves = hybrid(p, {}, kNever);
  ASSERT_EQ(halves.forces.size(), 2U) << halves.trouble;
  EXPECT_LE(norm(halves.forces[1] - whole.forces[1]), 2e-3 * norm(whole.forces[1]));
  for (std::size_t v = 0; v < p.mesh.vertices.size(); ++v) {
    EXPECT_LE(norm(halves.displacement[v] - whole.displacement[v]), 1e-5) << v;
  }
}

/// Force per area of W = μ/2 (tr FᵀF − 3) + λ'/2 (J − 1 − μ/λ')², stretched to `z` with free sides.
double macklin_stress(double z) {
  const LameParameters lame = lame_from_young(kYoung, kPoisson);
  const double mu = lame.mu, l = lame.lambda + lame.mu;
  double x = 1.0;  // of the sides: μ x + λ' (J − 1 − μ/λ') x z = 0
  for (int k = 0; k < 100; ++k) {
    const double c = mu + l * (x * x * z - 1.0 - mu / l) * z;
    x -= c / (2.0 * l * x * z * z);
  }
  return mu * z + l * (x * x * z - 1.0 - mu / l) * x * x;
}

// In small steps it is the neo-Hookean body whose moduli it was given; with longer ones it is another, and more so on a finer mesh. In
// steps of 20 ms tets collapse between its two constraints, however often they are swept over.
TEST(Xpbd, StiffnessHangsOnStepsAndMesh) {
  const Problem coarse = stretched(0.1), fine = stretched(0.1, {6, 6, 6});
  const double exact = macklin_stress(1.1) * kArea;
  EXPECT_NEAR(macklin_stress(1.0001) / (1e-4 * kYoung), 1.0, 1e-3) << "its modulus at rest is E";
  const auto error = [&](const Problem& p, const Effort& effort) {
    return std::abs(xpbd(p, effort, kNever).forces[1].z / exact - 1.0);
  };
  const double small_steps = error(coarse, {8000, 1}), long_steps = error(coarse, {500, 1});
  EXPECT_LT(small_steps, 0.01);
  EXPECT_GT(long_steps, 2.0 * small_steps);
  EXPECT_GT(error(fine, {500, 1}), 2.0 * long_steps);
  EXPECT_GT(error(coarse, {100, 100}), 0.5);
}

// At small strain it comes to E A ε and to ν.
TEST(ProjectiveDynamics, ComesToTheTissueAtSmallStrain) {
  const Problem p = stretched(0.01);
  const Answer answer = projective_dynamics(p, {100, 100}, kNever);
  EXPECT_NEAR(answer.forces[1].z / (kYoung * kArea * 0.01), 1.0, 0.02);
  EXPECT_NEAR(contraction(p, answer, 0.01), kPoisson, 0.02);
}

// A link gives way by a tenth of itself before it drags its neighbour, and no force is known.
TEST(ChainMail, DragsWhereLinksAreTaut) {
  Problem p = cube({1, 1, 4});
  p.supports.push_back({p.mesh.vertex_set("z_min"), {}});
  p.tools.push_back({p.mesh.vertex_set("z_max"), {}, ramp_to({0, 0, 0.001}, 2.0)});
  const Answer answer = chain_mail(p, {1, 0}, kNever);
  EXPECT_TRUE(answer.forces.empty());
  for (std::uint32_t v = 0; v < p.mesh.vertices.size(); ++v) {
    const double z = p.mesh.vertices[v].z;
    if (z > 0.74 * kEdge && z < 0.76 * kEdge) {
      EXPECT_NEAR(answer.displacement[v].z, 0.001 - 0.1 * 0.25 * kEdge, 1e-4);
    } else if (z > 0.24 * kEdge && z < 0.26 * kEdge) {
      EXPECT_EQ(answer.displacement[v].z, 0.0) << "it does not come as far";
    }
  }
}

// Whole bodies: the scene's own tissue in equilibrium and by steps, and the neo-Hookean one, agree where they are the same.
TEST(Engine, OwnTissueIsTheSameInStepsAndAtRest) {
  Problem p = cube({3, 3, 3});
  p.tissues[0].hyperelastic = NeoHookean{1285.714, 6000.0};
  p.supports.push_back({p.mesh.vertex_set("z_min"), {}});
  p.tools.push_back({p.mesh.vertex_set("z_max"), {}, ramp_to({0, 0, -0.004}, 2.0)});
  const Answer steps = own_tissue(p, {}, kNever), rest = own_tissue_at_rest(p, {}, kNever),
               neo = neo_hookean(p, {}, kNever);
  ASSERT_EQ(rest.forces.size(), 2U) << rest.trouble;
  EXPECT_LE(norm(steps.forces[1] - rest.forces[1]), 5e-3 * norm(rest.forces[1]));
  EXPECT_LE(norm(neo.forces[1] - steps.forces[1]), 1e-3 * norm(rest.forces[1]));
  EXPECT_NE(schwartz_tensor_mass(p, {}, kNever).trouble.find("no stiffness law"), std::string::npos);
}

/// A block that is stretched within 0.8 s and held, and the tets of a slot of it, from one side to the middle and two cells high: some
/// vertices are of no other tet.
Problem stretched_block(std::vector<std::uint32_t>& slot, int layer) {
  Problem p = cube({2, 2, 6});
  p.supports.push_back({p.mesh.vertex_set("z_min"), {}});
  p.tools.push_back({p.mesh.vertex_set("z_max"), {}, ramp_to({0, 0, 0.1 * kEdge}, 0.8)});
  for (std::uint32_t t = 0; t < p.mesh.tets.size(); ++t) {
    Vec3d middle;
    for (const std::uint32_t v : p.mesh.tets[t]) middle += p.mesh.vertices[v] * 0.25;
    if (middle.x < 0.5 * kEdge && (static_cast<int>(6.0 * middle.z / kEdge) + 1) / 2 == layer) slot.push_back(t);
  }
  return p;
}

/// The problem on a mesh that never had these tets, nor the vertices of no other.
Problem without_tets(Problem p, const std::vector<std::uint32_t>& tets) {
  for (auto t = tets.rbegin(); t != tets.rend(); ++t) p.mesh.tets.erase(p.mesh.tets.begin() + *t);
  p.mesh.regions.clear();
  p.mesh.vertex_sets.clear();
  std::vector<std::uint32_t> number(p.mesh.vertices.size(), 0);
  for (const Tet& tet : p.mesh.tets) {
    for (const std::uint32_t v : tet) number[v] = 1;
  }
  std::vector<Vec3d> kept;
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) continue;
    number[v] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(p.mesh.vertices[v]);
  }
  p.mesh.vertices = kept;
  for (Tet& tet : p.mesh.tets) {
    for (std::uint32_t& v : tet) v = number[v];
  }
  for (std::uint32_t& v : p.supports.front().vertices) v = number[v];
  for (std::uint32_t& v : p.tools.front().vertices) v = number[v];
  return p;
}

// Elastic bodies forget their path: cut while they are stretched, they come to the force of one that never had the tets.
TEST(Rivals, CutWhileLoadedComeToTheBodyWithoutTheTets) {
  std::vector<std::uint32_t> slot;
  const Problem whole = stretched_block(slot, 2);
  ASSERT_EQ(slot.size(), 24U);
  const Problem without = without_tets(whole, slot);
  ASSERT_LT(without.mesh.vertices.size(), whole.mesh.vertices.size());
  Problem cut = whole;
  cut.cut = Cut{1.2, slot};
  for (const Rival& rival : rivals()) {
    if (rival.name == "chain_mail" || rival.name == "linear_fem_modal") continue;
    // What XPBD lacks of its equilibrium falls with the step squared, and hangs on the masses, which a cut leaves.
    const Effort effort = rival.name == "projective_dynamics" ? Effort{100, 40}
                          : rival.name == "xpbd"              ? Effort{16000, 1}
                                                              : rival.efforts.back();
    const Answer of_whole = rival.run(whole, effort, kNever);
    if (!of_whole.trouble.empty()) continue;  // it asks for a law or viscosity
    const Answer of_cut = rival.run(cut, effort, kNever), of_less = rival.run(without, effort, kNever);
    ASSERT_EQ(of_cut.forces.size(), 2U) << rival.name << of_cut.trouble;
    const double before = of_whole.forces[0].z, after = of_less.forces[1].z;
    EXPECT_EQ(of_cut.forces[0].z, before) << rival.name << ": not cut yet";
    EXPECT_LT(after, 0.9 * before) << rival.name;
    EXPECT_NEAR(of_cut.forces[1].z / after, 1.0, 2e-3) << rival.name;
    EXPECT_GT(of_cut.cut_s, 0.0) << rival.name;
  }
  const double after = linear_fem(without, {}, kNever).forces[1].z;
  EXPECT_NEAR(linear_fem(cut, {}, kNever).forces[1].z, after, 1e-12 * after);
}

// Equilibria that are sought from the shapes of a coarser mesh are those that each mesh finds on its own, a cut among them.
TEST(Equilibria, DoNotDependOnWhereTheyAreSoughtFrom) {
  std::vector<std::uint32_t> slot;
  Problem coarse = stretched_block(slot, 2);
  coarse.tissues[0] = Tissue{.hyperelastic = NeoHookean{1285.714, 6000.0}};
  coarse.cut = Cut{1.2, slot};
  Problem fine = coarse;
  fine.mesh = refined(coarse.mesh);
  fine.supports.front().vertices = fine.mesh.vertex_set("z_min");
  fine.tools.front().vertices = fine.mesh.vertex_set("z_max");
  fine.cut->tets.clear();
  for (const std::uint32_t t : slot) {
    for (std::uint32_t k = 0; k < 8; ++k) fine.cut->tets.push_back(8 * t + k);
  }
  std::vector<std::vector<Vec3d>> near = equilibria(coarse, {}, kNever).shapes;
  ASSERT_EQ(near.size(), 2U);
  for (std::vector<Vec3d>& shape : near) shape = refined(coarse.mesh, shape);
  const Equilibria found = equilibria(fine, near, kNever);
  const Answer alone = own_tissue_at_rest(fine, {}, kNever);
  ASSERT_EQ(found.answer.forces.size(), 2U) << found.answer.trouble;
  ASSERT_EQ(alone.forces.size(), 2U) << alone.trouble;
  EXPECT_LT(alone.forces[1].z, 0.9 * alone.forces[0].z) << "the cut is felt";
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LE(norm(found.answer.forces[i] - alone.forces[i]), 1e-6 * norm(alone.forces[i])) << i;
  }
}

// Links go with their last tet; a condensed half has no tets to take out, and modes none at all.
TEST(Rivals, SayWhereTheyCannotBeCut) {
  std::vector<std::uint32_t> slot;
  Problem p = stretched_block(slot, 1);
  p.cut = Cut{1.2, slot};
  EXPECT_NE(hybrid(p, {}, kNever).trouble.find("the cut reaches into the condensed half"), std::string::npos);
  EXPECT_NE(linear_fem_modal(p, {0, 10}, kNever).trouble.find("modes are those of the whole body"), std::string::npos);
  const Answer mail = chain_mail(p, {10, 10}, kNever);
  EXPECT_GT(mail.cut_s, 0.0);
  EXPECT_EQ(mail.displacement.size(), p.mesh.vertices.size());
}

// Every model of the list has its own name, a source and an effort, and ends when it is stopped.
TEST(Rivals, AreNamedAndStop) {
  std::set<std::string_view> names;
  const Stop at_once{true};
  Problem p = stretched(0.1);
  for (const Rival& rival : rivals()) {
    EXPECT_TRUE(names.insert(rival.name).second) << rival.name;
    EXPECT_FALSE(rival.source.empty()) << rival.name;
    ASSERT_FALSE(rival.efforts.empty()) << rival.name;
    EXPECT_TRUE(rival.run(p, rival.efforts.back(), at_once).forces.empty()) << rival.name;
  }
  EXPECT_GE(names.size(), 10U);
}

}  // namespace
}  // namespace glisson::models
