// convergence_report.cpp — see convergence_report.h.
#include "cli/convergence_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace glisson::app {
namespace {

constexpr double kAreaChanges = 0.01;     // of the tool's area: more, and the meshes are loaded otherwise
constexpr double kMovesWithMass = 0.002;  // of the value: inertia is said from here on
constexpr int kCurvePoints = 40;
constexpr double kBracketFoot = 0.03;  // of the width of the chart

std::string percent(double share) { return fmt::format("{:+.2g} %", 100.0 * share); }

double largest_area_change(const ConvergenceStudy& study) {
  const double given = study.levels.front().mesh.tool_area;
  double most = 0.0;
  for (const LevelResult& level : study.levels) most = std::max(most, std::abs(level.mesh.tool_area - given));
  return given > 0.0 ? most / given : 0.0;
}

/// Whether a power of the size of cells leads to the limit.
bool has_power(const GridConvergence& g) { return g.extrapolates() && g.order > 0.0; }

/// f₀ + C h^p through the finest mesh, from h = 0 to the mesh as given.
nlohmann::json power_law(const ConvergenceStudy& study) {
  const GridConvergence& g = *study.found;
  const LevelResult& finest = study.levels.back();
  nlohmann::json x = nlohmann::json::array(), y = nlohmann::json::array();
  for (int i = 0; i <= kCurvePoints; ++i) {
    const double h = study.levels.front().mesh.cell * i / kCurvePoints;
    x.push_back(1e3 * h);
    y.push_back(g.extrapolated + (finest.value - g.extrapolated) * std::pow(h / finest.mesh.cell, g.order));
  }
  return {{"label", fmt::format("order {:.3g}", g.order)}, {"x", x}, {"y", y}};
}

}  // namespace

void ConvergenceStudy::conclude() {
  if (levels.size() < 2) return;
  std::vector<MeshResult> results;
  for (const LevelResult& level : levels) results.push_back({level.mesh.cell, level.value});
  found = grid_convergence(results, largest_order);
}

std::optional<double> ConvergenceStudy::change_with_mass() const {
  if (!lighter || levels.empty() || levels.front().value == 0.0) return std::nullopt;
  return (*lighter - levels.front().value) / std::abs(levels.front().value);
}

std::vector<std::string> ConvergenceStudy::words() const {
  std::vector<std::string> text;
  if (!trouble.empty()) text.push_back(trouble);
  if (!found) {
    text.push_back(
        fmt::format("{} of the meshes is done; two are needed to say anything of its error.", levels.size()));
    return text;
  }
  if (found->extrapolates()) {
    text.push_back(fmt::format("The mesh as given has an error of {}, the finest one of {}.",
                               percent(found->error_of(levels.front().value)),
                               percent(found->error_of(levels.back().value))));
  }
  if (const std::string verdict = verdict_text(*found); !verdict.empty()) text.push_back(verdict);
  if (const auto moved = change_with_mass(); moved && std::abs(*moved) > kMovesWithMass) {
    text.push_back(
        fmt::format("With a quarter of the mass and half of the step the value on the mesh as given moves by {}: it "
                    "contains inertia, damping by mass or the error of the step, on any mesh. For the force without "
                    "them compare with --set motion.integrator=quasi_static.",
                    percent(*moved)));
  }
  if (largest_area_change(*this) > kAreaChanges) {
    text.push_back(
        fmt::format("The area of the tool's set changes by {:.0f} % with the mesh, and the force with it: choose the "
                    "set so that it "
                    "ends at edges of cells.",
                    100.0 * largest_area_change(*this)));
  }
  if (levels.back().mesh.split) {
    text.emplace_back(
        "Every tet was split in eight: regions, sets that no place chooses and curved surfaces are those of the mesh "
        "as given.");
  }
  return text;
}

std::string convergence_table(const ConvergenceStudy& study, const std::string& at) {
  constexpr std::string_view kRow = "  {:<10}  {:>9}  {:>9}  {:>15}  {:>12}  {:>9}  {:>9}  {:>9}\n";
  std::string text = fmt::format("{}: {}, {}\n", study.variant, study.column, at == "peak" ? "largest" : "at the end");
  text += fmt::format(fmt::runtime(kRow), "mesh", "tets", "cell [mm]", "tool area [mm2]", "value", "change", "error",
                      "wall [s]");
  const bool extrapolates = study.found && study.found->extrapolates();
  for (std::size_t i = 0; i < study.levels.size(); ++i) {
    const LevelResult& level = study.levels[i];
    const double before = i > 0 ? study.levels[i - 1].value : 0.0, area = level.mesh.tool_area;
    text += fmt::format(
        fmt::runtime(kRow), i == 0 ? "as given" : fmt::format("{} x finer", 1 << i), level.mesh.tets,
        fmt::format("{:.4g}", 1e3 * level.mesh.cell), area > 0.0 ? fmt::format("{:.4g}", 1e6 * area) : "",
        fmt::format("{:.6g}", level.value), before != 0.0 ? percent((level.value - before) / std::abs(before)) : "",
        extrapolates ? percent(study.found->error_of(level.value)) : "", fmt::format("{:.2f}", level.wall_s));
  }
  if (extrapolates) {
    const GridConvergence& g = *study.found;
    const bool assumed = g.verdict == GridConvergence::Verdict::two_meshes;
    const std::string order = has_power(g) ? fmt::format("; order {:.3g}{}", g.order, assumed ? " (assumed)" : "") : "";
    text += fmt::format("  extrapolated: {:.6g}, expected within {:.6g} and {:.6g}{}\n", g.extrapolated, g.low, g.high,
                        order);
  } else if (study.found) {
    text += fmt::format("  not extrapolated; expected within {:.6g} and {:.6g}\n", study.found->low, study.found->high);
  }
  for (const std::string& sentence : study.words()) text += "  " + sentence + "\n";
  return text;
}

nlohmann::ordered_json convergence_json(const std::string& scene, const std::vector<ConvergenceStudy>& studies,
                                        const std::string& at) {
  constexpr const char* kVerdicts[] = {"converging",  "independent", "two_meshes",
                                       "alternating", "slow",        "not_monotone"};
  nlohmann::ordered_json json;
  json["format"] = 1;
  json["scene"] = scene;
  json["at"] = at;
  json["variants"] = nlohmann::ordered_json::array();
  for (const ConvergenceStudy& s : studies) {
    nlohmann::ordered_json one;
    one["variant"] = s.variant;
    one["column"] = s.column;
    one["levels"] = nlohmann::ordered_json::array();
    for (const LevelResult& level : s.levels) {
      nlohmann::ordered_json row;
      row["tets"] = level.mesh.tets;
      row["cell_m"] = level.mesh.cell;
      row["tool_area_m2"] = level.mesh.tool_area;
      row["value"] = level.value;
      row["wall_s"] = level.wall_s;
      one["levels"].push_back(std::move(row));
    }
    if (s.found) {
      one["verdict"] = kVerdicts[static_cast<int>(s.found->verdict)];
      const auto number_if = [](bool is, double x) { return is ? nlohmann::ordered_json(x) : nullptr; };
      const bool extrapolates = s.found->extrapolates();
      one["observed_order"] = number_if(s.found->seen_order != 0.0, s.found->seen_order);
      one["largest_order"] = s.found->largest;
      one["extrapolated"] = number_if(extrapolates, s.found->extrapolated);
      one["low"] = s.found->low;
      one["high"] = s.found->high;
      one["error_as_given"] = number_if(extrapolates, s.found->error_of(s.levels.front().value));
      one["change_with_mass"] = number_if(s.change_with_mass().has_value(), s.change_with_mass().value_or(0.0));
    }
    one["words"] = s.words();
    json["variants"].push_back(std::move(one));
  }
  return json;
}

/// Value against size of the cells: the meshes as circles; where it extrapolates f₀ + C h^p through the finest of them; and the
/// interval as a bracket at h = 0.
nlohmann::json convergence_chart(const ConvergenceStudy& study) {
  const GridConvergence& g = *study.found;
  nlohmann::json xs = nlohmann::json::array(), ys = nlohmann::json::array();
  for (const LevelResult& level : study.levels) xs.push_back(1e3 * level.mesh.cell), ys.push_back(level.value);
  nlohmann::json fits = nlohmann::json::array();
  if (has_power(g)) fits.push_back(power_law(study));
  const double foot = kBracketFoot * 1e3 * study.levels.front().mesh.cell;
  fits.push_back({{"label", "expected within"}, {"x", {foot, 0.0, 0.0, foot}}, {"y", {g.low, g.low, g.high, g.high}}});
  nlohmann::json chart;
  chart["title"] = fmt::format("{}: {} and the size of cells", study.variant, study.column);
  chart["x"] = {{"column", "cell"}, {"label", "size of cells [mm]"}, {"scale", 1.0}};
  chart["y"] = {{"column", study.column}, {"label", study.column}, {"scale", 1.0}};
  chart["variants"] = nlohmann::json::array();
  chart["points"] = {{{"label", "meshes"}, {"x", xs}, {"y", ys}}};
  chart["fits"] = std::move(fits);
  return chart;
}

nlohmann::json convergence_rows(const ConvergenceStudy& study, const std::string& at) {
  const GridConvergence& g = *study.found;
  nlohmann::json rows = nlohmann::json::array();
  for (const LevelResult& level : study.levels) {
    rows.push_back({level.mesh.tets, 1e3 * level.mesh.cell, 1e6 * level.mesh.tool_area, level.value,
                    g.extrapolates() ? percent(g.error_of(level.value)) : ""});
  }
  if (g.extrapolates()) rows.push_back({"extrapolated", "0", "", g.extrapolated, ""});
  rows.push_back({"expected within", "", "", fmt::format("{:.6g} … {:.6g}", g.low, g.high), ""});
  std::string note;
  for (const std::string& sentence : study.words()) note += (note.empty() ? "" : " ") + sentence;
  return {{"title", fmt::format("{}: {} on finer meshes", study.variant, study.column)},
          {"columns",
           {"tets", "cells [mm]", "tool area [mm²]", study.column + (at == "peak" ? ", largest" : ", end"), "error"}},
          {"rows", std::move(rows)},
          {"note", note}};
}

}  // namespace glisson::app
