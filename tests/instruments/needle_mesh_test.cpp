// What a needle feels does not depend on the mesh as long as that resolves the zone, nor on the spacing of its path.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "needle_scenes.h"

namespace glisson {
namespace {

using test::event;
using test::insert;
using test::Inserted;
using test::Insertion;
using test::pushed;
using test::run_to;

/// Force and depth of the puncture, and the mean force of the last tenth of the way.
struct Curve {
  double depth = 0.0, force = 0.0, plateau = 0.0;
};

Curve curve_of(const Insertion& o) {
  Inserted run = insert(o);
  Curve c;
  while (run.needle->stage() != NeedleStage::inside) run_to(run, run.simulation.time() + 1e-6);
  c.force = run.needle->tip_force();
  c.depth = event(*run.needle, "puncture")->depth;
  run_to(run, 0.9 * run.end);
  double n = 0.0;
  run_to(run, run.end, [&] {
    c.plateau += pushed(*run.needle);
    n += 1.0;
  });
  c.plateau /= n;
  return c;
}

Insertion on_mesh(int radial, int axial) {
  Insertion o;
  o.mesh.radial_cells = radial;
  o.mesh.axial_cells = axial;
  o.needle.zone = 5e-3;
  o.needle.rupture = {.force = {}, .toughness = 1500.0, .membrane_thickness = 1e-4};
  return o;
}

// With the energy criterion the mesh could show in force and depth. From 8 800 to 44 000 tets, whose edges at the axis are
// 0.5 to 0.3 of the zone's radius, force and plateau change by less than 10 %, the depth by 12 %
// (first order: 4.04, 4.28, 4.50 mm), and all by less the finer the mesh.
TEST(NeedleMesh, PunctureAndPlateauHoldOnThreeMeshes) {
  std::array<Curve, 3> curves;
  const std::array<std::array<int, 2>, 3> cells{{{7, 10}, {9, 13}, {12, 17}}};
  for (std::size_t k = 0; k < 3; ++k) {
    curves[k] = curve_of(on_mesh(cells[k][0], cells[k][1]));
    RecordProperty("force_mN_" + std::to_string(k), static_cast<int>(std::lround(1e3 * curves[k].force)));
    RecordProperty("depth_um_" + std::to_string(k), static_cast<int>(std::lround(1e6 * curves[k].depth)));
    RecordProperty("plateau_mN_" + std::to_string(k), static_cast<int>(std::lround(1e3 * curves[k].plateau)));
  }
  const auto hold = [&](double Curve::*what, double coarse, double middle) {
    const double finest = curves[2].*what;
    EXPECT_NEAR(curves[0].*what, finest, coarse * finest);
    EXPECT_NEAR(curves[1].*what, finest, middle * finest);
  };
  hold(&Curve::force, 0.10, 0.05);
  hold(&Curve::plateau, 0.10, 0.05);
  hold(&Curve::depth, 0.12, 0.06);
}

// Half the spacing of path points: the same force on the way in, to 2 %.
TEST(NeedleMesh, SpacingOfThePathHardlyShows) {
  Insertion wide = on_mesh(6, 8), narrow = wide;
  narrow.needle.spacing = 0.5 * wide.needle.spacing;
  const Curve a = curve_of(wide), b = curve_of(narrow);
  EXPECT_NEAR(a.plateau, b.plateau, 0.02 * b.plateau);
  EXPECT_NEAR(a.force, b.force, 1e-9);
}

}  // namespace
}  // namespace glisson
