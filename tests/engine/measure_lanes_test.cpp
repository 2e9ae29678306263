// The measure in lanes is that of glisson/material/shape_measure.h: exact near rest, blind to rotation, 1 when inverted.
#include <gtest/gtest.h>

#include <memory>

#include "engine/engine_run.h"
#include "glisson/material/shape_measure.h"

namespace glisson {
namespace {

using engine::Block;
using engine::Kernels;

/// Gradients, rounded to float, with the tets they are of.
struct Tets {
  std::vector<Mat3<float>> H;
  std::vector<ElementRest> rest;
};

Mat3d in_double(const Mat3<float>& H) {
  Mat3d out;
  for (std::size_t k = 0; k < 9; ++k) out(k / 3, k % 3) = double(H(k / 3, k % 3));
  return out;
}

/// The rest data of a tet in the middle of a chain of one (layout.h).
void put_rest(const ElementRest& rest, std::size_t lanes, float* lane) {
  const double w = 1.0 / (6.0 * rest.volume);
  const auto put = [&](std::size_t row, const Vec3d& v) {
    for (std::size_t i = 0; i < 3; ++i) lane[(row + i) * lanes] = float(v[i]);
  };
  put(engine::kRestAcross + 3, rest.s[0] * (1.0 / w));
  put(engine::kRestSpoke[3], rest.s[1] * (-1.0 / w));
  put(engine::kRestSpoke[2], rest.s[2] * (1.0 / w));
  lane[(engine::kRestScale + 1) * lanes] = float(w);
}

/// Runs the stage over the tets, one a chain, a block at a time as a submesh does. @return x of each; `inverted` is any
/// J ≤ 0
std::vector<double> measured(const Kernels& kernels, DeformationMeasure measure, const Tets& tets,
                             bool* inverted = nullptr) {
  const std::size_t L = kernels.lanes, block_tets = engine::kBlockBatches * L;
  const auto block = std::make_unique<Block>();
  std::vector<double> x;
  bool any = false;
  for (std::size_t first = 0; first < tets.H.size(); first += block_tets) {
    engine::LaneVector<float> rest(block_tets * engine::kChainRest, 0.0F);
    std::fill(std::begin(block->gradient), std::end(block->gradient), 0.0F);
    const std::size_t n = std::min(block_tets, tets.H.size() - first);
    for (std::size_t t = 0; t < n; ++t) {
      const std::size_t batch = t / L, item = engine::kChainTets * batch + 1, lane = t % L;
      for (std::size_t k = 0; k < 9; ++k) {
        block->gradient[(item * 9 + k) * L + lane] = tets.H[first + t](k / 3, k % 3);
      }
      put_rest(tets.rest[first + t], L, rest.data() + batch * engine::kChainRest * L + lane);
    }
    engine::Elements elements;
    elements.rest = rest.data();
    elements.tissue.bulk_over_two_mu = 1.0F;
    any = kernels.measure[std::size_t(measure)](elements, 0, engine::kBlockBatches, *block) || any;
    for (std::size_t t = 0; t < n; ++t) x.push_back(double(block->x[(engine::kChainTets * (t / L) + 1) * L + t % L]));
  }
  if (inverted != nullptr) *inverted = any;
  return x;
}

class MeasureLanes : public testing::TestWithParam<const Kernels*> {
 protected:
  std::mt19937 random_{11};
  Body body_ = build_body(test::jittered_box({5, 5, 5}, 0.01, 0.2, random_), {{0, Tissue{}}});

  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  /// As many gradients as the body has tets, from `make`.
  Tets tets(const std::function<Mat3d()>& make) {
    Tets out;
    for (const ElementRest& rest : body_.rest) {
      const Mat3d H = make();
      out.rest.push_back(rest);
      out.H.emplace_back();
      for (std::size_t k = 0; k < 9; ++k) out.H.back()(k / 3, k % 3) = float(H(k / 3, k % 3));
    }
    return out;
  }
  Mat3d random_gradient(double size) {
    Mat3d H;
    for (auto& row : H.m) {
      for (double& h : row) h = number(-size, size);
    }
    return H;
  }
  static Mat3d dilation(double a) { return {{{{a, 0.0, 0.0}, {0.0, a, 0.0}, {0.0, 0.0, a}}}}; }
  /// R − I of a rotation, from a quaternion.
  Mat3d random_rotation() {
    std::normal_distribution<double> normal;
    double w = normal(random_), x = normal(random_), y = normal(random_), z = normal(random_);
    const double scale = 1.0 / std::sqrt(w * w + x * x + y * y + z * z);
    w *= scale, x *= scale, y *= scale, z *= scale;
    return {{{{-2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
              {2 * (x * y + w * z), -2 * (x * x + z * z), 2 * (y * z - w * x)},
              {2 * (x * z - w * y), 2 * (y * z + w * x), -2 * (x * x + y * y)}}}};
  }
};

double size_of(const Mat3d& H) {
  double squares = 0.0;
  for (const auto& row : H.m) {
    for (const double h : row) squares += h * h;
  }
  return std::sqrt(squares);
}

// From strains of 1e-4 on, s is exact to 1e-5: its square is formed of terms of that order, none of order one.
TEST_P(MeasureLanes, SmallStrain) {
  for (const double size : {1e-4, 1e-3, 1e-2}) {
    const Tets t = tets([&] { return random_gradient(size); });
    const std::vector<double> s = measured(*GetParam(), DeformationMeasure::equivalent_shear_strain, t);
    const std::vector<double> p = measured(*GetParam(), DeformationMeasure::one_minus_q, t);
    for (std::size_t i = 0; i < s.size(); ++i) {
      const double exact = one_minus_q(in_double(t.H[i]));
      ASSERT_NEAR(s[i], intensity_of(exact), 1e-5 * intensity_of(exact));
      ASSERT_NEAR(p[i], exact, 2e-5 * exact);
    }
  }
}

/// What float can make of 1 − q: a dozen roundings (6e-8) of the terms that cancel in it, ‖dev ε‖ |H| and |H|³, and of
/// the diagonal's, which a uniform dilation has even where it has no deviator. Where the volume changes by 30 % the
/// cube root is good to 2e-7, and ψ to that times (J^⅓ − 1)².
double bound_of(const Mat3d& H) {
  const double h = size_of(H), diagonal = 8e-7 * h * h;
  const double root = std::abs(jacobian(H) - 1.0) < 0.299 ? 0.0 : h * h;
  return 8e-7 * (std::sqrt(deviator_squared(H)) * h + h * h * h + diagonal + root);
}

// At any strain 1 − q is exact to what its terms leave.
TEST_P(MeasureLanes, AnyStrain) {
  for (const double size : {0.05, 0.2, 0.6}) {
    const Tets t = tets([&] { return random_gradient(size); });
    const std::vector<double> p = measured(*GetParam(), DeformationMeasure::one_minus_q, t);
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Mat3d H = in_double(t.H[i]);
      if (std::abs(jacobian(H)) < 1e-3) continue;  // q falls like J^⅔ there
      ASSERT_NEAR(p[i], one_minus_q(H), bound_of(H)) << "J = " << jacobian(H);
    }
  }
}

// A uniform dilation is no change of shape: within the same bound of 0, on both sides of where ψ's form changes.
TEST_P(MeasureLanes, Dilation) {
  const Tets t = tets([&] { return dilation(number(-0.35, 0.5)); });
  const std::vector<double> p = measured(*GetParam(), DeformationMeasure::one_minus_q, t);
  for (std::size_t i = 0; i < p.size(); ++i) ASSERT_LE(p[i], bound_of(in_double(t.H[i])));
  // what a body under water sees: 3 % of volume leave s within 2e-5
  const Tets small = tets([&] { return dilation(number(-0.01, 0.01)); });
  for (const double s : measured(*GetParam(), DeformationMeasure::equivalent_shear_strain, small)) ASSERT_LE(s, 2e-5);
}

// A rotation is no change of shape either; terms of order ten cancel to 0 at half a turn.
TEST_P(MeasureLanes, Rotation) {
  const Tets t = tets([&] { return random_rotation(); });
  for (const double p : measured(*GetParam(), DeformationMeasure::one_minus_q, t)) ASSERT_LE(p, 2e-6);
}

// An inverted or flat tet has 1 − q = 1 and a raw ratio of 0, and only such a tet is told of.
TEST_P(MeasureLanes, Inverted) {
  const Tets upright = tets([&] { return random_gradient(0.2); });
  bool inverted = true;
  measured(*GetParam(), DeformationMeasure::equivalent_shear_strain, upright, &inverted);
  EXPECT_FALSE(inverted);
  for (const Mat3d& H :
       {dilation(-1.0), dilation(-2.5), Mat3d{{{{-2.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}}}}) {
    const Tets t = tets([&] { return H; });
    for (const double p : measured(*GetParam(), DeformationMeasure::one_minus_q, t, &inverted)) EXPECT_EQ(p, 1.0);
    EXPECT_TRUE(inverted);
    for (const double q : measured(*GetParam(), DeformationMeasure::regular_mean_ratio, t)) EXPECT_EQ(q, 0.0);
    Tets one = upright;
    one.H[one.H.size() / 2] = t.H[0];
    measured(*GetParam(), DeformationMeasure::equivalent_shear_strain, one, &inverted);
    EXPECT_TRUE(inverted) << "one among many";
  }
}

// The paper's raw ratio, from the rest tets' own edges: products of roundings only, some ten of 6e-8, where J is
// not itself a small difference.
TEST_P(MeasureLanes, RegularMeanRatio) {
  const Tets t = tets([&] { return random_gradient(0.3); });
  const std::vector<double> x = measured(*GetParam(), DeformationMeasure::regular_mean_ratio, t);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EdgeMetric<double> metric;
    const Tet& corners = body_.elements[i];
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) {
        const Vec3d l = body_.rest_positions[corners[a]] - body_.rest_positions[corners[b]];
        metric.xx += l.x * l.x, metric.yy += l.y * l.y, metric.zz += l.z * l.z;
        metric.xy += l.x * l.y, metric.yz += l.y * l.z, metric.zx += l.z * l.x;
      }
    }
    const Mat3d H = in_double(t.H[i]);
    ASSERT_NEAR(x[i], regular_mean_ratio(H, body_.rest[i].volume, metric), 2e-6 / std::min(1.0, jacobian(H)));
  }
}

// Lanes without a tet (no gradients, no volume) have a measure, and it is that of nothing.
TEST_P(MeasureLanes, Padding) {
  Tets t = tets([&] { return Mat3d{}; });
  for (ElementRest& rest : t.rest) rest = {};
  for (const auto m : {DeformationMeasure::equivalent_shear_strain, DeformationMeasure::one_minus_q,
                       DeformationMeasure::regular_mean_ratio}) {
    bool inverted = true;
    for (const double x : measured(*GetParam(), m, t, &inverted)) EXPECT_EQ(x, 0.0);
    EXPECT_FALSE(inverted);
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, MeasureLanes, testing::ValuesIn(test::every_kernels()), test::kernels_name);

}  // namespace
}  // namespace glisson
