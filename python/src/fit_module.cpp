// fit_module.cpp — glisson._fit: fits of tissues to measured curves. A module of its own, so that Ceres is only loaded
// where something is fitted.
#include <atomic>

#include "bind.h"
#include "fit/files/fit_json.h"
#include "fit/files/fit_state.h"
#include "fit/laws/law_candidates.h"
#include "fit/run_fit.h"
#include "live_simulation.h"
#include "report/json_text.h"

namespace {

namespace nb = nanobind;
using namespace glisson;

/// Goes on from what an interrupted run of the same fit left in a file, and keeps the file up to date.
void remember_in(const std::filesystem::path& state, const fit::FitSpec& spec, fit::FitRun& options) {
  const std::string fingerprint = fit_fingerprint(spec, options);
  if (auto known = read_fit_state(state, fingerprint)) options.memory = std::move(*known);
  options.remember = [state, fingerprint](const fit::FitMemory& memory) {
    write_fit_state(state, fingerprint, memory);
  };
}

/// The text of fit.json, and that of tissue.toml. Progress is told to Python, where Ctrl-C ends the fit with what is known.
std::pair<std::string, std::string> run(fit::FitSpec spec, const std::vector<std::string>& laws,
                                        const std::filesystem::path& data, std::optional<int> starts,
                                        std::optional<int> bootstrap, const nb::object& progress,
                                        const std::filesystem::path& state, int discover) {
  if (discover < 0 || discover > 4)
    throw std::invalid_argument("discover = " + std::to_string(discover) + " is out of range; allowed: 0 to 4 terms");
  if (starts) spec.search.starts = *starts;
  if (bootstrap) spec.proof.bootstrap = *bootstrap;
  std::atomic<bool> stop{false};
  std::exception_ptr raised;
  fit::FitRun options;
  options.laws = laws;
  options.discover = discover;
  options.data_folder = data;
  options.load = python::mesh_loader();
  options.stop = &stop;
  options.progress = [&](const fit::FitProgress& p) {
    const nb::gil_scoped_acquire gil;
    try {
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
      if (!progress.is_none() && !raised) progress(p.stage, p.done, p.planned, p.best_rms);
    } catch (...) {
      if (!raised) raised = std::current_exception();
      stop = true;
    }
  };
  if (!state.empty()) remember_in(state, spec, options);
  fit::FitResult result;
  {
    const nb::gil_scoped_release free;
    result = fit::run_fit(spec, options);
    if (result.complete && !state.empty()) std::filesystem::remove(state);
  }
  if (raised) std::rethrow_exception(raised);
  const FitHeading heading{spec.file.stem().string(), spec.title, spec.description, spec.notes, spec.source};
  return {json_text(fit_json(result, heading), 1) + "\n", result.tissue};
}

}  // namespace

NB_MODULE(_fit, m) {
  using namespace nb::literals;
  nb::module_::import_("glisson._core");
  nb::class_<fit::FitSpec>(m, "FitSpec", "What a FIT.toml says.")
      .def_ro("title", &fit::FitSpec::title)
      .def_ro("description", &fit::FitSpec::description)
      .def_ro("source", &fit::FitSpec::source)
      .def_prop_ro(
          "parameters",
          [](const fit::FitSpec& spec) {
            std::vector<std::string> keys;
            for (const auto& parameter : spec.parameters) keys.push_back(parameter.key);
            return keys;
          },
          "Keys of the free numbers");
  m.def("load_fit", &fit::load_fit, "file"_a, "Reads FIT.toml.\n:raises SceneError: with every problem of the file");
  m.def(
      "parse_fit",
      [](const std::string& text, const std::string& name, const std::filesystem::path& base) {
        return fit::parse_fit(text, (base / (name + ".toml")).string());
      },
      "text"_a, "name"_a = "fit", "base"_a = std::filesystem::path("."), "The same from text.");
  m.def(
      "known_laws",
      [] {
        std::vector<std::pair<std::string, std::string>> laws;
        for (const fit::LawName& law : fit::known_laws()) laws.emplace_back(law.name, law.what);
        return laws;
      },
      "Names of the laws that a fit can compare, and what they are");
  m.def("run", run, "spec"_a, "laws"_a = std::vector<std::string>{}, "data"_a = std::filesystem::path{},
        "starts"_a = nb::none(), "bootstrap"_a = nb::none(), "progress"_a = nb::none(),
        "state"_a = std::filesystem::path{}, "discover"_a = 0, "The texts of fit.json and tissue.toml.",
        nb::sig("def run(spec: FitSpec, laws: collections.abc.Sequence[str] = [], data: str | os.PathLike[str] = '', "
                "starts: int | None = None, bootstrap: int | None = None, progress: "
                "collections.abc.Callable[[str, int, int, float], object] | None = None, state: str | os.PathLike[str] "
                "= '', discover: int = 0) -> tuple[str, str]"));
}
