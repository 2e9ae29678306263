// Ramps and holds of muscle: six parameters of a law that misfits a little, from two curves. Their intervals end where the
// curves end them, though the residuals swing as slowly as the parameters' own shapes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "fit/run_fit.h"
#include "phantom.h"

namespace glisson::fit::muscle_hold_test {
namespace {

const std::filesystem::path kFolder = test::shipped("../shared/data/tissue");
constexpr double kArea = 1e-4, kHeight = 0.01;  // any: the data are stretch and Cauchy stress

/// Displacement and force of a specimen that keeps its volume: F = −σ A/λ.
std::string as_forces(const std::filesystem::path& file) {
  std::istringstream rows(phantom::text_of(file));
  std::ostringstream out;
  std::string line;
  std::getline(rows, line);
  out << "time (s),displacement (mm),force (N)\n";
  while (std::getline(rows, line)) {
    double time = 0.0, stretch = 1.0, kilopascals = 0.0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf", &time, &stretch, &kilopascals) != 3) continue;
    out << time << ',' << 1e3 * kHeight * (1.0 - stretch) << ',' << -1e3 * kilopascals * kArea / stretch << '\n';
  }
  return out.str();
}

constexpr const char* kFit = R"(
[specimen]
kind = "block"
width_mm = 10
depth_mm = 10
height_mm = 10
[tissue]
hyperelastic = { kind = "ogden", mu_Pa = [2600], alpha = [20], bulk_modulus_Pa = 1e6 }
maxwell = [{ share = 0.7, time_s = 1 }, { share = 0.1, time_s = 60 }]
[[parameter]]
key = "tissue.hyperelastic.mu_Pa[0]"
low = 100
high = 1e5
[[parameter]]
key = "tissue.hyperelastic.alpha[0]"
low = 0.5
high = 60
scale = "linear"
[[parameter]]
key = "tissue.maxwell[0].share"
low = 0.01
high = 0.84
scale = "linear"
[[parameter]]
key = "tissue.maxwell[0].time_s"
low = 0.02
high = 20
[[parameter]]
key = "tissue.maxwell[1].share"
low = 0.005
high = 0.15
scale = "linear"
[[parameter]]
key = "tissue.maxwell[1].time_s"
low = 5
high = 3000
[[data]]
files = ["hold_10.csv", "hold_20.csv"]
resample.over = "none"
[search]
starts = 1
[proof]
bootstrap = 0
next = false
)";

TEST(MuscleHold, HasIntervalsThatTheCurvesEnd) {  // long
  if (!std::filesystem::exists(kFolder)) GTEST_SKIP() << kFolder << " is not there";
  const phantom::Folder folder;
  for (const char* depth : {"10", "20"}) {
    const std::string name = std::string("hold_") + depth + ".csv";
    folder.write(name, as_forces(kFolder / ("muscle_" + name)));
  }
  const FitResult result = run_fit(parse_fit(kFit, (folder.path() / "fit.toml").string()), {});
  EXPECT_LT(result.rms_fit / kArea, 60.0);  // of a peak of 2.2 kPa
  for (const ParameterResult& p : result.parameters) {
    std::printf("  %s\n", p.words.c_str());
    EXPECT_NE(p.verdict, "not identifiable") << p.parameter.name;
  }
  EXPECT_EQ(result.parameters[1].verdict, "identified");
  EXPECT_THAT(result.conclusions,
              testing::Contains(testing::HasSubstr("How specimens differ is not in the intervals")));
}

}  // namespace
}  // namespace glisson::fit::muscle_hold_test
