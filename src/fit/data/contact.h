// contact.h — where a tool touches the specimen, from the force alone.
//
//      F │            ╱     the baseline, at rest or with a slope, and a parabola from the touch on (bent_line.h);
//        │          ╱       a slope is taken where it shows, and where the curve has a bend that no smooth curve has:
//      b │·········╱        a tissue that is in contact from the first row on has none.
//        └────────┴── x
//                 x_c
#pragma once

#include <optional>
#include <span>
#include <string>

namespace glisson::fit {

struct Contact {
  double at = 0.0;            ///< displacement of the first touch [m]
  double deviation = 0.0;     ///< its standard deviation [m]
  double rest_force = 0.0;    ///< of the baseline at the touch [N]
  std::size_t before = 0;     ///< rows before contact
  bool extrapolated = false;  ///< no rest was seen: the force's parabola carried back to zero
  double first_force = 0.0;   ///< at the first rows [N]
  bool sloped = false;        ///< the baseline's slope goes with it; else it rests, and the slope is reported alone
  double slope = 0.0, slope_deviation = 0.0;  ///< of the baseline, and its standard deviation [N/m]
  std::string doubt{};                        ///< why it is not to be believed; empty: it is
};

/// Finds the first touch. A force that stays above the rest by `threshold` standard deviations of its noise for five rows
/// tells where rest ends at the latest; the fit above, up to 3 % of the largest force (20 s at least), then places the
/// touch. Where fewer than ten rows come before that, the parabola through the first rows is carried back to F = 0.
///
/// The deviation is that of noise alone, up to a third too small where few rows lie within it. Forces without a slope at
/// contact are placed late: those of a sphere, F ∝ u^1.5, by 0.04 mm where twice
/// the noise is F(0.16 mm) (prepare_test.cpp).
///
/// A slope of more than four standard deviations is one where the bend is e⁶ times as likely as a quartic. Of a sphere that is
/// met on slopes of -20 to 20 % of the peak, 700 rows with 0.3 % of noise, the touch is 0.006 mm of 1.4 late, 0.01 rms.
/// @param x  displacement, rising but for noise [m] @param f  force [N]
/// @param sloped  whether other curves of the same test have a baseline with a slope: then this one has, too
/// @return nothing where the force never rises above its noise
std::optional<Contact> find_contact(std::span<const double> x, std::span<const double> f, double threshold,
                                    bool sloped = false);

/// The same touch for a curve of a set in which some begin in contact: its parabola is carried to zero from the force at which
/// they do, so that all of the set are placed alike. @param own  as found in the curve itself @param preload  that force [N]
/// @return nothing where the parabola does not reach zero
std::optional<Contact> contact_from(std::span<const double> x, std::span<const double> f, const Contact& own,
                                    double preload);

/// The baseline before a contact that is known.
struct RestLine {
  bool sloped = false;  ///< else it rests at the mean
  double force = 0.0;   ///< at the touch [N]
  double slope = 0.0, slope_deviation = 0.0;
};
/// @param x, f  of the rows before contact @param at  contact [m] @param sloped  as of `find_contact`
RestLine rest_before(std::span<const double> x, std::span<const double> f, double at, bool sloped);

}  // namespace glisson::fit
