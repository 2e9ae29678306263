// clock_time.h — times as a clock has them.
//
//   00:01:02.5   1:02:03   01:02.5      hours, minutes and seconds; minutes and seconds with a fraction
//   01:02                               minutes and seconds, or hours and minutes: of two meanings, and not read
#pragma once

#include <optional>
#include <string_view>

namespace glisson::fit {

/// Seconds since midnight, or since the clock began; nothing where the text is no clock time or has two meanings.
/// @param decimal  of the seconds, '.' or ','
std::optional<double> parse_clock(std::string_view text, char decimal);

/// Whether a text is a clock time of two meanings: `01:02`.
bool is_twofold_clock(std::string_view text);

}  // namespace glisson::fit
