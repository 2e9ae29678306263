// What is said of a further specimen holds for specimens that were not fitted: of five phantoms of a mix every three are
// fitted, and the other two are held against the intervals and bands, which are as wide as the exact ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "fit/run_fit.h"
#include "fit/uncertainty/distribution.h"
#include "phantom.h"

namespace glisson::fit::further_specimen_test {
namespace {

constexpr int kSpecimens = 5, kFitted = 3;
const double kExact = student_quantile(0.975, kFitted - 1.0) * std::sqrt(1.0 + 1.0 / kFitted);

struct Tally {
  int held = 0, asked = 0;
  std::vector<double> width;  ///< over that of the exact interval
  void add(double low, double high, double value, double exact) {
    held += low <= value && value <= high ? 1 : 0, ++asked;
    width.push_back((high - low) / (2.0 * exact));
  }
  double share() const { return held / static_cast<double>(asked); }
  double median() {
    std::nth_element(width.begin(), width.begin() + std::ssize(width) / 2, width.end());
    return width[width.size() / 2];
  }
};

/// Half the exact prediction interval from as many values as were fitted.
double exact_half(const std::vector<double>& values) {
  double mean = 0.0, squares = 0.0;
  for (const double v : values) mean += v / kFitted;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return kExact * std::sqrt(squares / (kFitted - 1.0));
}

double force_at(const Curve& c, double x) {
  const auto above = static_cast<std::size_t>(std::upper_bound(c.displacement.begin(), c.displacement.end(), x) -
                                              c.displacement.begin());
  const std::size_t i = std::clamp<std::size_t>(above, 1, c.size() - 1);
  const double part = (x - c.displacement[i - 1]) / (c.displacement[i] - c.displacement[i - 1]);
  return c.force[i - 1] + part * (c.force[i] - c.force[i - 1]);
}

class Mix {
 public:
  explicit Mix(const char* scene) : spec_(load_fit(test::shipped("scenes/fit") / scene)) {
    spec_.proof.bootstrap = 0, spec_.proof.next = false, spec_.search.starts = 2;
    for (const DataSpec& data : spec_.data) files_.insert(files_.end(), data.files.begin(), data.files.end());
    for (const auto& file : files_) own_.push_back(fitted({file}, {}).parameters);
  }

  FitResult fitted(const std::vector<std::filesystem::path>& fit, const std::vector<std::filesystem::path>& test) {
    FitSpec spec = spec_;
    spec.data[0].files = fit, spec.data[1].files = test;
    if (test.empty()) spec.data.pop_back();
    FitRun run;
    run.data_folder = phantom::kPhantoms;
    return run_fit(spec, run);
  }

  void look(int a, int b, Tally& parameters, Tally& forces) {
    std::vector<std::filesystem::path> fit;
    std::vector<int> numbers;
    for (int s = 0; s < kSpecimens; ++s) {
      if (s != a && s != b) fit.push_back(files_[static_cast<std::size_t>(s)]), numbers.push_back(s);
    }
    const FitResult result = fitted(fit, {files_[static_cast<std::size_t>(a)], files_[static_cast<std::size_t>(b)]});
    for (std::size_t p = 0; p < result.parameters.size(); ++p) {
      std::vector<double> values;
      for (const int s : numbers) values.push_back(own_[static_cast<std::size_t>(s)][p].value);
      const auto& further = result.parameters[p].further;
      ASSERT_TRUE(further);
      for (const int s : {a, b})
        parameters.add(further->low, further->high, own_[static_cast<std::size_t>(s)][p].value, exact_half(values));
    }
    for (const CurveResult& c : result.curves) {
      if (!c.curve.held_out) continue;
      ASSERT_EQ(c.further_low.size(), c.curve.size());
      for (std::size_t i = 0; i < c.curve.size(); ++i) {
        std::vector<double> values;
        for (std::size_t k = 0; k < numbers.size(); ++k)
          values.push_back(force_at(result.curves[k].curve, c.curve.displacement[i]));
        forces.add(c.further_low[i], c.further_high[i], c.curve.force[i], exact_half(values));
      }
    }
  }

 private:
  FitSpec spec_;
  std::vector<std::filesystem::path> files_;
  std::vector<std::vector<ParameterResult>> own_;
};

TEST(FurtherSpecimen, IsMetByThoseThatWereNotFitted) {  // long
  if (!phantom::have_phantoms()) GTEST_SKIP() << phantom::kPhantoms << " is not there";
  Tally parameters, forces;
  for (const char* scene : {"phantom_ef10_100t.toml", "phantom_ef10_75t.toml"}) {
    Mix mix(scene);
    Tally p, f;
    for (int a = 0; a < kSpecimens; ++a) {
      for (int b = a + 1; b < kSpecimens; ++b) mix.look(a, b, p, f);
    }
    std::printf("%s: parameters within in %.3f of %d, %.2f times the exact width; forces %.3f of %d, %.2f times\n",
                scene, p.share(), p.asked, p.median(), f.share(), f.asked, f.median());
    for (const auto& [one, all] : {std::pair{&p, &parameters}, {&f, &forces}}) {
      all->held += one->held, all->asked += one->asked;
      all->width.insert(all->width.end(), one->width.begin(), one->width.end());
    }
  }
  EXPECT_GE(parameters.share(), 0.90);
  EXPECT_GE(forces.share(), 0.90);
  EXPECT_LE(parameters.median(), 1.3);
  EXPECT_LE(forces.median(), 1.3);
  std::printf("all: parameters %.3f, %.2f times; forces %.3f, %.2f times\n", parameters.share(), parameters.median(),
              forces.share(), forces.median());
}

}  // namespace
}  // namespace glisson::fit::further_specimen_test
