// A ball pressed between two rigid plates carries the force of the exact solution of the linear theory, not that of Hertz's half-spaces,
// on meshes that are finer toward its poles, however the lattice lies in it.
//
// At a contact of a tenth of the radius the ball carries 5.5 % more than Hertz's half-spaces at the same approach: the far side of a
// half-space gives way, that of a ball is held by the other plate. The plates are contact tools without friction and the scheme is
// explicit; the force is read when the ball has come to rest.
#include <gtest/gtest.h>

#include "ball_plates.h"
#include "glisson/instruments/contact.h"
#include "glisson/instruments/tool_motion.h"
#include "region_mesh_load.h"

namespace glisson {
namespace region_mesh_mechanics {

struct PlatesError {
  std::array<double, 2> plate{};  ///< force of each over the exact one, less 1
  std::size_t tets = 0;
  double mean() const { return 0.5 * (plate[0] + plate[1]); }
};

/// Edges about the poles, growing to eight times as long.
/// @param edges  in the radius of the contact
RegionMeshOptions toward_the_plates(double angle, double edges, const Lay& lay) {
  const double contact = kRadius * std::sin(angle), finest = contact / edges;
  RegionMeshOptions options{.edge = 8.0 * finest, .growth = 0.2};
  for (const double sign : {1.0, -1.0}) {
    const PathPoint pole{lay.middle + lay.axis * (sign * kRadius)};
    options.sizes.push_back({.edge = finest, .path = {pole}, .within = 1.2 * contact});
  }
  return options;
}

/// A plate whose own z axis is this unit vector, that comes in along it by the approach within 0.1 s.
std::shared_ptr<ContactTool> plate(const Vec3d& z, double approach, const Lay& lay) {
  const Vec3d x = unit(cross(std::abs(z.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}, z)), y = cross(z, x);
  Pose start{lay.middle + z * kRadius};
  for (std::size_t i = 0; i < 3; ++i) start.axes.m[i] = {x[i], y[i], z[i]};
  const auto path = [=](double time) {
    const double s = std::min(1.0, time / 0.1);
    return z * (-approach * s * s * (3.0 - 2.0 * s));
  };
  ContactOptions options;
  options.shape = Plate{}, options.direction = -z;
  return std::make_shared<ContactTool>(options, std::make_shared<PathDriver>(start, ToolPath{path, std::nullopt}));
}

PlatesError press_between_plates(double angle, double edges, const Lay& lay) {
  Tissue t = tissue(5000.0);
  t.volume_change = VolumeChange::average_nodal;
  const PressedBall exact = ball_between_plates(angle, kRadius, t);
  const RegionMesh made = mesh_regions({ball("ball", kRadius, lay)}, toward_the_plates(angle, edges, lay));
  SimulationOptions options;
  options.damping_rate = 100.0, options.track_energies = false, options.mass_scaling_step = 1e-4;
  Simulation body(made.mesh, {{1, t}}, options);
  const std::array tools{plate(lay.axis, exact.approach, lay), plate(-lay.axis, exact.approach, lay)};
  for (const auto& tool : tools) body.attach(tool);
  EXPECT_TRUE(body.advance_to(0.25).made());
  PlatesError out{.tets = made.mesh.tets.size()};
  for (std::size_t i = 0; i < 2; ++i) {
    out.plate[i] = dot(tools[i]->forces().total(), tools[i]->options().direction) / exact.force - 1.0;
  }
  return out;
}

// The face in contact is flat to a ten-thousandth of the approach and pressed all over. A small contact is Hertz's: what the ball carries
// beyond that falls with a/R, at ν = 0.45 in proportion to it (at 0.3 there is a part (a/R) ln (a/R) besides).
TEST(BallBetweenPlates, SmallContactsAreHertz) {  // long
  Tissue t = tissue(5000.0);
  double before = 0.0;
  for (const double nu : {0.3, 0.45}) {
    t.poisson_ratio = nu;
    for (const double share : {0.025, 0.05, 0.1}) {
      const PressedBall b = ball_between_plates(std::asin(share), kRadius, t);
      EXPECT_LT(b.unevenness, 1e-4 * b.approach);
      for (double at = 0.0; at < 1.0; at += 0.05) {
        double pressure = 0.0;
        for (std::size_t k = 0; k < b.pressure_terms.size(); ++k) {
          pressure += b.pressure_terms[k] * std::pow(1.0 - at * at, static_cast<double>(k) + 0.5);
        }
        EXPECT_GT(pressure, 0.0) << nu << " " << share << " " << at;
      }
      const double beyond = b.force / b.hertz - 1.0;
      if (share > 0.025) {
        EXPECT_NEAR(beyond / before, nu == 0.45 ? 2.0 : 2.2, nu == 0.45 ? 0.03 : 0.06) << share;
      }
      before = beyond;
    }
    EXPECT_NEAR(before, nu == 0.45 ? 0.0465 : 0.0555, 0.0002);
  }
}

// 4.2 % was measured with 21 700 tets.
TEST(BallBetweenPlates, CarriesTheForceOfTheSeries) {  // long
  const PlatesError e = press_between_plates(0.1, 2.5, kTurned);
  record("turned", e.mean());
  EXPECT_LT(e.tets, 23000u);
  EXPECT_GT(e.mean(), 0.0);
  EXPECT_LT(e.mean(), 0.05);
  EXPECT_NEAR(e.plate[0], e.plate[1], 0.003) << "the plates balance";
}

// 1.74, 1.73 and 1.84 % were measured with 49 000, 48 800 and 49 200 tets, on three lattices turned against each other; Hertz's force is
// 5.3 % below the exact one.
TEST(GradedMeshMechanicsLong, BallBetweenPlatesIsWithinTwoPercentHoweverTheLatticeLies) {  // long
  const Lay other{unit(Vec3d{-0.7, 0.2, 0.5}), {0.4e-3, 1.1e-3, -0.3e-3}};
  const std::array<PlatesError, 3> all{press_between_plates(0.1, 4.5, kLevel), press_between_plates(0.1, 4.5, kTurned),
                                       press_between_plates(0.1, 4.5, other)};
  for (std::size_t i = 0; i < 3; ++i) {
    record("lattice_" + std::to_string(i), all[i].mean());
    EXPECT_LT(all[i].tets, 50000u) << i;
    EXPECT_NEAR(all[i].mean(), 0.0, 0.02) << i;
    EXPECT_NEAR(all[i].mean(), all[0].mean(), 0.01) << i;
    EXPECT_NEAR(all[i].plate[0], all[i].plate[1], 0.002) << i;
  }
}

}  // namespace region_mesh_mechanics
}  // namespace glisson
