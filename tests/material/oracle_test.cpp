// The response equals the textbook's formulas, for every law, from strains of 1e-9 to stretches of 0.3 to 3.
//
// The oracle (material/reference/reference_stress.h) is naive and runs in long double.
#include <gtest/gtest.h>

#include "material/every_tissue.h"

namespace glisson {
namespace {

using test::apart;
using test::Draw;
using test::every_tissue;
using test::Specimen;

double elastic_error(const Specimen& s, const Mat3d& H) {
  return apart(s.P(H), test::to_double(reference::piola(s.point, test::real_gradient(H))));
}

// Large deformation with rotation. Tolerance: the exponent of a law multiplies the rounding of its argument, some 30
// times here; the powers of J at stretches of 0.3 to 3 as much again.
TEST(Oracle, LargeDeformation) {
  for (const Tissue& t : every_tissue()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(1);
    for (int n = 0; n < 40; ++n) {
      const Mat3d H = draw.stretched(0.67, 1.44);  // J from 0.3 to 3
      EXPECT_LT(elastic_error(s, H), 1e-11) << "J = " << jacobian(H);
    }
  }
}

// Stretches of 0.4 and 2.5 in one tetrahedron, at any J between 0.25 and 3.
TEST(Oracle, ExtremeStretches) {
  for (const Tissue& t : every_tissue()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(2);
    for (int n = 0; n < 60; ++n) {
      const Mat3d H = draw.stretched(0.4, 2.5);
      const double J = jacobian(H);
      if (J < 0.25 || J > 3.0) continue;
      EXPECT_LT(elastic_error(s, H), 1e-10) << "J = " << J;
    }
  }
}

// Strains down to 1e-9 keep their digits: the stress is compared with its own size. √(1 − ρ) is good to 3e-8 and no
// better, and so is the modulus; the gradient of both measures of edges is left out below 1e-7.
TEST(Oracle, TinyStrain) {
  for (const Tissue& t : every_tissue()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(3);
    for (const double size : {1e-9, 1e-8, 1e-6, 1e-4, 1e-2}) {
      const bool rough = t.measure == DeformationMeasure::radius_ratio || t.measure == DeformationMeasure::solid_angle;
      for (int n = 0; n < 10; ++n)
        EXPECT_LT(elastic_error(s, draw.tensor(size)), rough ? 3e-7 : 1e-8) << "strain " << size;
    }
  }
}

// The energy, likewise; its error is that of its argument, of second order.
TEST(Oracle, Energy) {
  for (const Tissue& t : every_tissue()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(4);
    for (int n = 0; n < 40; ++n) {
      const Mat3d H = n < 20 ? draw.stretched(0.67, 1.44) : draw.tensor(1e-4);
      const double W = static_cast<double>(reference::stored_energy(s.point, test::real_gradient(H)));
      EXPECT_NEAR(s.response.energy(H, s.shape), W, 1e-8 * std::abs(W));
    }
  }
}

TEST(Oracle, ViscousStress) {
  for (const Tissue& t : test::viscous_tissues()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(5);
    for (int n = 0; n < 20; ++n) {
      const Mat3d H = draw.stretched(0.5, 2.0), rate = draw.tensor(3.0);
      const Mat3d P = test::to_double(reference::viscous_piola(s.point, test::real_gradient(H), test::to_real(rate)));
      EXPECT_LT(apart(s.response.viscous(H, rate), P), 1e-12);
    }
  }
}

// What Maxwell branches relax: S or its part without pressure.
TEST(Oracle, RelaxingStress) {
  for (const Tissue& t : test::maxwell_tissues()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(6);
    for (int n = 0; n < 20; ++n) {
      const Mat3d H = draw.stretched(0.67, 1.44);
      const Mat3d S = test::to_double(reference::relaxing_stress(s.point, test::real_gradient(H)));
      EXPECT_LT(apart(full(s.response.relaxing(H, s.P(H))), S), 1e-11);
    }
  }
}

// Inverted tetrahedra of the tensor-mass laws go on by the same formulas: the smallest singular value is negative.
TEST(Oracle, InvertedTensorMass) {
  for (const Tissue& t : test::tensor_mass_tissues()) {
    SCOPED_TRACE(t.name);
    const Specimen s(t);
    Draw draw(7);
    for (int n = 0; n < 20; ++n) {
      const Mat3d mirror{{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, -1.0}}}};
      const Mat3d F = product(deformation_gradient(draw.stretched(0.6, 1.6)), mirror);
      EXPECT_LT(elastic_error(s, test::difference(F, identity<double>())), 1e-11);
    }
  }
}

}  // namespace
}  // namespace glisson
