// run_folder.h — what `glisson run` left in a folder, for showing it again: times and files of its frames, forces, events.
//
//   DIR/<variant>/  frames.pvd  frames/*.vtu   view.jsonl     forces.csv forces_<name>.csv   events.csv
//                   times       read on demand who and where  thinned to 100 000 lines       all
//
// A run that broke off opens as far as its files go, and says so.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "view/replay/force_lines.h"
#include "view/state/snapshot.h"

namespace glisson::view {

/// One frame, not yet read.
struct RunFrame {
  double time = 0.0;  ///< [s]
  std::filesystem::path file;
  std::vector<ToolState> instruments;                   ///< places, without depth and force
  std::shared_ptr<const std::vector<Triangle>> torn{};  ///< of capsules; none, or the same as that of the frame before
};

struct RunFolder {
  std::string title, label;
  std::vector<ToolInfo> tools;  ///< driven sets, then instruments
  std::string forms = "[]";     ///< of the instruments, a JSON list as web/src/report_data.ts has it
  std::string
      vessel{};  ///< VesselForm of web/src/report_data.ts, `height_m` null where its wall has no end; empty: there is no container
  std::vector<std::string> held, driven;  ///< names of vertex sets
  std::vector<RunFrame> frames;           ///< one or more, ascending in time
  std::vector<ForceLine> forces;          ///< ascending in time; may be none
  std::vector<LiveEvent> events;
  std::vector<std::string> variants;  ///< that the folder holds
  std::string variant;                ///< the one that this is
  std::string notice;                 ///< what is missing; empty: nothing
};

/// Whether a path is a folder, which view takes for a run.
bool is_folder(const std::filesystem::path& path);

/// @param variant  empty: the first that has frames
/// @throws std::invalid_argument with the way out where the folder holds no run that can be shown
RunFolder open_run(const std::filesystem::path& folder, const std::string& variant);

}  // namespace glisson::view
