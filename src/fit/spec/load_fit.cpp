// load_fit.cpp — FIT.toml in, checked FitSpec out.
#include <cmath>

#include "base/input_file.h"
#include "fit/spec/fit_spec.h"
#include "fit/spec/section_fit.h"

namespace glisson::fit {
namespace {

namespace fs = std::filesystem;

/// Units that keys end with; those of the longest ends first.
constexpr const char* kUnits[]{"W/(m² K)", "W/(m K)", "J/(kg K)", "J/kg", "W/m³", "W/m²", "W/m",  "1/K",
                               "N·s/m²",   "N·s/m",   "kg/m³",    "m/s²", "Pa·s", "mm/s", "Pa/m", "1/s",
                               "N/m",      "J/m²",    "mm²",      "m/s",  "kg",   "°",    "mm",   "Pa",
                               "Hz",       "m",       "s",        "N",    "W",    "V",    "K"};

}  // namespace

std::string unit_of_key(const std::string& key) {
  const std::string last = key.substr(key.rfind('.') + 1);  // `time_s` of `tissue.maxwell[0].time_s`
  const std::string plain = last.substr(0, last.find('['));
  if (plain.ends_with("_C")) return "°C";
  for (const char* unit : kUnits) {
    if (plain.ends_with(FieldText{.unit = unit}.key())) return unit;
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
