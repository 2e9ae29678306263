// preset_test.cpp — presets are what their sources say, and scenes can start from them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "glisson/material_point.h"
#include "glisson/scene/tissue_presets.h"
#include "material/response.h"
#include "scene/scene_text.h"
#include "support/places.h"

namespace glisson {
namespace {

using test::complaint;
using test::kSmallScene;
using test::parse;
using ::testing::HasSubstr;

// Every preset is a tissue that the engine takes, says where it comes from, and cites a work of the bibliography.
TEST(Presets, AreValidAndHaveASource) {
  std::ifstream stream(test::shipped("docs/references.bib"));
  const std::string bibliography{std::istreambuf_iterator<char>(stream), {}};
  std::set<std::string> names;
  for (const TissuePreset& p : tissue_presets()) {
    EXPECT_TRUE(names.insert(p.name).second) << p.name << " is there twice";
    EXPECT_NO_THROW(require_valid(p.tissue)) << p.name;
    EXPECT_GT(p.tissue.lame().mu, 0.0) << p.name;
    for (const std::string& text : {p.what, p.source, p.fitted_to, p.validity, p.confirmed})
      EXPECT_FALSE(text.empty()) << p.name;
    std::smatch key;
    ASSERT_TRUE(std::regex_search(p.source, key, std::regex("^\\[([A-Za-z]+[0-9]{4})"))) << p.name << ": " << p.source;
    EXPECT_THAT(bibliography, HasSubstr("{" + key[1].str() + ",")) << p.name;
  }
  EXPECT_GE(names.size(), 12u);
}

// What `glisson tissues NAME` prints gives the same tissue when pasted as when named.
TEST(Presets, PastedAreThePresets) {
  for (const TissuePreset& p : tissue_presets()) {
    const Tissue named = parse(kSmallScene + "[tissue]\npreset = \"" + p.name + "\"\n").variants.at(0).tissue;
    for (const Tissue& t : {named, parse(kSmallScene + p.toml).variants.at(0).tissue}) {
      EXPECT_EQ(t.name, p.name);
      EXPECT_EQ(t.youngs_modulus, p.tissue.youngs_modulus) << p.name;
      EXPECT_EQ(t.poisson_ratio, p.tissue.poisson_ratio) << p.name;
      EXPECT_EQ(t.density, p.tissue.density) << p.name;
      EXPECT_EQ(t.viscosity, p.tissue.viscosity) << p.name;
      EXPECT_EQ(t.kinematics, p.tissue.kinematics) << p.name;
      EXPECT_EQ(t.volume_change, p.tissue.volume_change) << p.name;
      EXPECT_EQ(t.hyperelastic, p.tissue.hyperelastic) << p.name;
      EXPECT_EQ(t.maxwell, p.tissue.maxwell) << p.name;
    }
  }
}

/// Engineering stress of uniaxial compression, positive, by the preset's own response; the lateral stretch is the one
/// that leaves the sides free of stress.
double compressive_stress(const Response& response, double strain) {
  const auto piola = [&](double side) {
    Mat3d H{};
    H(0, 0) = H(1, 1) = side - 1.0;
    H(2, 2) = -strain;
    return response.elastic(H, ElementShape{});
  };
  double low = 1.0, high = 1.0 / std::sqrt(1.0 - strain);  // incompressible at most
  for (int i = 0; i < 80; ++i) {
    const double side = 0.5 * (low + high);
    (piola(side)(0, 0) > 0.0 ? high : low) = side;
  }
  return -piola(0.5 * (low + high))(2, 2);
}

struct Phantom {
  const char* preset;
  std::array<double, 7> stress_kPa;  ///< mean of ten runs at kStrains
  double residual_kPa;               ///< standard error that the preset states
};
constexpr std::array<double, 7> kStrains{0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
constexpr std::array<double, 7> kEf100{0.29, 0.66, 1.48, 2.54, 4.33, 8.33, 19.23};
constexpr std::array<double, 7> kEf75{0.47, 0.99, 2.18, 3.68, 6.23, 12.05, 28.71};
const std::vector<Phantom> kPhantoms{{"phantom_ef10_100t", kEf100, 0.062},
                                     {"phantom_ef10_100t_ogden", kEf100, 0.147},
                                     {"phantom_ef10_75t", kEf75, 0.100},
                                     {"phantom_ef10_75t_ogden", kEf75, 0.290}};

void set_bulk(HyperelasticLaw& law, double kappa) {
  std::visit([&](auto& l) { l.bulk_modulus = kappa; }, law);
}

// The phantoms' laws leave the measured compression curve the standard error that is said of them, at κ → ∞ as fitted.
TEST(Presets, PhantomsReproduceTheMeasuredCurve) {
  for (const Phantom& phantom : kPhantoms) {
    const TissuePreset& preset = tissue_preset(phantom.preset);
    Tissue tissue = preset.tissue;
    set_bulk(*tissue.hyperelastic, 1e5 * shear_modulus(*tissue.hyperelastic));
    const Response response(tissue);
    double squares = 0.0;
    for (std::size_t i = 0; i < kStrains.size(); ++i) {
      squares += std::pow(1e-3 * compressive_stress(response, kStrains[i]) - phantom.stress_kPa[i], 2);
    }
    const double parameters = std::holds_alternative<Ogden>(*tissue.hyperelastic) ? 2.0 : 3.0;
    // The stated figure has three digits, the parameters four or five.
    EXPECT_NEAR(std::sqrt(squares / (kStrains.size() - parameters)), phantom.residual_kPa, 0.0006) << phantom.preset;
    char stated[16];
    std::snprintf(stated, sizeof stated, "%.3f kPa", phantom.residual_kPa);
    EXPECT_THAT(preset.fitted_to, HasSubstr(stated));
  }
}

// With the bulk modulus they come with, 50 μ, the phantoms are softer than measured by no more than is said, 3 %.
TEST(Presets, PhantomsOfFiniteBulkStayClose) {
  for (const Phantom& phantom : kPhantoms) {
    Tissue tissue = tissue_preset(phantom.preset).tissue;
    const double mu = shear_modulus(*tissue.hyperelastic);
    EXPECT_NEAR(bulk_modulus(*tissue.hyperelastic), 50.0 * mu, 0.01 * mu) << phantom.preset;
    const Response response(tissue);
    set_bulk(*tissue.hyperelastic, 1e5 * mu);
    const Response stiff(tissue);
    for (const double strain : kStrains) {
      const double ratio = compressive_stress(response, strain) / compressive_stress(stiff, strain);
      EXPECT_LT(ratio, 1.0) << phantom.preset << " at " << strain;
      EXPECT_GT(ratio, strain > 0.55 ? 0.969 : 0.985) << phantom.preset << " at " << strain;
    }
  }
}

/// Stress at the strains of kStrains from the force of the tool on a 30 mm cube.
struct PressRecorder : RunObserver {
  std::vector<Sample> samples;
  void on_sample(const Sample& s) override { samples.push_back(s); }
  double stress_kPa(double strain) const {
    const auto away = [&](const Sample& s) { return std::abs(s.instruments[0].depth / 0.03 - strain); };
    const auto nearest = std::min_element(samples.begin(), samples.end(),
                                          [&](const Sample& a, const Sample& b) { return away(a) < away(b); });
    return 1e-3 * nearest->instruments[0].force.z / -(0.03 * 0.03);
  }
};

// A cube of each phantom, pressed to 60 % between plates without friction by the engine, follows the same curve. Within
// 1 %: nodal damping adds γ m v/2 = 7 mN at 10 mm/s, 0.5 % at a strain of 20 %, and samples are 0.04 % of strain off.
TEST(Presets, PhantomsAreThatStiffInTheEngine) {
  for (const Phantom& phantom : kPhantoms) {
    const std::string scene =
        "[mesh]\nkind = \"box\"\ncells = [2, 2, 2]\nsize_m = [0.03, 0.03, 0.03]\n[tissue]\npreset = \"" +
        std::string(phantom.preset) +
        "\"\n[motion]\ndamping_rate_per_s = 50\n[[fixed]]\nset = \"z_min\"\naxes = \"z\"\n[[tool]]\nset = \"z_max\"\n"
        "sideways = \"free\"\ndepth_mm = 18.1\nramp_s = 0.2\n";
    PressRecorder seen;
    const std::atomic<bool> go_on{false};
    ASSERT_EQ(run_variant(parse(scene).variants.at(0), {}, seen, go_on).end, RunSummary::End::finished);
    const Response response(tissue_preset(phantom.preset).tissue);
    for (const double strain : {0.2, 0.4, 0.6}) {
      const double expected = 1e-3 * compressive_stress(response, strain);
      EXPECT_NEAR(seen.stress_kPa(strain), expected, 0.01 * expected) << phantom.preset << " at " << strain;
    }
  }
}

// Miller's brain: in an instant 842 Pa, after long times 0.185 of it in shear, and its curve steeper in compression
// than in tension, by the closed form P = 2 μ/α (λ^(α−1) − λ^(−α/2−1)).
TEST(Presets, BrainRelaxesAsPublished) {
  const Tissue t = tissue_preset("brain_miller").tissue;
  const auto shear_at = [&](double time) {
    double g = 1.0;
    for (const MaxwellBranch& b : t.maxwell) g -= b.share * (1.0 - std::exp(-time / b.time));
    return shear_modulus(*t.hyperelastic) * g;
  };
  EXPECT_DOUBLE_EQ(shear_at(0.0), 842.0);
  EXPECT_NEAR(shear_at(0.5), 842.0 * (1.0 - 0.450 * (1.0 - std::exp(-1.0)) - 0.365 * (1.0 - std::exp(-0.01))), 1e-9);
  EXPECT_NEAR(shear_at(1e4), 155.77, 0.01);
  Mat3d shear{};
  shear(0, 1) = 1e-4;
  const Response response(t);
  // small shear is all deviator: what is left of the energy is the relaxed share, to second order in the strain
  EXPECT_NEAR(response.relaxed_energy(shear, {}) / response.energy(shear, {}), 0.185, 1e-6);
  Tissue stiff = t;
  set_bulk(*stiff.hyperelastic, 1e5 * 842.0);
  const double l = 0.7, P = 2.0 * 842.0 / -4.7 * (std::pow(l, -5.7) - std::pow(l, 1.35));
  EXPECT_NEAR(compressive_stress(Response(stiff), 1.0 - l), -P, 1e-3 * -P);
}

// Miller's polynomial, which the paper cites: P = 2 (λ − λ⁻²) (w₁ + w₂/λ) at once, w_k = c_k + 2 d_k (I_k − 3), and 0.185 of it
// after long times.
TEST(Presets, BrainOfThePaperIsMillersPolynomial) {
  Tissue t = tissue_preset("brain_miller_polynomial").tissue;
  EXPECT_DOUBLE_EQ(shear_modulus(*t.hyperelastic), 2.0 * (263.0 + 263.0));
  set_bulk(*t.hyperelastic, 1e5 * 1052.0);
  for (const double l : {0.7, 0.85, 1.1}) {
    const double w1 = 263.0 + 2.0 * 491.0 * (l * l + 2.0 / l - 3.0),
                 w2 = 263.0 + 2.0 * 491.0 * (2.0 * l + 1.0 / (l * l) - 3.0);
    const double P = 2.0 * (l - 1.0 / (l * l)) * (w1 + w2 / l);
    const std::vector<double> times{1e-6, 1e6}, held{l, l};
    const auto states = material_test(t, MaterialTest::uniaxial, MaterialControl::deformation, times, held);
    ASSERT_TRUE(states.back().converged);
    EXPECT_NEAR(states[0].nominal(2, 2), P, 1e-3 * std::abs(P)) << l;
    EXPECT_NEAR(states[1].nominal(2, 2), 0.185 * P, 1e-3 * std::abs(P)) << l;
  }
}

// Elastography measures the speed of shear waves, or the shear modulus: the presets give it back.
TEST(Presets, ElastographyGivesBackWhatWasMeasured) {
  const auto shear = [](const char* name) { return tissue_preset(name).tissue.lame().mu; };
  EXPECT_NEAR(shear("liver_mre"), 2090.0, 1.0);
  EXPECT_NEAR(shear("kidney_mre"), 4900.0, 1.0);
  EXPECT_NEAR(shear("muscle_thigh"), 3730.0, 1.0);
  const Tissue tumour = tissue_preset("liver_tumour").tissue;
  EXPECT_NEAR(std::sqrt(tumour.lame().mu / tumour.density), 3.29, 0.001);
  EXPECT_NEAR(shear("brain_balbi"), 900.0, 1e-9);
}

// Keys beside a preset win, single numbers of its law included; the rest is the preset's.
TEST(PresetInScene, IsOverriddenKeyByKey) {
  const Tissue t = parse(kSmallScene +
                         "[tissue]\npreset = \"brain_miller\"\ndensity_kg_m3 = 1040\n"
                         "hyperelastic.bulk_modulus_Pa = 9e4\nmaxwell = []\n")
                       .variants.at(0)
                       .tissue;
  EXPECT_EQ(t.density, 1040.0);
  EXPECT_TRUE(t.maxwell.empty());
  const auto& law = std::get<Ogden>(t.hyperelastic.value());
  EXPECT_EQ(law.bulk_modulus, 9e4);
  EXPECT_EQ(law.mu, std::vector<double>{842.0});
  EXPECT_EQ(t.volume_change, VolumeChange::average_nodal);
  const Tissue liver = parse(kSmallScene + "[tissue]\npreset = \"liver_mre\"\npoisson_ratio = 0.45\nname = \"mine\"\n")
                           .variants.at(0)
                           .tissue;
  EXPECT_EQ(liver.youngs_modulus, tissue_preset("liver_mre").tissue.youngs_modulus);
  EXPECT_EQ(liver.poisson_ratio, 0.45);
  EXPECT_EQ(liver.name, "mine");
}

// A variant or --set that names a preset starts from it, not from the scene's tissue, and the next may change its parts.
TEST(PresetInScene, OfAVariantStartsAnew) {
  const std::string text = kSmallScene +
                           "[tissue]\nyoungs_modulus_Pa = 5000\ndensity_kg_m3 = 1200\n"
                           "[[variant]]\nname = \"linear\"\n[[variant]]\nname = \"brain\"\n"
                           "tissue.preset = \"brain_miller\"\n";
  const Scene scene = parse(text, {{"variant.brain.tissue.maxwell.0.share", "0.3"}});
  EXPECT_FALSE(scene.variants.at(0).tissue.hyperelastic);
  EXPECT_EQ(scene.variants[0].tissue.youngs_modulus, 5000.0);
  EXPECT_EQ(scene.variants.at(1).tissue.density, 1000.0);
  EXPECT_TRUE(scene.variants[1].tissue.hyperelastic);
  EXPECT_EQ(scene.variants[1].tissue.maxwell.at(0).share, 0.3);
  const Tissue set = parse(kSmallScene + "[tissue]\nyoungs_modulus_Pa = 5000\n", {{"tissue.preset", "brain_balbi"}})
                         .variants.at(0)
                         .tissue;
  EXPECT_TRUE(std::holds_alternative<MooneyRivlin>(set.hyperelastic.value()));
  EXPECT_EQ(set.name, "brain_balbi");
}

// A region takes over the body's preset but for its own keys; with a preset of its own it takes over nothing.
TEST(PresetInScene, OfARegionStartsAnew) {
  const std::string where = "box_m = { min = [0, 0, 0], max = [1, 1, 1] }\n";
  const Variant v = parse(kSmallScene +
                          "[tissue]\npreset = \"brain_miller\"\ndensity_kg_m3 = 1040\n"
                          "[[region]]\nname = \"vessel\"\n" +
                          where + "tissue.preset = \"hepatic_vein\"\n[[region]]\nname = \"soft\"\n" + where +
                          "tissue.hyperelastic.mu_Pa = [400]\n[[region]]\nname = \"same\"\n" + where)
                        .variants.at(0);
  ASSERT_EQ(v.regions.size(), 3u);
  const Tissue& vessel = v.regions[0].tissue;
  EXPECT_EQ(vessel.name, "vessel");
  EXPECT_EQ(vessel.density, 1060.0);
  EXPECT_EQ(vessel.youngs_modulus, 0.62e6);
  EXPECT_FALSE(vessel.hyperelastic);
  EXPECT_TRUE(vessel.maxwell.empty());
  const Tissue& soft = v.regions[1].tissue;
  EXPECT_EQ(std::get<Ogden>(soft.hyperelastic.value()).mu, std::vector<double>{400.0});
  EXPECT_EQ(std::get<Ogden>(*soft.hyperelastic).alpha, std::vector<double>{-4.7});
  EXPECT_EQ(soft.density, 1040.0);
  EXPECT_EQ(v.regions[2].tissue.maxwell.size(), 2u);
  EXPECT_EQ(v.regions[2].tissue.name, "same");
}

// A name that is none is refused with the nearest one, in a scene at its line and in C++ by name.
TEST(PresetInScene, UnknownIsRefusedWithTheNearest) {
  const std::string said = complaint(kSmallScene + "[tissue]\npreset = \"brain_miler\"\ndensity_kg_m3 = 1040\n");
  EXPECT_THAT(said, HasSubstr("s.toml:17:10: tissue.preset: expected one of \"paper_liver\", "));
  EXPECT_THAT(said, HasSubstr("got \"brain_miler\"; did you mean \"brain_miller\"?"));
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 0) << said;
  EXPECT_THAT(complaint(kSmallScene + "[tissue]\npreset = 3\n"), HasSubstr("tissue.preset: expected one of "));
  try {
    tissue_preset("brain_miler");
    ADD_FAILURE() << "took an unknown name";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "there is no tissue preset \"brain_miler\"; did you mean \"brain_miller\"?");
  }
}

// A modulus beside a hyperelastic preset would silently drop its law: it is refused, at that key.
TEST(PresetInScene, KeysThatWouldDropTheLawAreRefused) {
  EXPECT_EQ(
      complaint(kSmallScene + "[tissue]\npreset = \"brain_miller\"\npoisson_ratio = 0.45\n"),
      "s.toml:18:1: tissue.poisson_ratio: the preset \"brain_miller\" has a hyperelastic law, which takes no such "
      "key; change that law's own keys in `hyperelastic`, or leave out `preset`");
  EXPECT_THAT(complaint(kSmallScene, {{"tissue.preset", "brain_miller"}, {"tissue.kinematics", "green"}}),
              HasSubstr("--set tissue.kinematics: the preset"));
  const Tissue t = parse(kSmallScene +
                         "[tissue]\npreset = \"liver_mre\"\n"
                         "hyperelastic = { kind = \"neo_hookean\", mu_Pa = 2000, bulk_modulus_Pa = 1e5 }\n")
                       .variants.at(0)
                       .tissue;
  EXPECT_TRUE(t.hyperelastic) << "a whole law in place of a linear preset's moduli is allowed";
}

// A mistake in a key beside a preset is said at that key, and a preset's own keys are never the user's mistake.
TEST(PresetInScene, MistakesBesideItAreSaidAtTheirKey) {
  EXPECT_THAT(complaint(kSmallScene + "[tissue]\npreset = \"brain_miller\"\nmaxwell = [{ share = 1.5, time_s = 1 }]\n"),
              HasSubstr("s.toml:18:"));
  EXPECT_THAT(complaint(kSmallScene + "[tissue]\npreset = \"liver_mre\"\nyoungs_modulus_Pa = -1\n"),
              HasSubstr("s.toml:18:21: tissue.youngs_modulus_Pa: -1 Pa is out of range"));
}

}  // namespace
}  // namespace glisson
