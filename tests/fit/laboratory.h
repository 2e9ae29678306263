// laboratory.h — tests of a material point and their closed forms, for the tests of a laboratory's tests.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "fit/forward/specimen_model.h"

namespace glisson::fit::laboratory {

inline constexpr double kMu = 1000.0, kC01 = 250.0, kBulk = 1e10;  // κ = 1e7 μ: 1e-7 of a stress is left of the volume

inline Tissue neo_hooke() {
  Tissue tissue;
  tissue.hyperelastic = NeoHookean{kMu, kBulk};
  return tissue;
}

inline Tissue mooney() {
  Tissue tissue;
  tissue.hyperelastic = MooneyRivlin{0.5 * kMu - kC01, kC01, kBulk};
  return tissue;
}

/// A test of a point: `driven` is a strain, of a shear its amount, of a creep a stress.
inline Curve test_of(LabTest test, Deforming deforming, Measured measured, std::vector<double> driven) {
  Curve c;
  c.name = std::string(word_of(test));
  c.measurement = {.test = test, .deforming = deforming, .measured = measured, .point = true, .unit = "Pa"};
  for (std::size_t i = 0; i < driven.size(); ++i) c.time.push_back(static_cast<double>(i));
  c.displacement = std::move(driven);
  c.force.assign(c.size(), 0.0);
  return c;
}

inline std::vector<double> answer(const Tissue& tissue, const Curve& curve) {
  const SpecimenModel model({curve}, {1.0, 1.0}, [&](std::span<const double>) { return tissue; });
  const Prediction p = model.predict(0, {});
  EXPECT_EQ(p.failure, "");
  EXPECT_EQ(p.force.size(), curve.size());
  return p.force;
}

struct Form {
  const char* name;
  Deforming deforming;
  double side;  ///< 1: extends
  /// Nominal stress of Mooney and Rivlin, W = c10 (I₁ − 3) + c01 (I₂ − 3), at a stretch or amount of shear [Rivlin1949].
  double (*stress)(double x, double c10, double c01);
};

inline double tension(double x, double c10, double c01) { return 2.0 * (x - 1.0 / (x * x)) * (c10 + c01 / x); }
inline double equibiaxial(double x, double c10, double c01) {
  return 2.0 * (x - std::pow(x, -5)) * (c10 + c01 * x * x);
}
inline double planar(double x, double c10, double c01) { return 2.0 * (x - std::pow(x, -3)) * (c10 + c01); }
inline double shear(double x, double c10, double c01) { return 2.0 * (c10 + c01) * x; }

inline const std::vector<Form> kForms{{"tension", Deforming::tension, 1.0, tension},
                                      {"compression", Deforming::compression, -1.0, tension},
                                      {"equibiaxial", Deforming::equibiaxial, 1.0, equibiaxial},
                                      {"planar", Deforming::planar, 1.0, planar},
                                      {"simple_shear", Deforming::simple_shear, 1.0, shear}};

inline LabTest test_named(const std::string& name) {
  for (const Word<LabTest>& w : kWords<LabTest>) {
    if (w.word == name) return w.value;
  }
  return LabTest::compression;
}

inline Tissue relaxing() {
  Tissue tissue = neo_hooke();
  tissue.hyperelastic = NeoHookean{kMu, 1e7};
  tissue.maxwell = {{0.4, 2.0}, {0.3, 30.0}};
  return tissue;
}

/// Columns as a file of them.
inline std::string table(const std::vector<std::string>& names, const std::vector<std::vector<double>>& columns) {
  std::ostringstream out;
  out.precision(12);
  for (std::size_t c = 0; c < names.size(); ++c) out << (c ? "," : "") << names[c];
  out << '\n';
  for (std::size_t i = 0; i < columns[0].size(); ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) out << (c ? "," : "") << columns[c][i];
    out << '\n';
  }
  return out.str();
}

}  // namespace glisson::fit::laboratory
