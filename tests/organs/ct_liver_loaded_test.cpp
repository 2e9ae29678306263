// ct_liver_loaded_test.cpp — the liver of a CT is unloaded and loaded again.
#include <gtest/gtest.h>

#include <filesystem>

#include "glisson/scene/scene.h"
#include "support/places.h"

namespace glisson {
namespace {

/// The liver of a patient on the back, of 5 kPa with vessels and a tumour, on ribs, kidney, bowel and spine as springs.
std::string ct_scene(const std::string& image, const std::string& start, double edge_mm) {
  return "[mesh]\nkind = \"image\"\npath = \"" + image + "\"\nedge_mm = " + std::to_string(edge_mm) + R"(
labels = ["liver", "gallbladder", "cava=inferior_vena_cava", "portal=portal_vein_and_splenic_vein"]
implants = ["tumour=ball:80,165,400,18mm"]
beside = [
  "ribs=rib_right_9+rib_right_10+rib_right_11+rib_right_12", "kidney=kidney_right", "bowel=pancreas+duodenum",
  "spine=vertebrae_T12+vertebrae_L1+vertebrae_L2+vertebrae_L3+vertebrae_L4+iliopsoas_right",
]
beside_mm = 10
refine = false
[tissue]
youngs_modulus_Pa = 5000
poisson_ratio = 0.4
density_kg_m3 = 1060
kinematics = "corotational"
[[region]]
name = "tumour"
tissue.youngs_modulus_Pa = 50000
[[fixed]]
set = "image_border"
[[load]]
set = "ribs"
spring_Pa_m = [200000, 200000, 200000]
[[load]]
set = "kidney"
spring_Pa_m = [200000, 200000, 200000]
[[load]]
set = "spine"
spring_Pa_m = [200000, 200000, 200000]
[[load]]
set = "bowel"
spring_Pa_m = [200000, 200000, 200000]
[motion]
integrator = "quasi_static"
gravity_m_s2 = [0, -9.81, 0]
duration_s = 1
)" + start;
}

// Vertices of the unloaded liver are centimetres from the image; under its weight, which grows in steps, it is back to 0.2 mm.
TEST(CtLiver, UnloadedAndLoadedIsBack) {  // long
  const std::filesystem::path file = test::shipped("../shared/data/image/abdomen_labels.nii.gz");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the shared CT is not here";
  const auto variant_of = [&](const std::string& start) {
    return parse_scene(ct_scene(file.string(), start, 14.0), "liver.toml", {}).variants.at(0);
  };
  const Variant loaded = variant_of("start = \"loaded\"\n");
  const TetMesh image = build_mesh(loaded, {});
  const BuiltVariant start(loaded, {});
  EXPECT_GT(start.unloaded->largest_shift, 0.02);

  Variant again = variant_of("gravity_ramp_s = 0.9\n");
  again.mesh = MeshFile{"unloaded", 1.0};
  BuiltVariant body(again, [&](const MeshFile&) { return start.simulation.mesh(); });
  ASSERT_TRUE(body.simulation.advance_to(1.0).made());
  double farthest = 0.0;
  const std::vector<Vec3d> places = body.simulation.positions();
  for (std::size_t v = 0; v < places.size(); ++v) farthest = std::max(farthest, norm(places[v] - image.vertices[v]));
  EXPECT_LE(farthest, 2e-4);
}

}  // namespace
}  // namespace glisson
