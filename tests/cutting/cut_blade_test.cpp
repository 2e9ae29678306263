// A blade on its way through tissue: it takes the toughness of the tissue times the area to cut it, and not more force.
#include <sstream>

#include "cutting/cut_body.h"
#include "glisson/instruments/blade.h"
#include "glisson/instruments/tool_motion.h"

namespace glisson::test::cut_blade_test {
namespace {

constexpr double kCell = 0.005, kWidth = 8 * kCell;

/// A block held at its bottom, and a blade as wide as the block and more that comes down into it.
struct Downstroke {
  TetMesh mesh;
  Simulation body;
  std::shared_ptr<Blade> blade;

  Downstroke(double toughness, double velocity, const Kind& kind)
      : mesh(made()), body(mesh, {{0, kind.tissue}}, damped(kind)) {
    body.fix(mesh.vertex_sets.at("z_min"));
    const Pose start{{0.0213, 0.5 * kWidth, 0.0405}, identity<double>()};
    auto driver = std::make_shared<PathDriver>(start, steady_path({.velocity = velocity}));
    blade = std::make_shared<Blade>(
        BladeOptions{.edge_from = {0, -0.03, 0}, .edge_to = {0, 0.03, 0}, .toughness = toughness, .cut_every = 0.0},
        driver);
    body.attach(blade);
  }
  static TetMesh made() {
    std::mt19937 random(2);
    return jittered_box({8, 8, 8}, kCell, 0.1, random);
  }
  static SimulationOptions damped(const Kind& kind) {
    SimulationOptions o = kind.options(std::nullopt);
    o.damping_rate = 30.0;
    return o;
  }
  /// Mean of the force on the tissue between two depths of the blade.
  Vec3d mean_force(double from, double to) {
    Vec3d sum{};
    double time = 0.0;
    while (blade->depth() < to) {
      EXPECT_LE(body.step().status, StepStatus::inverted);
      if (blade->depth() < from) continue;
      sum += blade->forces().cutting * body.step_size();
      time += body.step_size();
    }
    return sum * (1.0 / time);
  }
};

// In a steady cut the force is G times the width, straight ahead; the area is what the edge has passed, and the work of
// the cut G times that.
TEST(BladeForce, IsToughnessTimesWidth) {
  for (const Kind& kind : {Kind{"linear", linear_tissue(), Precision::single_precision},
                           Kind{"viscous", viscous_tissue(), Precision::double_precision}}) {
    const double toughness = 2.0;
    Downstroke cut(toughness, 0.05, kind);
    const Vec3d force = cut.mean_force(0.010, 0.025);
    // 0.5 % here; the edge's length in tissue that is not cut goes up and down by some tets on its way
    EXPECT_NEAR(force.z, -toughness * kWidth, 0.03 * toughness * kWidth) << kind.name;
    EXPECT_NEAR(norm(force), -force.z, 0.05 * -force.z) << kind.name;
    EXPECT_GT(cut.blade->area(), kWidth * 0.015) << kind.name;
    EXPECT_LT(cut.blade->area(), kWidth * 0.026) << kind.name;
    EXPECT_EQ(cut.blade->work_of_cut(), toughness * cut.blade->area());
  }
}

// Twice the toughness, twice the force; none, none.
TEST(BladeForce, GoesWithToughness) {
  const Kind kind{"linear", linear_tissue(), Precision::single_precision};
  const double one = Downstroke(1.0, 0.05, kind).mean_force(0.010, 0.020).z;
  EXPECT_NEAR(Downstroke(2.0, 0.05, kind).mean_force(0.010, 0.020).z, 2.0 * one, 0.1 * std::abs(one));
  EXPECT_EQ(Downstroke(0.0, 0.05, kind).mean_force(0.010, 0.020).z, 0.0);
}

// Tissue too tough for the blade is pressed down by it, and hardly cut.
TEST(BladeForce, PressesWhatItCannotCut) {
  const Kind kind{"linear", linear_tissue(), Precision::single_precision};
  Downstroke soft(0.5, 0.05, kind), tough(1e3, 0.05, kind);
  soft.mean_force(0.0, 0.004);
  tough.mean_force(0.0, 0.004);
  EXPECT_LT(tough.blade->area(), 0.3 * soft.blade->area() + 1e-12);
  double lowest = 0.0;
  for (const Vec3d& u : tough.body.displacement()) lowest = std::min(lowest, u.z);
  EXPECT_LT(lowest, -0.002);
}

// All the way down the block falls in two; momentum is what the blade and the support gave it, and the energies balance.
TEST(BladeForce, CutsThrough) {
  const Kind kind{"law", law_tissue(), Precision::single_precision};
  Downstroke cut(1.0, 0.5, kind);
  cut.mean_force(0.0, 0.045);
  EXPECT_EQ(piece_sizes(cut.body.present_mesh()).size(), 2U);
  EXPECT_EQ(cut.blade->length_in_tissue(), 0.0);
  EXPECT_NEAR(cut.blade->area(), kWidth * kWidth, 0.1 * kWidth * kWidth);
  const Energies e = cut.body.energies();
  EXPECT_GT(e.work_tools, 0.0);
  EXPECT_LE(std::abs(e.imbalance()), 1e-9 * (e.work_tools + std::abs(e.removed) + e.elastic));
}

// Saved in the middle of a cut and gone on, it is the same cut.
TEST(BladeForce, GoesOnFromACheckpoint) {
  const Kind kind{"viscous", viscous_tissue(), Precision::single_precision};
  Downstroke whole(1.0, 0.2, kind), continued(1.0, 0.2, kind);
  whole.mean_force(0.0, 0.012);
  std::stringstream file;
  whole.body.save(file);
  continued.body.load(file);
  whole.mean_force(0.0, 0.02);
  continued.mean_force(0.0, 0.02);
  EXPECT_EQ(continued.body.state_hash(), whole.body.state_hash());
  EXPECT_EQ(continued.blade->forces().cutting, whole.blade->forces().cutting);
  EXPECT_EQ(continued.blade->area(), whole.blade->area());
}

// What cannot be is refused with its name, value and range.
TEST(BladeOptionsRefused, NameTheOption) {
  const TetMesh mesh = Downstroke::made();
  Simulation body(mesh, {{0, linear_tissue()}}, {});
  const auto refusal = [&](const BladeOptions& o) -> std::string {
    try {
      const Blade blade(o, std::make_shared<PathDriver>(Pose{}, steady_path({})));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_NE(refusal({.name = "knife", .toughness = -1.0}).find("blade \"knife\": toughness [J/m²] = -1"),
            std::string::npos);
  EXPECT_NE(refusal({.edge_from = {}, .edge_to = {}}).find("the edge has no length"), std::string::npos);
  EXPECT_NE(refusal({.cut_every = -1.0}).find("cut_every [s] = -1"), std::string::npos);
  EXPECT_NE(refusal({.cutting = {.least_quality = 0.9}}).find("least_quality = 0.9"), std::string::npos);
  EXPECT_NE(refusal({.cutting = {.least_step = 0.0}}).find("least_step = 0"), std::string::npos);
  Cutter cutter(body);
  EXPECT_THROW(cutter.advance({}), std::invalid_argument) << "before it is placed";
  EXPECT_THROW(cutter.place({{std::nan(""), 0, 0}, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace glisson::test::cut_blade_test
