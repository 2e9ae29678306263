// A needle that is inside tissue stays as it is when the tissue changes: its path and its forces go on, and what it presses
// against is stiffer from then on.
#include <gtest/gtest.h>

#include "instruments/needle_scenes.h"

namespace glisson::test {
namespace {

void run_until(Inserted& run, double time) {
  run_to(run, time, [] {});
}

// The insertion of 20 mm with tissue four times as stiff from half way on. At the moment itself nothing shows: the path, the
// length inside and the force at the tip stay to the byte, and so does the run from a checkpoint made after it.
TEST(NeedleInChangedTissue, GoesOnFromWhereItIs) {
  const Insertion insertion;
  Inserted changed = insert(insertion), alone = insert(insertion);
  const double half = 0.5 * changed.end;
  run_until(changed, half), run_until(alone, half);
  ASSERT_EQ(changed.needle->stage(), NeedleStage::inside);
  Tissue stiff = changed.simulation.tissue(0);
  stiff.youngs_modulus *= 4.0;
  changed.simulation.set_tissue(0, stiff);
  EXPECT_EQ(changed.needle->path(), alone.needle->path());
  EXPECT_EQ(changed.needle->inserted_length(), alone.needle->inserted_length());
  EXPECT_EQ(changed.needle->tip_force(), alone.needle->tip_force());
  EXPECT_LT(changed.simulation.step_size(), 0.55 * alone.simulation.step_size());

  run_until(changed, half + 0.01);
  std::stringstream file;
  changed.simulation.save(file);
  Inserted on = insert(insertion);
  on.simulation.load(file);
  run_until(changed, changed.end), run_until(on, on.end), run_until(alone, alone.end);
  EXPECT_EQ(on.simulation.state_hash(), changed.simulation.state_hash());
  EXPECT_EQ(on.needle->inserted_length(), changed.needle->inserted_length());
  const Energies e = changed.simulation.energies();
  EXPECT_GT(e.changed, 0.0);
  EXPECT_LT(std::abs(e.imbalance()), 1e-9 * (e.elastic + e.dissipated));

  // stiffer tissue is carried along less by friction
  const auto moved = [](const Inserted& run) {
    double most = 0.0;
    for (const Vec3d& u : run.simulation.displacement()) most = std::max(most, norm(u));
    return most;
  };
  EXPECT_LT(moved(changed), 0.6 * moved(alone));
  EXPECT_GT(changed.needle->inserted_length(), alone.needle->inserted_length());
}

// Another density reaches the interactions as masses.
TEST(NeedleInChangedTissue, BearsAnotherDensity) {
  Inserted run = insert({});
  run_until(run, 0.5 * run.end);
  Tissue heavy = run.simulation.tissue(0);
  heavy.density *= 2.0;
  run.simulation.set_tissue(0, heavy);
  const double inserted = run.needle->inserted_length();
  run_until(run, 0.5 * run.end + 0.02);
  EXPECT_EQ(run.needle->stage(), NeedleStage::inside);
  EXPECT_NEAR(run.needle->inserted_length(), inserted, 1e-3);
}

}  // namespace
}  // namespace glisson::test
