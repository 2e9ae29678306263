// convergence_report.h — the results of a scene on several meshes, as text, JSON and parts of the report page.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "glisson/scene/convergence.h"

namespace glisson::app {

struct LevelMesh {
  std::size_t tets = 0;
  double cell = 0.0;       ///< cell_size [m]
  double tool_area = 0.0;  ///< [m²]; 0: no tool, or none with a face
  bool split = false;
};

struct LevelResult {
  LevelMesh mesh;
  double value = 0.0;
  double wall_s = 0.0;
};

/// One variant on its meshes.
struct ConvergenceStudy {
  std::string variant, column;
  std::vector<LevelResult> levels{};       ///< from the mesh as given to the finest that is done
  std::optional<GridConvergence> found{};  ///< none with fewer than two levels
  std::string trouble{};                   ///< why a mesh has no value; empty: none
  double largest_order = 2.0;              ///< largest_order() of the mesh as given
  std::optional<double> lighter{};         ///< the value on the mesh as given of lighter_variant()

  void conclude();
  /// The change of the value on the mesh as given with a quarter of the mass and half of the step; none where it was not tried.
  std::optional<double> change_with_mass() const;
  /// Sentences: what the mesh as given errs, and what to make of it.
  std::vector<std::string> words() const;
};

/// @param at  "peak" or "end"
std::string convergence_table(const ConvergenceStudy& study, const std::string& at);
nlohmann::ordered_json convergence_json(const std::string& scene, const std::vector<ConvergenceStudy>& studies,
                                        const std::string& at);
/// ChartSpec and TableData of web/src/report_data.ts. The study has two levels or more.
nlohmann::json convergence_chart(const ConvergenceStudy& study);
nlohmann::json convergence_rows(const ConvergenceStudy& study, const std::string& at);

}  // namespace glisson::app
