// Real curves of silicone phantoms: fitted on A1 to A3, held against A4 and A5. The error on curves that were held out is
// within what published repetitions differ by, one optimum is found from every start, and linear elasticity shows its misfit.
// Over the strains of the published fits the errors are those that were published.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "fit/data/load_curves.h"
#include "fit/phantom.h"
#include "fit/run_fit.h"
#include "support/places.h"

namespace glisson::fit {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = test::shipped("../shared/data/phantom");

struct Mix {
  const char* scene;
  std::array<double, 6> sd_kPa;  ///< of ten runs at 5, 10, 20, 30, 40, 50 % strain, as published [reference, phantoms]
};
const Mix kSoft{"phantom_ef10_100t.toml", {.05, .06, .08, .12, .22, .46}};
const Mix kStiff{"phantom_ef10_75t.toml", {.01, .01, .03, .06, .12, .29}};

/// Root mean square over strain 0 to 50 % of the published deviations, straight between the strains and to 0 at rest.
double published_spread(const Mix& mix) {
  constexpr std::array kStrains{0.05, 0.1, 0.2, 0.3, 0.4, 0.5};
  double squares = 0.0;
  constexpr int kSamples = 1000;
  for (int i = 0; i < kSamples; ++i) {
    const double strain = 0.5 * (i + 0.5) / kSamples;
    std::size_t k = 0;
    while (kStrains[k] < strain) ++k;
    const double left = k == 0 ? 0.0 : kStrains[k - 1], low = k == 0 ? 0.0 : mix.sd_kPa[k - 1];
    const double sd = low + (mix.sd_kPa[k] - low) * (strain - left) / (kStrains[k] - left);
    squares += sd * sd;
  }
  return std::sqrt(squares / kSamples);
}

double kPa(double newtons) { return 1e-3 * newtons / (0.25 * std::numbers::pi * 0.05 * 0.05); }

/// Root mean square of the fitted curves about their mean [kPa].
double spread_of_fitted(const FitResult& result) {
  for (const GroupResult& group : result.groups) {
    if (!group.held_out && group.spread) return kPa(*group.spread);
  }
  return std::nan("");
}

class Phantom : public ::testing::TestWithParam<Mix> {
 protected:
  void SetUp() override {
    if (!fs::exists(kFolder))
      GTEST_SKIP() << kFolder << " is not there: the phantoms' curves are not part of this repository";
    options_.data_folder = kFolder;
    spec_ = load_fit(test::shipped("scenes/fit") / GetParam().scene);
    spec_.proof.bootstrap = 0;
  }
  FitSpec spec_;
  FitRun options_;
};

TEST_P(Phantom, MeetsHeldOutCurvesAsNearAsTheTestRepeats) {
  const FitResult result = run_fit(spec_, options_);
  ASSERT_TRUE(result.complete);
  ASSERT_TRUE(result.rms_heldout);
  EXPECT_LE(kPa(*result.rms_heldout), published_spread(GetParam()));
  // no function of strain is nearer to three curves than their mean, about which they differ by this much
  EXPECT_LE(kPa(result.rms_fit), 1.2 * spread_of_fitted(result));
  // three parameters, twenty starts: one basin
  ASSERT_EQ(result.starts.size(), 20u);
  ASSERT_EQ(result.basins.size(), 1u);
  EXPECT_EQ(result.basins.front().found, 20);
  for (const ParameterResult& p : result.parameters) {
    ASSERT_TRUE(p.ci95()) << p.parameter.name;
    EXPECT_LT(p.ci95()->low, p.value);
    EXPECT_GT(p.ci95()->high, p.value);
  }
}

TEST_P(Phantom, LinearElasticityShowsItsMisfit) {
  options_.laws = {"constant", "linear", "veronda_westmann"};
  const FitResult result = run_fit(spec_, options_);
  ASSERT_EQ(result.laws.size(), 3u);
  EXPECT_EQ(result.laws[0].name, "veronda_westmann");
  EXPECT_TRUE(result.laws[0].best);
  const auto rms = [&](const std::string& name) {
    for (const LawResult& law : result.laws) {
      if (law.name == name) return kPa(*law.rms_heldout);
    }
    return std::nan("");
  };
  // a straight line through a curve that rises tenfold faster at its end than at its begin
  EXPECT_GT(rms("constant"), 0.5);
  EXPECT_GT(rms("linear"), 0.3);
  EXPECT_LE(rms("veronda_westmann"), published_spread(GetParam()));
}

/// Engineering stress at strains 0.5 % apart up to 66.5 %, the range of the published fits: the mean of the five tests, as a table.
std::string mean_table() {
  DataSpec tests;
  for (int i = 1; i <= 5; ++i) tests.files.emplace_back("EF10_100T_A" + std::to_string(i) + ".csv");
  tests.resample.over = ResampleOver::none;
  const std::vector<PreparedCurve> curves = load_curves(tests, phantom::kPhantomSize, kFolder);
  std::string table = "strain [-],stress [kPa]\n";
  for (int i = 1; i <= 133; ++i) {
    const double strain = 0.005 * i, way = strain * *phantom::kPhantomSize.height;
    double sum = 0.0;
    for (const auto& [curve, account] : curves) {
      const auto& x = curve.displacement;
      const std::size_t k = std::size_t(std::ranges::find_if(x, [&](double at) { return at > way; }) - x.begin());
      sum += std::lerp(curve.force[k - 1], curve.force[k], (way - x[k - 1]) / (x[k] - x[k - 1]));
    }
    table += std::to_string(strain) + ',' + std::to_string(kPa(sum / double(curves.size()))) + '\n';
  }
  return table;
}

// Published, of ten tests: one Ogden term leaves a standard error of 0.217 kPa, three Yeoh terms 0.066 kPa. These are five of
// the ten: scripts/fit_phantoms finds 0.209 and 0.072 kPa in them, where the specimen is incompressible.
TEST(PublishedRange, ErrorsAreThePublishedOnes) {
  if (!phantom::have_phantoms())
    GTEST_SKIP() << kFolder << " is not there: the phantoms' curves are not part of this repository";
  const phantom::Folder folder;
  folder.write("mean.csv", mean_table());
  FitSpec spec = load_fit(test::shipped("scenes/fit/phantom_mean.toml"));
  DataSpec mean;
  mean.files = {"mean.csv"};
  mean.speed = 1e-2 / 60.0;
  for (ColumnSpec* column : {&mean.columns.strain, &mean.columns.stress}) column->given = true;
  mean.columns.strain.name = "strain";
  mean.columns.stress.name = "stress";
  mean.resample.over = ResampleOver::none;
  spec.data = {mean};
  spec.proof.profiles = false;
  spec.proof.bootstrap = 0;
  FitRun options;
  options.data_folder = folder.path();
  options.laws = {"ogden", "yeoh"};
  const FitResult result = run_fit(spec, options);
  const auto error = [&](const std::string& name) {
    const auto law = std::ranges::find(result.laws, name, &LawResult::name);
    return law == result.laws.end() ? std::nan("") : kPa(law->rms_fit) * std::sqrt(133.0 / (133.0 - law->parameters));
  };
  EXPECT_NEAR(error("ogden"), 0.209, 0.002);
  EXPECT_NEAR(error("yeoh"), 0.072, 0.002);
  EXPECT_NEAR(error("ogden"), 0.217, 0.1 * 0.217);
  EXPECT_NEAR(error("yeoh"), 0.066, 0.1 * 0.066);
}

INSTANTIATE_TEST_SUITE_P(Mixes, Phantom, ::testing::Values(kSoft, kStiff), [](const auto& mix) {
  return std::string(mix.param.scene).find("100t") != std::string::npos ? "EF10_100T" : "EF10_75T";
});

}  // namespace
}  // namespace glisson::fit
