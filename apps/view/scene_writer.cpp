// scene_writer.cpp — see scene_writer.h.
#include "view/scene_writer.h"

#include "scene/recorded_scene.h"
#include "view/live_parameters.h"

namespace glisson::view {
namespace {

std::string head_of(const Scene& scene, const Variant& variant, const Recording& recording) {
  std::string head = "Recorded in glisson view: " + scene.title + ", " +
                     (variant.label.empty() ? variant.name : variant.label) +
                     ".\n`glisson run scene.toml` goes these ways again; what was felt then is in forces.csv.\n";
  if (const auto* mesh = std::get_if<MeshFile>(&variant.mesh); mesh != nullptr && scene.file.has_filename())
    head += "Its mesh is a file: put this beside " + scene.file.filename().string() + ", or give `--mesh FILE`.\n";
  const std::string unsaid = recording.unsaid();
  if (!unsaid.empty())
    head += "\nNot in this scene, as none can say it, so that forces differ from then on:\n" + unsaid;
  return head;
}

}  // namespace

std::vector<ZipFile> recording_files(const Scene& given, const Variant& variant, const std::vector<Override>& overrides,
                                     const std::vector<ToolInfo>& tools, const Recording& recording,
                                     const std::vector<double>& parameters) {
  Variant now = variant;
  const std::vector<TissueParameter> handles = tissue_parameters(variant);
  for (std::size_t i = 0; i < parameters.size(); ++i) set_parameter(now, handles.at(i), parameters[i]);
  scene::RecordedWays ways{
      .head = head_of(given, variant, recording), .files = {}, .duration = recording.duration(), .sample_rate = 1000.0};
  std::vector<ZipFile> files;
  for (std::size_t i = 0; i < tools.size(); ++i) {
    ways.files.push_back(way_file(tools, i));
    files.push_back({ways.files.back(), recording.way_csv(i)});
  }
  files.push_back({"forces.csv", recording.forces_csv(tools)});
  const std::filesystem::path base = given.file.parent_path();
  files.push_back({"scene.toml", scene::recorded_scene(given.source, given.file.string(), base, overrides, now, ways)});
  return files;
}

RecordingWriter recording_writer(Scene scene, Variant variant, std::vector<Override> overrides,
                                 std::vector<ToolInfo> tools) {
  return [=](const Recording& recording, const std::vector<double>& parameters) {
    return zip(recording_files(scene, variant, overrides, tools, recording, parameters));
  };
}

}  // namespace glisson::view
