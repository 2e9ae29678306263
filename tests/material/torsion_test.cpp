// Torsion of a cylinder has the torque and the axial force of Rivlin's closed forms, the torque of Saint-Venant where the twist is
// small, and relaxes as simple shear does.
#include "glisson/torsion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "glisson/material_point.h"
#include "material/every_tissue.h"

namespace glisson {
namespace {

constexpr double kRadius = 0.012;
constexpr double kPi = std::numbers::pi;

TorsionState twisted(const Tissue& tissue, double twist, const TorsionOptions& options = {}) {
  const double time = 1.0;
  return torsion(tissue, kRadius, {&time, 1}, {&twist, 1}, options).front();
}

Tissue of_law(const HyperelasticLaw& law) {
  Tissue tissue;
  tissue.hyperelastic = law;
  return tissue;
}

// Mooney–Rivlin, and neo-Hooke with c₀₁ = 0 and c₁₀ = μ/2:
//   T = π (c₁₀ + c₀₁) φ R⁴,   N = −½ π (c₁₀ + 2 c₀₁) φ² R⁴     [Rivlin1949]
// The tangential stress is linear in r and the normal one of second order, so that two Gauss points are enough; 1e-6.
TEST(Torsion, ClosedFormsOfRivlin) {
  const double fourth = std::pow(kRadius, 4);
  for (const double c01 : {0.0, 150.0, 400.0}) {
    const double c10 = 500.0;
    const Tissue tissue = c01 == 0.0 ? of_law(NeoHookean{2.0 * c10, 1e9}) : of_law(MooneyRivlin{c10, c01, 1e9});
    for (const double shear : {-0.3, 1e-3, 0.5, 2.0}) {
      const double twist = shear / kRadius;
      const double torque = kPi * (c10 + c01) * twist * fourth;
      const double force = -0.5 * kPi * (c10 + 2.0 * c01) * twist * twist * fourth;
      for (const std::size_t radii : {2, 12, 64}) {
        const TorsionState s = twisted(tissue, twist, {.radii = radii});
        EXPECT_NEAR(s.torque, torque, 1e-6 * std::abs(torque)) << c01 << ", γ = " << shear;
        EXPECT_NEAR(s.axial_force, force, 1e-6 * std::abs(force)) << c01 << ", γ = " << shear;
      }
    }
  }
}

// Stretched by λ, with φ on the length at rest: T = ½ π μ φ R⁴/λ, N = π μ R² (λ − λ⁻² − φ² R²/(4 λ²)) of incompressible neo-Hooke.
// κ = 10⁸ μ: 1e-6.
TEST(Torsion, OfAStretchedCylinder) {
  const double mu = 1000.0, square = kRadius * kRadius;
  for (const double stretch : {0.7, 1.1, 1.5}) {
    for (const double shear : {0.0, 0.4}) {
      const double twist = shear / kRadius;
      const TorsionState s = twisted(of_law(NeoHookean{mu, 1e11}), twist, {.stretch = stretch});
      const double torque = 0.5 * kPi * mu * twist * square * square / stretch;
      const double inverse = 1.0 / (stretch * stretch);
      const double force = kPi * mu * square * (stretch - inverse - 0.25 * twist * twist * square * inverse);
      EXPECT_NEAR(s.torque, torque, 1e-6 * torque) << stretch;
      EXPECT_NEAR(s.axial_force, force, 1e-6 * std::abs(force)) << stretch;
    }
  }
}

// Without twist the force is that of the uniaxial test, whatever the bulk modulus.
TEST(Torsion, WithoutTwistIsUniaxial) {
  for (const Tissue& tissue : test::every_tissue()) {
    if (test::has_directions(tissue) || tissue.fibres || tissue.viscosity > 0.0 || !tissue.maxwell.empty()) continue;
    const double time = 1.0, stretch = 1.1;
    const double P =
        material_test(tissue, MaterialTest::uniaxial, MaterialControl::deformation, {&time, 1}, {&stretch, 1})
            .front()
            .nominal(2, 2);
    const double force = twisted(tissue, 0.0, {.stretch = stretch}).axial_force, exact = kPi * kRadius * kRadius * P;
    EXPECT_NEAR(force, exact, 1e-9 * std::abs(exact)) << tissue.name;
  }
}

// A small twist: T = G J φ with J = π R⁴/2, of every tissue without a past. A shear of 1e-5 leaves the slope of a law and γ²: 1e-4.
TEST(Torsion, SmallTwistIsSaintVenants) {
  const double twist = 1e-5 / kRadius, J = 0.5 * kPi * std::pow(kRadius, 4);
  int tissues = 0;
  for (const Tissue& tissue : test::every_tissue()) {
    if (test::has_directions(tissue) || tissue.fibres || tissue.viscosity > 0.0 || !tissue.maxwell.empty()) continue;
    ++tissues;
    const double mu = tissue.hyperelastic ? tissue.lame().mu : lame_at(tissue, 0.0).mu;
    EXPECT_NEAR(twisted(tissue, twist).torque, mu * J * twist, 1e-4 * mu * J * twist) << tissue.name;
  }
  EXPECT_GT(tissues, 40);
}

// Where stress is proportional to shear, all shells relax alike: torque over time is that of simple shear, in every step; 1e-10. A twist
// at time 0 is applied at once.
TEST(Torsion, RelaxesAsSimpleShear) {
  Tissue branches, viscous;
  branches.maxwell = {{0.4, 0.5}, {0.3, 10.0}};
  viscous.viscosity = 300.0;
  const double shear = 0.1, J = 0.5 * kPi * std::pow(kRadius, 4);
  const std::vector<double> times{0.0, 0.2, 0.4, 1.0, 5.0, 60.0}, shears(times.size(), shear),
      twists(times.size(), shear / kRadius);
  for (const Tissue& tissue : {branches, viscous}) {
    const std::vector<TorsionState> held = torsion(tissue, kRadius, times, twists, {.between = 4});
    const std::vector<MaterialState> sheared =
        material_test(tissue, MaterialTest::simple_shear, MaterialControl::deformation, times, shears, 4);
    ASSERT_EQ(held.size(), times.size());
    for (std::size_t k = 0; k < times.size(); ++k) {
      const double torque = sheared[k].cauchy(0, 2) * J / kRadius;
      EXPECT_NEAR(held[k].torque, torque, 1e-10 * torque) << times[k];
      EXPECT_EQ(held[k].time, times[k]);
      EXPECT_EQ(held[k].twist, twists[k]);
    }
  }
}

// Along the axis fibres only add to the axial force what simple shear adds to theirs; one Gauss point is a rule, too.
TEST(Torsion, FibresAlongTheAxis) {
  Tissue tissue;
  tissue.kinematics = Kinematics::green;
  const double plain = twisted(tissue, 10.0, {.radii = 1}).axial_force;
  tissue.fibres = Fibres{.direction = {0.0, 0.0, 2.0}, .stiffness = 5000.0};
  EXPECT_GT(twisted(tissue, 10.0, {.radii = 1}).axial_force, plain);
}

// What cannot be is refused by name.
TEST(Torsion, RefusesBadInput) {
  const auto message = [](const std::function<void()>& call) -> std::string {
    try {
      call();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  };
  const std::vector<double> times{1.0, 2.0}, twists{1.0, 2.0}, endless{1.0, INFINITY};
  const auto of = [&](double radius, std::span<const double> values, const TorsionOptions& options) {
    return message([&] { torsion(Tissue{}, radius, times, values, options); });
  };
  EXPECT_NE(of(-0.01, twists, {}).find("radius = -0.01 m"), std::string::npos);
  EXPECT_NE(of(0.01, {twists.data(), 1}, {}).find("2 times and 1 values"), std::string::npos);
  EXPECT_NE(of(0.01, endless, {}).find("twist 2 is not finite"), std::string::npos);
  EXPECT_NE(of(0.01, twists, {.stretch = -1.0}).find("stretch = -1"), std::string::npos);
  EXPECT_NE(of(0.01, twists, {.between = 0}).find("between = 0"), std::string::npos);
  EXPECT_NE(of(0.01, twists, {.radii = 0}).find("radii = 0 is outside the allowed range, 1 to 256"), std::string::npos);
  Tissue across;
  across.fibres = Fibres{.direction = {1.0, 0.0, 1.0}, .stiffness = 100.0};
  EXPECT_NE(message([&] { torsion(across, 0.01, times, twists); }).find("not along z"), std::string::npos);
}

}  // namespace
}  // namespace glisson
