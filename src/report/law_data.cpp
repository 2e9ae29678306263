// law_data.cpp — see law_data.h.
#include "report/law_data.h"

#include <algorithm>
#include <string>
#include <vector>

#include "material/uniaxial.h"

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

/// Nominal stress of a tensile and compression test with free sides.
nlohmann::json stretch_data(const Tissue& tissue) {
  constexpr double kFrom = 0.5, kTo = 1.5;
  const Response response(tissue);
  std::vector<double> x, y;
  for (int i = 0; i < kPoints; ++i) {
    x.push_back(kFrom + (kTo - kFrom) * i / (kPoints - 1));
    y.push_back(uniaxial_state(response, x.back()).stress);
  }
  return {{"measure", "stretch, sides free [-]"},
          {"quantity", "nominal stress"},
          {"x", x},
          {"curves", {{{"label", std::string(law_name(*tissue.hyperelastic))}, {"y", y}}}}};
}

}  // namespace

double law_reach(const Variant& variant) {
  double reach = reach_of(variant.tissue);
  for (const RegionSpec& region : variant.regions) reach = std::max(reach, reach_of(region.tissue));
  return reach;
}

nlohmann::json law_data(const Variant& variant, double reach) {
  if (variant.tissue.hyperelastic) return stretch_data(variant.tissue);
  const DeformationMeasure measure = variant.tissue.measure;
  const double end = measure == DeformationMeasure::regular_mean_ratio ? 1.0 : reach;
  std::vector<double> x;
  for (int i = 0; i < kPoints; ++i) x.push_back(end * i / (kPoints - 1));
  nlohmann::json curves = nlohmann::json::array();
  add_curves(curves, variant.tissue, "", x);
  for (const RegionSpec& region : variant.regions) {
    if (region.tissue.measure == measure) add_curves(curves, region.tissue, region.name + ": ", x);
  }
  return {{"measure", measure_label(measure)}, {"x", x}, {"curves", curves}};
}

}  // namespace glisson
