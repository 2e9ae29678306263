#include "fit/tissue_of_fit.h"

#include <variant>

#include "fit/data/units.h"
#include "fit/forward/offset_model.h"
#include "glisson/material/locking.h"
#include "scene/build/parametric_variant.h"
#include "scene/parse/tissue_file.h"

namespace glisson::fit {
namespace {

scene::ParametricVariant experiment(const SceneText& scene, const std::vector<std::string>& keys) {
  return {scene.text, scene.name, scene.base, scene.overrides, scene.variant, keys};
}

Tissue own_tissue(const FitSpec& spec) { return experiment(scene_of(spec, {}), {}).tissue_with({}); }

std::string interval_text(const ParameterResult& p) {
  const std::optional<Interval> ci = p.ci95();
  if (!ci) return "how sure: unknown";
  return "95 %: " + (ci->low_open ? std::string("open") : brief(ci->low)) + " to " +
         (ci->high_open ? std::string("open") : brief(ci->high));
}

/// A line of a comment for each parameter that is no key of [tissue].
std::string other_keys(const LawSearch& search, const std::vector<double>& values) {
  std::string text;
  for (std::size_t p = 0; p < values.size(); ++p) {
    const std::string& key = search.law().parameters[p].key;
    if (key.rfind("tissue.", 0) != 0) text += "#   " + key + " = " + scene::show(values[p]) + "\n";
  }
  return text.empty() ? text : "# Fitted too, and no key of [tissue]:\n" + text;
}

}  // namespace

std::string own_law_name(const FitSpec& spec) {
  if (spec.is_heat()) return "heat";
  const Tissue tissue = own_tissue(spec);
  const auto kind = [](const auto& law) { return std::string(law.kName); };
  std::string name = tissue.hyperelastic ? std::visit(kind, *tissue.hyperelastic) : std::visit(kind, tissue.law);
  if (tissue.viscosity > 0.0) name += " + viscosity";
  if (!tissue.maxwell.empty()) name += " + relaxation";
  return name;
}

double own_modulus(const FitSpec& spec) {
  const LameParameters at_rest = own_tissue(spec).lame();
  return at_rest.mu * (3.0 * at_rest.lambda + 2.0 * at_rest.mu) / (at_rest.lambda + at_rest.mu);
}

namespace {

/// The fitted numbers that are keys of the scene.
struct OfScene {
  std::vector<std::string> keys;
  std::vector<double> values;
};
OfScene numbers_of_scene(const LawSearch& search) {
  OfScene all;
  const std::vector<double> values = search.values();
  for (std::size_t p = 0; p < values.size(); ++p) {
    const std::string& key = search.law().parameters[p].key;
    if (is_curve_key(key) || is_plate_key(key)) continue;
    all.keys.push_back(key), all.values.push_back(values[p]);
  }
  return all;
}

}  // namespace

Tissue fitted_tissue(const LawSearch& search) {
  const OfScene numbers = numbers_of_scene(search);
  return experiment(search.scene(), numbers.keys).tissue_with(numbers.values);
}

namespace {

/// How scenes have to keep the volume of a tissue that hardly changes it. A specimen was no body of tets; a scene was one, and
/// its choice belongs to the numbers that were fitted with it.
std::string volume_keys(const LawSearch& search, const FitSpec& spec, const scene::Node& tissue) {
  if (tissue.find("volume_change") || !locking_ratio(fitted_tissue(search))) return {};
  if (spec.specimen) return "volume_change = \"" + std::string(word_of(VolumeChange::average_nodal)) + "\"\n";
  return "# fitted with volume_change = \"" + std::string(word_of(VolumeChange::element)) +
         "\", on the scene's mesh; for other meshes fit with \"" + std::string(word_of(VolumeChange::average_nodal)) +
         "\" in the scene's [tissue]\n";
}

}  // namespace

namespace {

/// What was fitted, how well and with which intervals, as comments.
std::string heading_of(const FitResult& result, const FitSpec& spec) {
  std::string text = "# Fitted by `glisson fit " + spec.file.filename().string() + "`: " + spec.title + "\n";
  text +=
      "# Law " + result.law + "; fitted curves matched to " + measured_text(result.rms_fit, result.unit, 4) + " rms";
  if (result.rms_heldout) text += ", held-out ones to " + measured_text(*result.rms_heldout, result.unit, 4);
  text += ".\n";
  for (const ParameterResult& p : result.parameters) {
    text += "#   " + p.parameter.name + " = " + brief(p.value) + (p.parameter.unit.empty() ? "" : " ") +
            p.parameter.unit + ", " + interval_text(p) + ", " + p.verdict + "\n";
  }
  return text;
}

}  // namespace

std::string keys_of_fit(const LawSearch& search, const FitResult& result, const FitSpec& spec) {
  const OfScene numbers = numbers_of_scene(search);
  std::string text = heading_of(result, spec) + "# For [set] of a FIT.toml, or `glisson run " +
                     spec.scene.filename().string() + " --set KEY=VALUE`.\n";
  for (const Override& o : search.scene().overrides) text += "\"" + o.key + "\" = " + o.value + "\n";
  for (std::size_t k = 0; k < numbers.keys.size(); ++k)
    text += "\"" + numbers.keys[k] + "\" = " + scene::show(numbers.values[k]) + "\n";
  return text;
}

std::string tissue_of_fit(const LawSearch& search, const FitResult& result, const FitSpec& spec) {
  const OfScene numbers = numbers_of_scene(search);
  const std::string text = heading_of(result, spec) + other_keys(search, search.values()) + "\n";
  const scene::Node tissue = experiment(search.scene(), numbers.keys).tissue_tree(numbers.values);
  return text + scene::tissue_file_text(tissue) + volume_keys(search, spec, tissue);
}

}  // namespace glisson::fit
