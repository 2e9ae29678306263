// The shape measures: their values on the cube split, what they are blind to, and their precision near rest.
#include "glisson/material/shape_measure.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "element/body.h"
#include "glisson/mesh.h"
#include "material/reference/reference.h"
#include "support/random.h"

namespace glisson {
namespace {

using test::number;

Mat3d random_gradient(double amount) {
  Mat3d H;
  for (auto& row : H.m) {
    for (double& h : row) h = number(-amount, amount);
  }
  return H;
}

Mat3d product(const Mat3d& a, const Mat3d& b) {
  Mat3d c;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) c(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  }
  return c;
}

Mat3d plus_identity(Mat3d H, double sign) {
  for (std::size_t i = 0; i < 3; ++i) H(i, i) += sign;
  return H;
}

/// Rotation about a random axis by a random angle.
Mat3d random_rotation() {
  Vec3d k{number(-1, 1), number(-1, 1), number(-1, 1) + 1.5};
  k = k * (1.0 / norm(k));
  const double angle = number(-3.1, 3.1), c = std::cos(angle), s = std::sin(angle);
  Mat3d R;
  const Mat3d K{{{{0, -k.z, k.y}, {k.z, 0, -k.x}, {-k.y, k.x, 0}}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) R(i, j) = c * (i == j) + s * K(i, j) + (1 - c) * k[i] * k[j];
  }
  return R;
}

// The measure must not see rigid motion: rotating a deformed tetrahedron leaves q unchanged.
RC_GTEST_PROP(MeanRatio, IsFrameIndifferent, ()) {
  const Mat3d H = random_gradient(0.3);
  const Mat3d rotated = plus_identity(product(random_rotation(), plus_identity(H, 1.0)), -1.0);
  RC_ASSERT(std::abs(one_minus_q(rotated) - one_minus_q(H)) <= 1e-13);
}

// It is blind to uniform dilation, and says nothing about volume.
TEST(MeanRatio, IsBlindToDilation) {
  for (const double a : {-0.5, -0.1, 1e-6, 0.2, 2.0}) {
    Mat3d H{};
    for (std::size_t i = 0; i < 3; ++i) H(i, i) = a;
    EXPECT_NEAR(one_minus_q(H), 0.0, 1e-15) << "dilation by " << 1.0 + a;
  }
}

// It equals its textbook formula 3 J^⅔ / tr(FᵀF).
RC_GTEST_PROP(MeanRatio, EqualsItsFormula, ()) {
  const Mat3d H = random_gradient(0.4), F = plus_identity(H, 1.0);
  double squares = 0.0;
  for (const auto& row : F.m) {
    for (const double f : row) squares += f * f;
  }
  const double J = determinant(F);
  const double q = J > 0.0 ? 3.0 * std::pow(J, 2.0 / 3.0) / squares : 0.0;
  RC_ASSERT(std::abs(mean_ratio(H) - q) <= 1e-14);
}

// Compression by 5, 10, 20 and 40 % with a lateral ratio of 0.4: the figures of the literature check.
TEST(MeanRatio, FiguresUnderCompression) {
  const double expected[] = {0.99779, 0.99107, 0.96364, 0.85250};
  const double strain[] = {0.05, 0.10, 0.20, 0.40};
  for (int i = 0; i < 4; ++i) {
    Mat3d H{};
    H(0, 0) = H(1, 1) = 0.4 * strain[i];
    H(2, 2) = -strain[i];
    EXPECT_NEAR(mean_ratio(H), expected[i], 5e-6);
  }
}

// Near rest s is ‖dev ε‖; in float its relative error stays below 1e-5 down to s = 1e-4.
TEST(Intensity, SmallStrain) {
  for (const double size : {1e-1, 1e-2, 1e-3, 1e-4}) {
    Mat3d H{{{{0.3, 0.5, -0.2}, {0.1, -0.6, 0.4}, {0.7, -0.3, 0.5}}}};
    for (auto& row : H.m) {
      for (double& h : row) h *= size;
    }
    Mat3<float> Hf;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) Hf(i, j) = static_cast<float>(H(i, j));
    }
    const double s = intensity_of(one_minus_q(H));
    EXPECT_NEAR(s / std::sqrt(deviator_squared(H)), 1.0, 2.0 * size);
    EXPECT_NEAR(static_cast<double>(intensity_of(one_minus_q(Hf))) / s, 1.0, 1e-5) << "size " << size;
  }
}

// An inverted or collapsed tetrahedron gives the clamp, never NaN.
TEST(MeanRatio, InvertedIsClamped) {
  Mat3d H{};
  for (const double z : {-1.0, -1.5, -3.0, -1e6}) {
    H(2, 2) = z;
    EXPECT_EQ(one_minus_q(H), 1.0);
    EXPECT_EQ(mean_ratio(H), 0.0);
    EXPECT_EQ(regular_mean_ratio(H, 1e-6, EdgeMetric<double>{1, 1, 1, 0, 0, 0}), 0.0);
  }
  EXPECT_NEAR(intensity_of(1.0), std::sqrt(1.5), 1e-15);
}

// The raw measure on the cube split: 0.755953 at rest for all six; under 10 % compression four fall, two rise.
TEST(RegularMeanRatio, RisesInTwoOfSixUnderCompression) {
  const TetMesh cube = box_mesh({.cells = {1, 1, 1}, .size = {0.01, 0.01, 0.01}});
  Tissue raw;
  raw.measure = DeformationMeasure::regular_mean_ratio;
  int rising = 0, falling = 0;
  for (const Tet& t : cube.tets) {
    reference::Corners rest, u;
    for (std::size_t a = 0; a < 4; ++a) {
      const Vec3d& x = cube.vertices[t[a]];
      rest[a] = {x.x, x.y, x.z};
      u[a] = {0.04 * x.x, 0.04 * x.y, -0.10 * x.z};
    }
    EXPECT_NEAR(reference::measure(raw, rest,
                                   {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                    Eigen::Vector3d::Zero()}),
                0.755953, 1e-6);
    const double deformed = reference::measure(raw, rest, u);
    if (std::abs(deformed - 0.7424) < 1e-4) ++falling;
    if (std::abs(deformed - 0.7631) < 1e-4) ++rising;
  }
  EXPECT_EQ(falling, 4);
  EXPECT_EQ(rising, 2);
}

}  // namespace
}  // namespace glisson
