// indentation_fit_test.cpp — indentation from files to a fit: what time does to a force, what the table of laws keeps of it, twins
// whose parameters are found again, and what cannot be.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <random>

#include "fit/forward/indentation_model.h"
#include "fit/run_fit.h"
#include "lab/indenter.h"
#include "laboratory.h"
#include "phantom.h"

namespace glisson::fit::indentation_fit_test {
namespace {

using laboratory::table;
using ::testing::HasSubstr;

const Indenter kBall{.shape = IndenterShape::sphere, .radius = 3e-3};

Tissue brain(double mu, double alpha) {
  Tissue tissue;
  tissue.hyperelastic = Ogden{{mu}, {alpha}, 1e6};
  return tissue;
}

/// Down at 1 mm/s, then held.
struct Motion {
  std::vector<double> times, depths;
};
Motion ramp_and_hold(double depth, double hold) {
  Motion m;
  for (int i = 1; i <= 40; ++i) m.times.push_back(1e3 * depth * i / 40), m.depths.push_back(depth * i / 40);
  for (int i = 1; i <= 40 && hold > 0.0; ++i) m.times.push_back(m.times[39] + hold * i / 40), m.depths.push_back(depth);
  return m;
}

// While the contact grows or rests, a branch of all stress is one of the force [LeeRadok1960]: down within a thousandth of
// its time the force is the elastic one, and falls from there by 1 − g (1 − e^(−t/τ)).
TEST(Indentation, RelaxesAsItsBranchesDo) {
  Tissue tissue = brain(600.0, -8.0);
  const Layer layer{.thickness = 10e-3};
  std::vector<double> times, depths;
  for (int i = 1; i <= 10; ++i) times.push_back(1e-4 * i), depths.push_back(2e-4 * i);
  for (int i = 1; i <= 20; ++i) times.push_back(1e-3 + 0.5 * i), depths.push_back(2e-3);
  const std::vector<double> elastic = indentation(tissue, kBall, layer, times, depths);
  tissue.maxwell = {{0.3, 1.0}, {0.2, 5.0}};
  const std::vector<double> relaxing = indentation(tissue, kBall, layer, times, depths);
  EXPECT_NEAR(relaxing[9] / elastic[9], 1.0, 5e-4);
  for (std::size_t i = 10; i < times.size(); ++i) {
    const double t = times[i] - 1e-3, left = 1.0 + 0.3 * std::expm1(-t) + 0.2 * std::expm1(-t / 5.0);
    EXPECT_NEAR(relaxing[i] / elastic[i], left, 5e-4) << t;
  }
}

// Viscosity of an incompressible tissue adds η/μ times the rate of the elastic force: of a flat punch at a constant speed, whose
// force is linear in its depth, a constant 8 a η v on a half-space.
TEST(Indentation, ViscosityAddsItsRate) {
  Tissue tissue;
  tissue.hyperelastic = NeoHookean{1000.0, 1e7};
  tissue.viscosity = 50.0;
  const std::vector<double> times{0.1, 0.2, 0.3}, depths{1e-6, 2e-6, 3e-6};
  const std::vector<double> forces =
      indentation(tissue, {.shape = IndenterShape::flat, .radius = 1e-3}, {}, times, depths);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(forces[i], 8.0 * 1e-3 * (1000.0 * depths[i] + 50.0 * 1e-5), 0.01 * forces[i]);
}

// At a constant force a ball on a half-space of an elastic tissue stands at Hertz's depth, a punch and a blunt cone at Boussinesq's and
// Sneddon's [Sneddon1965], 1 %, at once and for ever.
TEST(IndentationCreep, ElasticIsTheClosedForms) {
  Tissue tissue;
  tissue.hyperelastic = NeoHookean{1000.0, 1e7};
  const double modulus = 4.0 * 1000.0;  // E/(1 − ν²)
  const std::vector<double> times{1e-3, 1.0, 10.0};
  struct Case {
    Indenter indenter;
    double depth;
  };
  for (const auto& [indenter, depth] :
       {Case{kBall, 3e-5}, Case{{.shape = IndenterShape::flat, .radius = 3e-3}, 3e-6},
        Case{{.shape = IndenterShape::cone, .half_angle = 88.0 * std::numbers::pi / 180.0}, 1e-4}}) {
    const double force = modulus * lab::thick_layer_force(indenter, depth);
    for (const double d : indentation_depths(tissue, indenter, {}, times, std::vector<double>(3, force)))
      EXPECT_NEAR(d / depth, 1.0, 0.01) << lab::words_of(indenter);
  }
}

// Lee and Radok [LeeRadok1960]: while the contact grows the elastic force of the depth is what creep makes of the load. At once under
// a constant force it is F J(t)/J(0), with the creep function of one branch of share g and time τ in closed form,
// 1 + g/(1 − g) (1 − exp(−(1 − g) t/τ)); of a Kelvin–Voigt tissue 1 − exp(−t/λ), λ = η/μ. Of a ball F goes with d^(3/2), of a cone
// with d², of a punch with d. 0.7 % of the load is left, of the ball on its mesh: 1 %.
TEST(IndentationCreep, IsTheCreepFunctionOfLeeAndRadok) {  // long
  Tissue elastic;
  elastic.hyperelastic = NeoHookean{1000.0, 1e7};
  Tissue relaxing = elastic, viscous = elastic;
  relaxing.maxwell = {{0.6, 5.0}};
  viscous.viscosity = 2000.0;
  std::vector<double> times{1e-6};
  for (int i = 1; i <= 40; ++i) times.push_back(0.5 * i);
  const std::vector<Indenter> indenters{kBall,
                                        {.shape = IndenterShape::flat, .radius = 3e-3},
                                        {.shape = IndenterShape::cone, .half_angle = 85.0 * std::numbers::pi / 180.0}};
  double worst = 0.0;
  for (const Indenter& indenter : indenters) {
    const double depth = indenter.shape == IndenterShape::flat ? 1e-6 : 3e-5;
    const std::vector<double> forces(times.size(), 4000.0 * lab::thick_layer_force(indenter, depth));
    const std::vector<double> creeping = indentation_depths(relaxing, indenter, {}, times, forces),
                              retarded = indentation_depths(viscous, indenter, {}, times, forces);
    const double rest = indentation_depths(elastic, indenter, {}, times, forces).back();
    for (std::size_t i = 0; i < times.size(); ++i) {
      const auto load = [&](double d) { return std::pow(d / rest, lab::depth_power(indenter.shape)); };
      const double J = 1.0 - 1.5 * std::expm1(-0.4 * times[i] / 5.0), K = -std::expm1(-times[i] / 2.0);
      worst = std::max({worst, std::abs(load(creeping[i]) / J - 1.0), std::abs(load(retarded[i]) - K)});
    }
  }
  std::printf("off by %.2g of the load\n", worst);
  EXPECT_LT(worst, 0.01);
}

// The inverse of indentation by depth, at finite strain in a layer, with two branches and viscosity: under the forces of a ramp and a
// hold the indenter goes as it went, within 0.3 % of the deepest.
TEST(IndentationCreep, InvertsAHold) {
  Tissue tissue = brain(600.0, -8.0);
  tissue.maxwell = {{0.3, 1.0}, {0.2, 5.0}};
  tissue.viscosity = 20.0;
  const Layer layer{.thickness = 10e-3};
  Motion m;
  for (int i = 1; i <= 120; ++i) m.times.push_back(0.1 * i), m.depths.push_back(3e-3 * std::sin(0.013 * i));
  const std::vector<double> forces = indentation(tissue, kBall, layer, m.times, m.depths);
  const std::vector<double> depths = indentation_depths(tissue, kBall, layer, m.times, forces);
  double worst = 0.0;
  for (std::size_t i = 0; i < depths.size(); ++i) worst = std::max(worst, std::abs(depths[i] - m.depths[i]));
  std::printf("off by %.2g of the deepest\n", worst / 3e-3);
  EXPECT_LT(worst, 0.003 * 3e-3);
}

// What no layer bears is told, and so are forces that are none.
TEST(IndentationCreep, RefusesWhatItCannotFollow) {
  const Tissue tissue = brain(600.0, -8.0);
  const std::vector<double> times{1.0, 2.0};
  EXPECT_THROW(indentation_depths(tissue, kBall, {.thickness = 2e-3}, times, std::vector<double>{0.0, 1e4}),
               std::runtime_error);
  EXPECT_THROW(indentation_depths(tissue, kBall, {}, times, std::vector<double>{1.0}), std::invalid_argument);
  EXPECT_EQ(indentation_depths(tissue, kBall, {}, times, std::vector<double>{0.0, 0.0}),
            (std::vector<double>{0.0, 0.0}));
}

// Between the laws that were solved forces are those of their own solution within 1 % of the largest and 0.3 % in the mean, as
// much as a finer mesh would change them, and no more laws are solved than the table has nodes.
TEST(Indentation, TableKeepsForcesBetweenLaws) {  // long
  Curve curve;
  curve.name = "made";
  const Motion m = ramp_and_hold(2e-3, 0.0);
  curve.time = m.times, curve.displacement = m.depths, curve.force.assign(m.times.size(), 0.0);
  curve.measurement.test = LabTest::indentation, curve.measurement.deforming = Deforming::indentation;
  curve.measurement.indenter = kBall;
  const std::vector<Parameter> parameters{{"mu", "Pa", 50.0, 5e4, Scale::logarithmic, 1000.0},
                                          {"alpha", "", -30.0, -1.0, Scale::linear, -10.0},
                                          {"share", "", 0.0, 0.8, Scale::linear, 0.4}};
  const TissueAt tissue = [](std::span<const double> x) {
    Tissue t = brain(x[0], x[1]);
    t.maxwell = {{x[2], 5.0}};
    return t;
  };
  const Layer layer{.thickness = 10e-3};
  const IndentationModel kept({curve}, layer, tissue, parameters),
      own({curve}, layer, tissue, parameters, {.table = false});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part;
  double mean = 0.0;
  for (int i = 0; i < 12; ++i) {
    const std::vector<double> x{50.0 * std::pow(1000.0, part(random)), -1.0 - 29.0 * part(random), 0.8 * part(random)};
    const Prediction a = kept.predict(0, x), b = own.predict(0, x);
    ASSERT_EQ(a.failure + b.failure, "");
    double worst = 0.0;
    for (std::size_t k = 0; k < a.force.size(); ++k)
      worst = std::max(worst, std::abs(a.force[k] - b.force[k]) / b.force.back());
    EXPECT_LT(worst, 0.01) << x[0] << " " << x[1];
    mean += worst / 12.0;
  }
  std::printf("%zu laws solved for the table, off by %.2g in the mean\n", kept.solved(), mean);
  EXPECT_LT(mean, 0.003);
  EXPECT_LT(kept.solved(), 180u);
}

const char* kFit = R"(
[specimen]
kind = "layer"
thickness_mm = 10
[tissue]
hyperelastic = { kind = "ogden", mu_Pa = [1000], alpha = [-5], bulk_modulus_Pa = 1e6 }
maxwell = [{ share = 0.3, time_s = 5 }]
[[parameter]]
key = "tissue.hyperelastic.mu_Pa[0]"
low = 50
high = 5e4
[[parameter]]
key = "tissue.hyperelastic.alpha[0]"
low = -30
high = -1
scale = "linear"
[[parameter]]
key = "tissue.maxwell[0].share"
low = 0.01
high = 0.9
scale = "linear"
[[parameter]]
key = "tissue.maxwell[0].time_s"
low = 0.5
high = 50
[[data]]
files = ["hold.csv"]
test = "indentation"
indenter = { kind = "sphere", radius_mm = 3 }
)";

/// A file as a machine writes it: of depth and force in mm and mN, with noise of 0.5 % of the peak.
std::string made(const Tissue& tissue, const Indenter& indenter, const Layer& layer, const Motion& m, unsigned seed) {
  std::vector<double> forces = indentation(tissue, indenter, layer, m.times, m.depths), mm;
  const double peak = *std::max_element(forces.begin(), forces.end());
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.005 * peak);
  for (double& f : forces) f = 1e3 * (f + noise(random));
  for (const double d : m.depths) mm.push_back(1e3 * d);
  return table({"time (s)", "indentation (mm)", "force (mN)"}, {m.times, mm, forces});
}

// Twenty starts, profiles and 200 replicates of a law, a share and a time from one ramp and hold: the truth is found within the
// intervals, in less than 30 s of one processor.
TEST(IndentationFit, FindsItsTwin) {  // long
  Tissue truth = brain(600.0, -9.0);
  truth.maxwell = {{0.45, 8.0}};
  const phantom::Folder folder;
  folder.write("hold.csv", made(truth, kBall, {.thickness = 10e-3}, ramp_and_hold(3e-3, 40.0), 1));
  folder.write("fit.toml", kFit);
  const std::clock_t begin = std::clock();
  const FitResult result = run_fit(load_fit(folder.path() / "fit.toml"), {});
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;  // of all threads
  const std::vector<double> expected{600.0, -9.0, 0.45, 8.0};
  std::printf("%.1f s of processors, %llu runs\n", seconds, static_cast<unsigned long long>(result.forward_runs));
  EXPECT_LT(seconds, 30.0);
  for (std::size_t p = 0; p < expected.size(); ++p) {
    const ParameterResult& r = result.parameters[p];
    std::printf("%s %.4g [%.4g, %.4g] %s\n", r.parameter.name.c_str(), r.value, r.ci95()->low, r.ci95()->high,
                r.verdict.c_str());
    EXPECT_NEAR(r.value / expected[p], 1.0, 0.05);
    EXPECT_LT(r.ci95()->low, expected[p] * (expected[p] > 0.0 ? 1.01 : 0.99));
    EXPECT_GT(r.ci95()->high, expected[p] * (expected[p] > 0.0 ? 0.99 : 1.01));
  }
  EXPECT_THAT(result.forward, HasSubstr("a layer under an indenter"));
  EXPECT_THAT(result.forward, HasSubstr("A finer grid gives the same force"));
  ASSERT_TRUE(result.forward_error);
  EXPECT_LT(*result.forward_error,
            0.01 * *std::max_element(result.curves[0].curve.force.begin(), result.curves[0].curve.force.end()));
}

// A force-controlled file, force over time and depth as a machine writes them, with noise of 0.5 %: from a load of 20 mN in 1 s, held
// for a minute, the law's modulus, share and time are found within their intervals.
TEST(IndentationFit, FindsTheTwinOfACreep) {  // long
  Tissue truth = brain(600.0, -5.0);
  truth.maxwell = {{0.45, 8.0}};
  std::vector<double> times, forces;
  for (int i = 1; i <= 20; ++i) times.push_back(0.05 * i), forces.push_back(1e-3 * i);
  for (int i = 1; i <= 60; ++i) times.push_back(1.0 + i), forces.push_back(20e-3);
  std::vector<double> depths = indentation_depths(truth, kBall, {.thickness = 10e-3}, times, forces);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.005 * depths.back());
  for (double& d : depths) d = 1e3 * (d + noise(random));
  for (double& f : forces) f *= 1e3;
  const phantom::Folder folder;
  folder.write("hold.csv", table({"time (s)", "indentation (mm)", "force (mN)"}, {times, depths, forces}));
  std::string text = kFit;
  const auto change = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  change("test = \"indentation\"", "test = \"creep\"\nmode = \"indentation\"\nresample.over = \"none\"");
  const std::size_t alpha = text.find("[[parameter]]\nkey = \"tissue.hyperelastic.alpha[0]\"");
  text.erase(alpha, text.find("[[parameter]]", alpha + 1) - alpha);  // one creep tells no stiffening from a modulus
  folder.write("fit.toml", text + "[search]\nstarts = 6\n[proof]\nbootstrap = 0\n");
  const FitResult result = run_fit(load_fit(folder.path() / "fit.toml"), {});
  const std::vector<double> expected{600.0, 0.45, 8.0};
  for (std::size_t p = 0; p < expected.size(); ++p) {
    const ParameterResult& r = result.parameters[p];
    std::printf("%s %.4g [%.4g, %.4g] %s\n", r.parameter.name.c_str(), r.value, r.ci95()->low, r.ci95()->high,
                r.verdict.c_str());
    EXPECT_NEAR(r.value / expected[p], 1.0, 0.05);
    EXPECT_LT(r.ci95()->low, expected[p] * 1.01);
    EXPECT_GT(r.ci95()->high, expected[p] * 0.99);
  }
  EXPECT_GT(result.tests.front().r2, 0.99);
}

std::string fault(std::string text, const std::string& from = "", const std::string& to = "") {
  const phantom::Folder folder;
  folder.write("hold.csv", "time (s),indentation (mm),force (mN)\n0,0,0\n1,0.5,2\n2,1,6\n3,1.5,12\n4,2,20\n5,2.5,30\n");
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  folder.write("fit.toml", text);
  try {
    FitSpec spec = load_fit(folder.path() / "fit.toml");
    spec.search.starts = 1, spec.search.most_iterations = 1;
    spec.proof = {.profiles = false, .bootstrap = 0, .next = false, .displacement = {}};
    run_fit(spec, {});
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no fault";
}

// What a program gives is refused by the member, its value and range; members that a shape does not have are not looked at.
TEST(IndentationFit, RefusesIndentersAndLayersThatCannotBe) {
  const auto refusal = [](const Indenter& indenter, const Layer& layer) -> std::string {
    try {
      indentation(brain(600.0, -8.0), indenter, layer, std::vector{1.0}, std::vector{1e-4});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  };
  const double five = 5.0 * Indenter::kDegree;
  EXPECT_THAT(refusal({.shape = IndenterShape::sphere}, {}), HasSubstr("indenter: radius [m] = 0 is outside"));
  EXPECT_THAT(refusal({.shape = IndenterShape::cone, .half_angle = five}, {}), HasSubstr("half_angle [rad] = 0.087"));
  EXPECT_THAT(refusal({.shape = IndenterShape::flat, .radius = 2e-3, .edge_radius = 3e-3}, {}),
              HasSubstr("edge_radius: 3 mm is above 2 mm"));
  EXPECT_THAT(refusal(kBall, {.thickness = 0.0}), HasSubstr("layer: thickness [m] = 0 is outside"));
  EXPECT_THAT(refusal(kBall, {.radius = -1.0}), HasSubstr("infinite: a wide layer"));
  EXPECT_EQ(refusal({.shape = IndenterShape::sphere, .radius = 3e-3, .half_angle = five, .edge_radius = 4e-3}, {}), "");
}

// What is missing or cannot be is named with the way out.
TEST(IndentationFit, NamesWhatCannotBe) {
  const std::string indenter = "indenter = { kind = \"sphere\", radius_mm = 3 }";
  EXPECT_THAT(fault(kFit, indenter, ""), HasSubstr("needs an indenter; give indenter = {"));
  EXPECT_THAT(fault(kFit, "radius_mm = 3", "radius_mm = 0"), HasSubstr("out of range; allowed: > 0"));
  EXPECT_THAT(fault(kFit, indenter, "indenter = { kind = \"cone\", half_angle_deg = 95 }"), HasSubstr("10 to 89"));
  EXPECT_THAT(fault(kFit, indenter, "indenter = { kind = \"flat\", radius_mm = 2, edge_radius_mm = 3 }"),
              HasSubstr("3 mm is above 2 mm, the radius of its face"));
  EXPECT_THAT(fault(kFit, "kind = \"layer\"\nthickness_mm = 10", "kind = \"point\""),
              HasSubstr("indentation needs [specimen] kind = \"layer\""));
  EXPECT_THAT(fault(kFit, "test = \"indentation\"", "test = \"tension\""),
              HasSubstr("belongs to test = \"indentation\""));
  EXPECT_THAT(fault(kFit, "test = \"indentation\"\n" + indenter, "test = \"tension\""),
              HasSubstr("is not made on a layer"));
  EXPECT_THAT(fault(kFit, "thickness_mm = 10", "thickness_mm = 2"), HasSubstr("of the layer's thickness of 2 mm"));
  EXPECT_THAT(fault(kFit, "thickness_mm = 10", "thickness_mm = 10\ndiameter_mm = 4"),
              HasSubstr("is wider than the specimen"));
  EXPECT_THAT(fault(kFit, "test = \"indentation\"",
                    "test = \"indentation\"\ncolumns.stress = { name = \"force\", unit = \"kPa\" }"),
              HasSubstr("does not belong to test = \"indentation\""));
  EXPECT_THAT(fault(kFit, "test = \"indentation\"",
                    "test = \"indentation\"\ncolumns.force = { name = \"force\", unit = \"kN\" }"),
              HasSubstr("soft tissues have"));
  EXPECT_THAT(fault(kFit, "test = \"indentation\"", "test = \"creep\""),
              HasSubstr("needs mode = \"indentation\" in a test of creep"));
  const std::string creep = "test = \"creep\"\nmode = \"indentation\"\n";
  EXPECT_THAT(fault(kFit, "test = \"indentation\"", creep + "contact.kind = \"detect\""),
              HasSubstr("a creep is driven by its load"));
  EXPECT_THAT(fault(kFit, "test = \"indentation\"", creep + "crop.max_displacement_mm = 1"),
              HasSubstr("a creep is cropped by time"));
}

}  // namespace
}  // namespace glisson::fit::indentation_fit_test
