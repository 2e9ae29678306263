// run_folder.cpp — see run_folder.h.
#include "view/replay/run_folder.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <stdexcept>

#include "glisson/io.h"
#include "glisson/scene/scene.h"
#include "report/json_field.h"
#include "view/replay/outside_file.h"
#include "view/replay/variant_folder.h"
#include "view/replay/view_lines.h"

namespace glisson::view {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& folder, const std::string& why) {
  throw std::invalid_argument(folder.string() + ": " + why);
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

void take_frames(const fs::path& folder, RunFolder& run) {
  if (is_file(folder / "heat.csv") && !is_file(folder / "view.jsonl")) {
    refuse(folder,
           "a run of heat alone, which the view does not show yet; open report.html, draw it by `glisson picture`, or "
           "open "
           "frames.pvd in ParaView");
  }
  const std::size_t named = [&] {
    std::vector<std::pair<double, fs::path>> frames;
    try {
      frames = read_pvd(folder / "frames.pvd");
    } catch (const FileError& error) {
      refuse(folder, std::string(error.what()) + "; run the scene again");
    }
    for (const auto& [time, file] : frames) {
      if (!is_file(folder / file)) break;
      if (run.frames.empty() || time > run.frames.back().time) run.frames.push_back({time, folder / file, {}, {}});
    }
    return frames.size();
  }();
  if (run.frames.empty())
    refuse(folder, "none of its " + std::to_string(named) + " frames is there; run the scene again");
  if (run.frames.size() < named)
    run.notice += "Only " + std::to_string(run.frames.size()) + " of " + std::to_string(named) + " frames are there.\n";
}

void take_forces(const fs::path& folder, RunFolder& run) {
  if (run.tools.empty()) run.tools.push_back({.name = "tool", .direction = {0.0, 0.0, -1.0}});
  if (run.tools.size() > kMostTools) run.tools.resize(kMostTools);
  std::vector<fs::path> files{folder / "forces.csv"};
  for (std::size_t i = 1; i < run.tools.size(); ++i) files.push_back(folder / ("forces_" + run.tools[i].name + ".csv"));
  for (const fs::path& file : files) can_be_read(file, std::numeric_limits<std::uintmax_t>::max());
  try {
    run.forces = read_forces(files);
  } catch (const std::runtime_error& error) {
    run.notice += std::string(error.what()) + ": no forces are shown.\n";
  }
}

void take_events(const fs::path& file, RunFolder& run) {
  std::ifstream stream = open_outside(file);
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line) && !stream.eof()) {
    const std::size_t a = line.find(','), b = line.find(',', a + 1), c = line.find(',', b + 1);
    if (c == std::string::npos) return;
    try {
      run.events.push_back({line.substr(c + 1), line.substr(b + 1, c - b - 1), std::stod(line.substr(0, a)),
                            std::stod(line.substr(a + 1, b - a - 1))});
    } catch (const std::exception&) {
      return;
    }
  }
}

/// How the run ended: a summary is the last that it writes. What is none is told, and the run is shown.
void take_end(const fs::path& file, RunFolder& run) {
  if (!can_be_read(file)) {
    run.notice += "The run was interrupted, or is still running: it is shown up to its last complete frame.\n";
    return;
  }
  std::ifstream stream = open_outside(file);
  try {
    const nlohmann::json summary = parse_json(std::string{std::istreambuf_iterator<char>(stream), {}});
    const std::string end = JsonField(summary).at("end").text();
    if (end != "finished") run.notice += "The run ended early: " + end + ".\n";
  } catch (const JsonError& error) {
    run.notice += "summary.json is damaged: " + std::string(error.what()) + "; the end of the run is unknown.\n";
  }
}

/// The heading that the scene beside the run gives, where it can be read.
void take_title(const fs::path& file, RunFolder& run) {
  std::ifstream stream = open_outside(file);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  try {
    const std::string title = parse_scene(text, file.string(), file.parent_path()).title;
    if (!title.empty()) run.title = title;
  } catch (const std::exception&) {  // a mesh or a record that the scene names is elsewhere
  }
}

}  // namespace

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

RunFolder open_run(const fs::path& given, const std::string& variant) {
  const fs::path folder = fs::weakly_canonical(given);
  RunFolder run;
  VariantFolder found = variant_folder(folder, variant);
  const fs::path own = found.path;
  run.variant = std::move(found.variant);
  run.variants = std::move(found.variants);
  take_frames(own, run);
  run.title = run.label = run.variant;
  take_view_file(own / "view.jsonl", run);
  take_forces(own, run);
  take_events(own / "events.csv", run);
  take_end(own / "summary.json", run);
  take_title((own == folder ? folder.parent_path() : folder) / "scene.toml", run);
  if (!run.notice.empty()) run.notice.pop_back();
  return run;
}

}  // namespace glisson::view
