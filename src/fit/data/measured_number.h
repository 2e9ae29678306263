// measured_number.h — a number as machines write it.
//
//   1051.896   1,051.896   1.051,896   1 051,896   1'051.896   −1,5E-3
//
// A mark of thousands parts the digits before the decimal mark into groups of three, the first of which is not 0: that tells
// `1,051` from `0,051`. Which of the two marks is the decimal one is the file's to say (text_layout.h).
#pragma once

#include <optional>
#include <string_view>

namespace glisson::fit {

/// A number as the file writes it; nothing where it is none or not finite. @param decimal  '.' or ','
std::optional<double> parse_number(std::string_view text, char decimal);

/// Whether a number has a mark of thousands.
bool has_thousands(std::string_view text, char decimal);

}  // namespace glisson::fit
