// image_body_test.cpp — meshes of labelled images: volumes, surfaces, pieces, borders, implants; labels as region numbers.
#include "glisson/image/image_body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
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

// Labels in memory mesh as those of a file, to the byte, cropped as these are.
TEST_F(ImageBodies, LabelsInMemory) {
  ImageBody body = two_halves();
  const TetMesh from_file = image_mesh(body).mesh;
  body.image = std::make_shared<LabelImage>(read_label_image(body.path));
  body.path.clear();
  EXPECT_EQ(image_mesh(body).mesh, from_file);
  body.labels = {"99"};
  EXPECT_THAT([&] { image_mesh(body); },
              ThrowsMessage<ImageError>(HasSubstr("no voxel has the label 99; there are: 10, 20, 30")));
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

// An implanted ball of 18 mm has its volume of 3.05 mL within 5 %, the bar below 5 mL, the first free number, and is taken from the organ around it.
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
  EXPECT_NEAR(tumour.volume / tumour.image_volume, 1.0, 0.05);
  const ImageMesh without = image_mesh(two_halves());
  double sum = 0.0, sum_without = 0.0;
  for (const ImageRegion& r : made.regions) sum += r.image_volume;
  for (const ImageRegion& r : without.regions) sum_without += r.image_volume;
  EXPECT_NEAR(sum, sum_without, 0.01 * tumour.image_volume);  // 27 points a voxel
  measure_distances(made);
  EXPECT_LE(made.regions[0].distance_p95, 0.5e-3);
}

// An implant of a label file has the volume of its voxels on their own, finer grid, within 3 %, its surface follows theirs to half a voxel, and
// what it covers is taken from the organ; all labels of the file are meant where none are named.
TEST_F(ImageBodies, ImplantedLabels) {
  const auto lesion = [](int i, int j, int k) {
    const double x = (i - 11.5) / 9.0, y = (j - 9.5) / 7.0, z = (k - 9.5) / 6.0;
    return x * x + y * y + z * z > 1.0 ? 0 : i < 12 ? 2 : 3;
  };
  std::string bytes = meta_image({24, 20, 20}, 1.0, lesion);
  bytes.replace(bytes.find("Offset = 0 0 0"), 14, "Offset = -25 -35 45");  // LPS: the ball's middle
  ImageBody body = two_halves();
  body.implants = {"lesion=labels:" + write("lesion.mha", bytes) + ":2+3"};
  ImageMesh made = image_mesh(body);
  expect_sound(made.mesh);
  measure_distances(made);
  const ImageRegion& implant = made.regions[0];
  EXPECT_EQ(implant.name, "lesion");
  EXPECT_NEAR(1e6 * implant.image_volume, 4.0 / 3.0 * M_PI * 9.0 * 7.0 * 6.0 * 1e-3, 0.03);
  EXPECT_NEAR(implant.volume / implant.image_volume, 1.0, 0.05);  // below 5 mL
  EXPECT_EQ(implant.pieces, 1u);
  EXPECT_LE(implant.distance_p95, 0.5e-3);
  const ImageMesh without = image_mesh(two_halves());
  double sum = 0.0, sum_without = 0.0;
  for (const ImageRegion& r : made.regions) sum += r.image_volume;
  for (const ImageRegion& r : without.regions) sum_without += r.image_volume;
  EXPECT_NEAR(sum, sum_without, 0.01 * implant.image_volume);
  const TetMesh named = made.mesh;
  body.implants = {"lesion=labels:" + (folder_ / "lesion.mha").string()};
  EXPECT_EQ(image_mesh(body).mesh, named);
  body.implants = {"lesion=labels:lesion.mha"};
  resolve_paths(body, folder_);
  EXPECT_EQ(body.implants.front(), "lesion=labels:" + (folder_ / "lesion.mha").string());
}

// An image of sizes on a grid of its own makes edges shorter where it asks for it, and nowhere else; one that asks for too much is refused with
// the voxel.
TEST_F(ImageBodies, SizesOfAnImage) {
  ImageBody body = two_halves();
  const ImageMesh plain = image_mesh(body);
  const auto finer_left = [](int i, int, int) { return i < 4 ? 3 : 0; };  // i < 4 is x < 45 mm
  body.size_image = write("sizes.mha", meta_image({9, 9, 9}, 12.0, finer_left));
  const ImageMesh made = image_mesh(body);
  expect_sound(made.mesh);
  const auto count = [](const TetMesh& mesh, double from, double to) {
    std::size_t n = 0;
    for (const Tet& t : mesh.tets) {
      const double x =
          0.25 * (mesh.vertices[t[0]].x + mesh.vertices[t[1]].x + mesh.vertices[t[2]].x + mesh.vertices[t[3]].x);
      n += x > from && x < to;
    }
    return static_cast<double>(n);
  };
  EXPECT_GT(count(made.mesh, 0.0, 0.036), 5.0 * count(plain.mesh, 0.0, 0.036));  // half the edges: 8 times
  EXPECT_LT(count(made.mesh, 0.066, 0.1), 1.3 * count(plain.mesh, 0.066, 0.1));
  body.edge = 1.0;
  EXPECT_THAT([&] { image_mesh(body); },
              ThrowsMessage<ImageError>(HasSubstr("voxel (0, 0, 0) asks for edges of 3 mm; allowed: at least 1/256")));
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
  EXPECT_THAT(said("t=labels:none.txt"), HasSubstr("names no image file"));
  EXPECT_THAT(said("t=labels:none.nii.gz"), HasSubstr("there is no such file"));
  EXPECT_THAT(said("t=labels:" + (folder_ / "halves.mha").string() + ":77"), HasSubstr("no voxel has the label 77"));
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
              ThrowsMessage<RegionLost>(
                  HasSubstr("region \"vessel\" (voxel (17, 6, 11), at (17, 6, 11) mm in RAS) is left without a tet")));
  body.refine = true;
  const ImageMesh whole = image_mesh(body);
  EXPECT_EQ(whole.regions[1].pieces, 1u);
  EXPECT_NEAR(whole.regions[1].volume / whole.regions[1].image_volume, 1.0, 0.05);
  EXPECT_THAT(whole.notes, testing::Contains(HasSubstr("mm in vessel, which longer ones would tear or shrink")));
  body.refine = false;
  body.edges_across = 1.5;
  EXPECT_EQ(image_mesh(body).regions[1].pieces, 1u);
}

// Sheets, threads and specks of one voxel keep the volume of their voxels within 5 %: with 8 points a voxel by which volumes are counted, a thread
// got a third more, and edges were halved until nothing was won.
TEST_F(ImageBodies, ThinPartsKeepTheirVolume) {
  const auto label = [](int i, int j, int k) {
    if (k == 10 && i > 4 && i < 26 && j > 4 && j < 20) return 1;              // a sheet
    if (j == 12 && k == 16 && i > 3 && i < 27) return 2;                      // a thread
    if (i == 14 && j == 8 && k == 20) return 3;                               // a speck
    if (i + j == 30 && k == 4 && i > 8 && i < 22) return 4;                   // voxels that touch at edges: one is kept
    return std::abs(i - 15) < 11 && std::abs(j - 12) < 9 && k == 13 ? 5 : 0;  // a sheet beside it
  };
  const ImageMesh made = image_mesh({.path = write("thin.mha", meta_image({30, 26, 24}, 1.0, label)),
                                     .labels = {"sheet=1", "thread=2", "speck=3", "steps=4", "cover=5"},
                                     .edge = 0.0025});
  expect_sound(made.mesh);
  for (const ImageRegion& r : made.regions) {
    EXPECT_NEAR(r.volume / r.image_volume, 1.0, 0.05) << r.name;
    EXPECT_EQ(r.pieces, r.image_pieces) << r.name;
  }
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

/// Each interface face lies between the two labels that it parts: its tets are one of each, and both are on their side of it; a face of the
/// surface has one tet. Faces of one region have two.
void expect_interfaces(const TetMesh& mesh) {
  std::map<Triangle, std::vector<std::uint32_t>> faces;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    ASSERT_GT(six_rest_volume(mesh, t), 0.0) << t;
    for (std::size_t out = 0; out < 4; ++out) {
      Triangle face{};
      for (std::size_t c = 0, n = 0; c < 4; ++c) {
        if (c != out) face[n++] = mesh.tets[t][c];
      }
      std::sort(face.begin(), face.end());
      faces[face].push_back(t);
    }
  }
  std::size_t outer = 0;
  for (const auto& [face, tets] : faces) {
    ASSERT_LE(tets.size(), 2u);
    outer += tets.size() == 1;
    if (tets.size() == 1) continue;
    const Vec3d &a = mesh.vertices[face[0]], &b = mesh.vertices[face[1]], &c = mesh.vertices[face[2]];
    double product = 1.0;
    for (const std::uint32_t t : tets) {
      for (const std::uint32_t v : mesh.tets[t]) {
        if (v != face[0] && v != face[1] && v != face[2]) product *= dot(cross(b - a, c - a), mesh.vertices[v] - a);
      }
    }
    ASSERT_LT(product, 0.0);  // one tet on each side, of its own region
  }
  EXPECT_EQ(outer, boundary_triangles(mesh).size());
}

/// Meshes random images; all that are made are sound and have all of their labels; the others are refused with the place of a voxel.
/// @return how many were made
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
      const std::clock_t start = std::clock();
      const ImageMesh made = image_mesh(body);
      EXPECT_LE(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 30.0);
      expect_sound(made.mesh);
      expect_interfaces(made.mesh);
      EXPECT_EQ(std::set<int>(made.mesh.regions.begin(), made.mesh.regions.end()), there);
      ++made_count;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr("\" (voxel ("));
    }
  }
  return made_count;
}

// Random labels with sheets, threads, single voxels and touching corners give sound meshes, or are refused with a voxel of the region.
TEST_F(ImageBodies, RandomLabels) { EXPECT_EQ(mesh_random_images(folder_, 5, 2, 24), 2); }

// The same 200 times at 64³, of which 190 and more are meshed: 19 of each 20.
class ManyImages : public ImageBodies, public testing::WithParamInterface<unsigned> {};
TEST_P(ManyImages, RandomLabels) {  // verify
  EXPECT_GE(mesh_random_images(folder_, GetParam(), 20, 64), 19);
}
INSTANTIATE_TEST_SUITE_P(Seeds, ManyImages, testing::Range(100U, 300U, 20U));

// A label that no mesh may have, for an earlier one covers it, is refused by name with its voxel and where that is.
TEST_F(ImageBodies, LostRegionIsRefusedWithItsVoxel) {
  const auto label = [](int i, int j, int k) {
    return i < 3 || i > 16 || j < 3 || j > 16 || k < 3 || k > 16 ? 0 : i == 9 && j == 10 && k == 11 ? 2 : 1;
  };
  ImageBody body{.path = write("speck.mha", meta_image({20, 20, 20}, 1.0, label)),
                 .labels = {"organ=1", "speck=2"},
                 .implants = {"clip=ball:9,10,11,6mm"},
                 .edge = 0.003};
  EXPECT_THAT([&] { image_mesh(body); },
              ThrowsMessage<RegionLost>(
                  HasSubstr("region \"speck\" (voxel (9, 10, 11), at (9, 10, 11) mm in RAS) is left without a tet")));
  body.implants.clear();
  EXPECT_EQ(image_mesh(body).regions[1].pieces, 1u);
}

}  // namespace
}  // namespace glisson
