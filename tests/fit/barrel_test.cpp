// barrel_test.cpp — a cylinder between plates with friction against exact states, closed forms and the limits of its law.
#include "fit/forward/barrel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fit/forward/barrel_model.h"
#include "material/uniaxial_path.h"

namespace glisson::fit::barrel_test {
namespace {

constexpr double kRadius = 0.025, kHeight = 0.03;

const HyperelasticLaw kYeoh = Yeoh{.c1 = 927, .c2 = 71, .c3 = 39, .bulk_modulus = 2e6};

double homogeneous_pressure(const HyperelasticLaw& law, double strain) {
  Tissue tissue;
  tissue.hyperelastic = law;
  UniaxialPath path(tissue);
  path.start(0.0);
  return -path.at(1.0 - strain).stress;
}

/// Force over that of the homogeneous state at each strain.
std::vector<double> factors(const HyperelasticLaw& law, Faces faces, Grip grip, const std::vector<double>& strains,
                            double radius = kRadius, const BarrelGrid& grid = {}) {
  Barrel barrel(std::make_shared<BarrelMesh>(radius, kHeight, grid), law, faces, grip);
  std::vector<double> all;
  for (const double strain : strains) {
    const double pressure = homogeneous_pressure(law, strain);
    all.push_back(barrel.press(strain * kHeight, pressure) / (pressure * std::numbers::pi * radius * radius));
  }
  return all;
}

const std::vector<double> kStrains{0.1, 0.2, 0.3, 0.4, 0.5, 0.58, 0.65};

// Smooth faces: the exact state is homogeneous, and elements of every law hold it to the rounding of Newton's last step.
TEST(Barrel, OnSmoothFacesIsHomogeneous) {
  for (const HyperelasticLaw& law :
       std::initializer_list<HyperelasticLaw>{NeoHookean{1000, 1e6}, kYeoh, Ogden{{1500, 300}, {-3, 5}, 1e5},
                                              VerondaWestmann{.c = 1000, .b = 0.7, .bulk_modulus = 1e6}}) {
    for (const double f : factors(law, Faces::smooth, {}, kStrains)) EXPECT_NEAR(f, 1.0, 1e-8) << law_name(law);
    for (const double f : factors(law, Faces::friction, {}, kStrains)) EXPECT_NEAR(f, 1.0, 1e-8) << law_name(law);
  }
}

// Little strain and full slip: by the reciprocal theorem, with the homogeneous state as the second,
// F d − f F e ⅔ R 2ν = F₀ d, so that F/F₀ = 1/(1 − 4/3 ν f R/H), exact for every f below that of sticking. The friction of
// the model is smooth, x/√(1 + x²) with x near 50: 3e-4 of it is missing; strains of 1e-3 add as much.
TEST(Barrel, FrictionOfLittleStrainIsTheReciprocalTheorems) {
  for (const double f : {0.02, 0.05, 0.1}) {
    const double exact = 1.0 / (1.0 - 2.0 / 3.0 * f * kRadius / kHeight);
    EXPECT_NEAR(factors(kYeoh, Faces::friction, {.friction = f}, {1e-3}).front() - 1.0, exact - 1.0,
                0.01 * (exact - 1.0))
        << f;
  }
  // adhesion: F d − ⅔ τ A R e = F₀ d
  const double pressure = homogeneous_pressure(kYeoh, 1e-3), exact = 2.0 / 3.0 * 0.1 * kRadius / kHeight / pressure;
  EXPECT_NEAR(factors(kYeoh, Faces::friction, {.adhesion = 0.1}, {1e-3}).front() - 1.0, exact, 0.01 * exact);
}

// Bonded thin disks of incompressible rubber have E_a → 2 E S², S = R/(2H) [GentLindley1959]: the pressure of a film between
// plates that approach, 1 + 2S² near enough where S is large. The edge disturbs a ring as wide as the disk is high: the
// difference falls in proportion to 1/S, and is below 2 % at S = 10.
TEST(Barrel, BondedThinDisksAreFilms) {
  const HyperelasticLaw law = NeoHookean{1000, 1e10};
  const auto excess = [&](double shape) {
    const BarrelGrid grid{.radial = 10, .axial = 3, .grading = 0.7};
    const double factor = factors(law, Faces::bonded, {}, {1e-4}, 2.0 * shape * kHeight, grid).front();
    return factor / (1.0 + 2.0 * shape * shape) - 1.0;
  };
  const double five = excess(5.0), ten = excess(10.0);
  EXPECT_LT(std::abs(ten), 0.02);
  EXPECT_NEAR(ten / five, 0.5, 0.15);
}

// Friction beyond what it takes to stick is a bond, less friction resists less, at every strain.
TEST(Barrel, FrictionLeadsFromSmoothToBonded) {
  const std::vector<double> bonded = factors(kYeoh, Faces::bonded, {}, kStrains);
  const std::vector<double> sticking = factors(kYeoh, Faces::friction, {.friction = 5.0}, kStrains);
  for (std::size_t i = 0; i < bonded.size(); ++i) EXPECT_NEAR(sticking[i] / bonded[i], 1.0, 0.005) << kStrains[i];
  std::vector<double> less(kStrains.size(), 1.0);
  for (const double f : {0.05, 0.1, 0.2, 0.4}) {
    const std::vector<double> more = factors(kYeoh, Faces::friction, {.friction = f}, kStrains);
    for (std::size_t i = 0; i < more.size(); ++i) {
      EXPECT_GT(more[i], less[i]) << f << " " << kStrains[i];
      EXPECT_LT(more[i], bonded[i]) << f << " " << kStrains[i];
    }
    less = more;
  }
}

// Twice as many elements, smaller at the edge, change the force by less than 1 % to 65 %, and by less than 0.3 % below 25 %,
// where the side has not come to lie on the plate.
TEST(Barrel, IsConvergedInItsGrid) {
  const BarrelGrid fine{.radial = 6, .axial = 5, .grading = 0.7};
  for (const auto& [faces, friction] : {std::pair{Faces::bonded, 0.0}, std::pair{Faces::friction, 0.1}}) {
    const std::vector<double> a = factors(kYeoh, faces, {.friction = friction}, kStrains),
                              b = factors(kYeoh, faces, {.friction = friction}, kStrains, kRadius, fine);
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_NEAR(a[i] / b[i], 1.0, kStrains[i] < 0.25 ? 0.005 : 0.02) << kStrains[i] << " " << friction;
  }
}

Curve ramp(double strain, int points) {
  Curve c;
  c.name = "ramp";
  for (int i = 0; i < points; ++i) {
    c.time.push_back(i);
    c.displacement.push_back(strain * kHeight * i / (points - 1));
  }
  c.force.assign(c.size(), 0.0);
  return c;
}

// Between the strains at which the barrel is solved the model's cubic is within 0.3 % of it.
TEST(BarrelModel, LiesOnTheBarrelsCurve) {
  Tissue tissue;
  tissue.hyperelastic = kYeoh;
  const Curve curve = ramp(0.62, 32);
  const BarrelModel model({curve}, {kRadius, kHeight, Faces::friction, {.friction = 0.1}},
                          [&](std::span<const double>) { return tissue; }, {});
  const Prediction p = model.predict(0, {});
  ASSERT_EQ(p.failure, "");
  Barrel barrel(std::make_shared<BarrelMesh>(kRadius, kHeight), kYeoh, Faces::friction, {.friction = 0.1});
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const double d = curve.displacement[i], exact = barrel.press(d, homogeneous_pressure(kYeoh, d / kHeight));
    EXPECT_NEAR(p.force[i] / exact, 1.0, 0.003) << d / kHeight;
  }
}

// What it cannot follow is told: a tissue without a hyperelastic law, and a press to nothing.
TEST(BarrelModel, RefusesWhatItCannotFollow) {
  const auto failure = [](const Tissue& tissue, double strain) {
    const BarrelModel model({ramp(strain, 10)}, {kRadius, kHeight, Faces::bonded, {}},
                            [&](std::span<const double>) { return tissue; }, {});
    return model.predict(0, {}).failure;
  };
  Tissue tissue;
  EXPECT_NE(failure(tissue, 0.3).find("is not hyperelastic"), std::string::npos);
  tissue.hyperelastic = kYeoh;
  EXPECT_NE(failure(tissue, 0.97).find("allowed: 0 to 0.95"), std::string::npos);
}

}  // namespace
}  // namespace glisson::fit::barrel_test
