// run_fuzz.cpp — damaged files in the folder of a run: what `glisson view DIR` shows, or a reason, nothing else.
//
// An input holds files (support.h, files_in) that replace those of a small run, base/run; `=== - NAME` removes one. What is
// opened goes the way to the viewer: states at five times, and every message that a server would send.
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "glisson/io.h"
#include "support.h"
#include "view/protocol/messages.h"
#include "view/replay/replay.h"
#include "view/replay/run_folder.h"

namespace {

namespace fs = std::filesystem;
using namespace glisson;
using fuzz::require;

/// The small run, laid out anew before every input.
class Run {
 public:
  Run() : folder_(fuzz::scratch() / "run") {
    const fs::path base = fs::path(GLISSON_FUZZ_BASE) / "run";
    for (const auto& entry : fs::recursive_directory_iterator(base)) {
      if (entry.is_regular_file())
        files_[entry.path().lexically_relative(base).string()] = fuzz::read_file(entry.path());
    }
    for (const char* more : {"main/forces_press.csv", "main/forces_extra.csv"}) files_[more];
    fs::create_directories(folder_ / "main/frames");
    for (const auto& [name, bytes] : files_) set(name, bytes);
  }
  void lay_out(std::string_view input) {
    for (const std::string& name : changed_) set(name, files_.at(name));
    changed_.clear();
    for (auto& [name, bytes] : fuzz::files_in(input)) {
      const bool gone = name.substr(0, 2) == "- ";
      if (gone) name.erase(0, 2);
      if (files_.find(name) == files_.end()) continue;  // none that a run has
      changed_.push_back(name);
      gone ? static_cast<void>(fs::remove(folder_ / name)) : set(name, bytes);
    }
  }
  const fs::path& folder() const { return folder_; }

 private:
  void set(const std::string& name, std::string_view bytes) const { fuzz::write_file(folder_ / name, bytes); }

  fs::path folder_;
  std::map<std::string, std::string> files_;
  std::vector<std::string> changed_;
};

void require_json(const std::string& text) { require(nlohmann::json::accept(text), "a message is JSON, in UTF-8"); }

void require_messages(const view::Snapshot& state) {
  require(state.shape != nullptr && state.displacement.size() == state.shape->mesh.vertices.size(),
          "a state has a displacement for each vertex");
  const view::Surface surface(state.shape);
  require(!view::keyframe_message(surface, state.shape_number).empty(), "there is a keyframe");
  require(!view::frame_message(state, surface, state.shape_number).empty(), "there is a frame");
  require_json(view::state_message(state, surface.pieces()));
  require_json(view::notice_message(state.notice));
}

void show(view::RunFolder run) {
  const double first = run.frames.front().time, last = run.frames.back().time;
  const view::SceneFacts facts{
      .title = run.title, .variant = run.label, .version = "fuzz", .instruments = run.forms, .recorder = {}};
  view::Replay replay(std::move(run));
  require_json(view::hello_message(replay, facts, "session"));
  for (const double share : {0.0, 0.3, 0.5, 0.8, 1.0}) {
    replay.show(first + share * (last - first));
    const view::Snapshot* state = replay.latest();
    require(state != nullptr, "what was shown is the latest");
    require_messages(*state);
  }
  for (view::ForceSample sample; replay.next_sample(sample);) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Run run;
  run.lay_out({reinterpret_cast<const char*>(data), size});
  try {
    show(view::open_run(run.folder(), ""));
  } catch (const std::invalid_argument& error) {
    require(std::string_view(error.what()).find(run.folder().string()) == 0, "a refusal begins with the folder");
  } catch (const FileError&) {
    // the first frame is no frame
  }
  return 0;
}
