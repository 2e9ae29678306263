#include "report/heat_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "glisson/io.h"
#include "glisson/version.h"
#include "report/csv_table.h"
#include "report/json_text.h"
#include "report/scene_checks.h"

namespace glisson {
namespace {

constexpr double kBoils = 100.0;  // [°C]

}  // namespace

std::vector<Field> heat_fields(const HeatSimulation& s, const std::vector<double>& isotherms) {
  const auto field = [](std::string name, auto begin, auto end) {
    return Field{.name = std::move(name), .components = 1, .values = {begin, end}};
  };
  const HeatHistory& h = s.state().history;
  const std::vector<double> frozen = s.frozen_share();
  std::vector<Field> fields{field("temperature_C", s.temperature().begin(), s.temperature().end()),
                            field("frozen", frozen.begin(), frozen.end()),
                            field("coldest_C", h.coldest.begin(), h.coldest.end()),
                            field("hottest_C", h.hottest.begin(), h.hottest.end()),
                            field("cem43_min", h.cem43.begin(), h.cem43.end()),
                            field("damage", h.damage.begin(), h.damage.end()),
                            field("freezings", h.freezings.begin(), h.freezings.end()),
                            field("dead", h.dead.begin(), h.dead.end())};
  for (std::size_t k = 0; k < h.below.size(); ++k)
    fields.push_back(field(fmt::format("below_{:g}_C_s", isotherms[k]), h.below[k].begin(), h.below[k].end()));
  return fields;
}

std::string heat_trouble_text(const HeatRunSummary& s) {
  return s.trouble.empty() ? "" : fmt::format("stopped at {:.6g} s: {}", s.time_s, s.trouble);
}

std::string boiling_warning(const HeatRunSummary& s) {
  if (s.highest_C <= kBoils) return {};
  return fmt::format(
      "{:.4g} °C is above 100 °C, where tissue boils: evaporation is not in the model, and what is hotter cannot be "
      "believed; take less power",
      s.highest_C);
}

HeatRecorder::HeatRecorder(Variant variant, RecorderOptions options, std::atomic<bool>& stop)
    : variant_(std::move(variant)), options_(std::move(options)), guarded_(stop) {}

void HeatRecorder::on_start(const Variant&, const BuiltHeat& built) {
  columns_ = built.temperature_columns();
  temperatures_ = columns_.size();
  columns_.insert(columns_.end(), built.heat_columns().begin() + 1, built.heat_columns().end());
  data_.resize(columns_.size());
  guarded_([&] {
    make_folder(options_.folder);
    if (variant_.output.frames > 0) make_folder(options_.folder / "frames");
    temperature_file_ = std::make_unique<LineFile>(options_.folder / "temperature.csv");
    temperature_file_->write(csv_line(built.temperature_columns()));
    heat_file_ = std::make_unique<LineFile>(options_.folder / "heat.csv");
    heat_file_->write(csv_line(built.heat_columns()));
  });
}

void HeatRecorder::on_sample(const HeatSample& sample) {
  for (std::size_t i = 0; i < temperatures_; ++i) data_[i].push_back(sample.temperatures[i]);
  for (std::size_t i = temperatures_; i < columns_.size(); ++i) data_[i].push_back(sample.heat[i - temperatures_ + 1]);
  guarded_([&] {
    temperature_file_->write(csv_line(sample.temperatures));
    heat_file_->write(csv_line(sample.heat));
  });
}

void HeatRecorder::on_frame(const HeatSimulation& s) {
  SurfaceState state{.time = s.time(), .mesh = s.mesh()};
  state.fields["temperature"].assign(s.temperature().begin(), s.temperature().end());
  if (!surface_) {
    surface_ = std::make_unique<SurfaceRecorder>(variant_, state, options_.surface_bytes);
    surface_->set_heat(*variant_.heat);
  }
  surface_->add(state);
  guarded_([&] {
    const std::filesystem::path file = std::filesystem::path("frames") / fmt::format("frame_{:04}.vtu", frames_.size());
    TetMesh mesh = s.mesh();
    mesh.regions.resize(mesh.tets.size(), 0);
    try {
      write_vtu(options_.folder / file, mesh, {}, heat_fields(s, variant_.heat->options.isotherms), {});
      frames_.emplace_back(s.time(), file);
      write_pvd(options_.folder / "frames.pvd", frames_);
    } catch (const std::runtime_error& error) {
      throw OutputError(error.what());
    }
  });
}

void HeatRecorder::on_end(const HeatRunSummary& summary) {
  summary_ = summary;
  guarded_([&] { write_whole(options_.folder / "summary.json", json_text(summary_json(), 2) + "\n"); });
}

const std::vector<double>* HeatRecorder::find_column(const std::string& name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  return found == columns_.end() ? nullptr : &data_[static_cast<std::size_t>(found - columns_.begin())];
}

const std::vector<double>& HeatRecorder::column(const std::string& name) const {
  if (const std::vector<double>* found = find_column(name)) return *found;
  throw std::out_of_range("temperature.csv and heat.csv have no column \"" + name + "\"");
}

void HeatRecorder::add_last(nlohmann::ordered_json& json) const {
  for (std::size_t i = 1; i < columns_.size(); ++i) {
    if (!data_[i].empty()) json[columns_[i]] = data_[i].back();
  }
}

nlohmann::ordered_json HeatRecorder::summary_json() const {
  const HeatRunSummary& s = summary_;
  nlohmann::ordered_json json;
  json["scene"] = options_.scene;
  json["variant"] = variant_.name;
  json["end"] = word_of(s.end);
  if (!s.trouble.empty()) json["trouble"] = heat_trouble_text(s);
  json["vertices"] = s.vertices;
  json["tets"] = s.tets;
  json["steps"] = s.steps;
  json["newton_iterations"] = s.work.iterations;
  json["linear_iterations"] = s.work.linear_iterations;
  json["time_s"] = s.time_s;
  json["wall_s"] = s.wall_s;
  json["lowest_of_all_C"] = s.lowest_C;
  json["highest_of_all_C"] = s.highest_C;
  if (const std::string warning = boiling_warning(s); !warning.empty()) json["boiling_warning"] = warning;
  add_last(json);
  json["limited_share_most"] = s.limited_share_most;
  json["threads"] = options_.threads;
  json["state_hash"] = fmt::format("{:016x}", s.state_hash);
  json["version"] = GLISSON_VERSION;
  json["checks"] = checks_json(options_.checks, s.end == RunSummary::End::finished,
                               [this](const std::string& name) -> const std::vector<double>& { return column(name); });
  return json;
}

nlohmann::json HeatRecorder::checks(const std::string& label) const {
  nlohmann::json list = nlohmann::json::array();
  for (const CheckSpec& check : options_.checks) {
    const auto value = [this](const std::string& name) -> const std::vector<double>& { return column(name); };
    list.push_back(check_json(check_result(check, summary_.end == RunSummary::End::finished, value), label));
  }
  return list;
}

nlohmann::json HeatRecorder::json() const {
  nlohmann::json summary = summary_json();
  summary.erase("checks");
  const nlohmann::json none = nlohmann::json::array(), no_table{{"columns", none}, {"data", none}};
  return {{"name", variant_.name},
          {"label", variant_.label.empty() ? variant_.name : variant_.label},
          {"summary", std::move(summary)},
          {"forces", table_json(columns_, data_)},
          {"instruments", none},
          {"probes", no_table},
          {"events", none},
          {"law_curves", none},
          {"surface", surface_ ? surface_->json() : nlohmann::json()}};
}

nlohmann::json HeatRecorder::charts(bool one_variant) const {
  nlohmann::json charts = nlohmann::json::array();
  const auto add = [&](const std::string& title, const std::string& unit, double scale, const auto& is_of) {
    nlohmann::json lines = nlohmann::json::array();
    std::vector<double> time = data_.front();
    for (double& t : time) t /= 60.0;
    for (std::size_t i = 1; i < columns_.size(); ++i) {
      if (!is_of(i)) continue;
      std::vector<double> values = data_[i];
      for (double& v : values) v *= scale;
      const std::string name = columns_[i].substr(0, columns_[i].rfind('_'));
      lines.push_back({{"label", name}, {"x", time}, {"y", std::move(values)}});
    }
    if (lines.empty()) return;
    charts.push_back({{"title", one_variant ? title : title + ": " + variant_.label},
                      {"x", {{"column", "time_s"}, {"label", "time [min]"}, {"scale", 1.0}}},
                      {"y", {{"column", ""}, {"label", unit}, {"scale", 1.0}}},
                      {"variants", nlohmann::json::array()},
                      {"lines", std::move(lines)}});
  };
  const auto ends = [this](std::size_t i, const char* with) { return columns_[i].ends_with(with); };
  add("Temperatures", "temperature [°C]", 1.0, [&](std::size_t i) { return i < temperatures_; });
  add("Fronts and extents", "length [mm]", 1e3, [&](std::size_t i) { return i >= temperatures_ && ends(i, "_m"); });
  add("Volumes", "volume [cm³]", 1e6, [&](std::size_t i) { return i >= temperatures_ && ends(i, "_m3"); });
  add("Areas", "area [cm²]", 1e4, [&](std::size_t i) { return i >= temperatures_ && ends(i, "_m2"); });
  add("Where the heat came from", "heat [kJ]", 1e-3,
      [&](std::size_t i) { return i >= temperatures_ && ends(i, "_J"); });
  return charts;
}

}  // namespace glisson
