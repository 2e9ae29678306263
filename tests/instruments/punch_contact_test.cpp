// A flat frictionless punch, held out by contact alone, meets P = 4 G a w κ/(1 − ν) on a bonded layer, and the pressure under
// it rises to its edge.
//
// κ is the solution of the mixed boundary value problem's integral equation, good to 1e-9; the meshes are those of
// tests/verification/punch_test.cpp, where the displacement under the punch is prescribed.
#include "instruments/pressed_layer.h"

namespace glisson::punch_contact_test {
namespace {

struct Punch {
  double nu, a_over_h, kappa;
  double step;          ///< mass is added to tets that do not bear it [s]
  double offset = 0.1;  ///< of the rim beyond a ring of vertices, in cells
};

constexpr double kRing = 0.01;  // radius of the ring of vertices at the rim [m]

/// Of the punch, on a mesh with cells at the rim of such a share of kRing [m].
double radius(const Punch& p, double cell) { return kRing * (1.0 + p.offset * cell); }

test::LayerOptions layer(const Punch& p, int mesh) {
  test::LayerOptions o;
  const double edge[] = {0.08, 0.04, 0.02}, top[] = {0.1, 0.07, 0.05};
  const int cells[][4] = {{6, 12, 4, 11}, {9, 18, 6, 17}, {12, 24, 8, 22}};
  const int m = mesh - 1;
  o.a = kRing, o.h = radius(p, edge[m]) / p.a_over_h, o.R = o.a + 5.0 * o.h;
  o.edge = edge[m] * o.a, o.top = top[m] * o.a;
  o.inside = cells[m][0], o.outside = cells[m][1], o.around = cells[m][2], o.layers = cells[m][3];
  return o;
}

Tissue tissue(double nu) {
  Tissue t;
  t.poisson_ratio = nu, t.volume_change = VolumeChange::average_nodal;
  return t;
}

constexpr double kDepth = 1e-5;

test::PressedLayer pressed(const Punch& p, int mesh, double friction) {
  const test::LayerOptions o = layer(p, mesh);
  test::PressedLayer run(o, tissue(p.nu), FlatPunch{.radius = radius(p, o.edge / o.a), .length = 0.05}, friction,
                         kDepth, 0.04, 250.0, p.step);
  test::advance_to(run.body, 0.12);
  return run;
}

double kappa_of(const test::PressedLayer& run, const Punch& p) {
  const double a = std::get<FlatPunch>(run.tool->options().shape).radius;
  return run.force() * (1.0 - p.nu) / (4.0 * tissue(p.nu).lame().mu * a * kDepth);
}

class PunchContact : public testing::TestWithParam<Punch> {};

// Three meshes come closer from above, the finest is within 3 %: 2.3 % was measured, twice. Triangles that the punch's rim cuts
// are held too, half a percent of the force.
TEST_P(PunchContact, ConvergesToTheExactForce) {  // long
  const Punch p = GetParam();
  double before = 1.0;
  for (const int mesh : {1, 2, 3}) {
    const double error = kappa_of(pressed(p, mesh, 0.0), p) / p.kappa - 1.0;
    RecordProperty("error_percent_mesh_" + std::to_string(mesh), std::to_string(100.0 * error));
    EXPECT_GT(error, 0.0);
    EXPECT_LT(error, before);
    before = error;
  }
  EXPECT_LT(before, 0.03);
}

INSTANTIATE_TEST_SUITE_P(Kappa, PunchContact,
                         testing::Values(Punch{0.30, 1.0, 2.4835, 1e-4}, Punch{0.49, 1.0, 3.4840, 5e-5}));

// Friction holds the surface from sliding in under the punch, which makes it stiffer, most so where ν = 0: the more of it the
// more force, until nothing slips. Bonded is what driving the same vertices is; and no slip differs from it by the
// vertices at the rim alone, which may lift off, and the triangles it cuts: below 1 %.
TEST(PunchContactFriction, GoesFromFreeToBonded) {  // long
  const Punch p{0.0, 1.0, 1.0, 1e-4};
  const double free = kappa_of(pressed(p, 1, 0.0), p), some = kappa_of(pressed(p, 1, 0.1), p),
               rough = kappa_of(pressed(p, 1, std::numeric_limits<double>::infinity()), p);
  EXPECT_GT(some, 1.01 * free);
  EXPECT_GT(rough, 1.01 * some);

  test::PressedLayer bonded(layer(p, 1), tissue(p.nu), FlatPunch{.radius = radius(p, 0.08), .length = 0.05}, 0.0,
                            kDepth, 0.04, 250.0, p.step, true);
  test::advance_to(bonded.body, 0.12);
  test::PressedLayer driven(layer(p, 1), tissue(p.nu), Ball{}, 0.0, -1.0, 0.04, 250.0, p.step);
  std::vector<std::uint32_t> held;
  for (const std::uint32_t v : driven.body.mesh().vertex_sets.at("punch")) held.push_back(v);
  const ConstraintId punch = driven.body.drive(held,
                                               [](double t) {
                                                 return Vec3d{0.0, 0.0, -test::PressedLayer::depth_at(t, kDepth, 0.04)};
                                               },
                                               {false, false, true});
  driven.hold_sideways(held);
  test::advance_to(driven.body, 0.12);
  const double exact = -4.0 * driven.body.force(punch).total().z;
  EXPECT_NEAR(bonded.force(), exact, 1e-6 * exact);
  EXPECT_NEAR(rough, kappa_of(bonded, p), 0.01 * rough);
}

// Under a flat punch the pressure is least in the middle and rises to the edge. Its integral over the present area is the force:
// to rounding, as every vertex gives back what was divided by its own area, seen from the side to a percent.
TEST(PunchContactPressure, RisesToTheEdgeAndAddsUp) {  // long
  const Punch p{0.30, 1.0, 2.4835, 1e-4};
  const test::PressedLayer run = pressed(p, 2, 0.0);
  const ContactPressure field = run.tool->contact_pressure();
  const std::vector<Triangle> surface = boundary_triangles(run.body.mesh());
  const std::vector<Vec3d> x = run.body.positions();
  double middle = 0.0, edge = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < field.vertices.size(); ++i) {
    const Vec3d at = run.body.mesh().vertices[field.vertices[i]];
    const double r = std::hypot(at.x, at.y);
    if (r < 1e-3) middle = field.pascals[i];
    if (r > 0.009 && r < 0.0099) edge = std::max(edge, field.pascals[i]);
    for (const Triangle& t : surface) {
      if (std::find(t.begin(), t.end(), field.vertices[i]) == t.end()) continue;
      sum += field.pascals[i] * norm(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]])) / 6.0;
    }
  }
  EXPECT_GT(middle, 0.0);
  EXPECT_GT(edge, 1.3 * middle);
  EXPECT_NEAR(4.0 * sum, run.force(), 0.01 * run.force());
}

}  // namespace
}  // namespace glisson::punch_contact_test
