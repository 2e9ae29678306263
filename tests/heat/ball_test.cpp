// Heat in a ball of obtuse tets against closed forms: blood, and cooling in air; what the limiter leaves alone.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "ball.h"
#include "glisson/heat/heat_simulation.h"

namespace glisson {
namespace {

constexpr double kRadius = 0.02;  // [m]

struct Found {
  double middle = 0.0;  // error there [K]
  double mean = 0.0;    // root of the mean square of the vertices' errors over the volume [K]
  double limited = 0.0;
};

// Steady temperatures of a ball with blood and metabolism whose wall is held, T_f + (T_w − T_f) R sinh(m r)/(r sinh(m R))
// [CarslawJaeger1959]: of second order in the middle and over the volume, extrapolated in the middle within 0.1 % of the difference. More
// than half of the vertices have conductances below 0, and the limiter takes nothing of them: the field is an extreme nowhere but in
// the middle, where blood and metabolism make it one.
TEST(HeatBall, BloodOfSecondOrder) {
  ThermalTissue t;
  t.perfusion = 5e-3, t.metabolic_heat = 4200.0;
  const double m = std::sqrt(t.perfusion * t.blood_heat_capacity / t.conductivity),
               far = 37.0 + t.metabolic_heat / (t.perfusion * t.blood_heat_capacity);
  const auto exact = [&](double r) {
    const double falls = r > 0.0 ? std::sinh(m * r) / (m * r) : 1.0;
    return far + (10.0 - far) * falls * m * kRadius / std::sinh(m * kRadius);
  };
  const auto find = [&](int splits) {
    HeatSimulation s(test::ball_mesh(kRadius, splits), {{0, t}}, {.step = 1e5});
    s.hold("wall", [](double) { return 10.0; });
    EXPECT_EQ(s.advance_to(1e6).status, HeatStatus::ok);
    double sum = 0.0, whole = 0.0;
    for (std::size_t k = 0; k < s.mesh().tets.size(); ++k) {
      for (const std::uint32_t v : s.mesh().tets[k]) {
        const double off = s.temperature()[v] - exact(norm(s.mesh().vertices[v])),
                     volume = six_rest_volume(s.mesh(), k);
        sum += volume * off * off, whole += volume;
      }
    }
    return Found{s.temperature()[0] - exact(0.0), std::sqrt(sum / whole), s.state().limited_share};
  };
  const Found coarse = find(2), fine = find(3);
  RecordProperty("middle_K", std::to_string(coarse.middle) + ", " + std::to_string(fine.middle));
  RecordProperty("mean_K", std::to_string(coarse.mean) + ", " + std::to_string(fine.mean));
  EXPECT_GT(coarse.middle / fine.middle, 3.6);
  EXPECT_GT(coarse.mean / fine.mean, 3.6);
  EXPECT_LT(std::abs(4.0 * fine.middle - coarse.middle) / 3.0, 1e-3 * (exact(0.0) - 10.0));
  EXPECT_LT(fine.limited, 1e-12);
}

// A ball that cools in air at a Biot number of 2 and a Fourier number of 0.2: in its middle
// Σ 4 (sin β − β cos β)/(2 β − sin 2β) e^(−β² Fo), 1 − β cot β = Bi [CarslawJaeger1959], extrapolated in time and space within 0.1 %.
TEST(HeatBall, CoolsInAir) {
  ThermalTissue t;
  t.latent_heat = 0.0;
  constexpr double kBiot = 2.0, kFourier = 0.2, kAir = 5.0;
  const double end = kFourier * kRadius * kRadius * t.density * t.specific_heat / t.conductivity;
  double sum = 0.0;
  for (int n = 0; n < 30; ++n) {
    double low = n * std::numbers::pi + 1e-9, high = (n + 1) * std::numbers::pi - 1e-9;
    for (int i = 0; i < 100; ++i) {
      const double b = 0.5 * (low + high);
      (1.0 - b / std::tan(b) < kBiot ? low : high) = b;
    }
    sum += 4.0 * (std::sin(low) - low * std::cos(low)) / (2.0 * low - std::sin(2.0 * low)) *
           std::exp(-low * low * kFourier);
  }
  const double exact = kAir + (37.0 - kAir) * sum;
  const auto middle = [&](int splits, int steps) {
    HeatSimulation s(test::ball_mesh(kRadius, splits), {{0, t}}, {.step = end / steps});
    s.add_convection("wall", kBiot * t.conductivity / kRadius, [](double) { return kAir; });
    EXPECT_EQ(s.advance_to(end).status, HeatStatus::ok);
    const HeatLedger l = s.ledger();
    EXPECT_LT(std::abs(l.imbalance()), 1e-10 * std::abs(l.surface));
    return s.temperature()[0];
  };
  const auto in_time = [&](int splits) { return 2.0 * middle(splits, 100) - middle(splits, 50); };
  const double coarse = in_time(2), fine = in_time(3), both = (4.0 * fine - coarse) / 3.0;
  RecordProperty("errors_K", std::to_string(coarse - exact) + ", " + std::to_string(fine - exact) + ", extrapolated " +
                                 std::to_string(both - exact));
  EXPECT_GT((coarse - exact) / (fine - exact), 3.5) << "second order in space";
  EXPECT_NEAR(both, exact, 1e-3 * (exact - kAir));
}

}  // namespace
}  // namespace glisson
