// A point of tissue under prescribed stretch and stress meets the closed forms of each law, relaxes and creeps as its branches
// and its viscosity say, and is what the engine's body of tets does in the same test.
#include "glisson/material_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "glisson/simulation/simulation.h"
#include "material/every_tissue.h"
#include "material/reference/reference_stress.h"
#include "material/uniaxial_path.h"
#include "support/must_step.h"

namespace glisson {
namespace {

constexpr auto kStretch = MaterialControl::deformation;
constexpr auto kStress = MaterialControl::nominal_stress;

/// Principal stretches of an incompressible test: λ^e along each axis.
using Exponents = std::array<double, 3>;
constexpr Exponents kUniaxial{-0.5, -0.5, 1.0}, kEquibiaxial{1.0, 1.0, -2.0}, kPlanar{-1.0, 0.0, 1.0};

/// d/dλ Σ λ_i^n of stretches λ^e.
double sum_slope(const Exponents& e, double stretch, double n) {
  double sum = 0.0;
  for (const double x : e) sum += n * x * std::pow(stretch, n * x - 1.0);
  return sum;
}

/// dW/dλ of an incompressible test [Pa].
template <class Law>
double incompressible(const Law& law, const Exponents& e, double stretch) {
  double x = -3.0, y = -3.0;  // I₁ − 3, I₂ − 3
  for (const double k : e) x += std::pow(stretch, 2.0 * k), y += std::pow(stretch, -2.0 * k);
  const reference::InvariantEnergy w = reference::invariant_energy(law, x, y);
  return static_cast<double>(w.first) * sum_slope(e, stretch, 2.0) +
         static_cast<double>(w.second) * sum_slope(e, stretch, -2.0);
}
double incompressible(const Ogden& law, const Exponents& e, double stretch) {
  double P = 0.0;
  for (std::size_t k = 0; k < law.mu.size(); ++k) {
    P += 2.0 * law.mu[k] / (law.alpha[k] * law.alpha[k]) * sum_slope(e, stretch, law.alpha[k]);
  }
  return P;
}

/// P_xz of simple shear: I₁ − 3 = I₂ − 3 = γ², J = 1, whatever the bulk modulus [Pa].
template <class Law>
double sheared(const Law& law, double amount) {
  const reference::InvariantEnergy w = reference::invariant_energy(law, amount * amount, amount * amount);
  return 2.0 * amount * static_cast<double>(w.first + w.second);
}
double sheared(const Ogden& law, double amount) {
  const double root = std::sqrt(amount * amount + 4.0), stretch = 0.5 * (amount + root);
  double P = 0.0;
  for (std::size_t k = 0; k < law.mu.size(); ++k) {
    const double a = law.alpha[k];
    P += 2.0 * law.mu[k] / a * (std::pow(stretch, a) - std::pow(stretch, -a)) / root;
  }
  return P;
}

Tissue of_law(HyperelasticLaw law, double bulk) {
  std::visit([bulk](auto& l) { l.bulk_modulus = bulk; }, law);
  Tissue t;
  t.hyperelastic = law;
  return t;
}

MaterialState after(const Tissue& tissue, MaterialTest test, MaterialControl control, double value) {
  const double time = 1.0;
  const MaterialState state = material_test(tissue, test, control, {&time, 1}, {&value, 1}).front();
  EXPECT_TRUE(state.converged) << tissue.name << ": " << state.message;
  return state;
}

// Simple shear changes no volume: the closed forms hold for any bulk modulus, to 1e-10. The largest shear is 1.5.
TEST(MaterialPoint, SimpleShearOfEveryHyperelasticLaw) {
  for (const HyperelasticLaw& law : test::every_hyperelastic_law()) {
    for (const double amount : {1e-3, 0.1, 0.7, 1.5}) {
      const double exact = std::visit([amount](const auto& l) { return sheared(l, amount); }, law);
      const MaterialState s = after(of_law(law, test::kExampleBulk), MaterialTest::simple_shear, kStretch, amount);
      EXPECT_NEAR(s.nominal(0, 2), exact, 1e-10 * std::abs(exact)) << law_name(law) << ", γ = " << amount;
    }
  }
}

// With κ = 3·10¹¹ Pa, some 10⁷ times the largest tangent, a law is incompressible: uniaxial, equibiaxial and planar tests to 1e-6.
TEST(MaterialPoint, IncompressibleLimits) {
  struct Case {
    MaterialTest test;
    Exponents stretches;
    std::size_t axis;
    double share;  // of dW/dλ in one of the driven directions
  };
  for (const HyperelasticLaw& law : test::every_hyperelastic_law()) {
    for (const Case& c :
         {Case{MaterialTest::uniaxial, kUniaxial, 2, 1.0}, Case{MaterialTest::equibiaxial, kEquibiaxial, 0, 0.5},
          Case{MaterialTest::planar, kPlanar, 2, 1.0}}) {
      for (const double stretch : {0.7, 0.95, 1.05, 1.4}) {
        const double exact =
            c.share * std::visit([&](const auto& l) { return incompressible(l, c.stretches, stretch); }, law);
        const MaterialState s = after(of_law(law, 3e11), c.test, kStretch, stretch);
        EXPECT_NEAR(s.nominal(c.axis, c.axis), exact, 1e-6 * std::abs(exact)) << law_name(law) << ", λ = " << stretch;
      }
    }
  }
}

// Equal stretches leave the bulk alone: σ = κ (J − 1) I of every hyperelastic law, by stretch and by stress.
TEST(MaterialPoint, VolumetricTestIsTheBulkModulus) {
  for (const HyperelasticLaw& law : test::every_hyperelastic_law()) {
    for (const double stretch : {0.8, 0.99, 1.1}) {
      const double J = stretch * stretch * stretch, exact = test::kExampleBulk * (J - 1.0);
      const Tissue tissue = of_law(law, test::kExampleBulk);
      const MaterialState s = after(tissue, MaterialTest::volumetric, kStretch, stretch);
      EXPECT_NEAR(s.cauchy(0, 0), exact, 1e-10 * std::abs(exact)) << law_name(law);
      const MaterialState back = after(tissue, MaterialTest::volumetric, kStress, s.nominal(0, 0));
      EXPECT_NEAR(back.deformation(1, 1), stretch, 1e-10) << law_name(law);
    }
  }
}

// Hooke's law in its three strains: P = E ε, E (λ² − 1)/2 · λ with Green's, E (λ − 1) with Biot's; sides by ν of the same strain.
TEST(MaterialPoint, LinearTissueInThreeStrains) {
  const double E = 3600.0, nu = 0.4;
  for (const double stretch : {0.8, 1.001, 1.3}) {
    Tissue tissue;
    const MaterialState small = after(tissue, MaterialTest::uniaxial, kStretch, stretch);
    EXPECT_NEAR(small.nominal(2, 2), E * (stretch - 1.0), 1e-10 * E);
    EXPECT_NEAR(small.deformation(0, 0), 1.0 - nu * (stretch - 1.0), 1e-12);
    tissue.kinematics = Kinematics::corotational;
    const MaterialState biot = after(tissue, MaterialTest::uniaxial, kStretch, stretch);
    EXPECT_NEAR(biot.nominal(2, 2), E * (stretch - 1.0), 1e-10 * E);
    EXPECT_NEAR(biot.deformation(0, 0), 1.0 - nu * (stretch - 1.0), 1e-12);
    tissue.kinematics = Kinematics::green;
    const MaterialState green = after(tissue, MaterialTest::uniaxial, kStretch, stretch);
    const double strain = 0.5 * (stretch * stretch - 1.0);
    EXPECT_NEAR(green.nominal(2, 2), stretch * E * strain, 1e-10 * E);
    EXPECT_NEAR(green.deformation(0, 0), std::sqrt(1.0 - 2.0 * nu * strain), 1e-12);
  }
}

// A stiffness law acts on the shape of the very deformation that it makes: E(s) ε with s of the stretches found.
TEST(MaterialPoint, StiffnessLawsFollowTheShape) {
  for (const StiffnessLaw& law : test::every_stiffness_law()) {
    Tissue tissue;
    tissue.youngs_modulus = test::kExampleModulus, tissue.law = law;
    for (const double stretch : {0.7, 1.05, 1.4}) {
      const MaterialState s = after(tissue, MaterialTest::uniaxial, kStretch, stretch);
      const double a = s.deformation(0, 0), c = stretch;
      const double q = 3.0 * std::pow(a * a * c, 2.0 / 3.0) / (2.0 * a * a + c * c);
      const double shear = std::sqrt(1.5 * (1.0 - q));
      const double E = lame_at(tissue, shear).mu * 2.0 * (1.0 + tissue.poisson_ratio);
      EXPECT_NEAR(s.nominal(2, 2), E * (stretch - 1.0), 1e-8 * E) << law_name(law);
      EXPECT_NEAR(a, 1.0 - tissue.poisson_ratio * (stretch - 1.0), 1e-10) << law_name(law);
    }
  }
}

bool has_point(const Tissue& t) { return !test::has_directions(t); }

// Stress that was read can be prescribed: every tissue comes back to its stretch, in every test. 1e-8: the roots of both are
// found to 1e-12 of the stress. Where only the volume changes, s is the root of a rounding error, 1e-8, and a law's modulus errs by
// that times its slope: 1e-7.
TEST(MaterialPoint, StressAndStretchAreInverse) {
  int tissues = 0;
  for (const Tissue& tissue : test::every_tissue()) {
    if (!has_point(tissue)) continue;
    ++tissues;
    for (const auto& word : kWords<MaterialTest>) {
      const bool shear = word.value == MaterialTest::simple_shear;
      const bool alike = word.value == MaterialTest::equibiaxial || word.value == MaterialTest::volumetric;
      if (alike && tissue.fibres) continue;  // stresses that differ between axes are not those of one value
      const double value = shear ? 0.15 : 1.08;
      const std::size_t i = word.value == MaterialTest::equibiaxial || shear ? 0 : 2, j = shear ? 2 : i;
      const MaterialState there = after(tissue, word.value, kStretch, value);
      const MaterialState back = after(tissue, word.value, kStress, there.nominal(i, j));
      const bool same = tissue.viscosity == 0.0 && tissue.maxwell.empty();  // else the way there is another
      const double within = word.value == MaterialTest::volumetric ? 1e-7 : 1e-8;
      EXPECT_NEAR(back.nominal(i, j), there.nominal(i, j), within * std::abs(there.nominal(i, j)))
          << tissue.name << ", " << word.word;
      if (same) {
        EXPECT_NEAR(back.deformation(i, j), value, within) << tissue.name << ", " << word.word;
      }
    }
  }
  EXPECT_GT(tissues, 60);
}

// Along a free path the work of the driven stress is the change of W: P = dW/dλ with the sides where they are (their stress is 0).
TEST(MaterialPoint, StressIsTheSlopeOfTheEnergy) {
  const double h = 1e-4;
  for (const Tissue& tissue : test::every_tissue()) {
    if (!has_point(tissue) || !test::is_conservative(tissue) || tissue.viscosity > 0.0 || !tissue.maxwell.empty())
      continue;
    const Response response(tissue);
    ElementShape shape;
    if (tissue.fibres) shape.fibre = unit(tissue.fibres->direction);
    const auto energy = [&](double stretch) {
      const MaterialState s = after(tissue, MaterialTest::uniaxial, kStretch, stretch);
      return response.energy(sum(s.deformation, scaled(identity<double>(), -1.0)), shape);
    };
    const double slope = (energy(1.2 + h) - energy(1.2 - h)) / (2.0 * h);
    const double P = after(tissue, MaterialTest::uniaxial, kStretch, 1.2).nominal(2, 2);
    EXPECT_NEAR(slope, P, 1e-5 * P) << tissue.name;  // h² and the digits of a difference of energies
  }
}

Tissue relaxing(double share, double time) {
  Tissue t;
  t.maxwell = {{share, time}}, t.maxwell_part = MaxwellPart::all;
  return t;
}

// A step of stretch that is held: P = E ε (1 − g (1 − e^(−t/τ))), in steps of any length. 1e-7: the step takes 1e-9 of the first time.
TEST(MaterialPoint, RelaxesAsItsBranches) {
  const double g = 0.6, tau = 2.0, strain = 0.1;
  const std::vector<double> times{0.0, 0.5, 1.0, 4.0, 40.0}, stretch(times.size(), 1.0 + strain);
  const std::vector<MaterialState> held =
      material_test(relaxing(g, tau), MaterialTest::uniaxial, kStretch, times, stretch);
  ASSERT_EQ(held.size(), times.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double exact = 3600.0 * strain * (1.0 - g * -std::expm1(-times[k] / tau));
    EXPECT_NEAR(held[k].nominal(2, 2), exact, 1e-7 * exact) << times[k];
  }
}

// The compliance is the inverse of the relaxation: ε = σ/E (1 + g/(1 − g) (1 − e^(−t (1−g)/τ))) after a step of stress; the error of
// steps falls by four when they are halved.
TEST(MaterialPoint, CreepIsTheInverseOfRelaxation) {
  const double g = 0.6, tau = 2.0, stress = 200.0;
  const std::vector<double> times{0.0, 1.0, 3.0, 10.0}, values(times.size(), stress);
  const auto worst = [&](std::size_t between) {
    const std::vector<MaterialState> creep =
        material_test(relaxing(g, tau), MaterialTest::uniaxial, kStress, times, values, between);
    double most = 0.0;
    for (std::size_t k = 1; k < times.size(); ++k) {
      const double exact = stress / 3600.0 * (1.0 + g / (1.0 - g) * -std::expm1(-times[k] * (1.0 - g) / tau));
      most = std::max(most, std::abs(creep[k].deformation(2, 2) - 1.0 - exact) / exact);
    }
    return most;
  };
  EXPECT_LT(worst(1000), 1e-6);
  EXPECT_NEAR(worst(50) / worst(100), 4.0, 0.3);
}

// Kelvin–Voigt under a step of shear stress: γ = τ/μ (1 − e^(−μ t/η)), of second order in the step.
TEST(MaterialPoint, KelvinVoigtCreeps) {
  Tissue tissue;
  tissue.viscosity = 800.0;
  const double mu = tissue.lame().mu, stress = 100.0;
  const std::vector<double> times{0.0, 0.2, 0.6, 2.0}, values(times.size(), stress);
  const auto worst = [&](std::size_t between) {
    const std::vector<MaterialState> creep =
        material_test(tissue, MaterialTest::simple_shear, kStress, times, values, between);
    double most = 0.0;
    for (std::size_t k = 1; k < times.size(); ++k) {
      const double exact = stress / mu * -std::expm1(-mu * times[k] / tissue.viscosity);
      most = std::max(most, std::abs(creep[k].deformation(0, 2) - exact) / exact);
    }
    return most;
  };
  EXPECT_LT(worst(1000), 1e-6);
  EXPECT_NEAR(worst(50) / worst(100), 4.0, 0.3);
}

// Along the specimen of the fit (uniaxial_path.h), which has short formulas of its own, all parts of the stress are the same.
TEST(MaterialPoint, IsTheSpecimenOfAFit) {
  for (Tissue tissue : test::every_tissue()) {
    if (!has_point(tissue) || tissue.fibres) continue;
    MaterialPoint point(tissue);
    UniaxialPath path(tissue);
    const double h = 0.02, speed = 2.0;
    path.start(speed);
    for (int k = 1; k <= 8; ++k) {
      const double start = 1.0 + speed * h * (k - 1), end = 1.0 + speed * h * k;
      const UniaxialState s = path.advance(h, {start + UniaxialPath::kMiddle * (end - start), speed}, {end, speed});
      const MaterialState& p = point.advance(h, test_targets(MaterialTest::uniaxial, kStretch, end));
      ASSERT_TRUE(s.converged && p.converged) << tissue.name << p.message;
      EXPECT_NEAR(p.nominal(2, 2), s.stress, 1e-6 * std::abs(s.stress)) << tissue.name;
      EXPECT_NEAR(p.deformation(0, 0), s.lateral_stretch, 1e-7) << tissue.name;
    }
  }
}

// The engine in double precision: a cube whose vertices move as F says pushes on its faces with P, of every tissue, after a history.
TEST(MaterialPoint, IsABodyOfTets) {          // long
  constexpr double kSpeed = 1.5, end = 0.06;  // 9 % of shear
  constexpr int steps = 600;
  const TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  for (Tissue tissue : test::every_tissue()) {
    if (!has_point(tissue)) continue;
    tissue.density = 1e6;  // all vertices are led: inertia moves nothing, and the stable step is long
    MaterialPoint point(tissue);
    MaterialTargets targets;
    Simulation body(mesh, {{0, tissue}}, {.step = end / steps, .precision = Precision::double_precision});
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      const std::array<std::uint32_t, 1> one{v};
      body.drive(one, [&mesh, v](double t) {
        const Vec3d& x = mesh.vertices[v];
        return Vec3d{0.5 * kSpeed * t * x.x + kSpeed * t * x.z, 0.0, -0.4 * kSpeed * t * x.z};
      });
    }
    for (int k = 1; k <= steps; ++k) {
      test::must_step(body);
      const double t = kSpeed * end * k / steps;
      targets(0, 0).value = 1.0 + 0.5 * t, targets(0, 2).value = t, targets(2, 2).value = 1.0 - 0.4 * t;
      ASSERT_TRUE(point.advance(end / steps, targets).converged);
    }
    const TetFields fields = body.tet_fields();
    Mat3d mean{};
    for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
      for (std::size_t i = 0; i < 9; ++i)
        mean(i / 3, i % 3) += fields.piola[9 * e + i] / static_cast<double>(mesh.tets.size());
    }
    EXPECT_LE(test::apart(mean, point.state().nominal), 1e-5 * test::size_of(mean)) << tissue.name;
  }
}

// What cannot be is refused by name; a stress that no stretch carries ends the test with its message and the last state.
TEST(MaterialPoint, RefusesBadInput) {
  const auto message = [](const std::function<void()>& call) -> std::string {
    try {
      call();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  };
  Tissue raw;
  raw.law = LinearLaw{1000.0}, raw.measure = DeformationMeasure::regular_mean_ratio;
  EXPECT_NE(message([&] { MaterialPoint point(raw); }).find("regular_mean_ratio"), std::string::npos);
  MaterialPoint point{Tissue{}};
  MaterialTargets both;
  both(0, 1) = both(1, 0) = {kStress, 0.0};
  EXPECT_NE(message([&] { point.advance(1.0, both); }).find("P_xy and P_yx"), std::string::npos);
  EXPECT_NE(message([&] { point.advance(0.0, {}); }).find("h = 0 s"), std::string::npos);
  MaterialTargets gone;
  gone(1, 1).value = 0.0;
  EXPECT_NE(message([&] { point.advance(1.0, gone); }).find("F_yy = 0"), std::string::npos);
  const std::vector<double> back{1.0, 0.5}, two{1.1, 1.2};
  EXPECT_NE(message([&] { material_test(Tissue{}, MaterialTest::uniaxial, kStretch, back, two); }).find("time 2"),
            std::string::npos);
  EXPECT_NE(message([&] {
              material_test(Tissue{}, MaterialTest::uniaxial, kStretch, {&two[0], 1}, two);
            }).find("1 times and 2"),
            std::string::npos);

  // St Venant–Kirchhoff bears no more than E/(3√3) of compression: beyond it the curve turns.
  Tissue green;
  green.kinematics = Kinematics::green;
  const std::vector<double> times{1.0, 2.0}, load{-500.0, -1200.0};
  const std::vector<MaterialState> states = material_test(green, MaterialTest::uniaxial, kStress, times, load);
  ASSERT_EQ(states.size(), 2U);
  EXPECT_TRUE(states[0].converged);
  EXPECT_FALSE(states[1].converged);
  EXPECT_NE(states[1].message.find("at 2 s"), std::string::npos) << states[1].message;
  EXPECT_EQ(states[1].deformation, states[0].deformation);
}

}  // namespace
}  // namespace glisson
