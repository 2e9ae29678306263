// What the surface is coloured by is what the material has there: exact for homogeneous deformation.
#include <algorithm>
#include <cmath>

#include "app/program.h"
#include "glisson/material/shape_measure.h"
#include "view/engine/live_body.h"
#include "view/protocol/messages.h"
#include "view/state/surface.h"

namespace glisson::view::view_surface_test {
namespace {

/// A body at x = X + H X, moving with v = L x.
Snapshot deformed(const LiveBody& body, const Mat3d& H, const Mat3d& L) {
  Snapshot state;
  state.shape = body.shape();
  state.tissues = body.tissues();
  for (const Vec3d& x : state.shape->mesh.vertices) {
    state.displacement.push_back(H * x);
    state.velocity.push_back(L * x);
  }
  return state;
}

Variant variant_of(const std::string& tissue) {
  std::string text = test::small_scene();
  const std::size_t at = text.find("youngs_modulus_Pa"), end = text.find("[motion]");
  return parse_scene(text.replace(at, end - at, tissue + "\n"), "view.toml", ".").variants.front();
}

const Mat3d kStill{};

Mat3d diagonal_of(double x, double y, double z) {
  Mat3d m;
  m(0, 0) = x, m(1, 1) = y, m(2, 2) = z;
  return m;
}

// s and q of every vertex are those of the deformation, and rigid turns have none.
TEST(LiveSurface, ShowsShape) {
  const LiveBody body(variant_of("youngs_modulus_Pa = 3600\npoisson_ratio = 0.4"), {});
  Mat3d H = diagonal_of(0.1, -0.05, 0.02);
  H(0, 1) = 0.07;
  const Snapshot state = deformed(body, H, kStill);
  Surface surface(state.shape);
  for (const double q : surface.field(Field::shape, state)) EXPECT_NEAR(q, 1.0 - one_minus_q(H), 1e-12);
  for (const double s : surface.field(Field::intensity, state)) EXPECT_NEAR(s, intensity_of(one_minus_q(H)), 1e-12);
  Mat3d turn = diagonal_of(-1.0, -1.0, 0.0);  // by a right angle about z
  turn(0, 1) = -1.0, turn(1, 0) = 1.0;
  for (const double q : surface.field(Field::shape, deformed(body, turn, kStill))) EXPECT_NEAR(q, 1.0, 1e-12);
}

// Von Mises' stress of a linear tissue is √3 · 2 μ |γ| in simple shear by 2 γ and E ε in uniaxial stress, inside as at the surface;
// the whole body is numbered after its surface, and its keyframe has its tets.
TEST(LiveSurface, ShowsStressInside) {
  const LiveBody body(variant_of("youngs_modulus_Pa = 3600\npoisson_ratio = 0.2"), {});
  Mat3d shear{};
  shear(0, 1) = shear(1, 0) = 0.01;
  const Mat3d pulled = diagonal_of(0.01, -0.002, -0.002);
  const Snapshot sheared = deformed(body, shear, kStill), stretched = deformed(body, pulled, kStill);
  Surface skin(sheared.shape), whole(sheared.shape, true);
  const TetMesh& mesh = sheared.shape->mesh;
  EXPECT_EQ(whole.size(), mesh.vertices.size());
  EXPECT_LT(skin.size(), whole.size());
  EXPECT_EQ(whole.triangles(), skin.triangles()) << "vertices at the surface keep their numbers";
  ASSERT_EQ(whole.tets().size(), 4 * mesh.tets.size());
  for (std::size_t i = 0; i < whole.tets().size(); ++i)
    ASSERT_EQ(whole.mesh_vertex(whole.tets()[i]), mesh.tets[i / 4][i % 4]);
  const double mu = 3600.0 / (2.0 * 1.2);
  for (const double x : whole.field(Field::von_mises, sheared)) EXPECT_NEAR(x, std::sqrt(3.0) * 2.0 * mu * 0.01, 1e-6);
  for (const double x : whole.field(Field::von_mises, stretched)) EXPECT_NEAR(x, 36.0, 1e-6);
  for (const double x : whole.field(Field::contact_pressure, sheared)) EXPECT_EQ(x, 0.0) << "nothing touches it";
  const std::string all = keyframe_message(whole, 7), outside = keyframe_message(skin, 7);
  const std::size_t inner = whole.size() - skin.size();
  const auto more = static_cast<double>(all.size() - outside.size());
  EXPECT_NEAR(more, static_cast<double>(4 + 16 * mesh.tets.size() + 13 * inner), 3.0) << "up to a multiple of 4";
}

// Pressure is −K tr ε of a linear tissue, with −⅔ η tr ε̇ of its viscosity; −κ (J − 1) of a hyperelastic one.
TEST(LiveSurface, ShowsPressure) {
  const LiveBody linear(variant_of("youngs_modulus_Pa = 3600\npoisson_ratio = 0.4\nviscosity_Pa_s = 5"), {});
  const Mat3d H = diagonal_of(0.01, -0.03, 0.005), L = diagonal_of(1.0, 2.0, -0.5);
  const double bulk = 3600.0 / (3.0 * (1.0 - 2.0 * 0.4));
  const double expected = -bulk * (0.01 - 0.03 + 0.005) - 2.0 / 3.0 * 5.0 * 2.5;
  Snapshot state = deformed(linear, H, L);
  Surface surface(state.shape);
  for (const double p : surface.field(Field::pressure, state)) EXPECT_NEAR(p, expected, 1e-9 * bulk);
  state.velocity.clear();  // nobody asked for it yet
  for (const double p : surface.field(Field::pressure, state)) EXPECT_NEAR(p, bulk * 0.015, 1e-9 * bulk);

  const LiveBody rubber(variant_of("hyperelastic = { kind = \"neo_hookean\", mu_Pa = 1000, bulk_modulus_Pa = 20000 }"),
                        {});
  const Mat3d growth = diagonal_of(0.02, 0.02, 0.02);
  const Snapshot grown = deformed(rubber, growth, kStill);
  Surface skin(grown.shape);
  for (const double p : skin.field(Field::pressure, grown))
    EXPECT_NEAR(p, -20000.0 * (std::pow(1.02, 3) - 1.0), 1e-6 * 20000.0);
}

// Pressure is that of the stress that makes the forces: with volume changes shared over vertices inside, and with branches
// that have relaxed in part, it is the simulation's own.
TEST(LiveSurface, ShowsThePressureOfTheForces) {
  LiveBody body(variant_of("hyperelastic = { kind = \"neo_hookean\", mu_Pa = 1000, bulk_modulus_Pa = 20000 }\n"
                           "volume_change = \"nodal\"\nmaxwell_part = \"all\"\n"
                           "maxwell = [{ share = 0.5, time_s = 0.005 }]"),
                {});
  Simulation& simulation = body.built().simulation;
  std::vector<Vec3d> u;
  for (const Vec3d& x : simulation.mesh().vertices)
    u.push_back({0.5 * x.z * x.x, -3.0 * x.y * x.y, 2.0 * x.x * x.z - 0.02 * x.y});
  simulation.set_state(u, std::vector<Vec3d>(u.size()));
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(simulation.step().made());
  Snapshot state;
  state.shape = body.shape(), state.tissues = body.tissues(), state.branches = BranchRecord(simulation);
  state.displacement.assign(simulation.displacement().begin(), simulation.displacement().end());
  state.velocity.assign(simulation.velocity().begin(), simulation.velocity().end());
  Surface surface(state.shape);
  const std::vector<double> shown = surface.field(Field::pressure, state);
  const TetFields fields = simulation.tet_fields();
  const TetMesh& mesh = state.shape->mesh;
  double largest = 0.0, without = 0.0;
  std::vector<double> expected(shown.size(), 0.0);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    double around = 0.0;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      if (std::find(mesh.tets[t].begin(), mesh.tets[t].end(), surface.mesh_vertex(i)) == mesh.tets[t].end()) continue;
      const double* s = &fields.stress[6 * t];
      expected[i] -= (s[0] + s[1] + s[2]) / 3.0;
      around += 1.0;
    }
    expected[i] /= around;
    largest = std::max(largest, std::abs(expected[i]));
  }
  for (std::size_t i = 0; i < shown.size(); ++i) EXPECT_NEAR(shown[i], expected[i], 1e-9 * largest);
  state.branches = {};  // as if all had relaxed: another pressure, so the branches above counted
  const std::vector<double> relaxed = surface.field(Field::pressure, state);
  for (std::size_t i = 0; i < shown.size(); ++i) without = std::max(without, std::abs(relaxed[i] - expected[i]));
  EXPECT_GT(without, 0.02 * largest);
}

// A change of the tissue changes the pressure of the same shape.
TEST(LiveSurface, FollowsTheTissue) {
  const LiveBody soft(variant_of("youngs_modulus_Pa = 3600\npoisson_ratio = 0.4"), {});
  const LiveBody stiff(variant_of("youngs_modulus_Pa = 7200\npoisson_ratio = 0.4"), {});
  Snapshot state = deformed(soft, diagonal_of(0.01, 0.01, 0.01), kStill);
  Surface surface(state.shape);
  const double before = surface.field(Field::pressure, state).front();
  state.tissues = stiff.tissues();
  EXPECT_NEAR(surface.field(Field::pressure, state).front() / before, 2.0, 1e-9);
}

// The bytes of a field give its numbers back to half a step, and hold what a body at rest has.
TEST(LiveSurface, PacksAFieldWithItsRange) {
  const LiveBody body(variant_of("youngs_modulus_Pa = 3600\npoisson_ratio = 0.4"), {});
  const Snapshot state = deformed(body, diagonal_of(0.01, 0.0, 0.0), kStill);
  const Surface surface(state.shape);
  const std::string frame = frame_message(state, surface, 7);
  EXPECT_EQ(frame.size(), 64 + 6 * surface.size());
  std::vector<double> values;
  for (std::size_t i = 0; i < surface.size(); ++i) values.push_back(-300.0 + 17.0 * static_cast<double>(i));
  const std::string with = with_field(frame, Field::pressure, values);
  ASSERT_EQ(with.size(), 64 + 7 * surface.size());
  EXPECT_EQ(with[3], 3);
  EXPECT_EQ(with.substr(64, 6 * surface.size()), frame.substr(64));
  const auto f32_at = [&](std::size_t at) {
    float x = 0.0f;
    std::memcpy(&x, with.data() + at, 4);
    return static_cast<double>(x);
  };
  EXPECT_EQ(f32_at(56), -300.0);
  EXPECT_NEAR(f32_at(60), values.back(), 1e-4);
  const double step = (values.back() + 300.0) / 255.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto byte = static_cast<unsigned char>(with[64 + 6 * values.size() + i]);
    EXPECT_NEAR(-300.0 + byte * step, values[i], 0.5 * step + 1e-9);
  }
  const std::string still = with_field(frame, Field::shape, std::vector<double>(surface.size(), 1.0));
  EXPECT_EQ(static_cast<unsigned char>(still.back()), 0) << "no range at rest";
}

}  // namespace
}  // namespace glisson::view::view_surface_test
