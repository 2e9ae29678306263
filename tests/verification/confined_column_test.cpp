// A column that cannot bulge is one-dimensional: ramp, creep and vibration against their closed forms.
//
// M = λ + 2 μ is the confined modulus, M_v that of the viscous tensor.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/column.h"
#include "support/must_step.h"

namespace glisson {
namespace {

double confined_modulus(const Tissue& t) { return t.lame().lambda + 2.0 * t.lame().mu; }

double confined_viscosity(const Tissue& t) {
  switch (t.viscous_tensor) {
    case ViscousTensor::shear:
      return 2.0 * t.viscosity;
    case ViscousTensor::deviatoric:
      return 4.0 / 3.0 * t.viscosity;
    case ViscousTensor::proportional:
    case ViscousTensor::pioletti:  // of large strain: tests/material
      break;
  }
  const double nu = t.poisson_ratio;
  return t.viscosity * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
}

using test::Column;

class ConfinedColumn : public testing::TestWithParam<ViscousTensor> {
 protected:
  Tissue tissue() const {
    Tissue t;
    t.viscosity = 1000.0;
    t.viscous_tensor = GetParam();
    return t;
  }
};

// Ramp: F/A = M v t / L + M_v v / L; the overhead is there at once and gone at once when the plate stops.
TEST_P(ConfinedColumn, RampHasTheViscousOverhead) {
  const Tissue t = tissue();
  const double M = confined_modulus(t), M_v = confined_viscosity(t), v = 0.01, stop = 0.1;
  Column column(t, 0.04, 4, 1, {});
  const ConstraintId plate = column.simulation.drive(column.top,
                                                     [=](double time) {
                                                       return Vec3d{0.0, 0.0, -v * std::min(time, stop)};
                                                     },
                                                     {false, false, true});
  double worst = 0.0;
  while (column.simulation.time() < 2.0 * stop) {
    const double time = column.simulation.time();
    test::must_step(column.simulation);
    const double pressure = -column.simulation.force(plate).total().z / column.area();
    const double expected = time < stop ? (M * v * time + M_v * v) / column.length : M * v * stop / column.length;
    // inertia diffuses away as exp(−π² M_v t / ρ L²), to 1e-4 within 3 ms at the smallest M_v
    const bool settled = (time > 0.003 && time < stop - 1e-4) || time > stop + 0.003;
    if (settled) worst = std::max(worst, std::abs(pressure / expected - 1.0));
  }
  EXPECT_LE(worst, 1e-3) << "largest relative error of the plate's pressure";
}

// Creep under a constant load: ε = (σ/M) (1 − e^(−t M / M_v)).
TEST_P(ConfinedColumn, CreepFollowsTheExponential) {  // long
  const Tissue t = tissue();
  const double M = confined_modulus(t), M_v = confined_viscosity(t), load = 100.0;
  Column column(t, 0.006, 2, 1, {});  // short, so that inertia, ρ L² / 2 M_v = 9 to 14 µs, stays below 1e-4 of M_v / M
  column.add_pressure(load);
  double worst = 0.0;
  while (column.simulation.time() < 3.0 * M_v / M) {
    test::must_step(column.simulation);
    const double time = column.simulation.time();
    const double strain = -column.top_displacement() / column.length;
    const double expected = load / M * (1.0 - std::exp(-time * M / M_v));
    if (time > 0.05 * M_v / M) worst = std::max(worst, std::abs(strain / expected - 1.0));
  }
  EXPECT_LE(worst, 1e-3) << "largest relative error of the strain";
}

std::string tensor_name(const testing::TestParamInfo<ViscousTensor>& tensor) {
  switch (tensor.param) {
    case ViscousTensor::shear:
      return "shear";
    case ViscousTensor::deviatoric:
      return "deviatoric";
    case ViscousTensor::proportional:
    case ViscousTensor::pioletti:  // of large strain: tests/material
      break;
  }
  return "proportional";
}

INSTANTIATE_TEST_SUITE_P(Tensors, ConfinedColumn,
                         testing::Values(ViscousTensor::shear, ViscousTensor::deviatoric, ViscousTensor::proportional),
                         tensor_name);

/// Relative error of the first natural frequency, π c_p / 2L, from the period of the free end.
double frequency_error(int cells) {
  const Tissue tissue;
  SimulationOptions options = test::in_double();
  const double L = 0.08, wave_speed = std::sqrt(confined_modulus(tissue) / tissue.density);
  options.step = 0.2 * L / cells / wave_speed;  // a fixed part of the cell's crossing time: both errors of second order
  Column column(tissue, L, cells, 2, options);
  std::vector<Vec3d> u;
  for (const Vec3d& x : column.mesh.vertices)
    u.push_back({0.0, 0.0, 1e-4 * std::sin(0.5 * std::numbers::pi * x.z / L)});
  column.simulation.set_state(u, std::vector<Vec3d>(u.size()));

  double first = -1.0, last = -1.0, before = column.top_displacement();
  int crossings = 0;
  while (crossings < 9) {
    test::must_step(column.simulation);
    const double now = column.top_displacement();
    if (before * now < 0.0) {
      last = column.simulation.time() - column.simulation.step_size() * now / (now - before);
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  const double measured = std::numbers::pi * 8.0 / (last - first);
  const double exact = 0.5 * std::numbers::pi * wave_speed / L;
  return std::abs(measured / exact - 1.0);
}

// Free vibration: the frequency converges to π c_p / 2L at second order of the cell size.
TEST(ConfinedColumn, VibrationConvergesAtSecondOrder) {
  const double coarse = frequency_error(4), middle = frequency_error(8), fine = frequency_error(16);
  EXPECT_GE(std::log2(coarse / middle), 1.8) << "errors " << coarse << " " << middle << " " << fine;
  EXPECT_GE(std::log2(middle / fine), 1.8) << "errors " << coarse << " " << middle << " " << fine;
  EXPECT_LE(fine, 1e-3);
}

}  // namespace
}  // namespace glisson
