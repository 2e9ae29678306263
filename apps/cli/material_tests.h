// material_tests.h — what `glisson material` computes: options in, the columns of a table out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "glisson/material/tissue.h"

namespace glisson::app {

struct MaterialOptions {
  std::string tissue, test = "uniaxial";
  std::vector<double> to;
  bool stress = false;
  std::optional<double> rate, hold;
  std::optional<std::size_t> points, between;
  std::optional<double> radius_mm, length_mm,
      stretch;                          ///< of torsion, the first of indentation, the last of oscillation too
  std::optional<std::string> indenter;  ///< of indentation
  std::optional<double> thickness_mm, diameter_mm, half_angle_deg, edge_radius_mm;
  bool bonded = false, force = false;
  std::optional<double> from_hz, to_hz;  ///< of oscillation
  std::optional<std::string> mode;
  std::string csv, picture;
  bool json = false;
};

struct Column {
  std::string name, unit;
  std::vector<double> values;
  double rest = 0.0;  ///< before the test

  /// As CSV and JSON have it: nominal_stress_Pa.
  std::string heading() const;
};

/// Columns over another: a picture of the table.
struct MaterialChart {
  std::string title;
  std::string y_name;  ///< of several columns
  std::size_t x = 0;
  std::vector<std::size_t> y;
  bool log_x = false;
  bool from_rest = true;  ///< the picture starts there; the table does not
};

struct MaterialResult {
  std::vector<Column> columns;        ///< none: the test ended before its first line
  std::vector<MaterialChart> charts;  ///< by numbers of columns
  std::string words;                  ///< what the specimen is, a sentence; empty: the test says it
  std::string trouble;                ///< why a test ended early; empty: it did not
};

/// All that --test takes, "uniaxial, …, oscillation".
std::string material_test_names();

/// @throws std::invalid_argument naming the option, its value and what is allowed
MaterialResult run_material_test(const MaterialOptions& options, const Tissue& tissue);

}  // namespace glisson::app
