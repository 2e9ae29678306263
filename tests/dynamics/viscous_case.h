// viscous_case.h — viscous bodies whose step has a limit, for tests of the integrators that bear viscosity.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "glisson/material/tissue.h"

namespace glisson::test {

inline Tissue viscous(double eta, ViscousTensor tensor = ViscousTensor::shear) {
  Tissue t;
  t.viscosity = eta;
  t.viscous_tensor = tensor;
  return t;
}

struct ViscousCase {
  const char* name;
  double eta;  ///< [Pa s]
  ViscousTensor tensor;
  double damping_rate;  ///< [1/s]
  int stages = 1;       ///< SimulationOptions::drag_stages
  Tissue tissue() const { return viscous(eta, tensor); }
};
inline void PrintTo(const ViscousCase& c, std::ostream* out) { *out << c.name; }
inline std::string case_name(const testing::TestParamInfo<ViscousCase>& c) { return c.param.name; }

}  // namespace glisson::test
