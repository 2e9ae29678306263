// law_data.cpp — see law_data.h.
#include "report/law_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "glisson/material_point.h"
#include "material/static_stretch.h"

namespace glisson {
namespace {

constexpr int kPoints = 241;

const char* measure_label(DeformationMeasure measure) {
  switch (measure) {
    case DeformationMeasure::equivalent_shear_strain:
      return "equivalent shear strain s [-]";
    case DeformationMeasure::one_minus_q:
      return "1 − q [-]";
    case DeformationMeasure::regular_mean_ratio:
      return "Liu–Joe mean ratio [-]";
    case DeformationMeasure::radius_ratio:
      return "radius ratio's strain [-]";
    case DeformationMeasure::solid_angle:
      return "solid angle's strain [-]";
  }
  return "measure [-]";
}

double reach_of(const StiffnessLaw& law) {
  if (const auto* step = std::get_if<StepLaw>(&law)) return 1.5 * (step->threshold + step->width);
  if (const auto* table = std::get_if<TableLaw>(&law)) return 1.1 * std::max(table->arguments.back(), 0.0);
  return 0.0;
}

double reach_of(const Tissue& tissue) {
  double reach = reach_of(tissue.law);
  if (tissue.lambda_law) reach = std::max(reach, reach_of(*tissue.lambda_law));
  if (tissue.mu_law) reach = std::max(reach, reach_of(*tissue.mu_law));
  return reach;
}

template <class Modulus>
nlohmann::json curve(const std::string& label, const std::vector<double>& x, Modulus modulus) {
  std::vector<double> y;
  y.reserve(x.size());
  for (const double value : x) y.push_back(modulus(value));
  return {{"label", label}, {"y", y}};
}

void add_curves(nlohmann::json& curves, const Tissue& tissue, const std::string& prefix, const std::vector<double>& x) {
  if (!tissue.lambda_law && !tissue.mu_law) {
    curves.push_back(
        curve(prefix + "E", x, [&](double value) { return law_value(tissue.law, tissue.youngs_modulus, value); }));
    return;
  }
  curves.push_back(curve(prefix + "λ", x, [&](double value) { return lame_at(tissue, value).lambda; }));
  curves.push_back(curve(prefix + "μ", x, [&](double value) { return lame_at(tissue, value).mu; }));
}

/// A test whose curve is drawn: from rest to `from` and to `to`.
struct DrawnTest {
  MaterialTest test;
  double rest, from, to;
  std::size_t row, column;  // of the driven component
  const char *measure, *quantity;
};

constexpr DrawnTest kDrawnTests[] = {
    {MaterialTest::uniaxial, 1.0, 0.5, 1.5, 2, 2, "stretch, sides free [-]", "nominal stress"},
    {MaterialTest::simple_shear, 0.0, 0.0, 1.0, 0, 2, "amount of shear [-]", "shear stress"}};

constexpr int kSteps = 100;            // from `from` to `to`; a hundredth of stretch or shear each
constexpr double kSteepest = 4.0;      // stress over the modulus at rest: what lies above would hide all else
constexpr double kSmallStrain = 1e-4;  // for that modulus

/// Relaxed stress where the driven component has come to a value; none where no state is found.
std::optional<double> stress_at(MaterialPoint& point, const DrawnTest& drawn, double value) {
  const MaterialState& state = point.advance(kLongTime, test_targets(drawn.test, MaterialControl::deformation, value));
  if (!state.converged) return std::nullopt;
  return state.nominal(drawn.row, drawn.column);
}

/// From rest to both ends, as far as the tissue has an answer that a picture can show.
std::vector<double> drawn_stresses(const Tissue& tissue, const DrawnTest& drawn, const std::vector<double>& x) {
  MaterialPoint nearby(tissue);
  const std::optional<double> small = stress_at(nearby, drawn, drawn.rest + kSmallStrain);
  const double highest = small ? kSteepest * std::abs(*small) / kSmallStrain : 0.0;
  std::vector<double> y(x.size(), std::numeric_limits<double>::quiet_NaN());
  const auto rest = std::lround((drawn.rest - drawn.from) / (drawn.to - drawn.from) * kSteps);
  y[static_cast<std::size_t>(rest)] = 0.0;
  for (const int step : {1, -1}) {
    MaterialPoint point(tissue);
    for (auto i = rest + step; i >= 0 && i <= kSteps; i += step) {
      const auto at = static_cast<std::size_t>(i);
      const std::optional<double> stress = stress_at(point, drawn, x[at]);
      if (!stress || std::abs(*stress) > highest) break;
      y[at] = *stress;
    }
  }
  return y;
}

/// The tissues whose curves are drawn, with what is said of each: after a test as quick as no branch can follow, and relaxed.
std::vector<std::pair<std::string, Tissue>> states_of(Tissue tissue) {
  tissue.viscosity = 0.0;
  if (tissue.maxwell.empty()) return {{"", std::move(tissue)}};
  Tissue at_once = tissue;
  at_once.maxwell.clear();
  return {{"at once", std::move(at_once)}, {"relaxed", std::move(tissue)}};
}

/// LawData of one test; null where the law depends on the mesh.
nlohmann::json stress_data(const DrawnTest& drawn, const std::vector<std::pair<std::string, Tissue>>& tissues) {
  std::vector<double> x;
  for (int i = 0; i <= kSteps; ++i) x.push_back(drawn.from + (drawn.to - drawn.from) * i / kSteps);
  nlohmann::json curves = nlohmann::json::array();
  for (const auto& [prefix, tissue] : tissues) {
    for (const auto& [state, drawn_tissue] : states_of(tissue)) {
      try {
        std::string label = prefix;
        if (!prefix.empty() && !state.empty()) label += ": ";
        label += state;
        curves.push_back({{"label", label}, {"y", drawn_stresses(drawn_tissue, drawn, x)}});
      } catch (const std::invalid_argument&) {  // a measure that depends on the mesh: there is no curve of the material
        return nullptr;
      }
    }
  }
  return {{"measure", drawn.measure}, {"quantity", drawn.quantity}, {"x", std::move(x)}, {"curves", std::move(curves)}};
}

void add_stress_data(nlohmann::json& all, const std::vector<std::pair<std::string, Tissue>>& tissues) {
  for (const DrawnTest& drawn : kDrawnTests) {
    if (nlohmann::json data = stress_data(drawn, tissues); !data.is_null()) all.push_back(std::move(data));
  }
}

nlohmann::json modulus_data(const Variant& variant, double reach) {
  const DeformationMeasure measure = variant.tissue.measure;
  const double end = measure == DeformationMeasure::regular_mean_ratio ? 1.0 : reach;
  std::vector<double> x;
  for (int i = 0; i < kPoints; ++i) x.push_back(end * i / (kPoints - 1));
  nlohmann::json curves = nlohmann::json::array();
  add_curves(curves, variant.tissue, "", x);
  for (const RegionSpec& region : variant.regions) {
    if (region.tissue.measure == measure) add_curves(curves, region.tissue, region.name + ": ", x);
  }
  return {{"measure", measure_label(measure)}, {"quantity", "modulus"}, {"x", x}, {"curves", curves}};
}

}  // namespace

double law_reach(const Variant& variant) {
  double reach = reach_of(variant.tissue);
  for (const RegionSpec& region : variant.regions) reach = std::max(reach, reach_of(region.tissue));
  return reach;
}

nlohmann::json stress_data(const Tissue& tissue) {
  nlohmann::json all = nlohmann::json::array();
  add_stress_data(all, {{"", tissue}});
  return all;
}

nlohmann::json law_data(const Variant& variant, double reach) {
  nlohmann::json all = nlohmann::json::array();
  if (!variant.tissue.hyperelastic) all.push_back(modulus_data(variant, reach));
  std::vector<std::pair<std::string, Tissue>> tissues{{"", variant.tissue}};
  for (const RegionSpec& region : variant.regions) tissues.emplace_back(region.name, region.tissue);
  add_stress_data(all, tissues);
  return all;
}

}  // namespace glisson
