// specimen_model.h — the cheapest forward model: a specimen that deforms alike all over.
//
// No mesh and no inertia: the stress is that of the tissue's own response (material/uniaxial_path.h, glisson/material_point.h),
// in the measure that the curve has, times the area.
#pragma once

#include <functional>
#include <vector>

#include "fit/forward/motion_model.h"
#include "glisson/material/tissue.h"

namespace glisson::fit {

/// A cylinder or block, driven along its height; sides free, faces without friction.
struct Specimen {
  double area = 0.0;    ///< of its face [m²], > 0
  double height = 0.0;  ///< [m], > 0
  double radius = 0.0;  ///< of a cylinder [m]; 0: it is none
};

/// The tissue at values of the parameters; may throw std::exception, whose text becomes the failure.
using TissueAt = std::function<Tissue(std::span<const double>)>;

/// Whether the stress depends on more than the present deformation.
bool has_past(const Tissue& tissue);

/// Every test of Curve: F = P A at stretches λ = 1 ± d/H, its measure and sign as Curve has them. Plates hold a pressed specimen:
/// where it lags behind a withdrawal it pulls.
///
/// A tissue without viscosity and Maxwell branches is solved at the curve's instants alone; others go through all of the
/// history, in steps of at most 1 % of stretch and 1/400 of the time, whatever the parameters, so that the force is a smooth
/// function of them.
class SpecimenModel final : public MotionModel {
 public:
  /// @throws std::invalid_argument naming what cannot be used
  SpecimenModel(std::vector<Curve> curves, const Specimen& specimen, TissueAt tissue);
  Prediction predict_from(std::size_t curve, std::span<const double> values, double contact) const override;

 private:
  Specimen specimen_;
  TissueAt tissue_;
};

}  // namespace glisson::fit
