// image_body.h — a body of the labels of an image, and its mesh.
//
//   ImageBody body{.path = "labels.nii.gz", .labels = {"liver", "vessels=63+64"}, .implants = {"tumour=ball:10,80,320,18mm"}};
//   ImageMesh made = image_mesh(body);              // regions 5 (liver), 63 (vessels), 118 (tumour), in metres, axes RAS
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "glisson/image/clean_labels.h"
#include "glisson/implicit.h"
#include "glisson/mesh_size.h"
#include "glisson/region_mesh.h"

namespace glisson {

struct ImageBody {
  static constexpr std::string_view kName = "image";
  std::filesystem::path path{};               ///< the image of labels
  std::shared_ptr<const LabelImage> image{};  ///< labels in memory, in place of `path`
  std::vector<std::string> labels{};          ///< regions by precedence of their surfaces: label_groups
  std::vector<std::string>
      implants{};  ///< NAME=ball:X,Y,Z,DIAMETERmm, NAME=ellipsoid:X,Y,Z,A,B,Cmm, in mm, and NAME=labels:FILE:LABELS; over all labels
  std::vector<std::string>
      beside{};  ///< labels that are not meshed: vertices of the surface within `beside_within` of each are a set
  double beside_within = 0.006;  ///< [m]
  double voxel = 0.0;            ///< as in CleanLabels
  int keep_pieces = 0;
  double smallest_piece_ml = 0.1, largest_hole_ml = 1.0;
  int smoothing = 2;          ///< rounds of smoothing, under which volumes and voxels are kept; 0: none
  double edges_across = 0.0;  ///< edges across the thickness of thin parts, which get shorter ones [-]; 0: they do not
  bool refine =
      true;  ///< regions that are torn or off in volume are meshed again with half the edges, three times at most
  double edge = 0.006;                 ///< mean length of edges [m], > 0
  std::uint64_t max_tets = 5000000;    ///< more are refused
  std::vector<MeshSize> sizes{};       ///< where edges are shorter
  std::filesystem::path size_image{};  ///< wanted edges [mm] on a grid of its own; empty: none
  double growth = kGrowth;             ///< edge over distance at which edges grow away from these [-]

  template <class Take>
  static constexpr auto fields(Take take) {
    using B = ImageBody;
    return take(
        field("path", &B::path,
              "the image: .nii, .nii.gz, .nrrd, .nhdr, .seg.nrrd, .mha or .mhd, relative to the scene")
            .must(),
        no_key("image", &B::image),
        field("labels", &B::labels,
              "the regions: numbers or names of labels, joined by +, with a name in front: \"vessels=63+64\"")
            .must(),
        field("implants", &B::implants,
              "bodies put into it: \"tumour=ball:X,Y,Z,DIAMETERmm\", \"…=ellipsoid:X,Y,Z,A,B,Cmm\" with its semi-axes, "
              "or "
              "\"…=labels:FILE\", all labels of another image, \"…=labels:FILE:2+lesion\" some of them"),
        field("beside", &B::beside,
              "labels that are not meshed, as in `labels`: the vertices of the body's surface near each are a set with "
              "its name, for supports"),
        field("beside_within", &B::beside_within, "mm", above(0), "how near, from the faces of their voxels")
            .keyed("beside_mm"),
        voxel_field<B>(), keep_pieces_field<B>(), smallest_piece_field<B>(), largest_hole_field<B>(),
        field("smoothing", &B::smoothing, between(0, 100),
              "rounds of smoothing, under which each region keeps its volume and each voxel its region; 0: none"),
        field("edges_across", &B::edges_across, "-", between(0, 20),
              "edges across vessels, sheets and rims, which get shorter ones where `edge` is too long for that; 0: "
              "they do not"),
        field("refine", &B::refine,
              "a region that comes out in other pieces than its voxels, or by 3 % of another volume (below 5 mL 5 %), "
              "is meshed again with "
              "half the edges, three times at most"),
        edge_field<B>(), max_tets_field<B>(), sizes_field<B>(),
        field("size_image", &B::size_image,
              "an image of wanted edges in mm, on any grid: edges are no longer than it has there; voxels of 0 or less "
              "and "
              "NaN ask for nothing"),
        growth_field<B>());
  }
};

/// A region of a mesh beside the voxels that it is of.
struct ImageRegion {
  std::string name;
  int label = 0;  ///< its number in the mesh: the first label, of an implant the first that is free
  std::size_t tets = 0;
  double volume = 0.0;  ///< of the mesh [m³]
  double image_volume =
      0.0;  ///< of the voxels after cleaning, less what implants cover; of an implant that of its shape [m³]
  std::size_t pieces = 0,
              image_pieces = 0;  ///< of the mesh, by faces of tets; of the voxels, by theirs (of an implant 1)
  /// p95 of the distance between the region's surface in the mesh and the level ½ of its voxels blurred by 0.7 of them, the larger of both ways; from the
  /// faces of its voxels to the mesh [m]. The image's border is left out.
  double distance_p95 = 0.0, faces_p95 = 0.0;
};

/// The regions of an image as functions of a point, by precedence, and what they come from: what image_mesh gives to mesh_regions.
struct ImageRegions {
  std::vector<BodyRegion>
      regions;  ///< implants, then the border of the image where it cuts the body (a hole), then the labels
  std::vector<int> numbers;                 ///< of each in the mesh; 0: the border
  GroupImage labels;                        ///< after cleaning
  std::vector<double> image_volumes;        ///< of each region [m³]; 0: the border
  std::vector<std::size_t> implant_pieces;  ///< of each implant
  std::function<void(TetMesh&)> add_sets;   ///< NAME_surface of each region, image_border, and those of `beside`
  std::function<void(const TetMesh&, std::vector<ImageRegion>&)> measure;  ///< what measure_distances does
  std::vector<std::string> notes;
};

struct ImageMesh {
  TetMesh mesh;                      ///< regions are numbered by their labels
  RegionMeshReport report;           ///< of the mesher; its regions too have these numbers
  std::vector<ImageRegion> regions;  ///< in the order of the body's labels, then implants
  std::vector<std::string> notes;    ///< of the file, then each step of cleaning, a sentence each
  std::vector<MeshSize> sizes;       ///< those of the body, and those that `refine` added
  ImageRegions from;                 ///< what was meshed
};

/// @throws ImageError for the file; std::invalid_argument for labels, implants and options
ImageRegions image_regions(const ImageBody& body);

/// The vertex sets that the mesh of a body has: NAME_surface of each region, those of `beside`, and `image_border`, which is there only where
/// the image cuts the body. @throws as image_regions, for words and the header of the file
std::vector<std::string> image_set_names(const ImageBody& body);

/// Makes what a body names by a relative path (image, `size_image`, implants) relative to a folder. Words that are wrong stay as they are.
void resolve_paths(ImageBody& body, const std::filesystem::path& folder);

/// Edge of a cube of the volume of a voxel of a body's image, as it is meshed [m]. @throws ImageError
double voxel_edge(const ImageBody& body);

/// The mesh of an image. @throws as image_regions and mesh_regions
ImageMesh image_mesh(const ImageBody& body, std::function<bool(double)> progress = {});

/// Fills the distances of a mesh's regions. Cost: some 0.3 s for a liver of 40 000 voxels and 60 000 tets.
void measure_distances(ImageMesh& made);

/// The edge that was asked for in each tet of a mesh of a body, at its centre [m].
std::vector<double> edges_asked(const ImageBody& body, const ImageMesh& made);

}  // namespace glisson
