// barrel_model_test.cpp — the forward model of a cylinder that clings to its plates, against the barrel itself and what it cannot
// follow.
#include "fit/forward/barrel_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lab/yeoh_cylinder.h"

namespace glisson::fit::barrel_model_test {
namespace {

using namespace test::yeoh_cylinder;

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
  const BarrelModel model({curve}, {kRadius, kHeight, lab::Faces::friction, {.friction = 0.1}},
                          [&](std::span<const double>) { return tissue; }, {});
  const Prediction p = model.predict(0, {});
  ASSERT_EQ(p.failure, "");
  lab::Barrel barrel(std::make_shared<lab::BarrelMesh>(kRadius, kHeight), kYeoh, lab::Faces::friction,
                     {.friction = 0.1});
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const double d = curve.displacement[i], exact = barrel.press(d, homogeneous_pressure(kYeoh, d / kHeight));
    EXPECT_NEAR(p.force[i] / exact, 1.0, 0.003) << d / kHeight;
  }
}

/// A test of the model's own specimen, to an extension: < 0 compresses.
Curve along(LabTest test, double extension, int points = 24) {
  Curve c = ramp(std::abs(extension), points);
  c.name = std::string(word_of(test));
  c.measurement.test = test;
  c.measurement.deforming = extension < 0.0 ? Deforming::compression : Deforming::tension;
  return c;
}

Tissue yeoh() {
  Tissue tissue;
  tissue.hyperelastic = kYeoh;
  return tissue;
}

// Tests to either side share one φ: pressed and pulled in one fit each has the force of its own barrel within 0.3 %, a cycle through
// rest both of them, and torsion of the same specimen that of one with free faces, to the bit.
TEST(BarrelModel, ServesBothSidesOfRest) {
  Curve cycle = along(LabTest::cyclic, 0.3);
  for (std::size_t i = 0; i < cycle.size(); ++i)
    cycle.displacement[i] = 0.3 * kHeight * std::sin(2.0 * std::numbers::pi * static_cast<double>(i) / 23.0);
  Curve twist = along(LabTest::torsion, 0.3);
  twist.measurement.deforming = Deforming::torsion, twist.measurement.measured = Measured::torque;
  const std::vector<Curve> curves{along(LabTest::compression, -0.3), along(LabTest::tension, 0.6), cycle, twist};
  const TissueAt tissue = [](std::span<const double>) { return yeoh(); };
  const BarrelModel model(curves, {kRadius, kHeight, lab::Faces::bonded, {}}, tissue);
  const SpecimenModel free(curves, {std::numbers::pi * kRadius * kRadius, kHeight, kRadius}, tissue);
  const auto exact = [](double extension) {
    lab::Barrel barrel(std::make_shared<lab::BarrelMesh>(kRadius, kHeight), kYeoh, lab::Faces::bonded);
    return -barrel.press(-extension, std::abs(homogeneous_pressure(kYeoh, -extension / kHeight)));
  };
  for (std::size_t c = 0; c < 3; ++c) {
    const Prediction p = model.predict(c, {});
    ASSERT_EQ(p.failure, "");
    const double outward = curves[c].measurement.outward();
    for (std::size_t i = 1; i + 1 < curves[c].size(); i += 4) {
      const double extension = outward * curves[c].displacement[i], force = outward * exact(extension);
      EXPECT_NEAR(p.force[i], force, 0.003 * std::abs(force)) << curves[c].name << " " << extension / kHeight;
    }
  }
  EXPECT_EQ(model.predict(3, {}).force, free.predict(3, {}).force);
}

// Creep between bonded faces is the inverse of tension and compression between them: under the forces that an elastic specimen
// answers with it has the displacements it answered to, within 1e-6 of its height.
TEST(BarrelModel, CreepsAsItIsPulled) {
  for (const double extension : {-0.3, 0.5}) {
    const TissueAt tissue = [](std::span<const double>) { return yeoh(); };
    const Plates plates{kRadius, kHeight, lab::Faces::bonded, {}};
    Curve driven = along(LabTest::tension, extension), loaded = along(LabTest::creep, extension);
    driven.measurement.test = extension < 0.0 ? LabTest::compression : LabTest::tension;
    loaded.measurement.measured = Measured::strain;
    loaded.force = driven.displacement;
    // φ is known a fifth beyond a creep's own strains: as far as here
    Curve farther = along(driven.measurement.test, 1.2 * extension);
    loaded.displacement = BarrelModel({driven, farther}, plates, tissue).predict(0, {}).force;
    const Prediction p = BarrelModel({loaded}, plates, tissue).predict(0, {});
    ASSERT_EQ(p.failure, "");
    for (std::size_t i = 0; i < p.force.size(); ++i)
      EXPECT_NEAR(p.force[i], driven.displacement[i], 1e-6 * kHeight) << extension << " " << i;
  }
}

// Friction has no meaning where plates pull, nor on the way back; true stress none where the section is not one.
TEST(BarrelModel, NamesTestsThatItsPlatesCannotMake) {
  const auto fault = [](Curve curve, lab::Faces faces, Measured measured = Measured::nominal) -> std::string {
    curve.measurement.measured = measured;
    try {
      BarrelModel({curve}, {kRadius, kHeight, faces, {.friction = 0.1}}, [](std::span<const double>) { return yeoh(); },
                  {});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no fault";
  };
  EXPECT_NE(fault(along(LabTest::relaxation, 0.2), lab::Faces::friction).find("faces = \"bonded\""), std::string::npos);
  EXPECT_NE(fault(along(LabTest::cyclic, -0.2), lab::Faces::friction).find("crop the file to its loading"),
            std::string::npos);
  EXPECT_NE(fault(along(LabTest::tension, 0.2), lab::Faces::bonded, Measured::cauchy).find("give columns.stress"),
            std::string::npos);
  EXPECT_EQ(fault(along(LabTest::relaxation, -0.2), lab::Faces::friction), "no fault");
}

// What it cannot follow is told: a tissue without a hyperelastic law, and a press to nothing.
TEST(BarrelModel, RefusesWhatItCannotFollow) {
  const auto failure = [](const Tissue& tissue, double strain) {
    const BarrelModel model({ramp(strain, 10)}, {kRadius, kHeight, lab::Faces::bonded, {}},
                            [&](std::span<const double>) { return tissue; }, {});
    return model.predict(0, {}).failure;
  };
  Tissue tissue;
  EXPECT_NE(failure(tissue, 0.3).find("is not hyperelastic"), std::string::npos);
  tissue.hyperelastic = kYeoh;
  EXPECT_NE(failure(tissue, 0.97).find("allowed: 0.05 to 5"), std::string::npos);
}

}  // namespace
}  // namespace glisson::fit::barrel_model_test
