// comparison_report.cpp — see comparison_report.h.
#include "cli/comparison_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/embedded.h"
#include "report/report_page.h"

namespace glisson::app {
namespace {

const models::Rival& rival_of(const std::string& name) {
  const auto list = models::rivals();
  return *std::find_if(list.begin(), list.end(), [&](const models::Rival& r) { return r.name == name; });
}

std::string effort_text(const ComparedRow& row) {
  if (row.effort == models::Effort{}) return fmt::format("{}", row.answer.steps);
  return row.effort.iterations > 0 ? fmt::format("{}×{}", row.effort.steps, row.effort.iterations)
                                   : fmt::format("{}", row.effort.steps);
}

std::string share_text(double share) { return share < 0.0 ? "-" : fmt::format("{:.3g} %", 100.0 * share); }

/// Three digits, without a power of ten where it is large.
std::string short_text(double value) {
  return value < 1000.0 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
}

/// "-" where it is not known.
std::string megabytes(const ComparedRow& row) {
  return row.answer.bytes == 0 ? "-" : fmt::format("{:.3g}", 1e-6 * static_cast<double>(row.answer.bytes));
}

std::string unit(const Comparison& c) { return c.moments ? "N m" : "N"; }

std::string heading_of(const Comparison& c) { return c.moments ? "moment" : "force"; }

std::string reference_text(const Comparison& c) {
  const Reference& r = c.reference;
  const std::string within =
      r.high - r.low < 1e-6
          ? ""
          : fmt::format(", which is expected within {:+.2g} and {:+.2g} % of that", 100.0 * r.low, 100.0 * r.high);
  return fmt::format(
      "reference: the scene's own tissue {}, {} tets; {} of {:.4g} {} at the end, {:+.2g} % of it extrapolated to the "
      "limit of fine meshes{}{}{}\n",
      r.kind, r.tets, heading_of(c), norm(r.forces.back()), unit(c), 100.0 * r.extrapolated, within,
      r.words.empty() ? "" : ". ", r.words);
}

/// What the models that reach the target take, from the quickest; then those that do not, with their least error.
std::string target_text(const Comparison& c) {
  std::vector<const ComparedRow*> best;
  std::string missed;
  for (const models::Rival& rival : models::rivals()) {
    if (const ComparedRow* row = c.quickest(rival.name)) {
      best.push_back(row);
      continue;
    }
    double least = -1.0;
    bool ran = false;
    for (const ComparedRow& row : c.rows) {
      if (row.model != rival.name) continue;
      ran = true;
      if (row.error_force >= 0.0 && (least < 0.0 || row.error_force < least)) least = row.error_force;
    }
    if (ran)
      missed += fmt::format("  {:<24} {:>10}\n", rival.name, least < 0.0 ? "no " + heading_of(c) : share_text(least));
  }
  std::stable_sort(best.begin(), best.end(), [](const auto* a, const auto* b) { return a->wall_s() < b->wall_s(); });
  std::string text = fmt::format("within {:.3g} % of the {} and the surface, there and with all that is finer:\n",
                                 100.0 * c.target, heading_of(c));
  for (const ComparedRow* row : best) {
    text += fmt::format("  {:<24} {:>10.3g} s  {:>6.3g} times the quickest\n", row->model, row->wall_s(),
                        row->wall_s() / best.front()->wall_s());
  }
  if (best.empty()) text += "  none\n";
  return missed.empty() ? text : text + "not within it; least error:\n" + missed;
}

nlohmann::json numbers(const std::vector<double>& values) { return values; }

/// The rows of a model as a line of error over time, from the shortest.
nlohmann::json error_line(const Comparison& c, std::string_view model) {
  std::vector<const ComparedRow*> rows;
  for (const ComparedRow& row : c.rows) {
    if (row.model == model && row.error_force > 0.0) rows.push_back(&row);
  }
  if (rows.empty()) return nullptr;
  std::stable_sort(rows.begin(), rows.end(), [](const auto* a, const auto* b) { return a->wall_s() < b->wall_s(); });
  std::vector<double> x, y;
  for (const ComparedRow* row : rows) {
    x.push_back(1e3 * row->wall_s());
    y.push_back(100.0 * row->error_force);
  }
  return {{"label", model}, {"x", numbers(x)}, {"y", numbers(y)}};
}

nlohmann::json axis(const std::string& name, const std::string& label) {
  return {{"column", name}, {"label", label}, {"scale", 1.0}};
}

/// Of each model the row of least error.
nlohmann::json force_chart(const Comparison& c) {
  nlohmann::json lines = nlohmann::json::array();
  const auto line = [&](const std::string& label, const std::vector<Vec3d>& forces) {
    std::vector<double> x{0.0}, y{0.0};
    for (std::size_t i = 0; i < forces.size(); ++i) {
      x.push_back(c.stations[i]);
      y.push_back(norm(forces[i]));
    }
    lines.push_back({{"label", label}, {"x", numbers(x)}, {"y", numbers(y)}});
  };
  line("reference", c.reference.forces);
  for (const models::Rival& rival : models::rivals()) {
    const ComparedRow* best = nullptr;
    for (const ComparedRow& row : c.rows) {
      if (row.model == rival.name && row.error_force >= 0.0 && (best == nullptr || row.error_force < best->error_force))
        best = &row;
    }
    if (best != nullptr) line(best->model, best->answer.forces);
  }
  return {{"title", "The " + heading_of(c) + ", each model at its best"},
          {"x", axis("time_s", "time [s]")},
          {"y", axis("force", heading_of(c) + " [" + unit(c) + "]")},
          {"variants", nlohmann::json::array()},
          {"lines", std::move(lines)}};
}

nlohmann::json error_chart(const Comparison& c) {
  nlohmann::json lines = nlohmann::json::array();
  for (const models::Rival& rival : models::rivals()) {
    if (nlohmann::json line = error_line(c, rival.name); !line.is_null()) lines.push_back(std::move(line));
  }
  return {{"title", "Error against time"},
          {"x", axis("wall_ms", "time by the clock [ms]")},
          {"y", axis("error", "error of the " + heading_of(c) + " [%]")},
          {"variants", nlohmann::json::array()},
          {"lines", std::move(lines)},
          {"log_x", true},
          {"log_y", true}};
}

nlohmann::json rows_table(const Comparison& c) {
  nlohmann::json rows = nlohmann::json::array();
  std::vector<std::string> columns{
      "model",    "tets",        "steps", "error of the " + heading_of(c), "error of the surface", "set-up [ms]",
      "run [ms]", "memory [MB]", "note"};
  if (!c.measured.empty()) columns.emplace_back("against the measurement");
  for (const ComparedRow& row : c.rows) {
    rows.push_back({row.model, row.tets, effort_text(row), share_text(row.error_force), share_text(row.error_surface),
                    short_text(1e3 * row.answer.setup_s), short_text(1e3 * row.answer.run_s), megabytes(row),
                    note_of(row)});
    if (!c.measured.empty()) rows.back().push_back(share_text(row.error_measured));
  }
  return {{"title", "Each run"}, {"columns", columns}, {"rows", std::move(rows)}, {"note", reference_text(c)}};
}

nlohmann::json models_table(const Comparison& c) {
  nlohmann::json rows = nlohmann::json::array();
  for (const models::Rival& rival : models::rivals()) {
    const auto of_it = [&](const ComparedRow& row) { return row.model == rival.name; };
    if (std::none_of(c.rows.begin(), c.rows.end(), of_it)) continue;
    rows.push_back({rival.name, rival.what, rival.source, rival.cannot});
  }
  return {{"title", "The models"},
          {"columns", {"model", "what it is", "source", "what it cannot do"}},
          {"rows", std::move(rows)},
          {"note", ""}};
}

/// Of a model's rows the one on the finest mesh with the greatest effort; null: it has none.
const ComparedRow* last_row(const Comparison& c, std::string_view model) {
  const ComparedRow* last = nullptr;
  for (const ComparedRow& row : c.rows) {
    if (row.model == model) last = &row;
  }
  return last;
}

/// A row a model: the errors of its force in all variants, each on the finest mesh with the greatest effort.
std::vector<std::vector<std::string>> summary_rows(std::span<const Comparison> all) {
  std::vector<std::vector<std::string>> rows;
  for (const models::Rival& rival : models::rivals()) {
    std::vector<std::string> row{std::string(rival.name)};
    double wall = 0.0;
    bool ran = false;
    for (const Comparison& c : all) {
      const ComparedRow* last = last_row(c, rival.name);
      ran = ran || (last != nullptr && last->answer.trouble.empty());
      row.push_back(last == nullptr ? "-" : share_text(last->error_force));
      wall += last == nullptr ? 0.0 : last->wall_s();
    }
    row.push_back(fmt::format("{:.3g} s", wall));
    if (ran) rows.push_back(std::move(row));
  }
  return rows;
}

std::string summary_text(std::span<const Comparison> all) {
  std::string text = fmt::format("error of the {} by variant, finest mesh and greatest effort:\n  {:<24}",
                                 heading_of(all.front()), "");
  for (const Comparison& c : all) text += fmt::format("  {:>12}", c.variant);
  text += fmt::format("  {:>12}\n", "time of all");
  for (const auto& row : summary_rows(all)) {
    text += fmt::format("  {:<24}", row.front());
    for (std::size_t i = 1; i < row.size(); ++i) text += fmt::format("  {:>12}", row[i]);
    text += "\n";
  }
  return text;
}

nlohmann::json summary_table(std::span<const Comparison> all) {
  nlohmann::json columns{"model"};
  for (const Comparison& c : all) columns.push_back(c.variant);
  columns.push_back("time of all");
  return {{"title", "Error of the " + heading_of(all.front()) + " by variant"},
          {"columns", std::move(columns)},
          {"rows", summary_rows(all)},
          {"note", "Each on the finest mesh with the greatest effort."}};
}

std::string table_of(const Comparison& c) {
  constexpr std::string_view kRow = "  {:<24} {:>7}  {:>10}  {:>10}  {:>10}{}  {:>10}  {:>10}  {:>8}  {}\n";
  const auto measured = [&](const std::string& cell) {
    return c.measured.empty() ? std::string() : fmt::format("  {:>10}", cell);
  };
  std::string text = c.variant.empty() ? "" : fmt::format("variant {}\n", c.variant);
  text += reference_text(c);
  text += fmt::format(fmt::runtime(kRow), "model", "tets", "steps", heading_of(c), "surface", measured("measured"),
                      "set-up [s]", "run [s]", "[MB]", "");
  for (const ComparedRow& row : c.rows) {
    text += fmt::format(fmt::runtime(kRow), row.model, row.tets, effort_text(row), share_text(row.error_force),
                        share_text(row.error_surface), measured(share_text(row.error_measured)),
                        fmt::format("{:.3g}", row.answer.setup_s), fmt::format("{:.3g}", row.answer.run_s),
                        megabytes(row), note_of(row));
  }
  return text + target_text(c);
}

nlohmann::ordered_json forces_json(const std::vector<Vec3d>& forces) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Vec3d& f : forces) list.push_back({f.x, f.y, f.z});
  return list;
}

nlohmann::ordered_json reference_json(const Comparison& c) {
  return {{"tets", c.reference.tets},
          {"forces", forces_json(c.reference.forces)},
          {"extrapolated", c.reference.extrapolated},
          {"limit_low", c.reference.low},
          {"limit_high", c.reference.high}};
}

}  // namespace

std::string note_of(const ComparedRow& row) {
  if (!row.answer.trouble.empty()) return row.answer.trouble;
  if (row.answer.forces.empty()) return fmt::format("no forces; cannot: {}", rival_of(row.model).cannot);
  if (!std::isfinite(row.error_force)) return "its numbers are not finite";
  if (row.answer.cut_s > 0.0) return fmt::format("the cut took {} ms", short_text(1e3 * row.answer.cut_s));
  return {};
}

std::string comparison_table(std::span<const Comparison> comparisons) {
  std::string text;
  for (const Comparison& c : comparisons) text += table_of(c);
  return comparisons.size() > 1 ? text + summary_text(comparisons) : text;
}

nlohmann::ordered_json comparison_json(std::span<const Comparison> comparisons, const std::string& scene) {
  const auto or_null = [](double value) {
    return value < 0.0 ? nlohmann::ordered_json() : nlohmann::ordered_json(value);
  };
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  nlohmann::ordered_json variants = nlohmann::ordered_json::array();
  for (const Comparison& c : comparisons) {
    for (const ComparedRow& row : c.rows) {
      rows.push_back({{"model", row.model},
                      {"tets", row.tets},
                      {"steps", row.answer.steps},
                      {"iterations", row.effort.iterations},
                      {"error_force", or_null(row.error_force)},
                      {"error_surface", or_null(row.error_surface)},
                      {"error_measured", or_null(row.error_measured)},
                      {"wall_s", row.wall_s()},
                      {"setup_s", row.answer.setup_s},
                      {"cut_s", row.answer.cut_s},
                      {"bytes", row.answer.bytes},
                      {"forces", forces_json(row.answer.forces)},
                      {"note", note_of(row)}});
      if (!c.variant.empty()) rows.back()["variant"] = c.variant;
    }
    variants.push_back({{"variant", c.variant}, {"stations_s", c.stations}, {"reference", reference_json(c)}});
  }
  const Comparison& first = comparisons.front();
  nlohmann::ordered_json json{{"scene", scene},
                              {"machine", machine_text()},
                              {"unit", unit(first)},
                              {"target", first.target},
                              {"stations_s", first.stations},
                              {"reference", reference_json(first)},
                              {"rows", rows}};
  if (comparisons.size() > 1) json["variants"] = variants;
  return json;
}

std::string comparison_page(std::span<const Comparison> comparisons) {
  std::vector<nlohmann::json> scenes;
  for (const Comparison& c : comparisons) {
    const std::string title = c.variant.empty() ? c.title : c.title + ": " + c.variant;
    nlohmann::json tables = nlohmann::json::array();
    if (comparisons.size() > 1 && &c == &comparisons.front()) tables.push_back(summary_table(comparisons));
    tables.push_back(rows_table(c));
    tables.push_back(models_table(c));
    scenes.push_back({{"name", title},
                      {"title", title},
                      {"description", c.description},
                      {"notes", nlohmann::json::array()},
                      {"source", ""},
                      {"variants", nlohmann::json::array()},
                      {"charts", {force_chart(c), error_chart(c)}},
                      {"tables", std::move(tables)},
                      {"checks", nlohmann::json::array()}});
  }
  return report_page(report_template(),
                     report_json(comparisons.front().title, "many models, one experiment", std::move(scenes)));
}

}  // namespace glisson::app
