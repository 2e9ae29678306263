// yeoh_cylinder.h — the cylinder of the tests of barrels, and the pressure on it where it deforms alike all over.
#pragma once

#include "material/uniaxial_path.h"

namespace glisson::test::yeoh_cylinder {

inline constexpr double kRadius = 0.025, kHeight = 0.03;

inline const HyperelasticLaw kYeoh = Yeoh{.c1 = 927, .c2 = 71, .c3 = 39, .bulk_modulus = 2e6};

/// Of the plate on smooth faces, < 0 where it pulls [Pa].
inline double homogeneous_pressure(const HyperelasticLaw& law, double strain) {
  Tissue tissue;
  tissue.hyperelastic = law;
  UniaxialPath path(tissue);
  path.start(0.0);
  return -path.at(1.0 - strain).stress;
}

}  // namespace glisson::test::yeoh_cylinder
