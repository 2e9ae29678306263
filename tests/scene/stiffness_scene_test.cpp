// stiffness_scene_test.cpp — [[stiffness]]: moduli of tets from images of elastography, against a column of two springs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numbers>

#include "image/label_image.h"
#include "scene/scene_text.h"
#include "support/folder.h"

namespace glisson {
namespace {

using ::testing::HasSubstr;

class StiffnessScene : public test::InFolder {
 protected:
  /// Cubes of 5 mm that fill the column of 20 × 20 × 80 mm; a number each.
  template <class Value>
  void write_column(const std::string& name, Value value) {
    std::string bytes = test::meta_image({4, 4, 16}, 5.0, value);
    bytes.replace(bytes.find("Offset = 0 0 0"), 14, "Offset = -2.5 -2.5 2.5");  // LPS
    write(name, bytes);
  }
  Scene parsed(const std::string& text) { return parse_scene(text, "column.toml", folder_, {}); }
  std::string complaint(const std::string& text) {
    try {
      const Scene scene = parsed(text);
      build_variant(scene.variants.at(0), {});
    } catch (const std::exception& error) {
      return error.what();
    }
    return "was built";
  }
};

const std::string kColumn = R"([mesh]
kind = "box"
cells = [2, 2, 8]
size_m = [0.02, 0.02, 0.08]
[tissue]
youngs_modulus_Pa = 3000
poisson_ratio = 0
viscosity_Pa_s = 3
[motion]
integrator = "quasi_static"
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
direction = [0, 0, -1]
depth_mm = 1
velocity_mm_s = 10
)";

double peak_force(const Scene& scene) {
  RunObserver quiet;
  const std::atomic<bool> stop{false};
  return run_variant(scene.variants.at(0), {}, quiet, stop).peak_force_N;
}

// Two halves of 2 and 8 kPa are springs in series: F = A d / Σ (L/E), exact without Poisson's ratio in small strain, to half a band of 1 %. The
// same force comes from an image of the shear modulus E/2.
TEST_F(StiffnessScene, TwoHalvesAreSpringsInSeries) {
  const double area = 4e-4, depth = 1e-3, half = 0.04;
  write_column("e.mha", [](int, int, int k) { return k < 8 ? 2 : 8; });
  write_column("g.mha", [](int, int, int k) { return k < 8 ? 1 : 4; });
  const double series = area * depth / (half / 2000.0 + half / 8000.0), own = area * depth * 3000.0 / 0.08;
  EXPECT_NEAR(peak_force(parsed(kColumn)), own, 1e-6 * own);
  const std::string more = "[[stiffness]]\nunit_Pa = 1000\nband = 0.01\n";
  EXPECT_NEAR(peak_force(parsed(kColumn + more + "path = \"e.mha\"\n")), series, 0.005 * series);
  EXPECT_NEAR(peak_force(parsed(kColumn + more + "path = \"g.mha\"\nquantity = \"shear_modulus\"\n")), series,
              0.005 * series);
}

// E = 2 (1 + ν) G′ and η = G″/(2π f) in each band, named by its modulus; the tissue is else that of its region, and tets where the image has no
// value keep theirs.
TEST_F(StiffnessScene, TissuesOfBands) {
  write_column("g.mha", [](int, int, int k) { return k < 4 ? 0 : k < 10 ? 2 : 5; });
  write_column("loss.mha", [](int, int, int k) { return k < 10 ? 1 : 3; });
  const Scene scene = parsed(kColumn + R"([[region]]
name = "top"
box_m = { min = [-1, -1, 0.03], max = [1, 1, 1] }
tissue = { density_kg_m3 = 1111, poisson_ratio = 0.4 }
[[stiffness]]
path = "g.mha"
quantity = "shear_modulus"
loss = "loss.mha"
frequency_hz = 60
unit_Pa = 1000
band = 0.02
region = "top"
)");
  const BuiltVariant built = build_variant(scene.variants.at(0), {});
  const TetMesh& mesh = built.simulation.mesh();
  const std::map<int, Tissue> tissues = region_tissues(scene.variants.at(0), mesh);
  int bands = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double z = 0.0;
    for (const std::uint32_t v : mesh.tets[t]) z += 0.25 * mesh.vertices[v].z;
    const Tissue& tissue = tissues.at(mesh.region_of(t));
    EXPECT_EQ(tissue, built.simulation.tissue(mesh.region_of(t)));
    if (z < 0.03) {
      ASSERT_EQ(tissue.youngs_modulus, 3000.0);
      ASSERT_EQ(tissue.viscosity, 3.0);
      continue;
    }
    const double g = z < 0.05 ? 2000.0 : 5000.0, loss = z < 0.05 ? 1000.0 : 3000.0, e = 2.0 * 1.4 * g;
    ASSERT_NEAR(tissue.youngs_modulus, e, 0.0101 * e);
    ASSERT_NEAR(tissue.viscosity, loss / (2.0 * std::numbers::pi * 60.0), 1e-9);
    ASSERT_EQ(tissue.density, 1111.0);
    ASSERT_EQ(tissue.poisson_ratio, 0.4);
  }
  for (const auto& [number, name] : mesh.region_names) bands += name.starts_with("top ") && name.ends_with(" kPa");
  EXPECT_EQ(bands, 2);
}

// What cannot be is said with the way out.
TEST_F(StiffnessScene, ExplainsWhatItRefuses) {
  write_column("e.mha", [](int, int, int) { return 2; });
  write_column("none.mha", [](int, int, int) { return 0; });
  const auto with = [&](const std::string& keys) { return complaint(kColumn + "[[stiffness]]\n" + keys); };
  EXPECT_EQ(with("path = \"e.mha\"\n"), "was built");
  EXPECT_THAT(with("path = \"gone.mha\"\n"), HasSubstr("stiffness.0.path"));
  EXPECT_THAT(with("path = \"e.mha\"\nregion = \"liver\"\n"),
              HasSubstr("names the region \"liver\", which the mesh has not"));
  EXPECT_THAT(with("path = \"none.mha\"\n"), HasSubstr("has no value above 0 where the body is"));
  EXPECT_THAT(with("path = \"e.mha\"\nloss = \"e.mha\"\nquantity = \"shear_modulus\"\n"),
              HasSubstr("is needed with `loss`"));
  EXPECT_THAT(with("path = \"e.mha\"\nfrequency_hz = 50\n"), HasSubstr("without `loss`"));
  EXPECT_THAT(with("path = \"e.mha\"\nloss = \"e.mha\"\nfrequency_hz = 50\n"),
              HasSubstr("quantity = \"shear_modulus\""));
  EXPECT_THAT(
      complaint(kColumn + "[[region]]\nname = \"top\"\nbox_m = { min = [-1, -1, 0.03], max = [1, 1, 1] }\n"
                          "tissue.hyperelastic = { kind = \"neo_hookean\", mu_Pa = 800, bulk_modulus_Pa = 9000 }\n"
                          "[[stiffness]]\npath = \"e.mha\"\n"),
      HasSubstr("has a hyperelastic law, which has no Young's modulus"));
}

}  // namespace
}  // namespace glisson
