// advice_lines.h — advice as lines of `glisson check`, each piece below what it is about.
#pragma once

#include <optional>
#include <vector>

#include "glisson/scene/advice.h"

namespace glisson::app {

/// Prints the advice that is about this. @param index  in the variant's list; none: about any
void print_advice(const std::vector<Advice>& advice, Advice::About about, std::optional<std::size_t> index = {});

}  // namespace glisson::app
