// further_batch_test.cpp — where the optimum of a further batch lies: the exact prediction interval of a linear law, families whose next
// batch is met as often as is said, and what is refused.
#include "fit/uncertainty/further_batch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "fit/run_fit.h"
#include "fit/uncertainty/distribution.h"
#include "laboratory.h"
#include "phantom.h"
#include "small_models.h"

namespace glisson::fit::further_batch_test {
namespace {

using testing::HasSubstr;
using testing_models::Noise;
using testing_models::plan;
using testing_models::Twin;

/// As many curves as `values` has numbers, F = v x without noise, in batches of so many.
std::vector<Curve> lines(const std::vector<double>& values, std::size_t in_a_batch) {
  std::vector<Curve> curves;
  for (std::size_t k = 0; k < values.size(); ++k) {
    Curve c = plan(20, 0.05, 1.0);
    c.name = "curve " + std::to_string(k + 1);
    c.batch = std::string(1, static_cast<char>('A' + k / in_a_batch));
    for (std::size_t i = 0; i < c.size(); ++i) c.force[i] = values[k] * c.displacement[i];
    curves.push_back(std::move(c));
  }
  return curves;
}

double line(double x, double, std::span<const double> v) { return v[0] * x; }

// Of F = a x the optimum of a batch is the mean of its specimens' a: the interval is the exact one of Student's t from three such means,
// whatever specimens do within a batch.
TEST(FurtherBatch, IsTheExactIntervalOfALine) {
  const std::vector<double> means{2.0, 2.6, 2.9};
  const Twin twin({{"a", "N", 0.0, 10.0, Scale::linear, 1.0}}, lines({1.9, 2.1, 2.2, 3.0, 2.85, 2.95}, 2), 0.01, line);
  const Optimum best = descend(twin.problem, std::vector{0.3});
  const FurtherBatch further = further_batch(twin.problem, covariance(twin.problem, best.scaled), {});
  ASSERT_EQ(further.batches, (std::vector<std::string>{"A", "B", "C"}));
  double mean = 0.0, squares = 0.0;
  for (const double m : means) mean += m / 3.0;
  for (const double m : means) squares += (m - mean) * (m - mean);
  const double half = student_quantile(0.975, 2.0) * std::sqrt(squares / 2.0 * (1.0 + 1.0 / 3.0));
  // the descents end within 1e-10 of the cost, so that a is known to some 1e-6
  EXPECT_NEAR(further.parameters[0].low, mean - half, 1e-5);
  EXPECT_NEAR(further.parameters[0].high, mean + half, 1e-5);
  EXPECT_FALSE(further.parameters[0].low_open || further.parameters[0].high_open);
}

// Two batches tell nothing of a third; an end beyond a bound is open.
TEST(FurtherBatch, SaysNothingOfTwoAndIsOpenAtABound) {
  const Twin two({{"a", "N", 0.0, 10.0, Scale::linear, 1.0}}, lines({1.9, 2.1, 2.2, 3.0}, 2), 0.01, line);
  const Optimum best = descend(two.problem, std::vector{0.3});
  EXPECT_TRUE(further_batch(two.problem, covariance(two.problem, best.scaled), {}).parameters.empty());
  const Twin wide({{"a", "N", 0.0, 10.0, Scale::linear, 1.0}}, lines({0.5, 0.6, 3.0, 3.1, 6.0, 6.3}, 2), 0.01, line);
  const Optimum middle = descend(wide.problem, std::vector{0.3});
  const FurtherBatch further = further_batch(wide.problem, covariance(wide.problem, middle.scaled), {});
  ASSERT_EQ(further.parameters.size(), 1U);
  EXPECT_TRUE(further.parameters[0].low_open);
  EXPECT_EQ(further.parameters[0].low, 0.0);
}

constexpr double kMu = 2500.0, kAlpha = 6.0;
constexpr int kBatches = 5, kSpecimens = 5;

double ogden(double x, double, std::span<const double> v) { return testing_models::ogden(x, v[0], v[1]); }

/// Specimens of a batch that differ by 4 % in μ and 0.2 in α about a batch that differs by 10 % and 0.5, with 1 % of noise.
std::vector<Curve> drawn_batch(Noise& noise, int number) {
  const double own_mu = std::log(kMu) + 0.10 * noise(), own_alpha = kAlpha + 0.5 * noise();
  std::vector<Curve> curves;
  for (int k = 0; k < kSpecimens; ++k) {
    Curve c = plan(60, 0.01, 0.5);
    c.batch = std::to_string(number);
    c.name = c.batch + "." + std::to_string(k);
    const std::vector<double> v{std::exp(own_mu + 0.04 * noise()), own_alpha + 0.2 * noise()};
    const std::vector<double> e = noise.correlated(c.size(), 0.6);
    for (std::size_t i = 0; i < c.size(); ++i)
      c.force[i] = ogden(c.displacement[i], 0.0, v) + 0.01 * testing_models::ogden(0.5, kMu, kAlpha) * e[i];
    curves.push_back(std::move(c));
  }
  return curves;
}

struct Tally {
  int batch[2] = {},
      mean[2] = {};  ///< how often the interval of a further batch, and that of the mean, holds the next optimum
};

Tally tally(std::uint64_t first, std::uint64_t families) {
  const std::vector<Parameter> parameters{{"mu", "Pa", 100.0, 1e5, Scale::logarithmic, 1000.0},
                                          {"alpha", "", 0.5, 20.0, Scale::linear, 3.0}};
  const double spread = 0.02 * testing_models::ogden(0.5, kMu, kAlpha);
  Tally t;
  for (std::uint64_t seed = first; seed < first + families; ++seed) {
    Noise noise(seed);
    std::vector<Curve> curves;
    for (int b = 0; b < kBatches; ++b) {
      for (Curve& c : drawn_batch(noise, b)) curves.push_back(std::move(c));
    }
    const Twin twin(parameters, curves, spread, ogden), next(parameters, drawn_batch(noise, kBatches), spread, ogden);
    const std::vector<double> start = twin.problem.to_scaled(std::vector{2000.0, 5.0});
    const Optimum best = descend(twin.problem, start);
    const Covariance c = covariance(twin.problem, best.scaled);
    const FurtherBatch further = further_batch(twin.problem, c, {});
    const std::vector<double> there = next.problem.to_values(descend(next.problem, start).scaled);
    for (std::size_t p = 0; p < 2; ++p) {
      t.batch[p] += further.parameters.at(p).holds(there[p]) ? 1 : 0;
      t.mean[p] += c.interval[p].holds(there[p]) ? 1 : 0;
    }
  }
  std::printf("of %d next batches: mu in %d, alpha in %d; by the interval of the mean %d and %d\n",
              static_cast<int>(families), t.batch[0], t.batch[1], t.mean[0], t.mean[1]);
  return t;
}

// Sixty families of five batches of five: the optimum of the next batch lies within in nine of ten or more (95 % are said; 54 of 60 or
// more have a probability of 0.97), where the interval of the mean holds it in half of them at most.
TEST(FurtherBatchFamilies, MeetTheNextOfSixty) {  // verify
  const Tally t = tally(1000, 60);
  for (int p = 0; p < 2; ++p) {
    EXPECT_GE(t.batch[p], 54);
    EXPECT_LE(t.mean[p], 36);
  }
}

// Six of them: all but one.
TEST(FurtherBatch, IsMetByTheNextOfAFewFamilies) {
  const Tally t = tally(1, 6);
  for (int p = 0; p < 2; ++p) EXPECT_GE(t.batch[p], 5);
}

std::string press(double stiffness) {
  std::vector<double> time, way, force;
  for (int i = 0; i <= 30; ++i) {
    const double stretch = 1.0 - 0.01 * i;
    time.push_back(i), way.push_back(0.3 * i);
    force.push_back(stiffness * (1.0 / (stretch * stretch) - stretch) + 0.002 * std::sin(7.0 * i));
  }
  return laboratory::table({"time (s)", "displacement (mm)", "force (N)"}, {time, way, force});
}

const std::string kHead = R"([specimen]
kind = "cylinder"
diameter_mm = 50
height_mm = 30
[tissue]
hyperelastic = { kind = "neo_hookean", mu_Pa = 2000, bulk_modulus_Pa = 1e6 }
[[parameter]]
key = "tissue.hyperelastic.mu_Pa"
low = 50
high = 1e5
[search]
starts = 2
[proof]
bootstrap = 0
next = false
)";

/// A fit to presses of six specimens in tables of two, each with the keys given for it.
FitResult fitted(const std::vector<std::string>& keys) {
  const phantom::Folder folder;
  std::string text = kHead;
  for (std::size_t b = 0; b < keys.size(); ++b) {
    std::string files;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::string name = "s" + std::to_string(2 * b + k) + ".csv";
      folder.write(name, press(4.0 + 0.4 * static_cast<double>(b) + 0.1 * static_cast<double>(k)));
      files += (k == 0 ? "\"" : ", \"") + name + "\"";
    }
    text += "[[data]]\nfiles = [" + files + "]\n" + keys[b];
  }
  folder.write("fit.toml", text);
  return run_fit(load_fit(folder.path() / "fit.toml"), {});
}

std::string refusal(const std::vector<std::string>& keys) {
  try {
    fitted(keys);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no refusal";
}

// Three batches named in a file give the interval and the sentence; it is wider than that of the mean. Without them the result says what
// the interval is not of.
TEST(FurtherBatch, ComesWithAFitOfThree) {
  const FitResult result = fitted({"batch = \"A\"\n", "batch = \"B\"\n", "batch = \"C\"\n"});
  const ParameterResult& mu = result.parameters.front();
  ASSERT_TRUE(mu.further_batch && mu.ci95());
  EXPECT_LT(mu.further_batch->low, mu.ci95()->low);
  EXPECT_GT(mu.further_batch->high, mu.ci95()->high);
  EXPECT_THAT(result.conclusions, testing::Contains(HasSubstr("The optimum of a further batch is to be expected")));
  const FitResult plain = fitted({"", "", ""});
  EXPECT_FALSE(plain.parameters.front().further_batch);
  EXPECT_THAT(plain.conclusions, testing::Contains(HasSubstr("not of another batch's")));
}

// Fewer than three, or some without a name, are refused with the way out; held-out tables do not count.
TEST(FurtherBatch, RefusesFewerThanThree) {
  EXPECT_THAT(refusal({"batch = \"A\"\n", "batch = \"B\"\n"}), HasSubstr("2 batches are fitted"));
  EXPECT_THAT(refusal({"batch = \"A\"\n", "batch = \"A\"\n"}), HasSubstr("1 batch is fitted"));
  EXPECT_THAT(refusal({"batch = \"A\"\n", "", "batch = \"B\"\n"}), HasSubstr("names no batch"));
  EXPECT_THAT(refusal({"batch = \"A\"\n", "batch = \"B\"\n", "batch = \"C\"\nuse = \"test\"\n"}),
              HasSubstr("needs three or more"));
}

}  // namespace
}  // namespace glisson::fit::further_batch_test
