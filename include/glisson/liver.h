// liver.h — a liver of shapes: lobes, fissures, vessels to the third generation and a tumour, in the proportions of an adult.
//
// Axes as a scene of the upright body has them: x to the patient's left, y to the back, z to the head. The origin lies in the
// middle of the organ's box. Sizes, angles and calibres with their sources: docs/liver.md.
#pragma once

#include "glisson/implicit.h"

namespace glisson {

struct LiverOptions {
  static constexpr std::string_view kName = "liver";
  double edge = 0.008;                        ///< mean length of the tets' edges [m]
  double scale = 1.0;                         ///< factor on all lengths [-]; 1: 21 × 16 × 11 cm
  bool vessels = true;                        ///< portal and hepatic veins as regions; else they are parenchyma
  bool gallbladder = false;                   ///< the gallbladder in its bed, as a region; else the bed is empty
  Vec3d tumour_center{-0.035, -0.005, 0.01};  ///< [m], before scaling
  double tumour_radius = 0.012;               ///< [m], before scaling; 0: no tumour
  std::uint64_t max_tets = 5000000;           ///< more are refused
  std::vector<MeshSize> sizes{};              ///< where edges are shorter; not scaled
  double growth = kGrowth;                    ///< edge over distance at which edges grow away from these [-]

  template <class Take>
  static constexpr auto fields(Take take) {
    using L = LiverOptions;
    return take(edge_field<L>().advise("15 gives some 5000 tets, 8 some 31 000, 2 some 1.9 million"),
                field("scale", &L::scale, "-", between(0.2, 3), "factor on all lengths"),
                field("vessels", &L::vessels, "portal and hepatic veins as regions of their own"),
                field("gallbladder", &L::gallbladder, "the gallbladder in its bed, as a region `gallbladder`"),
                field("tumour_center", &L::tumour_center, "mm", "centre of the tumour, before scaling"),
                field("tumour_radius", &L::tumour_radius, "mm", at_least(0), "its radius, before scaling; 0: none"),
                max_tets_field<L>(), sizes_field<L>("where edges are shorter, in the scene's coordinates"),
                growth_field<L>());
  }
  Fault check() const;
};

/// The shapes and regions of a liver: `tumour`, `gallbladder` if requested, `hepatic_veins`, `portal_veins` and `parenchyma`, in this
/// order of precedence.
/// A vein thinner than 1.2 edges is left out from there, a tree of less than three edges in all; the edge of a tree that a
/// size names is that of the size.
/// @throws std::invalid_argument naming the option, its value and the allowed range
ImplicitBody liver_body(const LiverOptions& options);

/// Its mesh, with vertex sets of its surface (docs/liver.md): `bare_area` (at the back, around the vena cava), `dome` (under the
/// diaphragm), `visceral_face` (below), `vena_cava` (its groove), `coronary_ligament` (around the bare area),
/// `right_triangular_ligament`, `left_triangular_ligament`, `falciform_ligament`, and with the gallbladder `gallbladder`.
/// @throws as liver_body and mesh_regions
RegionMesh liver_mesh(const LiverOptions& options, std::function<bool(double)> progress = {});

}  // namespace glisson
