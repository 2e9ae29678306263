// data_spec.h — what a [[data]] section of FIT.toml says: files of one test, how to read them, what to make of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fit/data/curve_file.h"
#include "glisson/fit.h"

namespace glisson::fit {

enum class Sign { found, positive, negative };  ///< how compression and insertion are written

/// A column of the files: by name or by number.
struct ColumnSpec {
  bool given = false;
  std::string name;
  std::optional<std::int32_t> number;  ///< from 1
  std::string unit;                    ///< empty: what the file says
  Sign sign = Sign::found;
  std::string origin;  ///< where FIT.toml says it, for messages
};

struct ColumnsSpec {
  ColumnSpec time;
  ColumnSpec displacement, strain, stretch, true_strain, green_strain, shear, angle, frequency;  ///< what is driven
  ColumnSpec force, stress, cauchy_stress, second_piola_stress, torque, axial_force;             ///< what answers
  ColumnSpec storage_modulus, loss_modulus;
  ColumnSpec value;  ///< of a test of heat
};

enum class ContactKind { none, detect, given, automatic };

/// Where the tool touches the specimen: displacement, time and force count from there.
struct ContactSpec {
  ContactKind kind = ContactKind::none;
  double at = 0.0;         ///< of `given` [m]
  double preload = 0.0;    ///< of `detect`: force from which all of a set are carried to zero [N]; 0: each by itself
  double threshold = 4.0;  ///< of `detect`: force above the rest before contact [standard deviations of the noise]
  bool sloped = false;     ///< of `detect` and `given`: another curve of the test has a baseline with a slope
  bool zero_force = true;  ///< takes the baseline before contact off the force
};

enum class CropUntil { end, peak, drop };

/// What is left of a test. Rows outside any of the bounds go; a bound that is not given cuts nothing.
struct CropSpec {
  std::optional<double> min_time, max_time;                  ///< [s]
  std::optional<double> min_displacement, max_displacement;  ///< [m]
  std::optional<double> min_strain, max_strain;              ///< displacement over height [-]
  std::optional<double> min_force, max_force;                ///< [N]
  CropUntil until = CropUntil::end;
  double drop = 0.2;  ///< of `until = "drop"`: fall below the largest force so far, as part of it
};

enum class CyclePart { both, loading, unloading };

struct CycleSpec {
  CyclePart part = CyclePart::both;
  std::optional<std::int32_t> number;  ///< from 1; none: the first of `loading`/`unloading`, all of `both`
  double least = 0.1;                  ///< a turn back counts from this part of the whole way on
};

enum class FilterKind { none, median, savitzky_golay };

struct FilterSpec {
  FilterKind kind = FilterKind::none;
  std::int32_t half_width = 5;  ///< rows on each side
  std::int32_t degree = 3;      ///< of the polynomial
};

enum class ResampleOver { time, displacement, none };
enum class ResampleHow { average, pick };

struct ResampleSpec {
  ResampleOver over = ResampleOver::time;
  ResampleHow how = ResampleHow::average;
  std::int32_t points = 100;
};

/// Size of the specimen, where it is known: turns stress and strain into force and way, and checks units.
struct SpecimenSize {
  std::optional<double> area;    ///< at rest, across the load [m²]
  std::optional<double> height;  ///< at rest, along the load [m]
  std::optional<double> radius;  ///< of a cylinder [m]
  bool point = false;            ///< stands for no body: area and height are 1
};

struct DataSpec {
  std::string group;  ///< repetitions of one test share it; empty: given by whoever numbers the sections
  std::string batch;  ///< specimens made or taken together; empty: not said
  std::vector<std::filesystem::path> files;
  LabTest test = LabTest::compression;
  std::optional<Deforming>
      deforming;            ///< of a test whose name does not say it; none: the file's stretch, else compression
  double prestretch = 1.0;  ///< of an oscillation
  std::optional<Indenter> indenter;   ///< of an indentation
  HeatReading heat;                   ///< of a test of heat
  std::vector<double> times, values;  ///< of a test of heat, in place of files [s], [unit of the column]
  std::optional<double> deviation;    ///< standard deviation of a value of a test of heat [unit of the column]
  bool held_out = false;
  double weight = 1.0;
  TextSpec text;
  ColumnsSpec columns;
  std::optional<double> speed;  ///< of the tool [m/s]; gives the time where no column does
  SpecimenSize size;            ///< of these specimens, instead of the common one
  bool skip_bad_rows = false;
  bool unlikely = false;  ///< takes numbers that look like a wrong unit
  ContactSpec contact;
  CropSpec crop;
  CycleSpec cycle;
  FilterSpec filter;
  ResampleSpec resample;
  std::string origin;  ///< where FIT.toml says it, for messages

  bool is_heat() const { return test == LabTest::heat; }
  bool indents() const { return test == LabTest::indentation || deforming == Deforming::indentation; }
};

}  // namespace glisson::fit
