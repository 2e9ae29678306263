// test_columns.h — which columns a test takes: one that is driven and one that answers, and what their numbers are.
//
//   compression, tension, relaxation, …   displacement, strain, stretch …  ──▶  force, stress, cauchy_stress …
//   simple_shear                          shear, displacement              ──▶  the same
//   torsion                               angle                            ──▶  torque, axial_force or both
//   indentation                           displacement (the depth)         ──▶  force
//   oscillation                           frequency                        ──▶  storage_modulus or loss_modulus
//   heat                                  time                             ──▶  value
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fit/data/choose_column.h"
#include "fit/data/data_spec.h"
#include "fit/data/units.h"

namespace glisson::fit {

enum class Drive { displacement, strain, stretch, true_strain, green_strain, shear, angle, frequency, time };
enum class Answer {
  force,
  stress,
  cauchy_stress,
  second_piola_stress,
  torque,
  axial_force,
  storage_modulus,
  loss_modulus,
  value
};

/// Whether a test's name says how the specimen deforms; others hold, load or cycle one of these deformations.
bool names_its_deformation(LabTest test);

/// The columns of a file that a test takes.
struct TestColumns {
  Drive drive = Drive::displacement;
  Answer answer = Answer::force;
  ChosenColumn driven, answering;
  Sign driven_sign = Sign::found, answering_sign = Sign::found;
  std::optional<ChosenColumn> time;
};

/// Chooses them. Complains, and returns nothing, where one is missing, does not belong to the test, or needs a size that the
/// specimen has not.
std::optional<TestColumns> test_columns(const CurveFile& file, const DataSpec& spec, const SpecimenSize& size,
                                        scene::Problems& problems);

/// The driven number of a row, from its own in SI and positive as the test goes, to that of a Curve.
/// @param outward  1 where the test extends the specimen, −1 where it compresses it
double driven_number(Drive drive, double value, const SpecimenSize& size, double outward);
/// The same of the answering number.
double answering_number(Answer answer, double value, const SpecimenSize& size);

/// What a test measures by an answering column.
Measured measured_by(Answer answer);

/// What a column of a scene of heat is in, by the end of its name.
struct HeatUnit {
  std::string unit;                  ///< "°C", "m", …; "-" of one column over another
  std::optional<Quantity> quantity;  ///< none: files have the column's own unit
};
HeatUnit unit_of(const HeatReading& reading);
/// "cold_area_m2 / ice_area_m2, two".
std::string name_of(const HeatReading& reading);

/// A test of two answering columns as one of each: G′ and G″, torque and axial force.
std::vector<DataSpec> parted(const DataSpec& spec);

}  // namespace glisson::fit
