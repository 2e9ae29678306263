// fit_fuzz.cpp — any text as the description of a fit: a sound one or a SceneError, nothing else.
#include <cmath>

#include "fit/spec/fit_spec.h"
#include "glisson/scene/scene.h"
#include "support.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using glisson::fuzz::require;
  try {
    const auto fit = glisson::fit::parse_fit({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    require(!fit.title.empty(), "there is a title");
    for (const auto& p : fit.parameters) require(std::isfinite(p.low) && p.low < p.high, "bounds are in order");
    require(fit.search.starts >= 1, "there is a start");
  } catch (const glisson::SceneError& error) {
    require(std::string_view(error.what()).substr(0, 9) == "fuzz.toml", "a message begins with the file");
  }
  return 0;
}
