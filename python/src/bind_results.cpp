// bind_results.cpp — whole runs, and what they leave: the columns of forces.csv, events, frames, the summary.
//
//   run_variant ── own thread or this one, GIL released ──▶ samples kept in C++, row by row
//                 └▶ observers in Python take the GIL; Ctrl-C and what they raise end the run
#include <atomic>

#include "glisson/scene/scene.h"
#include "live_simulation.h"
#include "report/force_table.h"
#include "report/json_text.h"
#include "report/output_file.h"
#include "report/output_folder.h"
#include "report/summary_json.h"

namespace glisson::python {
namespace {

/// Rows of numbers under columns.
struct Table {
  std::vector<std::string> columns;
  std::vector<double> numbers;

  std::size_t rows() const { return columns.empty() ? 0 : numbers.size() / columns.size(); }
  nb::object array(nb::handle self) const {
    using Array = nb::ndarray<nb::numpy, const double, nb::c_contig>;
    return Array(numbers.data(), {rows(), columns.size()}, self).cast(nb::rv_policy::reference);
  }
  std::size_t place_of(const std::string& name) const {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i] == name) return i;
    }
    std::string known;
    for (const std::string& column : columns) known += (known.empty() ? "" : ", ") + column;
    throw nb::key_error(("no column \"" + name + "\"; there are: " + known).c_str());
  }
  Doubles column(const std::string& name) const {
    const std::size_t place = place_of(name);
    std::vector<double> values;
    for (std::size_t i = place; i < numbers.size(); i += columns.size()) values.push_back(numbers[i]);
    return scalars(std::move(values));
  }
  /// The bytes of the file that `glisson run` writes.
  std::string csv() const {
    std::string text;
    for (std::size_t i = 0; i < columns.size(); ++i) text += (i > 0 ? "," : "") + columns[i];
    text += '\n';
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      text += number_text(numbers[i]) + ((i + 1) % columns.size() == 0 ? "\n" : ",");
    }
    return text;
  }
};

struct Frame {
  double time = 0.0;
  std::vector<Vec3d> displacement;
};

/// Pickles, but for the variant, whose description may hold functions of the program.
struct RunResult {
  std::optional<Variant> variant;  ///< none in one that was unpickled
  std::string name, label;
  std::shared_ptr<Table> forces = std::make_shared<Table>();
  std::map<std::string, std::shared_ptr<Table>> further;
  std::shared_ptr<Table> probes = std::make_shared<Table>();
  std::vector<RunEvent> events;
  std::vector<Frame> frames;
  std::string summary;  ///< the text of summary.json
  std::string end, trouble;
};

/// Ends runs from another thread.
struct StopFlag {
  std::atomic<bool> set{false};
};

class Recorder : public RunObserver {
 public:
  Recorder(RunResult& result, nb::object on_sample, bool frames, std::shared_ptr<StopFlag> stop)
      : result_(result), on_sample_(std::move(on_sample)), frames_(frames), stop_(std::move(stop)) {}

  void on_start(const Variant& variant, const Simulation& simulation) override {
    advice_ = advise_at_rest(variant, simulation);
  }
  void on_built(const BuiltVariant& built) override {
    table_.emplace(*result_.variant, built);
    instruments_ = built.instruments;
    result_.forces->columns = table_->columns();
    for (const auto& file : table_->further()) {
      result_.further[file.name] = std::make_shared<Table>(Table{file.columns, {}});
    }
    if (built.probes.empty()) return;
    result_.probes->columns = {"time_s"};
    for (const std::string& column : built.probes.columns()) result_.probes->columns.push_back(column);
  }
  void on_sample(const Sample& sample) override {
    append(*result_.forces, table_->row(sample));
    if (!sample.probes.empty()) {
      append(*result_.probes, {sample.probe_time});
      append(*result_.probes, sample.probes);
    }
    for (const auto& file : table_->further()) append(*result_.further[file.name], ForceTable::row_of(file, sample));
    if (on_sample_.is_none()) return;
    const nb::gil_scoped_acquire gil;
    look_for_interrupt();
    nb::dict row;
    const auto& [columns, numbers] = *result_.forces;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      row[columns[i].c_str()] = numbers[numbers.size() - columns.size() + i];
    }
    on_sample_(row);
  }
  void on_event(const RunEvent& event) override { result_.events.push_back(event); }
  void on_frame(const Simulation& simulation) override {
    if (!frames_) return;
    const auto u = simulation.displacement();
    result_.frames.push_back({simulation.time(), {u.begin(), u.end()}});
  }
  void on_progress(double) override {
    const nb::gil_scoped_acquire gil;
    look_for_interrupt();
  }
  void on_end(const RunSummary& summary) override {
    const Variant& variant = *result_.variant;
    const std::string scene = std::filesystem::path(variant.scene_name).stem().string();
    result_.summary = json_text(summary_json(summary, variant, scene, 1, rejected_poses(instruments_), advice_));
    result_.end = word_of(summary.end);
    result_.trouble = trouble_text(summary);
  }

 private:
  static void append(Table& table, const std::vector<double>& row) {
    table.numbers.insert(table.numbers.end(), row.begin(), row.end());
  }
  static void look_for_interrupt() {
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  }

  RunResult& result_;
  std::optional<ForceTable> table_;
  std::vector<std::shared_ptr<Instrument>> instruments_;
  std::vector<Advice> advice_;
  nb::object on_sample_;
  bool frames_;
  std::shared_ptr<StopFlag> stop_;
};

std::shared_ptr<RunResult> run(const Variant& variant, std::optional<TetMesh> mesh, nb::object on_sample, bool frames,
                               std::shared_ptr<StopFlag> stop) {
  auto result = std::make_shared<RunResult>();
  result->variant = variant;
  result->name = variant.name;
  result->label = variant.label.empty() ? variant.name : variant.label;
  if (mesh) result->variant->mesh = MeshFile{};
  if (!stop) stop = std::make_shared<StopFlag>();
  Recorder recorder(*result, std::move(on_sample), frames, stop);
  const MeshLoader load = mesh_loader(std::move(mesh));
  const nb::gil_scoped_release free;
  run_variant(*result->variant, load, recorder, stop->set);
  return result;
}

nb::dict summary_dict(const RunResult& r) {
  return nb::cast<nb::dict>(nb::module_::import_("json").attr("loads")(r.summary));
}

nb::list event_dicts(const RunResult& r) {
  nb::list out;
  for (const RunEvent& e : r.events) {
    nb::dict event;
    event["time_s"] = e.what.time, event["depth_m"] = e.what.depth;
    event["event"] = e.what.event, event["instrument"] = e.instrument;
    out.append(event);
  }
  return out;
}

nb::list frame_pairs(const RunResult& r) {
  nb::list out;
  for (const Frame& f : r.frames) out.append(nb::make_tuple(f.time, vectors(f.displacement)));
  return out;
}

nb::tuple result_state(const RunResult& r) {
  return nb::make_tuple(r.name, r.label, r.forces, r.further, event_dicts(r), frame_pairs(r), r.summary, r.end,
                        r.trouble, r.probes);
}

RunResult result_of(const nb::tuple& state) {
  RunResult r{.variant = {},
              .name = nb::cast<std::string>(state[0]),
              .label = nb::cast<std::string>(state[1]),
              .forces = nb::cast<std::shared_ptr<Table>>(state[2]),
              .further = nb::cast<std::map<std::string, std::shared_ptr<Table>>>(state[3]),
              .probes = nb::cast<std::shared_ptr<Table>>(state[9]),
              .events = {},
              .frames = {},
              .summary = nb::cast<std::string>(state[6]),
              .end = nb::cast<std::string>(state[7]),
              .trouble = nb::cast<std::string>(state[8])};
  if (!r.forces || !r.probes) throw nb::cast_error();
  for (nb::handle event : nb::cast<nb::list>(state[4])) {
    RunEvent& e = r.events.emplace_back();
    e.instrument = nb::cast<std::string>(event["instrument"]), e.what.event = nb::cast<std::string>(event["event"]);
    e.what.time = nb::cast<double>(event["time_s"]), e.what.depth = nb::cast<double>(event["depth_m"]);
  }
  for (nb::handle frame : nb::cast<nb::list>(state[5])) {
    r.frames.push_back({nb::cast<double>(frame[0]), to_vectors(nb::borrow<ArrayLike>(frame[1]), "frames")});
  }
  return r;
}

/// A table of its columns and rows.
Table table_of(const nb::tuple& state) {
  using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
  const auto rows = nb::cast<Rows>(state[1]);
  Table table{nb::cast<std::vector<std::string>>(state[0]), {}};
  if (rows.shape(1) != table.columns.size()) throw nb::cast_error();
  table.numbers.assign(rows.data(), rows.data() + rows.size());
  return table;
}

const Variant& variant_of(const RunResult& r) {
  if (!r.variant)
    throw std::runtime_error("a result that was unpickled does not have its variant: read the scene again");
  return *r.variant;
}

/// A folder of results while it is written, as the program holds it: until `release`.
class HeldFolder {
 public:
  HeldFolder(const std::filesystem::path& folder, const std::function<void(const std::string&)>& warn) {
    try {
      held_ = std::make_unique<OutputFolder>(folder, warn, "give another folder as `out`");
    } catch (const std::invalid_argument& refused) {
      throw std::runtime_error(refused.what());
    }
  }
  void release() { held_.reset(); }

 private:
  std::unique_ptr<OutputFolder> held_;
};

void bind_folders(nb::module_& m) {
  nb::class_<HeldFolder>(m, "HeldFolder",
                         "A folder of results that no other process writes to, nor inside it or around it.")
      .def(nb::init<const std::filesystem::path&, const std::function<void(const std::string&)>&>(), "folder"_a,
           "warn"_a)
      .def("release", &HeldFolder::release);
}

void bind_tables(nb::module_& m) {
  nb::class_<Table>(m, "Table", "Columns of numbers, as in a .csv of a run: table[\"force_N\"].")
      .def_ro("columns", &Table::columns, "Names, with their units")
      .def("__getitem__", &Table::column, "name"_a)
      .def("__contains__",
           [](const Table& t, const std::string& name) {
             return std::find(t.columns.begin(), t.columns.end(), name) != t.columns.end();
           })
      .def("__len__", &Table::rows)
      .def_prop_ro(
          "array", [](nb::handle self) { return nb::cast<const Table&>(self).array(self); },
          "All of it, a row a sample: a read-only view",
          nb::sig("def array(self) -> numpy.typing.NDArray[numpy.float64]"))
      .def("to_csv", &Table::csv, "The bytes of the file that `glisson run` writes")
      .def(
          "to_dict",
          [](const Table& t) {
            nb::dict out;
            for (const std::string& name : t.columns) out[name.c_str()] = t.column(name);
            return out;
          },
          "Arrays by column, as pandas and polars take them",
          nb::sig("def to_dict(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"))
      .def(
          "__getstate__",
          [](nb::handle self) {
            const auto& table = nb::cast<const Table&>(self);
            return nb::make_tuple(table.columns, table.array(self).attr("copy")());
          },
          nb::sig(kGetState))
      .def(
          "__setstate__",
          [](Table& self, const nb::tuple& state) {
            set_pickled(self, state, "Table", 2, [&] { return table_of(state); });
          },
          nb::sig(kSetState))
      .def("__repr__", [](const Table& t) {
        return "<Table of " + std::to_string(t.rows()) + " rows, " + std::to_string(t.columns.size()) + " columns>";
      });
}

}  // namespace

void bind_results(nb::module_& m) {
  bind_tables(m);
  bind_folders(m);
  nb::class_<StopFlag>(m, "StopFlag", "Ends runs from another thread, at their next step.")
      .def(nb::init<>())
      .def("stop", [](StopFlag& flag) { flag.set = true; });
  nb::class_<RunResult>(m, "RunResult", "Results of one variant: result[\"force_N\"] is a column of forces.csv.")
      .def_ro("name", &RunResult::name, "Of the variant")
      .def_ro("label", &RunResult::label, "Of the variant, for charts")
      .def_prop_ro("variant", variant_of, "What was run; a result that was unpickled does not have it")
      .def_ro("forces", &RunResult::forces, "forces.csv")
      .def_ro("further", &RunResult::further, "forces_<name>.csv of every further tool and instrument")
      .def_ro("probes", &RunResult::probes, "probes.csv, whose rows belong to those of forces; empty without probes")
      .def(
          "__getitem__", [](const RunResult& r, const std::string& name) { return r.forces->column(name); }, "name"_a)
      .def_prop_ro(
          "columns", [](const RunResult& r) { return r.forces->columns; }, "Of forces.csv")
      .def_prop_ro("events", event_dicts, "events.csv: punctures, releases and the like",
                   nb::sig("def events(self) -> list[dict[str, typing.Any]]"))
      .def_prop_ro("frames", frame_pairs, "Time [s] and displacement [m] of every frame, where they were asked for",
                   nb::sig("def frames(self) -> list[tuple[float, numpy.typing.NDArray[numpy.float64]]]"))
      .def_prop_ro("summary", summary_dict, "summary.json", nb::sig("def summary(self) -> dict[str, typing.Any]"))
      .def_ro("end", &RunResult::end, "How it ended: finished, interrupted, stopped_inverted, …")
      .def_ro("trouble", &RunResult::trouble, "Message about a numerical failure, with a remedy; else empty")
      .def("__getstate__", result_state, nb::sig(kGetState))
      .def(
          "__setstate__",
          [](RunResult& self, const nb::tuple& state) {
            set_pickled(self, state, "RunResult", 10, [&] { return result_of(state); });
          },
          nb::sig(kSetState))
      .def("__repr__", [](const RunResult& r) {
        return "<RunResult " + r.name + ": " + std::to_string(r.forces->rows()) + " samples, " + r.end + ">";
      });
  m.def("run_variant", run, "variant"_a, "mesh"_a = nb::none(), "on_sample"_a = nb::none(), "frames"_a = false,
        "stop"_a = nb::none(), doc("run_variant"),
        nb::sig("def run_variant(variant: Variant, mesh: TetMesh | None = None, on_sample: "
                "collections.abc.Callable[[dict[str, float]], object] | None = None, frames: bool = False, stop: "
                "StopFlag | None = None) -> RunResult"));
}

}  // namespace glisson::python
