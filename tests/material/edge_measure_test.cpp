// Radius ratio and minimum solid angle against the rest tetrahedron: what they see, and how they are scaled.
#include "material/edge_measure.h"

#include <gtest/gtest.h>

#include <numbers>

#include "element/element_shape.h"
#include "material/every_tissue.h"
#include "material/principal.h"
#include "support/bodies.h"

namespace glisson {
namespace {

double strain_of(bool radius, const Mat3d& H, const Mat3d& turn = identity<double>()) {
  return edge_strain(radius, edge_measure(radius, H, turn).value);
}
Mat3d deviator(Mat3d a) {
  const double third = trace(a) / 3.0;
  for (std::size_t i = 0; i < 3; ++i) a(i, i) -= third;
  return a;
}

// Both are 1 for the shape at rest, turned and blown up, and 0 where it is inverted or flat.
TEST(EdgeMeasure, RestAndItsImages) {
  test::Draw draw(41);
  for (const bool radius : {true, false}) {
    EXPECT_NEAR(edge_measure(radius, Mat3d{}, identity<double>()).value, 1.0, 1e-15);
    for (int n = 0; n < 10; ++n) {
      const Mat3d Q = draw.rotation();
      const Mat3d image = test::difference(scaled(Q, 0.3 + 0.3 * n), identity<double>());
      EXPECT_NEAR(edge_measure(radius, image, draw.rotation()).value, 1.0, 1e-13);
    }
    EXPECT_EQ(edge_measure(radius, detail::diagonal(0.0, 0.0, -1.0), identity<double>()).value, 0.0);
    EXPECT_EQ(edge_measure(radius, detail::diagonal(0.0, 0.0, -1.5), identity<double>()).value, 0.0);
  }
}

// Near rest: 1 − ρ = ⅔ ‖ε_E‖² + 8/9 ‖ε_T‖², and 1 − σ = 5/√6 max n·ε n.
TEST(EdgeMeasure, NearRest) {
  const double h = 1e-4;
  const auto value = [&](bool radius, const Mat3d& e) {
    return edge_measure(radius, scaled(e, h), identity<double>()).value;
  };
  const double r = std::sqrt(0.5);
  const Mat3d E = detail::diagonal(r, -r, 0.0);
  const Mat3d T{{{{0.0, r, 0.0}, {r, 0.0, 0.0}, {0.0, 0.0, 0.0}}}};
  EXPECT_NEAR((1.0 - value(true, E)) / (h * h), 2.0 / 3.0, 1e-3);
  EXPECT_NEAR((1.0 - value(true, T)) / (h * h), 8.0 / 9.0, 1e-3);
  Mat3d along = identity<double>();  // stretch along n = (1, 1, 1)/√3, of norm 1
  for (std::size_t i = 0; i < 9; ++i)
    along(i / 3, i % 3) = (1.0 / 3.0 - (i % 4 == 0 ? 1.0 / 3.0 : 0.0)) * std::sqrt(1.5);
  EXPECT_NEAR((1.0 - value(false, along)) / h, 5.0 / std::sqrt(6.0), 1e-3);
  EXPECT_NEAR((1.0 - value(false, scaled(along, -1.0))) / h, 5.0 / (3.0 * std::sqrt(6.0)), 1e-3);
  EXPECT_LT((1.0 - value(false, E)) / h, 1e-3);
}

// Over all directions of strain the mean of s² is ‖dev ε‖², and s lies between the bounds the head of the file gives.
TEST(EdgeMeasure, IsScaledToTheDeviator) {
  for (const bool radius : {true, false}) {
    test::Draw draw(42);
    double squares = 0.0, least = 10.0, most = 0.0;
    constexpr int kDirections = 200000;
    for (int n = 0; n < kDirections; ++n) {
      const Mat3d e = deviator(full(symmetric(draw.tensor(1.0))));
      const double s = strain_of(radius, scaled(e, 1e-4 / test::size_of(e))) / 1e-4;
      squares += s * s / kDirections, least = std::min(least, s), most = std::max(most, s);
    }
    EXPECT_NEAR(squares, 1.0, 0.01);
    EXPECT_GT(least, radius ? std::sqrt(5.0 / 6.0) - 1e-3 : 0.0);
    EXPECT_LT(most, radius ? std::sqrt(10.0 / 9.0) + 1e-3 : 1.70);
  }
}

// The turn of an element is that of the textbook's polar decomposition, and an even renumbering of its corners leaves
// the measure alone.
TEST(EdgeMeasure, TurnsWithItsTetrahedron) {
  std::mt19937 random(43);
  Tissue t;
  t.measure = DeformationMeasure::solid_angle;
  const TetMesh mesh = test::jittered_box({2, 2, 2}, 0.01, 0.2, random);
  TetMesh renumbered = mesh;
  for (Tet& tet : renumbered.tets) tet = {tet[1], tet[2], tet[0], tet[3]};
  const Body body = build_body(mesh, {{0, t}}), other = build_body(renumbered, {{0, t}});
  const Mat3d H = test::Draw(44).tensor(0.1);
  for (std::size_t e = 0; e < body.elements.size(); ++e) {
    std::array<Vec3d, 4> corners;
    for (std::size_t a = 0; a < 4; ++a) corners[a] = mesh.vertices[body.elements[e][a]];
    const Mat3d turn = element_shape(body, t, e).turn;
    EXPECT_LT(test::apart(turn, test::Specimen(t, corners).shape.turn), 1e-12);
    for (const bool radius : {true, false}) {
      EXPECT_NEAR(strain_of(radius, H, turn), strain_of(radius, H, element_shape(other, t, e).turn), 1e-12);
    }
  }
}

}  // namespace
}  // namespace glisson
