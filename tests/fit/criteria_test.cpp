// Information criteria have their closed forms and find the order that made the data; the held-out rule prefers the simplest
// law that predicts as well.
#include "fit/uncertainty/criteria.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "small_models.h"

namespace glisson::fit {
namespace {

constexpr int kPoints = 60;
constexpr int kFitted = 3, kHeldout = 4;

Eigen::MatrixXd powers(int order) {
  Eigen::MatrixXd x(kPoints, order + 1);
  for (int i = 0; i < kPoints; ++i)
    for (int k = 0; k <= order; ++k) x(i, k) = std::pow(i / (kPoints - 1.0), k);
  return x;
}

/// Polynomials of order 1 … 6 fitted by the normal equations to curves of order 3 with white noise of 2 %.
std::vector<LawFit> polynomials(std::uint64_t seed) {
  testing_models::Noise noise(seed);
  const Eigen::Vector4d truth(0.0, 1.0, -2.0, 4.0);
  std::vector<Eigen::VectorXd> curves;
  for (int c = 0; c < kFitted + kHeldout; ++c) {
    curves.emplace_back(powers(3) * truth);
    for (double& f : curves.back()) f += 0.06 * noise();
  }
  std::vector<LawFit> laws;
  for (int order = 1; order <= 6; ++order) {
    const Eigen::MatrixXd x = powers(order);
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(kPoints);
    for (int c = 0; c < kFitted; ++c) mean += curves[static_cast<std::size_t>(c)] / kFitted;
    const Eigen::VectorXd model = x * x.colPivHouseholderQr().solve(mean);
    LawFit law{"order " + std::to_string(order),
               static_cast<std::size_t>(order) + 1,
               0.0,
               kFitted * kPoints,
               kFitted * kPoints,
               {}};
    for (int c = 0; c < kFitted; ++c) law.sum_squares += (curves[static_cast<std::size_t>(c)] - model).squaredNorm();
    for (int c = kFitted; c < kFitted + kHeldout; ++c)
      law.heldout_rms.push_back((curves[static_cast<std::size_t>(c)] - model).norm() / std::sqrt(kPoints));
    laws.push_back(law);
  }
  return laws;
}

// ln L of n residuals under their own variance is Σ ln of the normal density.
TEST(Criteria, HaveTheirClosedForms) {
  const std::vector<double> r{0.3, -0.1, 0.4, -0.2, 0.1, -0.5, 0.2, 0.1};
  double squares = 0.0;
  for (const double x : r) squares += x * x;
  const double variance = squares / 8.0;
  double log_likelihood = 0.0;
  for (const double x : r)
    log_likelihood += -0.5 * std::log(2.0 * std::numbers::pi * variance) - 0.5 * x * x / variance;
  const Criteria c = criteria(squares, 8, 8.0, 2);
  EXPECT_NEAR(c.log_likelihood, log_likelihood, 1e-12);
  EXPECT_NEAR(c.aic, -2.0 * log_likelihood + 6.0, 1e-12);
  EXPECT_NEAR(c.aicc, c.aic + 2.0 * 3.0 * 4.0 / 4.0, 1e-12);
  EXPECT_NEAR(c.bic, -2.0 * log_likelihood + 3.0 * std::log(8.0), 1e-12);
  EXPECT_TRUE(std::isinf(criteria(squares, 8, 8.0, 7).aicc));
  // half the samples count: half the likelihood
  EXPECT_NEAR(criteria(squares, 8, 4.0, 2).log_likelihood, 0.5 * log_likelihood, 1e-12);
}

// BIC finds the order nearly always, AICc takes one too many in the seeds theory expects of it (P(χ²₁ > 2) = 16 %, and more
// orders to go to), the held-out rule hardly ever takes a law more complex than the true one.
TEST(Criteria, FindTheOrderThatMadeTheData) {
  int bic = 0, aicc = 0, rule = 0, complex = 0;
  constexpr int kSeeds = 200;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const std::vector<LawFit> laws = polynomials(seed);
    const LawRanking ranking = rank_laws(laws);
    const auto least = [&](auto figure) {
      return laws[std::min_element(ranking.order.begin(), ranking.order.end(),
                                   [&](const LawRank& a, const LawRank& b) { return figure(a) < figure(b); })
                      ->law]
          .parameters;
    };
    if (least([](const LawRank& r) { return r.delta_bic; }) == 4) ++bic;
    if (least([](const LawRank& r) { return r.delta_aicc; }) == 4) ++aicc;
    if (laws[ranking.chosen].parameters == 4) ++rule;
    if (laws[ranking.chosen].parameters > 4) ++complex;
  }
  std::printf("of 200 seeds: BIC %d, AICc %d, held-out rule %d right, %d too complex\n", bic, aicc, rule, complex);
  EXPECT_GE(bic, 180);
  EXPECT_GE(aicc, 120);
  EXPECT_GE(rule, 180);
  EXPECT_LE(complex, 10);
}

TEST(Criteria, WeightsAreThoseOfAkaike) {
  const std::vector<LawFit> laws{{"a", 1, 10.0, 100, 100.0, {}}, {"b", 2, 8.0, 100, 100.0, {}}};
  const LawRanking r = rank_laws(laws);
  EXPECT_EQ(r.best, 1u);
  EXPECT_NEAR(r.order[0].akaike_weight + r.order[1].akaike_weight, 1.0, 1e-12);
  EXPECT_NEAR(r.order[1].akaike_weight / r.order[0].akaike_weight, std::exp(-0.5 * r.order[1].delta_aicc), 1e-12);
  EXPECT_THAT(r.sentence, testing::StartsWith("the data support 2 parameters: b"));
}

// Two laws within each other's error: the simpler is chosen, and the sentence says against which.
TEST(Criteria, ChoosesTheSimplestThatIsAsGood) {
  const std::vector<LawFit> laws{{"ogden 2", 4, 8.0, 100, 50.0, {0.9, 1.0, 1.2}},
                                 {"linear", 1, 90.0, 100, 20.0, {5.0, 5.2, 4.9}},
                                 {"exponential", 2, 8.5, 100, 45.0, {0.95, 1.05, 1.2}}};
  const LawRanking r = rank_laws(laws);
  EXPECT_EQ(r.best, 0u);
  EXPECT_EQ(r.chosen, 2u);
  EXPECT_EQ(r.order.back().law, 1u);
  EXPECT_FALSE(r.order.back().as_good);
  EXPECT_THAT(r.sentence, testing::AllOf(testing::StartsWith("the data support 2 parameters: exponential"),
                                         testing::HasSubstr("ogden 2 with 4")));
}

// One sample that counts is too few for any AICc: then AIC chooses, by hand ln 1e4 = 9.2 for one parameter more, and it is said.
TEST(Criteria, ChoosesByAicWhereNoLawHasAnAicc) {
  const std::vector<LawFit> laws{{"far", 1, 1e4, 100, 1.0, {}}, {"near", 2, 1.0, 100, 1.0, {}}};
  const LawRanking r = rank_laws(laws);
  EXPECT_FALSE(r.corrected);
  EXPECT_EQ(r.chosen, 1u);
  EXPECT_NEAR(r.order[1].delta_aicc, std::log(1e4) - 2.0, 1e-12);
  EXPECT_NE(r.sentence.find("too few for AICc"), std::string::npos) << r.sentence;
}

TEST(Criteria, RefusesLawsOfDifferentCurves) {
  const std::vector<LawFit> laws{{"a", 1, 10.0, 100, 100.0, {}}, {"b", 2, 8.0, 99, 99.0, {}}};
  EXPECT_THROW(rank_laws(laws), std::invalid_argument);
  EXPECT_THROW(rank_laws({}), std::invalid_argument);
}

}  // namespace
}  // namespace glisson::fit
