// specimen_model_test.cpp — a homogeneous specimen against closed forms, and against the body it stands for.
#include "fit/forward/specimen_model.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "fit/forward/offset_model.h"
#include "fit/forward/scene_model.h"

namespace glisson::fit::specimen_model_test {
namespace {

constexpr double kArea = 4e-4, kHeight = 0.02;

/// A press at a constant speed to a share of the height.
Curve ramp(double velocity, double strain, int points) {
  Curve c;
  c.name = "ramp";
  c.velocity = velocity;
  for (int i = 0; i < points; ++i) {
    c.time.push_back(strain * kHeight / velocity * i / (points - 1));
    c.displacement.push_back(velocity * c.time.back());
  }
  c.force.assign(c.size(), 0.0);
  return c;
}

std::vector<double> force_of(const Tissue& tissue, const Curve& curve) {
  const SpecimenModel model({curve}, {kArea, kHeight}, [&](std::span<const double>) { return tissue; });
  const Prediction p = model.predict(0, {});
  EXPECT_EQ(p.failure, "");
  EXPECT_EQ(p.force.size(), curve.size());
  return p.force;
}

double largest(const std::vector<double>& x) {
  double most = 0.0;
  for (const double v : x) most = std::max(most, std::abs(v));
  return most;
}

// Small strain: F = E ε A, whatever ν.
TEST(UniaxialForward, LinearTissueIsHookes) {
  Tissue tissue;
  const Curve curve = ramp(0.01, 0.3, 31);
  for (const double nu : {0.0, 0.4, 0.49}) {
    tissue.poisson_ratio = nu;
    const std::vector<double> force = force_of(tissue, curve);
    for (std::size_t i = 0; i < curve.size(); ++i)
      EXPECT_NEAR(force[i], 3600.0 * curve.displacement[i] / kHeight * kArea, 1e-10);
  }
}

// Nearly incompressible: neo-Hooke P = μ (λ − λ⁻²), Ogden P = 2μ/α (λ^(α−1) − λ^(−α/2−1)). κ = 1e6 μ leaves 1e-5 of it.
TEST(UniaxialForward, IncompressibleLawsHaveTheirClosedForms) {
  const Curve curve = ramp(0.01, 0.6, 61);
  Tissue neo, ogden;
  neo.hyperelastic = NeoHookean{1000.0, 1e9};
  ogden.hyperelastic = Ogden{{1000.0}, {-4.7}, 1e9};
  const std::vector<double> a = force_of(neo, curve), b = force_of(ogden, curve);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double l = 1.0 - curve.displacement[i] / kHeight, alpha = -4.7;
    EXPECT_NEAR(a[i], -kArea * 1000.0 * (l - 1.0 / (l * l)), 2e-5 * largest(a));
    const double exact = 2.0 * 1000.0 / alpha * (std::pow(l, alpha - 1.0) - std::pow(l, -alpha / 2.0 - 1.0));
    EXPECT_NEAR(b[i], -kArea * exact, 2e-5 * largest(b));
  }
}

// A Maxwell body that relaxes as a whole, at constant rate and then held: its convolution integral. The weights are exact
// for the stress of small strain, which is linear in time, so coarse sampling costs nothing; but the cubics of the history
// round the corner over the samples beside it, here 1 ms of 2 s.
TEST(UniaxialForward, MaxwellBranchesFollowTheirConvolution) {
  Tissue tissue;
  tissue.maxwell = {{0.3, 0.5}, {0.25, 8.0}};
  tissue.maxwell_part = MaxwellPart::all;
  Curve curve = ramp(0.002, 0.2, 9);
  const double end = curve.time.back(), rate = 0.002 / kHeight;
  curve.time.insert(curve.time.end() - 1, end - 1e-3);
  curve.displacement.insert(curve.displacement.end() - 1, 0.2 * kHeight - 0.002 * 1e-3);
  for (const double t : {1e-3, 0.7, 3.0, 20.0})
    curve.time.push_back(end + t), curve.displacement.push_back(0.2 * kHeight);
  curve.force.assign(curve.size(), 0.0);
  const std::vector<double> force = force_of(tissue, curve);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double t = curve.time[i], from = std::max(0.0, t - end);
    double stress = 3600.0 * 0.45 * rate * (t - from);
    for (const MaxwellBranch& b : tissue.maxwell)
      stress += 3600.0 * b.share * rate * b.time * (std::exp(-from / b.time) - std::exp(-t / b.time));
    EXPECT_NEAR(force[i], stress * kArea, 1e-6 * largest(force)) << t;
  }
}

// Kelvin and Voigt's overhead: (η/E) × the elastic tensor gives F/A = E ε + η ε̇ from the first instant on.
TEST(UniaxialForward, ProportionalViscosityAddsItsOverheadAtOnce) {
  Tissue tissue;
  tissue.viscosity = 1000.0;
  tissue.viscous_tensor = ViscousTensor::proportional;
  const Curve curve = ramp(0.01, 0.3, 31);
  const std::vector<double> force = force_of(tissue, curve);
  for (std::size_t i = 0; i < curve.size(); ++i)
    EXPECT_NEAR(force[i], kArea * (3600.0 * curve.displacement[i] / kHeight + 1000.0 * 0.5), 1e-9);
}

// With σ_v = 2 η ε̇ the sides come out late: 2η ẋ + 2(λ + μ) x = λ v t, x = λv/K (t − τ (1 − e^(−t/τ))), τ = 2η/K,
// K = 2 (λ + μ). Two implicit stages in steps of τ/11 leave some (h/τ)² / 10 of the lateral part.
TEST(UniaxialForward, ShearViscosityLetsTheSidesLag) {
  Tissue tissue;
  tissue.viscosity = 100.0;
  const LameParameters lame = tissue.lame();
  const Curve curve = ramp(0.02, 0.1, 21);
  const std::vector<double> force = force_of(tissue, curve);
  const double v = 1.0, K = 2.0 * (lame.lambda + lame.mu), tau = 200.0 / K;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double t = curve.time[i], x = lame.lambda * v / K * (t - tau * (1.0 - std::exp(-t / tau)));
    const double stress = -lame.lambda * (2.0 * x - v * t) + 2.0 * lame.mu * v * t + 200.0 * v;
    EXPECT_NEAR(force[i], kArea * stress, 1e-4 * largest(force)) << t;
  }
}

const std::string kBlock = R"([mesh]
kind = "box"
cells = [2, 2, 2]
size_m = [0.02, 0.02, 0.02]
[[fixed]]
set = "x_min"
axes = "x"
[[fixed]]
set = "y_min"
axes = "y"
[[fixed]]
set = "z_min"
axes = "z"
[[tool]]
set = "z_max"
sideways = "free"
)";

/// Root of the mean square difference over the largest force.
double distance(const std::vector<double>& a, const std::vector<double>& b, std::size_t from = 0) {
  double sum = 0.0;
  for (std::size_t i = from; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size() - from)) / largest(b);
}

struct Pair {
  std::vector<double> body, specimen;
};
Pair both(const std::string& tissue, const std::string& motion, const Curve& curve) {
  const SceneText scene{.text = kBlock + "[tissue]\n" + tissue + "[motion]\n" + motion,
                        .name = "block.toml",
                        .base = {},
                        .overrides = {},
                        .variant = {}};
  const SceneModel model(scene, {}, {curve});
  const Prediction run = model.predict(0, {});
  EXPECT_EQ(run.failure, "");
  return {run.force, force_of(model.variant(0, {}).tissue, curve)};
}

// Rest: a body of tets between smooth plates, solved by statics to 1e-8, is the specimen; between its load steps the force is
// a cubic in time.
TEST(UniaxialForward, IsTheStaticBody) {
  const Curve curve = ramp(0.01, 0.5, 41);
  const std::string motion = "integrator = \"quasi_static\"\nimplicit.largest_step_s = 0.02\n";
  for (const char* tissue :
       {"hyperelastic = { kind = \"ogden\", mu_Pa = [1000], alpha = [-4.7], bulk_modulus_Pa = 6000 }\n",
        "hyperelastic = { kind = \"yeoh\", c1_Pa = 500, c2_Pa = 100, bulk_modulus_Pa = 9000 }\n",
        "law = { kind = \"linear\", slope_Pa = 20000 }\n",
        "kinematics = \"corotational\"\nlaw_form = \"energy\"\nlaw = { kind = \"exponential\", amplitude_Pa = 900, "
        "rate = 4 }\n"}) {
    const Pair p = both(tissue, motion, curve);
    EXPECT_LT(distance(p.body, p.specimen), 1e-3) << tissue;
  }
}

// In time: implicit steps of the body, first order in h, come within 1 % of the specimen with viscosity or branches; so does
// the explicit body, whose inertia rings (E/ρ gives waves of 2 m/s, 0.02 s up and down; damped).
TEST(UniaxialForward, IsTheMovingBody) {
  const Curve curve = ramp(0.01, 0.4, 41);
  const std::string implicit = "integrator = \"implicit\"\nstep_s = 0.002\n";
  const std::string branches = "maxwell = [{ share = 0.4, time_s = 0.2 }, { share = 0.2, time_s = 3 }]\n";
  const std::string neo = "hyperelastic = { kind = \"neo_hookean\", mu_Pa = 1300, bulk_modulus_Pa = 6000 }\n";
  for (const std::string& tissue :
       {std::string("viscosity_Pa_s = 200\n"), "viscosity_Pa_s = 200\nviscous_tensor = \"deviatoric\"\n" + neo,
        "viscosity_Pa_s = 2000\nviscous_tensor = \"pioletti\"\n" + neo, branches, branches + neo,
        branches + neo + "maxwell_part = \"all\"\nviscosity_Pa_s = 50\n"}) {
    const Pair p = both(tissue, implicit, curve);
    EXPECT_LT(distance(p.body, p.specimen, 1), 0.01) << tissue;
  }
  const Pair p = both(branches + neo, "damping_rate_per_s = 100\n", ramp(0.01, 0.4, 21));
  EXPECT_LT(distance(p.body, p.specimen, 1), 0.02);
}

// A withdrawal goes back the way it came without viscosity, and below it with it.
TEST(UniaxialForward, CyclesLoseWorkToViscosityAlone) {
  Curve curve = ramp(0.01, 0.3, 31);
  for (int i = 29; i >= 0; --i) {
    curve.time.push_back(curve.time.back() + 0.02);
    curve.displacement.push_back(curve.displacement[static_cast<std::size_t>(i)]);
  }
  curve.force.assign(curve.size(), 0.0);
  Tissue tissue;
  tissue.law = LinearLaw{20000};
  const std::vector<double> elastic = force_of(tissue, curve);
  tissue.maxwell = {{0.5, 0.2}};
  const std::vector<double> relaxing = force_of(tissue, curve);
  for (std::size_t i = 1; i < 30; ++i) {
    EXPECT_NEAR(elastic[i], elastic[60 - i], 1e-9);
    EXPECT_GT(relaxing[i], relaxing[60 - i]);
  }
}

// A contact at d₀ is a curve shifted by d₀: before it there is no force. Keys of the measurement reach their curve alone.
TEST(OffsetModel, ShiftsContactAndForce) {
  Curve a = ramp(0.01, 0.3, 31), b = a;
  a.name = "a", b.name = "b";
  const auto inner =
      std::make_shared<SpecimenModel>(std::vector{a, b}, Specimen{kArea, kHeight}, [](std::span<const double> x) {
        Tissue t;
        t.youngs_modulus = x[0];
        return t;
      });
  const std::vector<std::string> keys{"curve.contact_mm", "tissue.youngs_modulus_Pa", "curve.b.contact_mm",
                                      "curve.a.force_offset_N"};
  EXPECT_EQ(inner_keys(keys), std::vector<std::string>{"tissue.youngs_modulus_Pa"});
  const OffsetModel model(inner, keys);
  const std::vector<double> values{1.0, 5000.0, -0.5, 0.25};
  const std::vector<double> fa = model.predict(0, values).force, fb = model.predict(1, values).force;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = a.displacement[i];
    EXPECT_NEAR(fa[i], 0.25 + 5000.0 * kArea / kHeight * std::max(0.0, d - 1e-3), 1e-9);
    EXPECT_NEAR(fb[i], 5000.0 * kArea / kHeight * std::max(0.0, d - 0.5e-3), 1e-9);
  }
  EXPECT_NEAR(model.predict(1, std::vector{-1.0, 5000.0, 0.0, 0.0}).force[0], 5000.0 * kArea / kHeight * 1e-3, 1e-9)
      << "a curve that begins in the tissue";
  EXPECT_THROW(OffsetModel(inner, std::vector<std::string>{"curve.c.contact_mm"}), std::invalid_argument);
}

// The same bytes from many threads at once; what cannot be computed is told and not thrown.
TEST(UniaxialForward, IsAskedFromManyThreadsAndFailsInWords) {
  Tissue tissue;
  tissue.hyperelastic = Fung{1000, 3.0, 50000};
  tissue.maxwell = {{0.3, 1.0}};
  const SpecimenModel model({ramp(0.01, 0.5, 101)}, {kArea, kHeight}, [&](std::span<const double> x) {
    if (x[0] > 1.0) throw std::runtime_error("no such tissue");
    return tissue;
  });
  const std::vector<double> once = model.predict(0, std::vector{0.0}).force;
  std::vector<std::vector<double>> all(64);
  tbb::parallel_for(std::size_t{0}, all.size(),
                    [&](std::size_t i) { all[i] = model.predict(0, std::vector{0.0}).force; });
  for (const auto& force : all) EXPECT_EQ(force, once);
  EXPECT_EQ(model.predict(0, std::vector{2.0}).failure, "no such tissue");
  const SpecimenModel thin({ramp(0.01, 0.5, 11)}, {kArea, 0.009}, [&](std::span<const double>) { return tissue; });
  EXPECT_NE(thin.predict(0, {}).failure.find("pressed to nothing"), std::string::npos);
}

}  // namespace
}  // namespace glisson::fit::specimen_model_test
