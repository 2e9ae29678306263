// advice_text.h — texts with numbers in them.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"

namespace glisson::advice {

/// What a rule says: nothing, or some texts.
using Texts = std::vector<std::string>;

/// The pattern with a value in place of each `{}`.
std::string fill(std::string_view pattern, std::initializer_list<std::string> values);

/// In at most so many significant digits.
inline std::string digits(int count, double value) { return detail::number_text(value, count); }
/// Without decimals.
std::string whole(double value);
/// The texts with commas between them.
std::string listed(const std::vector<std::string>& texts, std::string_view between = ", ");

}  // namespace glisson::advice
