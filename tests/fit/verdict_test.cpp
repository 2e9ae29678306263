// The words say what the numbers mean: which parameter is known, which is not, and which combination is known all the same.
#include "fit/uncertainty/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fit/uncertainty/combination.h"
#include "small_models.h"

namespace glisson::fit::verdict_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using testing_models::Noise;
using testing_models::plan;
using testing_models::simulate;
using testing_models::Twin;

Verdicts verdicts(const Problem& problem, const std::vector<double>& start, bool profile = true) {
  const Optimum best = descend(problem, problem.to_scaled(start));
  const Covariance c = covariance(problem, best.scaled);
  const Profiles p = profiles(problem, best, c);
  Verdicts v = judge(problem, c, profile ? &p : nullptr);
  for (const ParameterVerdict& one : v.of) std::printf("  %s\n", one.words.c_str());
  for (const std::string& words : v.conclusions) std::printf("  %s\n", words.c_str());
  return v;
}

std::vector<Curve> noisy(std::vector<Curve> curves, double sd, std::uint64_t seed) {
  Noise noise(seed);
  for (Curve& c : curves)
    for (double& f : c.force) f += sd * noise();
  return curves;
}

// F = a b x: neither is identifiable, the product is, and its interval holds the truth.
TEST(Verdict, NamesTheCombinationThatIsFixed) {
  const auto product = [](double x, double, std::span<const double> v) { return v[0] * v[1] * x; };
  const auto curves = noisy(simulate(plan(40, 0.0, 1.0), 1, product, {2.0, 3.0}), 0.05, 5);
  const Twin twin(
      {{"a", "Pa", 0.01, 100.0, Scale::logarithmic, 1.0}, {"b", "m", 0.01, 1000.0, Scale::logarithmic, 1.0}}, curves,
      0.05, product);
  for (const bool profile : {true, false}) {
    const Verdicts v = verdicts(twin.problem, {1.0, 1.0}, profile);
    EXPECT_EQ(v.of[0].verdict, Verdict::not_identifiable);
    EXPECT_EQ(v.of[1].verdict, Verdict::not_identifiable);
    EXPECT_THAT(v.of[0].words, StartsWith("a: not identifiable"));
    ASSERT_FALSE(v.conclusions.empty());
    EXPECT_THAT(v.conclusions[0], AllOf(StartsWith("a and b: only their combination"), HasSubstr(" · "),
                                        HasSubstr("correlation -1.000")));
    // of ln a + ln b, the bounds' logarithms apart: t sd, 0.46 % were the noise known to be independent
    double value = 0.0, half = 0.0;
    const std::string tail = v.conclusions[0].substr(v.conclusions[0].find(" = ") + 3);
    ASSERT_EQ(std::sscanf(tail.c_str(), "%lf ± %lf", &value, &half), 2) << tail;
    EXPECT_NEAR(value, 6.0, 0.05);
    const Optimum best = descend(twin.problem, twin.problem.to_scaled(std::vector{1.0, 1.0}));
    const Covariance c = covariance(twin.problem, best.scaled);
    const double sd = std::sqrt(c.variance_of(std::vector{std::log(1e4), std::log(1e5)}));
    EXPECT_NEAR(half, 100.0 * c.quantile * sd, 0.05);
    EXPECT_NEAR(half, 0.46, 0.20);  // the noise of 38 samples is known to 12 %, its correlation widens by 12 to 20 %
  }
  EXPECT_THAT(verdicts(twin.problem, {1.0, 1.0}).conclusions[0], HasSubstr("flat from"));
}

// E and ν from one confined compression: F = E (1 − ν) / ((1 + ν)(1 − 2ν)) x, the oedometer's modulus alone.
TEST(Verdict, SaysThatOneCurveDoesNotFixTwoConstants) {
  const auto confined = [](double x, double, std::span<const double> v) {
    return v[0] * (1.0 - v[1]) / ((1.0 + v[1]) * (1.0 - 2.0 * v[1])) * x;
  };
  const auto curves = noisy(simulate(plan(40, 0.0, 0.1), 1, confined, {5.0, 0.3}), 0.01, 6);
  const Twin twin({{"E", "kPa", 0.1, 50.0, Scale::logarithmic, 1.0}, {"nu", "", 0.1, 0.49}}, curves, 0.01, confined);
  const Verdicts v = verdicts(twin.problem, {4.0, 0.25});
  EXPECT_EQ(v.of[0].verdict, Verdict::not_identifiable);
  EXPECT_EQ(v.of[1].verdict, Verdict::not_identifiable);
  EXPECT_THAT(v.of[1].words, HasSubstr("profile is flat from 0.1 to 0.49"));
  EXPECT_THAT(v.conclusions,
              Contains(AllOf(HasSubstr("E and nu"), HasSubstr("less of nu"), HasSubstr("correlation -"))));
}

// Free sides: the force of a small compression is E x, whatever ν is.
TEST(Verdict, SaysThatACurveDoesNotDependOnAParameter) {
  const auto free = [](double x, double, std::span<const double> v) { return v[0] * x; };
  const auto curves = noisy(simulate(plan(40, 0.0, 0.1), 1, free, {5.0, 0.3}), 0.01, 6);
  const Twin twin({{"E", "kPa", 0.5, 50.0, Scale::logarithmic, 1.0}, {"nu", "", 0.1, 0.49}}, curves, 0.01, free);
  const Verdicts v = verdicts(twin.problem, {4.0, 0.25});
  EXPECT_EQ(v.of[0].verdict, Verdict::identified);
  EXPECT_EQ(v.of[1].verdict, Verdict::not_identifiable);
  EXPECT_THAT(v.conclusions, Contains(StartsWith("nu: these curves do not depend on it")));
}

// A limit on one side only is weak, and the words say which side is missing.
TEST(Verdict, CallsAOneSidedLimitWeak) {
  const auto saturation = [](double x, double, std::span<const double> v) { return 1.0 - std::exp(-v[0] * x); };
  const auto curves = noisy(simulate(plan(30, 0.2, 1.0), 1, saturation, {40.0}), 0.02, 5);
  const Twin twin({{"k", "1/m", 1.0, 1000.0, Scale::logarithmic, 1.0}}, curves, 0.02, saturation);
  const Verdicts v = verdicts(twin.problem, {10.0});
  EXPECT_EQ(v.of[0].verdict, Verdict::weak);
  EXPECT_THAT(v.of[0].words, HasSubstr("no upper limit within its bounds (1000 1/m)"));
}

// Zero within the interval, whatever the bounds: where the force hardly changes over it the parameter can go, and where
// another makes up for it, it is weak, however small a part of its bounds it takes.
TEST(Verdict, TellsWhatCanBeLeftOutFromWhatIsCompensated) {
  const auto wave = [](double x, double, std::span<const double> v) { return v[0] + v[1] * std::sin(40.0 * x); };
  const auto flat = noisy(simulate(plan(60, 0.0, 1.0), 1, wave, {5.0, 0.0}), 0.1, 5);
  const Twin apart({{"level", "N", 0.1, 50.0, Scale::logarithmic, 1.0}, {"wave", "N", -1.0, 1.0}}, flat, 0.1, wave);
  const Verdicts v = verdicts(apart.problem, {4.0, 0.2});
  EXPECT_EQ(v.of[0].verdict, Verdict::identified);
  EXPECT_THAT(v.of[0].words, HasSubstr("(± "));
  EXPECT_EQ(v.of[1].verdict, Verdict::negligible);
  EXPECT_THAT(v.of[1].words, HasSubstr("it can be left out"));
  const auto line = [](double x, double, std::span<const double> at) { return at[0] + at[1] * x; };
  const auto far = noisy(simulate(plan(60, 10.0, 10.5), 1, line, {5.0, 0.0}), 0.1, 5);
  const Twin close({{"level", "N", -1e4, 1e4}, {"slope", "N/m", -1e3, 1e3}}, far, 0.1, line);
  const Verdicts w = verdicts(close.problem, {4.0, 0.2});
  EXPECT_EQ(w.of[1].verdict, Verdict::weak);  // ± 0.2 of 2000, but of either sign, and the level makes up for it
  EXPECT_THAT(w.of[1].words, AllOf(HasSubstr("of either sign"), HasSubstr("make up for that")));
}

TEST(Verdict, SaysWhichBoundIsInTheWay) {
  const auto line = [](double x, double, std::span<const double> v) { return v[0] * x; };
  const auto curves = noisy(simulate(plan(30, 0.0, 1.0), 1, line, {5.0}), 0.1, 5);
  const Twin twin({{"E", "Pa", 0.1, 4.0, Scale::logarithmic, 1.0}}, curves, 0.1, line);
  const Verdicts v = verdicts(twin.problem, {1.0});
  EXPECT_EQ(v.of[0].verdict, Verdict::at_bound);
  EXPECT_THAT(v.of[0].words, AllOf(HasSubstr("at its upper bound, 4 Pa"), HasSubstr("fit better with more")));
}

// Without profiles nothing is known of values away from a bound, and nothing is said of them: here four times the rms is left at 2 Pa.
TEST(Verdict, SaysWhatWasNotExamined) {
  const auto line = [](double x, double, std::span<const double> v) { return v[0] * x; };
  const auto curves = noisy(simulate(plan(30, 0.0, 1.0), 1, line, {5.0}), 0.1, 5);
  const Twin twin({{"E", "Pa", 0.1, 4.0, Scale::logarithmic, 1.0}}, curves, 0.1, line);
  const Verdicts v = verdicts(twin.problem, {1.0}, false);
  EXPECT_EQ(v.of[0].verdict, Verdict::at_bound);
  EXPECT_THAT(v.of[0].words, AllOf(HasSubstr("at its upper bound, 4 Pa"), HasSubstr("was not examined"),
                                   Not(HasSubstr("nearly as good")), Not(HasSubstr("0.1 Pa"))));
  EXPECT_THAT(verdicts(twin.problem, {1.0}).of[0].words, HasSubstr("nearly as good"));
  const auto product = [](double x, double, std::span<const double> w) { return w[0] * w[1] * x; };
  const auto both = noisy(simulate(plan(40, 0.0, 1.0), 1, product, {2.0, 3.0}), 0.05, 5);
  const Twin two({{"a", "Pa", 0.01, 100.0, Scale::logarithmic, 1.0}, {"b", "m", 0.01, 1000.0, Scale::logarithmic, 1.0}},
                 both, 0.05, product);
  EXPECT_THAT(verdicts(two.problem, {1.0, 1.0}, false).of[0].words,
              AllOf(HasSubstr("was not examined"), Not(HasSubstr("fits these curves"))));
}

// Ogden's μ and α over a large range are known both; over a small one they make up for each other.
TEST(Verdict, TellsEntangledFromIdentified) {
  const auto ogden = [](double x, double, std::span<const double> v) { return testing_models::ogden(x, v[0], v[1]); };
  const std::vector<Parameter> parameters{{"mu", "Pa", 100.0, 1e4, Scale::logarithmic, 1e3}, {"alpha", "", 1.0, 20.0}};
  const auto far = noisy(simulate(plan(60, 0.0, 0.5), 2, ogden, {1000.0, 6.0}), 20.0, 5);
  const Twin good(parameters, far, 20.0, ogden);
  const Verdicts v = verdicts(good.problem, {500.0, 3.0});
  EXPECT_EQ(v.of[0].verdict, Verdict::identified);
  EXPECT_EQ(v.of[1].verdict, Verdict::identified);
  const auto near = noisy(simulate(plan(60, 0.0, 0.05), 2, ogden, {1000.0, 6.0}), 3.5, 5);
  const Twin poor(parameters, near, 3.5, ogden);
  const Verdicts w = verdicts(poor.problem, {1000.0, 6.0});
  EXPECT_EQ(w.of[1].verdict, Verdict::weak);
  EXPECT_THAT(w.conclusions,
              Contains(AllOf(StartsWith("mu and alpha compensate each other"), HasSubstr("correlation 0.9"))));
  EXPECT_THAT(w.conclusions, Contains(StartsWith("least known: ")));
}

TEST(Combination, WritesExponentsAndFactors) {
  const auto power = [](double x, double, std::span<const double> v) { return v[0] * v[1] * v[1] * x; };
  const auto curves = noisy(simulate(plan(40, 0.0, 1.0), 1, power, {2.0, 3.0}), 0.05, 5);
  const Twin logs({{"a", "", 0.1, 100.0, Scale::logarithmic, 1.0}, {"b", "", 0.1, 100.0, Scale::logarithmic, 1.0}},
                  curves, 0.05, power);
  EXPECT_THAT(verdicts(logs.problem, {1.0, 1.0}).conclusions, Contains(HasSubstr("b · a^0.5 = ")));
  const auto sum = [](double x, double, std::span<const double> v) { return (v[0] - 3.0 * v[1]) * x; };
  const auto lines = noisy(simulate(plan(40, 0.0, 1.0), 1, sum, {4.0, 1.0}), 0.05, 5);
  const Twin linear({{"a", "", -10.0, 10.0}, {"b", "", -5.0, 5.0}}, lines, 0.05, sum);
  EXPECT_THAT(verdicts(linear.problem, {1.0, 0.5}).conclusions, Contains(HasSubstr("b − 0.333 a = ")));
}

}  // namespace
}  // namespace glisson::fit::verdict_test
