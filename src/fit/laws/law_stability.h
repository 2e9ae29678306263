// law_stability.h — whether a fitted law is stable where it will be used: from half to twice the stretches of the data.
//
// A law is stable on a path of deformation where more strain takes more stress, dσ : dε > 0 [Drucker1959]. One that is not may match
// its curves well, and gives a body in which strain runs away in single tets. Curves of one kind of test do not tell: a Mooney–Rivlin
// law with c01 < 0 may be stable in the tension that it was fitted to, and lose it in compression. So three paths are looked at.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "glisson/fit.h"
#include "glisson/material/tissue.h"

namespace glisson::fit {

/// Stretches and amounts of shear of homogeneous tests [-].
struct DataRange {
  double least_stretch = 1.0, largest_stretch = 1.0;
  double largest_shear = 0.0;
};
/// That of curves; one kind stands for the other where a fit has but one. @param height  of the specimen [m]; none: the tests are not
/// homogeneous, and a range of 20 % stands for theirs @param radius  of a twisted cylinder [m]
DataRange data_range(std::span<const CurveResult> curves, std::optional<double> height, double radius);

/// The law at once, without viscosity and branches, along free uniaxial and equibiaxial stretch and simple shear. Empty for a measure
/// that depends on the mesh.
std::vector<StabilityResult> law_stability(const Tissue& tissue, const DataRange& range);

/// What a reader of the result has to know of it.
std::string stability_sentence(std::span<const StabilityResult> paths, const DataRange& range);

}  // namespace glisson::fit
