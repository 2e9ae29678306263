// scene_fuzz.cpp — any text as a scene: a sound scene or a SceneError, nothing else.
//
// Lines at the head that read `#set KEY=VALUE` are handed over as --set, so that overrides are fuzzed with the
// same corpus; to the scene they are comments. Small bodies that come out sound are built, for their selections.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "glisson/scene/heat_run.h"
#include "glisson/scene/scene.h"

namespace {

constexpr std::string_view kMark = "#set ";

/// Stops the fuzzer unless the scene keeps what parse_scene promises.
void require(bool kept, const char* promise) {
  if (kept) return;
  std::fprintf(stderr, "parse_scene broke its promise: %s\n", promise);
  std::abort();
}

std::vector<glisson::Override> overrides_of(std::string_view text) {
  std::vector<glisson::Override> overrides;
  while (text.substr(0, kMark.size()) == kMark) {
    const std::string_view line = text.substr(0, text.find('\n'));
    const std::size_t equals = line.find('=');
    if (equals != std::string_view::npos) {
      overrides.push_back(
          {std::string(line.substr(kMark.size(), equals - kMark.size())), std::string(line.substr(equals + 1))});
    }
    text.remove_prefix(std::min(text.size(), line.size() + 1));
  }
  return overrides;
}

void require_sound(const glisson::Variant& v) {
  require(!v.name.empty() && v.name.find('/') == std::string::npos && v.name.front() != '.',
          "a name is fit for a folder");
  try {
    glisson::require_valid(v.tissue);
    for (const auto& region : v.regions) glisson::require_valid(region.tissue);
    for (const auto& tool : v.tools) glisson::press(tool.motion);
  } catch (const std::invalid_argument& error) {
    require(false, error.what());
  }
  if (v.heat) {
    require(v.heat->duration > 0.0 && v.heat->sample_every > 0.0, "a run of heat ends");
    for (const auto& tissue : v.heat->tissues) require(tissue.tissue.check().what.empty(), "latent heat has a range");
  }
  require(v.output.sample_rate > 0.0 && std::isfinite(v.output.sample_rate), "the sample rate is a rate");
  require(!v.simulation.step || *v.simulation.step > 0.0, "a step is longer than nothing");
  require(v.max_steps || std::isfinite(glisson::run_duration(v)), "a run ends");
  for (const glisson::InstrumentSpec& x : v.instruments) {
    const glisson::Vec3d at = glisson::make_driver(x)->advance(0.0, 1e-3, {}).position;
    require(std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z), "a tool is somewhere");
    require(std::abs(glisson::determinant(glisson::start_pose(x).axes) - 1.0) < 1e-6, "a tool's axes are a rotation");
  }
}

bool is_small(const glisson::Variant& v) {
  const auto* box = std::get_if<glisson::BoxOptions>(&v.mesh);
  if (box == nullptr) return false;
  std::int64_t cubes = 1;
  for (const int n : box->cells) cubes *= n;
  return cubes <= 64;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const glisson::Scene scene = glisson::parse_scene(text, "fuzz.toml", "/scenes", overrides_of(text));
    require(!scene.variants.empty(), "there is a variant");
    for (const glisson::Variant& v : scene.variants) require_sound(v);
    const glisson::Variant& first = scene.variants.front();
    if (is_small(first) && first.heat)
      glisson::BuiltHeat(first, {}).read();
    else if (is_small(first))
      glisson::build_mesh(first, {});
  } catch (const glisson::SceneError& error) {
    require(std::string_view(error.what()).substr(0, 9) == "fuzz.toml", "a message begins with the file");
  }
  return 0;
}
