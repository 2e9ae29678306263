// column_words.h — the names that laboratories give to the columns of a test, in English, German, French and Spanish.
#pragma once

#include <string_view>

namespace glisson::fit {

/// What the numbers of a column are.
enum class ColumnMeaning {
  time,
  displacement,
  strain,
  stretch,
  true_strain,
  green_strain,
  shear,
  angle,
  frequency,
  force,
  stress,
  cauchy_stress,
  second_piola_stress,
  torque,
  axial_force,
  storage_modulus,
  loss_modulus,
  temperature
};

/// Whether the name of a column, its unit taken off, begins with a word for its meaning: "Compressive load", "Angular Frequency",
/// "Scherweg". Case does not count; adjectives that leave the meaning as it is may precede the word. A symbol (`F`, `Fz`) is the
/// whole name.
bool has_meaning(std::string_view name, ColumnMeaning meaning);

/// Whether the name of a column of frequencies says that these are angular: "Angular frequency", "Kreisfrequenz", "pulsation", "ω".
bool says_angular(std::string_view name);

}  // namespace glisson::fit
