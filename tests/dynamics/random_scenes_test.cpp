// A thousand random scenes of any tissue, integrator, step and motion: none leaves a number that is not finite, and none
// fails without saying so.
#include <gtest/gtest.h>

#include <random>

#include "glisson/instruments/motion.h"
#include "glisson/simulation/simulation.h"
#include "material/every_tissue.h"
#include "support/bodies.h"

namespace glisson {
namespace {

bool all_finite(std::span<const Vec3d> field) {
  return std::all_of(field.begin(), field.end(), [](const Vec3d& v) { return std::isfinite(norm(v)); });
}

/// One scene: a small box pressed, pulled or sheared at its top, from rest or from a wild state.
struct RandomScene {
  std::mt19937 random;
  TetMesh mesh;
  Tissue tissue;
  SimulationOptions options;
  Vec3d end;  ///< displacement of the top [m]
  double rate;
  bool wild;

  explicit RandomScene(unsigned seed) : random(seed) {
    const int cells = 2 + static_cast<int>(random() % 2);
    mesh = test::jittered_box({cells, cells, cells}, 0.03 / cells, 0.2, random);
    const std::vector<Tissue> all = test::every_tissue();
    tissue = all[random() % all.size()];
    const bool secant = tissue.law_form == LawForm::secant || tissue.hyperelastic;
    if (secant && random() % 3 == 0) tissue.volume_change = VolumeChange::average_nodal;
    if (random() % 3 == 0) tissue.viscosity = std::pow(10.0, number(-2.0, 3.0));
    options.integrator = static_cast<Integrator>(random() % 4);
    options.precision = random() % 2 == 0 ? Precision::single_precision : Precision::double_precision;
    options.gravity = {number(-30.0, 30.0), 0.0, number(-30.0, 30.0)};
    options.damping_rate = random() % 2 == 0 ? 0.0 : number(0.0, 200.0);
    options.exact_steps = random() % 2 == 0;
    end = Vec3d{number(-1.0, 1.0), number(-1.0, 1.0), number(-1.2, 1.0)} * 0.03;
    rate = std::pow(10.0, number(-2.0, 0.5));
    wild = random() % 4 == 0;
  }
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }

  /// Empty, or what is wrong.
  std::string play() {
    Simulation s(mesh, {{0, tissue}}, options);
    s.fix(mesh.vertex_sets.at("z_min"));
    const double duration = norm(end) / rate;
    const Vec3d to = end;
    const ConstraintId tool =
        s.drive(mesh.vertex_sets.at("z_max"), [=](double t) { return to * std::min(t / duration, 1.0); });
    if (wild) shake(s);
    const bool newton = options.integrator == Integrator::implicit || options.integrator == Integrator::quasi_static;
    for (int i = 0; i < (newton ? 6 : 300); ++i) {
      const double before = s.time();
      const StepResult step = s.step();
      if (!all_finite(s.displacement()) || !all_finite(s.velocity())) return "a state that is not finite";
      const bool made = step.status == StepStatus::ok || step.status == StepStatus::inverted;
      if (!made) return {};
      if (!(s.time() > before)) return "a step without time";
      if (!std::isfinite(norm(s.force(tool).total()))) return "a force that is not finite, unsaid";
    }
    return {};
  }

  /// Displacements of half a cell and some 10 m/s at the free vertices.
  void shake(Simulation& s) {
    std::vector<Vec3d> u = test::random_field(mesh.vertices.size(), 0.008, random);
    std::vector<Vec3d> v = test::random_field(mesh.vertices.size(), 10.0, random);
    for (const char* set : {"z_min", "z_max"}) {
      for (const std::uint32_t i : mesh.vertex_sets.at(set)) u[i] = v[i] = {};
    }
    s.set_state(u, v);
  }
};

class RandomScenes : public testing::TestWithParam<unsigned> {};

TEST_P(RandomScenes, NeverFailUnsaid) {
  constexpr unsigned kScenes = 125;
  for (unsigned i = 0; i < kScenes; ++i) {
    const unsigned seed = kScenes * GetParam() + i;
    RandomScene scene(seed);
    const std::string wrong = scene.play();
    EXPECT_EQ(wrong, "") << "seed " << seed << ", " << scene.tissue.name << ", integrator "
                         << static_cast<int>(scene.options.integrator);
  }
}

INSTANTIATE_TEST_SUITE_P(Eighths, RandomScenes, testing::Range(0U, 8U));

}  // namespace
}  // namespace glisson
