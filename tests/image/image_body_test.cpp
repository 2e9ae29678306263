// image_body_test.cpp — meshes of labelled images: volumes, surfaces, pieces, borders, implants; labels as region numbers.
#include "glisson/image/image_body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "glisson/image/read_image.h"
#include "image/label_image.h"
#include "image/mesh_pieces.h"
#include "support/folder.h"

namespace glisson {
namespace {

using test::meta_image;
using testing::HasSubstr;
using testing::ThrowsMessage;

class ImageBodies : public test::InFolder {
 protected:
  /// Two organs that share a flat interface, and a vessel through both; 3 mm voxels.
  ImageBody two_halves() {
    const auto label = [](int i, int j, int k) {
      if (std::hypot(i - 15.5, j - 14.5, k - 13.5) > 11.0) return 0;
      if (std::hypot(j - 14.5, k - 13.5) < 3.0) return 30;
      return i < 16 ? 10 : 20;
    };
    return {.path = write("halves.mha", meta_image({32, 30, 28}, 3.0, label)),
            .labels = {"left=10", "right=20", "vessel=30"}};
  }
};

/// Each inner face lies on two tets, none on more, and all tets have a volume.
void expect_sound(const TetMesh& mesh) {
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.non_manifold_faces, 0u);
  EXPECT_TRUE(report.reoriented_tets.empty());
  EXPECT_TRUE(report.degenerate_tets.empty());
  EXPECT_TRUE(report.unused_vertices.empty());
}

// Regions are numbered by their labels, conform, keep the volume of their voxels within 3 % and their pieces, follow the blurred voxels to
// half a voxel, and have no dihedral angle below 10° or above 165°: the mesher's own bounds.
TEST_F(ImageBodies, MeshOfThreeLabels) {
  ImageMesh made = image_mesh(two_halves());
  expect_sound(made.mesh);
  EXPECT_EQ(made.mesh.region_names, (std::map<int, std::string>{{10, "left"}, {20, "right"}, {30, "vessel"}}));
  EXPECT_GE(made.report.min_dihedral_deg, 10.0);
  EXPECT_LE(made.report.max_dihedral_deg, 165.0);
  measure_distances(made);
  ASSERT_EQ(made.regions.size(), 3u);
  for (const ImageRegion& r : made.regions) {
    EXPECT_NEAR(r.volume / r.image_volume, 1.0, 0.03) << r.name;
    EXPECT_EQ(r.pieces, r.image_pieces) << r.name;
    EXPECT_LE(r.distance_p95, 1.5e-3) << r.name;
    EXPECT_GT(r.distance_p95, 0.0) << r.name;
    EXPECT_LE(r.faces_p95, 1.6e-3) << r.name;
  }
  double volume = 0.0;
  for (const RegionVolume& v : made.report.regions) volume += v.volume;
  EXPECT_NEAR(volume, ::glisson::volume(made.mesh), 1e-12);
}

// The distance that is reported is one that was measured: a mesh moved by 2 mm along x is 2 mm off where its surface faces x.
TEST_F(ImageBodies, DistancesAreMeasured) {
  ImageMesh made = image_mesh(two_halves());
  for (Vec3d& v : made.mesh.vertices) v.x += 0.004;
  measure_distances(made);
  for (const ImageRegion& r : made.regions) {
    if (r.name == "vessel") continue;  // along x
    EXPECT_GT(r.distance_p95, 2.5e-3) << r.name;
    EXPECT_LT(r.distance_p95, 4.8e-3) << r.name;
  }
}

// Same image, same bytes.
TEST_F(ImageBodies, SameImageSameMesh) {
  const ImageBody body = two_halves();
  EXPECT_EQ(image_mesh(body).mesh, image_mesh(body).mesh);
}

// An organ that the image cuts is closed flat at the outer faces of its last voxels: it ends at
// that plane, its volume is that of its voxels, and this is said.
TEST_F(ImageBodies, CutOrganIsClosedFlat) {
  const auto label = [](int i, int j, int k) { return std::hypot(i - 11.5, j - 11.5, k - 15.5) < 9.0 ? 7 : 0; };
  const ImageBody body{.path = write("cut.mha", meta_image({24, 24, 16}, 2.0, label)), .labels = {"7"}, .edge = 0.004};
  const ImageMesh made = image_mesh(body);
  expect_sound(made.mesh);
  const double plane = 0.002 * 15.5;
  double top = 0.0, on_plane = 0.0;
  for (const Vec3d& v : made.mesh.vertices) top = std::max(top, v.z);
  EXPECT_NEAR(top, plane, 1e-12);
  for (const Triangle& t : boundary_triangles(made.mesh)) {
    const Vec3d &a = made.mesh.vertices[t[0]], &b = made.mesh.vertices[t[1]], &c = made.mesh.vertices[t[2]];
    const Vec3d area = cross(b - a, c - a) * 0.5;
    if (std::abs((a.z + b.z + c.z) / 3.0 - plane) < 1e-4 && area.z > 0.99 * norm(area)) on_plane += area.z;
  }
  EXPECT_NEAR(on_plane, M_PI * 0.018 * 0.018, 0.05 * M_PI * 0.018 * 0.018);  // the disc of the ball's middle
  EXPECT_NEAR(made.regions[0].volume / made.regions[0].image_volume, 1.0, 0.03);
  EXPECT_THAT(made.notes,
              testing::Contains(HasSubstr("the image ends in the body at its last k; it is closed flat there")));
}

// An implanted ball of 18 mm has its volume of 3.05 mL within 3 %, the first free number, and is taken from the organ around it.
TEST_F(ImageBodies, ImplantedBall) {
  ImageBody body = two_halves();
  body.implants = {"tumour=ball:35,43.5,56,18mm"};
  ImageMesh made = image_mesh(body);
  expect_sound(made.mesh);
  ASSERT_EQ(made.regions.size(), 4u);
  const ImageRegion& tumour = made.regions[0];
  EXPECT_EQ(tumour.name, "tumour");
  EXPECT_EQ(tumour.label, 31);
  EXPECT_NEAR(1e6 * tumour.image_volume, 3.0536, 1e-4);
  EXPECT_NEAR(tumour.volume / tumour.image_volume, 1.0, 0.03);
  const ImageMesh without = image_mesh(two_halves());
  double sum = 0.0, sum_without = 0.0;
  for (const ImageRegion& r : made.regions) sum += r.image_volume;
  for (const ImageRegion& r : without.regions) sum_without += r.image_volume;
  EXPECT_NEAR(sum, sum_without, 0.01 * tumour.image_volume);  // 27 points a voxel
  measure_distances(made);
  EXPECT_LE(made.regions[0].distance_p95, 0.5e-3);
}

// Words of implants that are wrong say how to write them; one outside of all regions, and one with a taken name, are refused.
TEST_F(ImageBodies, ImplantsThatAreWrong) {
  const auto said = [&](const std::string& word) {
    ImageBody body = two_halves();
    body.implants = {word};
    try {
      image_regions(body);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("was made");
  };
  EXPECT_THAT(said("ball:1,2,3,4mm"), HasSubstr("write NAME=ball:X,Y,Z,DIAMETERmm"));
  EXPECT_THAT(said("t=cube:1,2,3,4mm"), HasSubstr("is of the kind \"cube\""));
  EXPECT_THAT(said("t=ball:1,2,3"), HasSubstr("has 3 numbers in place of 4"));
  EXPECT_THAT(said("t=ball:1,2,x,3mm"), HasSubstr("\"x\" is no length in mm"));
  EXPECT_THAT(said("t=ball:1,2,3,-4mm"), HasSubstr("not above 0"));
  EXPECT_THAT(said("t=ball:-500,0,0,4mm"), HasSubstr("lies in none of the regions"));
  EXPECT_THAT(said("left=ball:35,43.5,56,18mm"), HasSubstr("has the name of another region"));
  EXPECT_EQ(said("t=ellipsoid:35,43.5,56,9,6,5mm"), "was made");
}

// A vessel of two voxels that long edges lose is meshed again with shorter ones until it is whole, and that is said; without `refine`
// it is refused by name.
TEST_F(ImageBodies, TornVesselIsRefined) {
  const auto label = [](int i, int j, int k) {
    if (i < 2 || i > 37 || j < 2 || j > 21 || k < 2 || k > 21) return 0;
    const double along = 11.0 + 5.0 * std::sin(0.25 * i);
    return std::abs(j - along) <= 1.0 && (k == 11 || k == 12) ? 2 : 1;
  };
  ImageBody body{.path = write("vessel.mha", meta_image({40, 24, 24}, 1.0, label)),
                 .labels = {"organ=1", "vessel=2"},
                 .edge = 0.005};
  body.refine = false;
  EXPECT_THAT([&] { image_mesh(body); },
              ThrowsMessage<RegionLost>(HasSubstr("region \"vessel\" is left without a tet")));
  body.refine = true;
  const ImageMesh whole = image_mesh(body);
  EXPECT_EQ(whole.regions[1].pieces, 1u);
  EXPECT_NEAR(whole.regions[1].volume / whole.regions[1].image_volume, 1.0, 0.05);
  EXPECT_THAT(whole.notes, testing::Contains(HasSubstr("mm in vessel, which longer ones would tear or shrink")));
  body.refine = false;
  body.edges_across = 1.5;
  EXPECT_EQ(image_mesh(body).regions[1].pieces, 1u);
}

// A sheared grid meshes as one at right angles does: the volume is that of the voxels.
TEST_F(ImageBodies, ShearedGrid) {
  std::string bytes = meta_image(
      {28, 26, 24}, 2.0, [](int i, int j, int k) { return std::hypot(i - 13.5, j - 12.5, k - 11.5) < 8.0 ? 1 : 0; });
  const std::string turn = "TransformMatrix = -1 0 0 0 -1 0 0 0 1";
  bytes.replace(bytes.find(turn), turn.size(), "TransformMatrix = -1 0 0 -0.3 -1 0 0 0.2 1");
  const ImageMesh made = image_mesh({.path = write("sheared.mha", bytes), .labels = {"1"}, .edge = 0.004});
  expect_sound(made.mesh);
  EXPECT_NEAR(made.regions[0].volume / made.regions[0].image_volume, 1.0, 0.03);
  EXPECT_GE(made.report.min_dihedral_deg, 10.0);
}

// Specks go to what they share most area with; pieces that are to stay, and large ones, stay.
TEST(MeshPieces, SpecksAreAbsorbed) {
  TetMesh mesh = box_mesh({.cells = {6, 3, 3}, .size = {0.06, 0.03, 0.03}});
  mesh.regions.assign(mesh.tets.size(), 1);
  const auto cube = [](int i, int j, int k) { return static_cast<std::size_t>(i + 6 * (j + 3 * k)) * 6; };
  const double six = six_rest_volume(mesh, 0);
  std::set<std::size_t> marked;
  for (const std::size_t first : {cube(1, 1, 1), cube(3, 1, 1), cube(4, 1, 1)}) {
    for (std::size_t t = first; t < first + 6; ++t) mesh.regions[t] = 2;
  }
  const double one_cube = six;  // six tets of a sixth of it
  EXPECT_EQ(image::mesh_pieces(mesh), (std::map<int, std::size_t>{{1, 1}, {2, 2}}));
  TetMesh kept = mesh;
  EXPECT_EQ(image::absorb_specks(kept, 1.5 * one_cube, {{1, 1}, {2, 2}}), 0u);
  EXPECT_EQ(image::absorb_specks(kept, 0.5 * one_cube, {{1, 1}, {2, 1}}), 0u);
  EXPECT_EQ(kept, mesh);
  EXPECT_EQ(image::absorb_specks(kept, 1.5 * one_cube, {{1, 1}, {2, 1}}), 1u);
  EXPECT_EQ(image::mesh_pieces(kept), (std::map<int, std::size_t>{{1, 1}, {2, 1}}));
  EXPECT_EQ(kept.regions[cube(1, 1, 1)], 1);
  EXPECT_EQ(kept.regions[cube(3, 1, 1)], 2);
}

/// A random image of balls, sheets, threads, single voxels and touching corners, up to 12 labels.
std::string random_image(unsigned seed, int n) {
  std::mt19937 random(seed);
  const auto draw = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(most)); };
  std::vector<unsigned char> voxels(static_cast<std::size_t>(n * n * n), 0);
  const auto put = [&](int i, int j, int k, int label) {
    if (i > 0 && j > 0 && k > 0 && i < n - 1 && j < n - 1 && k < n - 1)
      voxels[static_cast<std::size_t>(i + n * (j + n * k))] = static_cast<unsigned char>(label);
  };
  const int labels = 2 + draw(11);
  for (int label = 1; label <= labels; ++label) {
    const int ci = 4 + draw(n - 8), cj = 4 + draw(n - 8), ck = 4 + draw(n - 8), r = 2 + draw(n / 4);
    const int kind = label == 1 ? 0 : draw(5);
    for (int k = -r; k <= r; ++k) {
      for (int j = -r; j <= r; ++j) {
        for (int i = -r; i <= r; ++i) {
          const bool in_ball = i * i + j * j + k * k <= r * r;
          if ((kind == 0 && in_ball) || (kind == 1 && k == 0) || (kind == 2 && j == 0 && k == 0) ||
              (kind == 3 && i == j && k == 0) || (kind == 4 && in_ball && (i + j + k) % 2 == 0 && r < 5))
            put(ci + i, cj + j, ck + k, label);
        }
      }
    }
  }
  return meta_image({n, n, n}, 1.0,
                    [&](int i, int j, int k) { return voxels[static_cast<std::size_t>(i + n * (j + n * k))]; });
}

/// Meshes random images; all that are made are sound. @return how many were
int mesh_random_images(const std::filesystem::path& folder, unsigned first, unsigned count, int n) {
  int made_count = 0;
  for (unsigned seed = first; seed < first + count; ++seed) {
    SCOPED_TRACE(seed);
    const std::filesystem::path file = folder / "random.mha";
    std::ofstream(file, std::ios::binary) << random_image(seed, n);
    ImageBody body{.path = file, .edge = 0.0025};
    std::set<int> there;
    for (const LabelFigures& f : label_figures(read_label_image(file))) there.insert(f.label);
    for (const int label : there) body.labels.push_back(std::to_string(label));
    try {
      const ImageMesh made = image_mesh(body);
      expect_sound(made.mesh);
      ++made_count;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr("region \""));
    }
  }
  return made_count;
}

// Random labels with sheets, threads, single voxels and touching corners give sound meshes, or are refused with the region's name.
TEST_F(ImageBodies, RandomLabels) { EXPECT_EQ(mesh_random_images(folder_, 5, 2, 24), 2); }

// The same 200 times at 64³; 190 of them are meshed.
TEST_F(ImageBodies, ManyRandomLabels) {  // verify
  EXPECT_GE(mesh_random_images(folder_, 100, 200, 64), 190);
}

}  // namespace
}  // namespace glisson
