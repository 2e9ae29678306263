// A run with removals and splits gives the same bytes on any number of threads, and again.
#include "change/changed_body.h"
#include "change/faces.h"
#include "glisson/instruments/motion.h"
#include "support/must_step.h"

namespace glisson::test::same_bytes_test {
namespace {

class SameBytes : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, SameBytes, testing::ValuesIn(every_kind()), kind_name);

constexpr double kCell = 0.004;

/// State hashes and forces through a run in which the body loses tets and is split again and again.
struct Trace {
  std::vector<std::uint64_t> hashes;
  std::vector<Vec3d> forces;
  bool operator==(const Trace&) const = default;
};

Trace run(const Kind& kind, int threads) {
  std::mt19937 random(17);
  const TetMesh mesh = jittered_box({9, 9, 12}, kCell, 0.0, random);  // 5832 tets: several submeshes
  SimulationOptions options = kind.options(std::nullopt);
  options.threads = threads;
  options.gravity = {0.0, 0.0, -9.81};
  Simulation s(mesh, {{0, kind.tissue}}, options);
  s.fix(mesh.vertex_sets.at("z_min"));
  const ConstraintId tool = s.drive(mesh.vertex_sets.at("z_max"), press({.velocity = 0.1, .depth = 0.01, .hold = 1}));
  Trace trace;
  for (int i = 0; i < 12; ++i) {
    if (i % 3 == 1) s.remove_tets(choose(60, mesh.tets.size(), random));
    if (i % 3 == 2)
      s.split_faces(faces_on_plane(s.present_mesh(), static_cast<std::size_t>(i / 3 % 3), (2 + i / 3) * kCell));
    for (int k = 0; k < 5; ++k) test::must_step(s);
    trace.hashes.push_back(s.state_hash());
    trace.forces.push_back(s.force(tool).total());
  }
  return trace;
}

// On any number of threads (in double precision there is always one), and again on the same.
TEST_P(SameBytes, OnAnyNumberOfThreadsAndAgain) {
  const Trace one = run(GetParam(), 1);
  EXPECT_EQ(run(GetParam(), 1), one);
  if (GetParam().precision == Precision::double_precision) return;
  for (const int threads : {2, 4, 8}) EXPECT_EQ(run(GetParam(), threads), one) << threads << " threads";
}

}  // namespace
}  // namespace glisson::test::same_bytes_test
