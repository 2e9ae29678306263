// variant_recorder.cpp — see variant_recorder.h.
#include "report/variant_recorder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "glisson/scene/heat_run.h"
#include "report/csv_table.h"
#include "report/heat_recorder.h"
#include "report/json_text.h"
#include "report/law_data.h"
#include "report/summary_json.h"

namespace glisson {

VariantRecorder::VariantRecorder(Variant variant, RecorderOptions options, std::atomic<bool>& stop)
    : variant_(std::move(variant)), options_(std::move(options)), guarded_(stop), stop_(stop) {}
VariantRecorder::~VariantRecorder() = default;

void VariantRecorder::on_start(const Variant&, const Simulation& simulation) {
  advice_ = advise_at_rest(variant_, simulation);
  surface_ = std::make_unique<SurfaceRecorder>(variant_, surface_state(simulation, simulation.tet_fields()),
                                               options_.surface_bytes);
  guarded_([&] {
    make_folder(options_.folder);
    if (!variant_.instruments.empty()) {
      event_file_ = std::make_unique<LineFile>(options_.folder / "events.csv");
      event_file_->write("time_s,depth_m,event,instrument");
    }
    if (variant_.output.frames > 0) {
      const bool linear = variant_.simulation.precision == Precision::adaptive;
      frames_ = std::make_unique<FrameSeries>(options_.folder, linear);
    }
  });
}

void VariantRecorder::on_built(const BuiltVariant& built) {
  instruments_ = built.instruments;
  surface_->set_instruments(built.instruments);
  surface_->set_capsules(built.capsules);
  if (built.container) surface_->set_container(*built.container, built.simulation.mesh());
  if (frames_) frames_->set_instruments(built.instruments);
  table_.emplace(variant_, built);
  data_.resize(table_->columns().size());
  for (const auto& instrument : built.instruments) {
    names_.push_back(instrument->name());
    kinds_.emplace_back(word_of(instrument->form().kind));
  }
  for (const ForceTable::Further& file : table_->further()) further_data_.emplace_back(file.columns.size());
  if (!built.probes.empty()) {
    probe_columns_ = {"time_s"};
    probe_columns_.insert(probe_columns_.end(), built.probes.columns().begin(), built.probes.columns().end());
    probe_data_.resize(probe_columns_.size());
  }
  if (built.heat) {
    coupling_ = built.heat;
    heat_ = std::make_unique<HeatRecorder>(variant_, options_, stop_);
    heat_->on_start(variant_, coupling_->heat());
    heat_->on_sample(coupling_->heat().read());
    if (frames_) frames_->set_heat(coupling_, variant_.heat->options.isotherms);
    surface_->set_heat(*variant_.heat);
  }
  guarded_([&] {
    files_.emplace_back(options_.folder / "forces.csv");
    files_.back().write(csv_line(table_->columns()));
    for (const ForceTable::Further& file : table_->further()) {
      files_.emplace_back(options_.folder / ("forces_" + file.name + ".csv"));
      files_.back().write(csv_line(file.columns));
    }
    if (!probe_columns_.empty()) {
      probe_file_ = std::make_unique<LineFile>(options_.folder / "probes.csv");
      probe_file_->write(csv_line(probe_columns_));
    }
    if (frames_) {
      view_ = std::make_unique<ViewFile>(options_.folder, options_.scene, variant_, built.instruments);
      view_->set_capsules(built.capsules);
    }
  });
}

void VariantRecorder::on_event(const RunEvent& event) {
  events_.push_back(event);
  guarded_([&] {
    if (!event_file_) return;  // "probe lost", in a scene without instruments
    const auto& [time, depth, what] = event.what;
    event_file_->write(number_text(time) + "," + number_text(depth) + "," + what + "," + event.instrument);
  });
}

void VariantRecorder::on_sample(const Sample& sample) {
  record_probes(sample);
  if (heat_ && coupling_->heat().simulation.time() > heat_->column("time_s").back())
    heat_->on_sample(coupling_->heat().read());
  const std::vector<double> row = table_->row(sample);
  for (std::size_t i = 0; i < row.size(); ++i) data_[i].push_back(row[i]);
  guarded_([&] { files_.front().write(csv_line(row)); });
  for (std::size_t i = 0; i < table_->further().size(); ++i) {
    const std::vector<double> own = ForceTable::row_of(table_->further()[i], sample);
    for (std::size_t k = 0; k < own.size(); ++k) further_data_[i][k].push_back(own[k]);
    guarded_([&] { files_[i + 1].write(csv_line(own)); });
  }
}

void VariantRecorder::record_probes(const Sample& sample) {
  if (probe_columns_.empty()) return;
  std::vector<double> row{sample.probe_time};
  row.insert(row.end(), sample.probes.begin(), sample.probes.end());
  for (std::size_t i = 0; i < row.size(); ++i) probe_data_[i].push_back(row[i]);
  guarded_([&] { probe_file_->write(csv_line(row)); });
}

void VariantRecorder::on_frame(const Simulation& simulation) {
  const TetFields fields = simulation.tet_fields();
  SurfaceState state = surface_state(simulation, fields);
  if (coupling_) {
    const std::span<const double> t = coupling_->heat().simulation.temperature();
    state.fields["temperature"].assign(t.begin(), t.end());
  }
  surface_->add(state);
  guarded_([&] {
    if (frames_) frames_->add(simulation, fields);
    if (view_) view_->add(simulation.time());
  });
}

void VariantRecorder::on_end(const RunSummary& summary) {
  summary_ = summary;
  rejected_ = rejected_poses(instruments_);
  instruments_.clear(), coupling_ = nullptr;
  guarded_([&] {
    if (frames_) frames_->finish();
    write_whole(options_.folder / "summary.json", json_text(summary_with_tips(), 2) + "\n");
  });
}

const std::vector<double>& VariantRecorder::column(const std::string& name) const {
  const auto found_in = [&](const std::vector<std::string>& names, const auto& data) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? nullptr : &data[static_cast<std::size_t>(found - names.begin())];
  };
  if (const auto* values = found_in(table_->columns(), data_)) return *values;
  if (const auto* values = found_in(probe_columns_, probe_data_)) return *values;
  if (const auto* values = heat_ ? heat_->find_column(name) : nullptr) return *values;
  const char* files = heat_                    ? ", probes.csv, temperature.csv and heat.csv have"
                      : probe_columns_.empty() ? " has"
                                               : " and probes.csv have";
  throw std::out_of_range("forces.csv" + std::string(files) + " no column \"" + name + "\"");
}

std::vector<TipDistance> VariantRecorder::tips() const {
  std::vector<TipDistance> tips;
  if (probe_data_.empty() || probe_data_.front().empty()) return tips;
  for (const ProbeSpec& probe : variant_.probes) {
    if (probe.tip.empty()) continue;
    const std::string name = probe.options.name + "_tip_";
    const std::vector<double>& distance = column(name + "distance_m");
    tips.push_back({probe.options.name, probe.tip, distance.back(), column(name + "along_m").back(),
                    column(name + "across_m").back(), *std::min_element(distance.begin(), distance.end())});
  }
  return tips;
}

/// The summary of the run, and where tips ended.
nlohmann::ordered_json VariantRecorder::summary_with_tips() const {
  nlohmann::ordered_json json = summary_json(summary_, variant_, options_.scene, options_.threads, rejected_, advice_);
  for (const TipDistance& tip : tips()) {
    const std::string name = tip.probe + "_tip_";
    json[name + "distance_m"] = tip.distance;
    json[name + "along_m"] = tip.along;
    json[name + "across_m"] = tip.across;
    json[name + "distance_least_m"] = tip.least;
  }
  if (heat_) {
    json["energy_changed_J"] = summary_.energies.changed;
    heat_->add_last(json);
  }
  json["checks"] = checks_json(options_.checks, summary_.end == RunSummary::End::finished,
                               [this](const std::string& name) -> const std::vector<double>& { return column(name); });
  return json;
}

nlohmann::json VariantRecorder::events_json() const {
  nlohmann::json list = nlohmann::json::array();
  for (const RunEvent& e : events_) {
    list.push_back(
        {{"time_s", e.what.time}, {"depth_m", e.what.depth}, {"event", e.what.event}, {"instrument", e.instrument}});
  }
  return list;
}

/// Tools and instruments by name and kind; all but the first, whose columns are those of forces.csv, with a table of their own.
nlohmann::json VariantRecorder::instruments_json() const {
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = 0; i < names_.size(); ++i) {
    list.push_back({{"name", names_[i]}, {"kind", kinds_[i]}});
    if (i > 0) list.back()["forces"] = table_json(table_->further()[i - 1].columns, further_data_[i - 1]);
  }
  return list;
}

nlohmann::json VariantRecorder::json(double law_reach) const {
  nlohmann::json summary(summary_with_tips());
  for (const char* of_scene : {"advice", "checks"})
    summary.erase(of_scene);  // the page has those of the scene, in words
  return {{"name", variant_.name},
          {"label", variant_.label.empty() ? variant_.name : variant_.label},
          {"summary", std::move(summary)},
          {"forces", table_json(table_->columns(), data_)},
          {"instruments", instruments_json()},
          {"probes", table_json(probe_columns_, probe_data_)},
          {"events", events_json()},
          {"law_curves", law_data(variant_, law_reach)},
          {"surface", surface_ ? surface_->json() : nlohmann::json()}};
}

}  // namespace glisson
