// The tissue of scenes/needle/bovine_liver.toml lets a held needle go by the shares and the times of its branches, those of whole
// liver [Kerdok2006]: exactly where all of the stress relaxes, less where its bulk and the capsule do not; then the needle is pulled out.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "../support/scene_runs.h"

namespace glisson::bovine_needle_held_test {
namespace {

/// Force on the needle over time.
struct Record {
  std::vector<double> time, force;  ///< [s], [N]

  double at(double t) const {
    for (std::size_t i = 1; i < time.size(); ++i) {
      if (time[i] >= t) return force[i - 1] + (force[i] - force[i - 1]) * (t - time[i - 1]) / (time[i] - time[i - 1]);
    }
    return force.back();
  }
};

class ForceRecorder final : public RunObserver {
 public:
  void on_sample(const Sample& s) override {
    record.time.push_back(s.time);
    record.force.push_back(-s.instruments.front().force.z);
  }
  Record record;
};

/// On coarse cells: how the force relaxes does not ask for a zone that the mesh resolves.
Record run(const std::string& variant, std::vector<Override> more) {
  std::vector<Override> overrides{{"output.frames", "0"}};
  overrides.insert(overrides.end(), more.begin(), more.end());
  const Scene scene = test::shipped_scene("needle/bovine_liver.toml", overrides);
  const auto found = std::ranges::find(scene.variants, variant, &Variant::name);
  ForceRecorder recorder;
  const std::atomic<bool> stop{false};
  EXPECT_EQ(run_variant(*found, {}, recorder, stop).end, RunSummary::End::finished);
  return recorder.record;
}

/// Pressed 5 mm into the whole surface within 1.224 s, and held there. Damping ends what the stop makes swing.
Record pressed(double hold, std::vector<Override> more) {
  const std::string motion = R"({ kind = "press", velocity_mm_s = 5, ramp_s = 0.4, depth_mm = 5.12, hold_s = )";
  std::vector<Override> overrides{{"mesh.radial_cells", "4"},
                                  {"mesh.axial_cells", "8"},
                                  {"output.sample_rate_hz", "100"},
                                  {"motion.damping_rate_per_s", "200"},
                                  {"instrument.needle.rupture.force_N", "100"},
                                  {"instrument.needle.motion", motion + std::to_string(hold) + " }"}};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return run("insertion", overrides);
}

/// Share of a stress that is left a time after it came up at once.
double left(double time) { return 1.0 + 0.3 * std::expm1(-time / 1.86) + 0.3 * std::expm1(-time / 51.3); }

/// What the force of elastic tissue becomes where each part of it relaxes from when it came up: ∫ m(t − s) dF(s).
double relaxed(const Record& elastic, double time) {
  double force = 0.0;
  for (std::size_t i = 1; i < elastic.time.size() && elastic.time[i] <= time; ++i) {
    force += (elastic.force[i] - elastic.force[i - 1]) * left(time - 0.5 * (elastic.time[i] + elastic.time[i - 1]));
  }
  return force;
}

// A needle on the whole surface, which is not stuck to a capsule, is felt as the integral of the elastic force over its history says, within
// 1 %, where all of the stress relaxes (measured: 0.75 % 0.3 s after the stop, 0.14 % from 5 s on). The shipped tissue's
// deviator relaxes alone: at these strains its bulk bears a good part, and a fifth to a sixth less of the force at once is gone.
TEST(BovineNeedleHeld, RelaxesByItsSharesAndTimes) {  // long
  const Override bare{"capsule", "[]"};
  const Record elastic = pressed(0.4, {bare, {"tissue.maxwell", "[]"}});
  const Record all = pressed(40.0, {bare, {"tissue.maxwell_part", "all"}});
  const Record shipped = pressed(40.0, {bare});
  const double at_once = elastic.force.back();
  ASSERT_GT(at_once, 0.3);
  for (const double time : {1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 40.0}) {
    const double expected = relaxed(elastic, time), found = all.at(time);
    RecordProperty("after_" + std::to_string(static_cast<int>(1e3 * time)) + "_ms_of_expected",
                   std::to_string(found / expected));
    EXPECT_NEAR(found, expected, 0.01 * expected) << time << " s";
    if (time < 3.0) continue;
    const double gone = (at_once - shipped.at(time)) / (at_once - expected);
    RecordProperty("shipped_gone_after_" + std::to_string(static_cast<int>(1e3 * time)) + "_ms", std::to_string(gone));
    EXPECT_GT(gone, 0.70) << time << " s";
    EXPECT_LT(gone, 0.95) << time << " s";
  }
}

/// The force at rest as c₀ + c₁ e^(−t/1.86 s) + c₂ e^(−t/51.3 s), by least squares, and what that leaves [N].
struct TwoBranches {
  Eigen::Vector3d c;
  double rms;
};
TwoBranches at_rest(const Record& run, double from, double until) {
  std::vector<double> times, forces;
  for (std::size_t i = 0; i < run.time.size(); ++i) {
    if (run.time[i] >= from && run.time[i] <= until)
      times.push_back(run.time[i] - from), forces.push_back(run.force[i]);
  }
  const auto rows = static_cast<Eigen::Index>(times.size());
  Eigen::MatrixXd A(rows, 3);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double t = times[static_cast<std::size_t>(i)];
    A.row(i) << 1.0, std::exp(-t / 1.86), std::exp(-t / 51.3);
  }
  const Eigen::Map<const Eigen::VectorXd> f(forces.data(), rows);
  const Eigen::Vector3d c = A.colPivHouseholderQr().solve(f);
  return {c, std::sqrt((A * c - f).squaredNorm() / static_cast<double>(rows))};
}

// The variant `held`, in by 38.9 mm, half a minute at rest and out again: at rest the force falls by its two times alone, within 1 % of what it
// was (measured: 0.2 %), and by a fifth, most of it slowly, since the fast branch relaxes on the way in already. Without branches only the
// viscous part of the friction goes. On the way out the needle is held back, and let go.
TEST(BovineNeedleHeld, IsInsertedHeldAndWithdrawn) {  // verify
  const std::vector<Override> coarse{
      {"mesh.radial_cells", "5"}, {"mesh.axial_cells", "12"}, {"output.sample_rate_hz", "50"}};
  const double stop = 38.9 / 3.0;
  const Record held = run("held", coarse);
  const double before = held.at(stop + 0.2), after = held.at(stop + 29.9);
  const TwoBranches found = at_rest(held, stop + 0.2, stop + 29.9);
  RecordProperty("before_mN", static_cast<int>(std::lround(1e3 * before)));
  RecordProperty("after_mN", static_cast<int>(std::lround(1e3 * after)));
  RecordProperty("rms_percent", std::to_string(100.0 * found.rms / before));
  RecordProperty("shares", std::to_string(found.c[1] / before) + " " + std::to_string(found.c[2] / before));
  EXPECT_LT(found.rms, 0.01 * before);
  EXPECT_GT(found.c[1], 0.05 * before);
  EXPECT_GT(found.c[2], 0.05 * before);
  EXPECT_LT(after, 0.85 * before);
  EXPECT_LT(*std::ranges::min_element(held.force), -0.2);
  EXPECT_NEAR(held.force.back(), 0.0, 1e-6);

  std::vector<Override> elastic = coarse;
  elastic.push_back({"tissue.maxwell", "[]"}), elastic.push_back({"instrument.needle.motion.hold_s", "3"});
  elastic.push_back({"instrument.needle.motion.returns", "false"});
  const Record stays = run("insertion", elastic);
  const double lost = 1.0 - stays.force.back() / stays.at(stop + 0.2);
  RecordProperty("elastic_lost_percent", std::to_string(100.0 * lost));
  EXPECT_LT(lost, 0.03);
}

}  // namespace
}  // namespace glisson::bovine_needle_held_test
