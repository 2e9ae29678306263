// Intervals of the mean over specimens hold it as often as they say, at the width of the exact t-interval from the specimens'
// own estimates: for a law that fits, and for one that misfits a little.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fit/uncertainty/covariance.h"
#include "fit/uncertainty/distribution.h"
#include "fit/uncertainty/profile.h"
#include "small_models.h"

namespace glisson::fit::population_test {
namespace {

using testing_models::Noise;
using testing_models::plan;
using testing_models::Twin;

constexpr int kPopulations = 500;
constexpr double kMu = 2500.0, kAlpha = 6.0;            ///< of the population's mean, in ln μ and in α
constexpr double kSpreadMu = 0.06, kSpreadAlpha = 0.3;  ///< of its specimens, in ln μ and in α
const std::vector<Parameter> kParameters{{"mu", "Pa", 100.0, 1e5, Scale::logarithmic, 1000.0},
                                         {"alpha", "", 0.5, 20.0, Scale::linear, 3.0}};

double ogden(double x, double, std::span<const double> v) { return testing_models::ogden(x, v[0], v[1]); }

/// What the law does not know of, the same in each specimen: a swing of a part of the force at its end.
double misfit(double x, double part) {
  return part * testing_models::ogden(0.5, kMu, kAlpha) * std::sin(18.0 * x) * x / 0.5;
}

struct Population {
  std::vector<Curve> curves;
  double mean[2];  ///< of the law's parameters, in z, by many specimens without noise
};

Population drawn(std::uint64_t seed, double misfit_part, double noise_part) {
  Noise noise(seed);
  Population p;
  const std::size_t specimens = 3 + seed % 4;
  for (std::size_t k = 0; k < specimens; ++k) {
    Curve c = plan(100, 0.005, 0.5);
    c.name = "specimen " + std::to_string(k + 1);
    const std::vector<double> own{kMu * std::exp(kSpreadMu * noise()), kAlpha + kSpreadAlpha * noise()};
    const std::vector<double> e = noise.correlated(c.size(), 0.8);
    for (std::size_t i = 0; i < c.size(); ++i) {
      const double x = c.displacement[i];
      c.force[i] =
          ogden(x, 0.0, own) + misfit(x, misfit_part) + noise_part * testing_models::ogden(0.5, kMu, kAlpha) * e[i];
    }
    p.curves.push_back(std::move(c));
  }
  return p;
}

Optimum best(const Problem& problem) { return descend(problem, problem.to_scaled(std::vector{2000.0, 5.0})); }

/// The mean of z that the law has in such a population: its fit to a curve of the mean parameters.
std::vector<double> truth(double misfit_part) {
  Curve c = plan(100, 0.005, 0.5);
  for (std::size_t i = 0; i < c.size(); ++i)
    c.force[i] = ogden(c.displacement[i], 0.0, std::vector{kMu, kAlpha}) + misfit(c.displacement[i], misfit_part);
  const Twin twin(kParameters, {c}, 1.0, ogden);
  return best(twin.problem).scaled;
}

struct Tally {
  int held_curvature[2] = {}, held_profile[2] = {};
  std::vector<double> ratio_curvature[2], ratio_profile[2];
};

double median(std::vector<double> x) {
  std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2), x.end());
  return x[x.size() / 2];
}

Tally tally(double misfit_part, double noise_part) {
  const std::vector<double> mean = truth(misfit_part);
  Tally t;
  for (std::uint64_t seed = 0; seed < kPopulations; ++seed) {
    const Population p = drawn(seed, misfit_part, noise_part);
    const double force = testing_models::ogden(0.5, kMu, kAlpha);
    const Twin twin(kParameters, p.curves, 0.02 * force, ogden);
    const Optimum at = best(twin.problem);
    const Covariance c = covariance(twin.problem, at.scaled);
    const Profiles f = profiles(twin.problem, at, c);
    const auto g = static_cast<double>(p.curves.size());
    double sum[2] = {}, squares[2] = {};
    for (const Curve& curve : p.curves) {
      const Twin own(kParameters, {curve}, 0.02 * force, ogden);
      const std::vector<double> z = best(own.problem).scaled;
      for (int i = 0; i < 2; ++i) sum[i] += z[i], squares[i] += z[i] * z[i];
    }
    for (int i = 0; i < 2; ++i) {
      const double exact =
          student_quantile(0.975, g - 1.0) * std::sqrt((squares[i] - sum[i] * sum[i] / g) / (g - 1.0) / g);
      std::vector<double> low = mean, high = mean;
      const auto scaled = [&](double value) {
        std::vector<double> values = twin.problem.to_values(at.scaled);
        values[static_cast<std::size_t>(i)] = value;
        return twin.problem.to_scaled(values)[static_cast<std::size_t>(i)];
      };
      const auto look = [&](const Interval& interval, int& held, std::vector<double>& ratio) {
        const double a = scaled(interval.low), b = scaled(interval.high), m = mean[static_cast<std::size_t>(i)];
        held += a <= m && m <= b ? 1 : 0;
        ratio.push_back(0.5 * (b - a) / exact);
      };
      look(c.interval[static_cast<std::size_t>(i)], t.held_curvature[i], t.ratio_curvature[i]);
      look(f.of[static_cast<std::size_t>(i)].interval, t.held_profile[i], t.ratio_profile[i]);
    }
  }
  return t;
}

void require(double misfit_part, double noise_part) {
  const Tally t = tally(misfit_part, noise_part);
  for (int i = 0; i < 2; ++i) {
    const double by_curvature = t.held_curvature[i] / double(kPopulations),
                 by_profile = t.held_profile[i] / double(kPopulations);
    std::printf("%-5s curvature: held in %.3f, %.3f times the exact width; profile: %.3f, %.3f\n",
                kParameters[static_cast<std::size_t>(i)].name.c_str(), by_curvature, median(t.ratio_curvature[i]),
                by_profile, median(t.ratio_profile[i]));
    EXPECT_GE(by_curvature, 0.90);
    EXPECT_LE(by_curvature, 0.98);
    EXPECT_LE(median(t.ratio_curvature[i]), 1.3);
    EXPECT_GE(by_profile, 0.90);
    EXPECT_LE(by_profile, 0.98);
    EXPECT_LE(median(t.ratio_profile[i]), 1.3);
  }
}

TEST(Population, IsCoveredByALawThatFits) { require(0.0, 0.01); }             // verify
TEST(Population, IsCoveredByALawThatMisfitsALittle) { require(0.02, 0.01); }  // verify
TEST(Population, IsCoveredUnderMuchNoise) { require(0.0, 0.05); }             // verify

}  // namespace
}  // namespace glisson::fit::population_test
