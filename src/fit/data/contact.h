// contact.h — where a tool touches the specimen, from the force alone.
//
//      F │            ╱     F = b                              x < x_c
//        │          ╱       F = b + k₁ (x − x_c) + k₂ (x − x_c)²   x ≥ x_c,  k₁ ≥ 0
//      b │·········╱        least squares in b, k₁, k₂ for every x_c; the x_c of the least sum of squares,
//        └────────┴── x     and where the sum is s² more, one standard deviation from it
//                 x_c
#pragma once

#include <optional>
#include <span>

namespace glisson::fit {

struct Contact {
  double at = 0.0;            ///< displacement of the first touch [m]
  double deviation = 0.0;     ///< its standard deviation [m]
  double rest_force = 0.0;    ///< mean before contact [N]
  std::size_t before = 0;     ///< rows before contact
  bool extrapolated = false;  ///< no rest was seen: the force's parabola carried back to zero
  double first_force = 0.0;   ///< at the first rows [N]
};

/// Finds the first touch. A force that stays above the rest by `threshold` standard deviations of its noise for five rows
/// tells where rest ends at the latest; the fit above, up to 3 % of the largest force (20 s at least), then places the
/// touch. Where fewer than ten rows come before that, the parabola through the first rows is carried back to F = 0.
///
/// The deviation is that of noise alone, up to a third too small where few rows lie within it. Forces without a slope at
/// contact are placed late: those of a sphere, F ∝ u^1.5, by 0.04 mm where twice
/// the noise is F(0.16 mm) (prepare_test.cpp).
/// @param x  displacement, rising but for noise [m] @param f  force [N]
/// @return nothing where the force never rises above its noise
std::optional<Contact> find_contact(std::span<const double> x, std::span<const double> f, double threshold);

/// The same touch for a curve of a set in which some begin in contact: its parabola is carried to zero from the force at which
/// they do, so that all of the set are placed alike. @param own  as found in the curve itself @param preload  that force [N]
/// @return nothing where the parabola does not reach zero
std::optional<Contact> contact_from(std::span<const double> x, std::span<const double> f, const Contact& own,
                                    double preload);

}  // namespace glisson::fit
