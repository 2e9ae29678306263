// A ball pressed into a half-space meets Hertz: F = 4/3 E/(1 − ν²) √R d^1.5 [Johnson1985, ch. 4].
//
// The half-space is a bonded layer of 25 times the radius of contact. It is stiffer by what its bottom does not give: seen
// from there the ball is a point, and the surface over it sinks by w = κ₁ P (1 − ν)/(4 G h) less, with κ₁ = 0.88 for
// ν = 0.3, from the punch's κ(a/h) for small a/h (1/κ = 1 − 0.871 a/h at a/h = 0.1). That much is added to d.
#include "instruments/pressed_layer.h"

namespace glisson {
namespace {

struct HertzMesh {
  int inside, around;
  double growth;  ///< of a cell over the one before, away from the ball
};

/// Cells of width `first` that grow by a ratio, to fill a length.
int cells(double length, double first, double growth) {
  int n = 0;
  for (double sum = 0.0, width = first; sum < length; width *= growth, ++n) sum += width;
  return n;
}

/// Force over Hertz's, when the ball has come to rest.
double measured(const HertzMesh& m, Integrator integrator = Integrator::central_difference, double step = 1e-4) {
  const double a = 2e-3, R = 20e-3, d = a * a / R;
  test::LayerOptions o;
  o.a = a, o.h = 25.0 * a, o.R = 25.0 * a, o.inside = m.inside, o.around = m.around;
  o.edge = o.top = 0.8 * a / m.inside;
  o.outside = cells(o.R - a, o.edge, m.growth), o.layers = cells(o.h, o.top, m.growth);
  Tissue t;
  t.poisson_ratio = 0.3, t.volume_change = VolumeChange::average_nodal;
  test::PressedLayer p(o, t, Ball{R}, 0.0, d, 0.06, 120.0, step, false, integrator);
  test::advance_to(p.body, 0.14);
  const double G = t.lame().mu, nu = t.poisson_ratio, F = p.force();
  const double deeper = d + 0.88 * F * (1.0 - nu) / (4.0 * G * o.h);
  return F / (4.0 / 3.0 * t.youngs_modulus / (1.0 - nu * nu) * std::sqrt(R) * std::pow(deeper, 1.5));
}

// Three meshes come closer, from above as displacement elements do: 5.1, 3.6, 2.1 % were measured.
TEST(Hertz, ForceConverges) {  // long
  double before = 0.15;
  for (const HertzMesh& m : {HertzMesh{3, 4, 1.5}, HertzMesh{4, 6, 1.35}, HertzMesh{8, 12, 1.19}}) {
    const double error = measured(m) - 1.0;
    RecordProperty("error_percent_" + std::to_string(m.inside), std::to_string(100.0 * error));
    EXPECT_GT(error, 0.0);
    EXPECT_LT(error, 0.75 * before);
    before = error;
  }
  EXPECT_LT(before, 0.03);
}

// Statics in steps of 20 ms ends where the explicit scheme comes to rest.
TEST(HertzInLongSteps, IsThatOfTheExplicitScheme) {
  const HertzMesh mesh{3, 4, 1.5};
  const double reference = measured(mesh), at_rest = measured(mesh, Integrator::quasi_static, 0.02);
  RecordProperty("explicit", std::to_string(reference));
  RecordProperty("static", std::to_string(at_rest));
  EXPECT_NEAR(at_rest, reference, 0.01);
}

}  // namespace
}  // namespace glisson
