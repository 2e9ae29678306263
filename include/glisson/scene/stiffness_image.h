// stiffness_image.h — stiffness tet by tet, from an image of elastography: moduli of the tissue where the image has them.
#pragma once

#include <filesystem>
#include <string>

#include "glisson/field.h"
#include "glisson/words.h"

namespace glisson {

/// What the numbers of the image are.
enum class StiffnessQuantity { youngs_modulus, shear_modulus };
template <>
inline constexpr Word<StiffnessQuantity> kWords<StiffnessQuantity>[] = {
    {"youngs_modulus", StiffnessQuantity::youngs_modulus, "E"},
    {"shear_modulus", StiffnessQuantity::shear_modulus, "G, or G′ of an oscillation: E = 2 (1 + ν) G"}};

/// Young's modulus of each tet from an image, on a grid of its own: the mean over the voxels whose centres the tet holds, of a tet that holds
/// none the value at its middle. Tets of a region whose moduli differ by less than `band` share one: the region becomes several, "liver 5.01 kPa".
/// Tets where the image has no value above 0 keep the tissue's own.
struct StiffnessImage {
  static constexpr std::string_view kName = "stiffness";
  std::filesystem::path path{};  ///< NaN and what is not above 0 are gaps
  std::string region{};          ///< empty: the whole body
  StiffnessQuantity quantity = StiffnessQuantity::youngs_modulus;
  double unit = 1.0;             ///< [Pa]
  std::filesystem::path loss{};  ///< G″ in the same unit: η = G″ / (2π `frequency`); empty: the tissue's own viscosity
  double frequency = 0.0;        ///< of the oscillation [Hz]
  double band = 0.05;            ///< ratio of neighbouring moduli less 1 [-]

  template <class Take>
  static constexpr auto fields(Take take) {
    using S = StiffnessImage;
    return take(
        field("path", &S::path, "the image: .nii, .nii.gz, .nrrd, .nhdr, .mha or .mhd, relative to the scene").must(),
        field("region", &S::region, "name of the region whose tissue it is").otherwise("the whole body"),
        field("quantity", &S::quantity, "what its numbers are"),
        field("unit", &S::unit, "Pa", above(0), "what a number of 1 is; 1000 for an image in kPa"),
        field("loss", &S::loss,
              "an image of G″ in the same unit: the viscosity is η = G″/(2π f), `viscous_tensor` as in the tissue")
            .otherwise("the tissue's viscosity"),
        field("frequency", &S::frequency, "Hz", at_least(0), "f, of the oscillation by which G′ and G″ were measured"),
        field(
            "band", &S::band, "-", between(0.01, 1),
            "tets whose moduli differ by a smaller share have the same, so that each modulus is exact to half of it"));
  }
  Fault check() const;
};

}  // namespace glisson
