// drawing.h — runs the drawing files of the Python package with the Python that is there: no display, no graphics card.
#pragma once

#include <nlohmann/json.hpp>

namespace glisson::app {

/// Runs `python/glisson/drawing_command.py`, which travels inside the program, on one object of options.
/// @return its exit code @throws std::runtime_error where no Python with NumPy and matplotlib is found, with the way to one
int draw(const nlohmann::json& options);

}  // namespace glisson::app
