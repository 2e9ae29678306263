// material_point.h — a point of tissue without a body: its response to prescribed stretch or stress.
//
//   MaterialPoint point(tissue);
//   MaterialTargets pull;                        every stretch held as it is …
//   pull(2, 2) = {MaterialControl::deformation, 1.2};
//   pull(0, 0) = pull(1, 1) = {MaterialControl::nominal_stress, 0.0};     … but free sides
//   point.advance(0.1, pull).cauchy(2, 2);       in a tenth of a second
//
// Each of the nine components is controlled separately: by F_ij, or by P_ij as a testing machine measures it. The
// formulas are those of the engine (material/response.h) in double precision, with viscosity and Maxwell branches.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "glisson/material/tissue.h"
#include "glisson/math.h"

namespace glisson {

/// The prescribed quantity of a component.
enum class MaterialControl {
  deformation,    ///< F_ij [-]
  nominal_stress  ///< P_ij, force over area at rest [Pa]
};

/// A component and its value at the end of a step; on the way there it changes linearly with time.
struct MaterialTarget {
  MaterialControl control = MaterialControl::deformation;
  double value = 0.0;
  bool operator==(const MaterialTarget&) const = default;
};

/// Targets of all components. At first every F_ij is held as at rest.
class MaterialTargets {
 public:
  MaterialTargets() {
    for (std::size_t i = 0; i < 3; ++i) (*this)(i, i).value = 1.0;
  }
  MaterialTarget& operator()(std::size_t i, std::size_t j) { return all_[3 * i + j]; }
  const MaterialTarget& operator()(std::size_t i, std::size_t j) const { return all_[3 * i + j]; }

 private:
  std::array<MaterialTarget, 9> all_{};
};

struct MaterialState {
  double time = 0.0;                       ///< [s]
  Mat3d deformation = identity<double>();  ///< F [-]
  Mat3d nominal{};  ///< P, first Piola–Kirchhoff: elastic, viscous and of the Maxwell branches [Pa]
  /// σ = P Fᵀ/J [Pa]; P itself for kinematics `small`, where the two are the same.
  Mat3d cauchy{};
  /// False: no deformation with the prescribed stress was found. The state is that of the step before, and `message` says what to
  /// do.
  bool converged = true;
  std::string message;
};

/// A point of a tissue with its history.
///
/// Steps are implicit and of second order: the viscous stress by two stages [Alexander1977], branches by their exact weights
/// for a stress that is linear over the step. Without viscosity and branches a state does not depend on the steps. Tissue::volume_change
/// plays no part: where all tets deform alike, their volume changes are those of their neighbours.
class MaterialPoint {
 public:
  /// @throws std::invalid_argument for a tissue that is not valid, or whose measure depends on the mesh (regular_mean_ratio,
  ///         radius_ratio, solid_angle)
  explicit MaterialPoint(const Tissue& tissue);
  ~MaterialPoint();
  MaterialPoint(MaterialPoint&&) noexcept;
  MaterialPoint& operator=(MaterialPoint&&) noexcept;

  const MaterialState& state() const;
  /// Advances by h. @param h  [s], > 0; with viscosity a fast change needs short steps
  /// @throws std::invalid_argument for an h that is not above 0, a target that is not finite, F_ii ≤ 0, or stress prescribed of
  ///         both P_ij and P_ji, which would leave the rotation free
  const MaterialState& advance(double h, const MaterialTargets& targets);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Tests of a homogeneous specimen. z is its axis.
enum class MaterialTest { uniaxial, equibiaxial, planar, simple_shear, volumetric };
template <>
inline constexpr Word<MaterialTest> kWords<MaterialTest>[] = {
    {"uniaxial", MaterialTest::uniaxial, "F_zz or P_zz is driven; the sides are free"},
    {"equibiaxial", MaterialTest::equibiaxial, "F_xx = F_yy or P_xx = P_yy is driven; z is free"},
    {"planar", MaterialTest::planar, "F_zz or P_zz is driven; F_yy = 1 and x is free: pure shear"},
    {"simple_shear", MaterialTest::simple_shear, "F_xz or P_xz is driven; all else is held"},
    {"volumetric", MaterialTest::volumetric, "F_xx = F_yy = F_zz or their P are driven"}};

/// Targets of a test whose driven component is at `value`.
/// @param value  stretch [-], of simple shear its amount γ; or nominal stress [Pa]
MaterialTargets test_targets(MaterialTest test, MaterialControl control, double value);

/// A test from rest at time 0: the state at each time. Between two times the driven value changes linearly.
/// @param times   [s], ascending, > 0; with a first time of 0 the first value is applied within 10⁻⁹ of the second time
/// @param values  as of test_targets, one per time
/// @param between  steps from one time to the next, ≥ 1: more of them for a tissue with viscosity or branches
/// @return one state per time; the last is not converged if the test ends early
/// @throws std::invalid_argument as MaterialPoint, and for lists of unequal lengths or times that do not ascend
std::vector<MaterialState> material_test(const Tissue& tissue, MaterialTest test, MaterialControl control,
                                         std::span<const double> times, std::span<const double> values,
                                         std::size_t between = 1);

}  // namespace glisson
