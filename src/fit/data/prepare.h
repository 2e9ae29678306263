// prepare.h — from the rows of a file to a curve of the fit.
//
//   rows ─ spikes (median) ─ cycle ─ contact: zero of way, time, force ─ crop ─ smooth (Savitzky–Golay) ─ resample ─▶ Curve
//                                                                          └─ noise of the force, before smoothing
#pragma once

#include <optional>
#include <string>

#include "fit/data/raw_test.h"
#include "glisson/fit.h"

namespace glisson::fit {

/// What was done to a test, for the report.
struct CurveAccount {
  std::string name;
  std::filesystem::path file;
  std::size_t rows_read = 0;        ///< rows of the file with numbers, bad ones too
  std::size_t rows_skipped = 0;     ///< bad ones
  std::size_t rows_merged = 0;      ///< averaged with the row before, of the same time
  std::vector<std::string> turned;  ///< columns whose sign was turned
  std::string clock;                ///< the first time, as written, where the times are those of a clock; else ""
  std::size_t cycles = 0;           ///< found
  std::size_t rows_in_cycle = 0;
  std::size_t rows_before_contact = 0;
  std::size_t rows_cropped = 0;
  std::size_t points = 0;
  std::string contact_how;                    ///< "as recorded", "given", "detected", "extrapolated"
  double contact = 0.0;                       ///< displacement of the file at which contact was found [m]
  double contact_deviation = 0.0;             ///< its standard deviation [m]; 0: not estimated
  double force_at_rest = 0.0;                 ///< taken off the force, at contact [N]
  bool sloped = false;                        ///< a slope of the baseline went with it
  double slope = 0.0, slope_deviation = 0.0;  ///< of the baseline, and its standard deviation [N/m]; 0: not seen
  double first_force = 0.0;                   ///< at the first rows, where contact was detected [N]
  double row_noise = 0.0;                     ///< standard deviation of the force of single rows [N]
  std::string unit = "N";                     ///< of the forces
  std::string drive_unit = "m";               ///< of the displacements, in words

  /// One line of words.
  std::string text() const;
  /// How many rows `skip_bad_rows` skipped, in a sentence.
  std::string skipped_text() const;
};

struct PreparedCurve {
  Curve curve;
  CurveAccount account;
};

/// Time counts from contact, where that is detected or given; else from the first row of the cycle. The first point may
/// lie later: bins are averaged and crops cut. `Curve::noise` is that of the curve's points: of rows over √(rows a point).
/// Complains and returns nothing where too little is left.
std::optional<PreparedCurve> prepare(const RawTest& test, const DataSpec& spec, const SpecimenSize& size,
                                     scene::Problems& problems);

}  // namespace glisson::fit
