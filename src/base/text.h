// text.h — numbers and lists of numbers as they appear in messages about meshes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace glisson::detail {

/// A number in at most `digits` significant digits, without trailing zeros: "0.04", "1e-12".
std::string number_text(double value, int digits = 6);

/// The shortest text that reads back as this number: "0.04", "1e-12", "nan".
std::string show(double value);

/// "1 tet", "3 tets": a count with its noun.
std::string count_text(std::size_t count, const std::string& singular, const std::string& plural);

/// Without blanks (space, tab, \\r, \\v, \\f) at both ends.
std::string_view trimmed(std::string_view text);

/// A to Z in small letters; all other bytes as they are.
std::string lower_case(std::string_view text);

/// The first indices and how many more there are: "3, 17, 20 and 5 more".
std::string index_list(std::span<const std::uint32_t> indices, std::size_t shown = 8);

}  // namespace glisson::detail
