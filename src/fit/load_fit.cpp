// load_fit.cpp — FIT.toml in, checked FitSpec out.
#include <array>
#include <cmath>
#include <utility>

#include "base/input_file.h"
#include "fit/fit_spec.h"
#include "fit/section_fit.h"

namespace glisson::fit {
namespace {

namespace fs = std::filesystem;

/// The end of a key and the unit it means; the longest first.
constexpr std::array kUnits{std::pair{"_N_s_m2", "N·s/m²"}, std::pair{"_kg_m3", "kg/m³"}, std::pair{"_Pa_s", "Pa·s"},
                            std::pair{"_mm_s", "mm/s"},     std::pair{"_per_s", "1/s"},   std::pair{"_N_m", "N/m"},
                            std::pair{"_J_m2", "J/m²"},     std::pair{"_deg", "°"},       std::pair{"_mm", "mm"},
                            std::pair{"_Pa", "Pa"},         std::pair{"_Hz", "Hz"},       std::pair{"_hz", "Hz"},
                            std::pair{"_m", "m"},           std::pair{"_s", "s"},         std::pair{"_N", "N"}};

}  // namespace

std::string unit_of_key(const std::string& key) {
  const std::string plain = key.substr(0, key.find('['));
  for (const auto& [end, unit] : kUnits) {
    if (plain.ends_with(end)) return unit;
  }
  return {};
}

Parameter parameter_of(const ParameterSpec& spec) {
  Parameter p{spec.name, unit_of_key(spec.key), spec.low, spec.high, spec.scale, 0.0};
  const double middle =
      spec.scale == Scale::logarithmic ? std::sqrt(spec.low * spec.high) : 0.5 * (spec.low + spec.high);
  p.start = spec.start.value_or(middle);
  return p;
}

FitSpec parse_fit(std::string_view text, const std::string& name) {
  const scene::Node root = scene::parse_document(text, name);
  scene::Problems problems(name, {&fit_section()});
  FitSpec fit;
  fit.file = name;
  fit.source = text;
  read_section(fit_section(), root, &fit, {problems, "", root.where});
  problems.throw_if_any();
  const fs::path base = fit.file.parent_path();
  if (!fit.scene.empty() && fit.scene.is_relative()) fit.scene = base / fit.scene;
  if (fit.title.empty()) fit.title = fit.file.stem().string();
  return fit;
}

FitSpec load_fit(const fs::path& file) {
  const detail::InputFile input = detail::read_input(file, detail::kTomlInput);
  if (!input.problem.empty()) throw SceneError(input.problem);
  return parse_fit(input.bytes, file.string());
}

}  // namespace glisson::fit
