// axial_response_test.cpp — the short formulas of a stretched specimen are those of the general response.
#include "material/axial_response.h"

#include <gtest/gtest.h>

#include <random>

namespace glisson {
namespace {

std::vector<Tissue> every_axial_tissue() {
  std::vector<Tissue> all;
  for (const HyperelasticLaw& law : std::initializer_list<HyperelasticLaw>{
           NeoHookean{1000, 9000}, MooneyRivlin{300, 200, 9000},
           Yeoh{.c1 = 400, .c2 = 50, .c3 = 7, .bulk_modulus = 9000}, Fung{1000, 2.0, 9000},
           VerondaWestmann{.c = 700, .b = 1.5, .bulk_modulus = 9000}, Ogden{{700, -100}, {6.0, -4.7}, 9000}}) {
    Tissue t;
    t.hyperelastic = law;
    all.push_back(t);
  }
  for (const Kinematics k : {Kinematics::small, Kinematics::corotational, Kinematics::green}) {
    for (const LawForm form : {LawForm::secant, LawForm::energy}) {
      for (const DeformationMeasure m :
           {DeformationMeasure::equivalent_shear_strain, DeformationMeasure::one_minus_q}) {
        Tissue t;
        t.kinematics = k, t.law_form = form, t.measure = m;
        t.law = LinearLaw{20000};
        all.push_back(t);
        t.law = ConstantLaw{};
        t.lambda_law = ExponentialLaw{500, 3.0};
        t.mu_law = PolynomialLaw{{2000, 3000}};
        all.push_back(t);
      }
    }
  }
  // at the end, where they change no draw of the others: a law of s loses more digits where stretches are nearly equal
  Invariants sum{.c10 = 200, .c01 = 100, .c20 = 30, .c11 = 20, .c02 = 10, .c30 = 5, .bulk_modulus = 9000};
  sum.a1 = 100, sum.b1 = 1.5, sum.a2 = 80, sum.b2 = 0.7, sum.q1 = 50, sum.r1 = 0.1, sum.q2 = 40, sum.r2 = 0.05;
  for (const HyperelasticLaw& law :
       std::initializer_list<HyperelasticLaw>{Gent{.mu = 1000, .limit = 8.0, .bulk_modulus = 9000}, sum}) {
    Tissue t;
    t.hyperelastic = law;
    all.push_back(t);
  }
  return all;
}

Mat3d diagonal(Axial<double> h) { return {{{{h.side, 0, 0}, {0, h.side, 0}, {0, 0, h.along}}}}; }

/// Largest difference of an axial tensor from a full one, over the size of the latter and a small absolute part.
double difference(Axial<double> a, const Mat3d& b, double size) {
  return std::max({std::abs(a.side - b(0, 0)), std::abs(a.side - b(1, 1)), std::abs(a.along - b(2, 2))}) / size;
}

// Elastic, viscous and relaxing stress of any tissue at stretches from 0.1 to 2 are those of Response. Some tissue kinds take
// cube roots and logarithms in another order: 1e-11 of the modulus is a thousand roundings of the largest terms.
TEST(AxialResponse, IsTheResponseOfDiagonalGradients) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> strain(-0.6, 1.0), rate(-3, 3);
  for (Tissue tissue : every_axial_tissue()) {
    tissue.viscosity = 30.0;
    tissue.maxwell = {{0.3, 1.0}};
    for (const ViscousTensor v : {ViscousTensor::shear, ViscousTensor::deviatoric, ViscousTensor::pioletti}) {
      for (const MaxwellPart part : {MaxwellPart::deviator, MaxwellPart::all}) {
        tissue.viscous_tensor = v, tissue.maxwell_part = part;
        const Response general(tissue);
        const AxialResponse axial(tissue);
        for (int i = 0; i < 20; ++i) {
          const double scale = i % 4 == 0 ? 1e-3 : 1.0;
          const Axial<double> h{scale * strain(random), scale * strain(random)}, r{rate(random), rate(random)};
          const Mat3d P = general.elastic(diagonal(h), ElementShape{});
          const double size = 9000.0 + std::sqrt(squared_norm(P));
          EXPECT_LT(difference(axial.elastic(h), P, size), 1e-11);
          EXPECT_LT(difference(axial.viscous(h, r), general.viscous(diagonal(h), diagonal(r)), 1e3), 1e-12);
          const Axial<double> Pa{P(0, 0), P(2, 2)};
          const double inflated = size / std::pow(1.0 + std::min(h.side, h.along), 4);
          EXPECT_LT(difference(axial.relaxing(h, Pa), full(general.relaxing(diagonal(h), P)), inflated), 1e-11);
        }
      }
    }
  }
}

// Squashed below 0.2 of a stretch or of volume the general response takes over, and nothing jumps.
TEST(AxialResponse, GoesOnWhereSquashed) {
  Tissue tissue;
  tissue.hyperelastic = Ogden{{1000}, {6.0}, 9000};
  const AxialResponse axial(tissue);
  const double above = axial.elastic(Axial<double>{0.9, -0.8 + 1e-9}).along;
  EXPECT_NEAR(axial.elastic(Axial<double>{0.9, -0.8 - 1e-9}).along, above, 1e-6 * std::abs(above));
}

// Fibres, and laws of measures that differ from tet to tet, are refused in words.
TEST(AxialResponse, RefusesWhatIsNotAlikeAllOver) {
  Tissue fibres;
  fibres.fibres = Fibres{.stiffness = 100};
  EXPECT_THROW(AxialResponse{fibres}, std::invalid_argument);
  Tissue raw;
  raw.measure = DeformationMeasure::radius_ratio;
  EXPECT_NO_THROW(AxialResponse{raw}) << "a constant law asks for no measure";
  raw.law = LinearLaw{100};
  EXPECT_THROW(AxialResponse{raw}, std::invalid_argument);
}

}  // namespace
}  // namespace glisson
