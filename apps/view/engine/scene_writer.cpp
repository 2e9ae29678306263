// scene_writer.cpp — see scene_writer.h.
#include "view/engine/scene_writer.h"

#include <algorithm>

#include "glisson/scene/recorded_scene.h"
#include "report/json_text.h"
#include "view/engine/live_parameters.h"

namespace glisson::view {
namespace {

/// Whether the mesh is made of files.
bool has_files(const MeshSource& mesh) {
  const auto* body = std::get_if<ImplicitBody>(&mesh);
  return std::holds_alternative<MeshFile>(mesh) || std::holds_alternative<ImageBody>(mesh) ||
         (body != nullptr && std::any_of(body->shapes.begin(), body->shapes.end(), [](const NamedShape& s) {
            return std::holds_alternative<SurfaceShape>(s.what);
          }));
}

std::string head_of(const Scene& scene, const Variant& variant, const Recording& recording) {
  std::string head = "Recorded in glisson view: " + scene.title + ", " +
                     (variant.label.empty() ? variant.name : variant.label) +
                     ".\n`glisson run scene.toml` follows these paths again; the recorded forces are in forces.csv.\n";
  if (has_files(variant.mesh) && scene.file.has_filename())
    head += "Its mesh is a file: put this next to " + scene.file.filename().string() + ", or give `--mesh FILE`.\n";
  const std::string unsaid = recording.unsaid();
  if (!unsaid.empty())
    head += "\nNot part of this scene, because a scene cannot describe it; forces differ from then on:\n" + unsaid;
  return head;
}

}  // namespace

std::vector<ZipFile> recording_files(const Scene& given, const Variant& variant, const std::vector<Override>& overrides,
                                     const std::vector<ToolInfo>& tools, std::shared_ptr<const Recording> recording,
                                     const std::vector<double>& parameters) {
  Variant now = variant;
  const std::vector<TissueParameter> handles = tissue_parameters(variant);
  for (std::size_t i = 0; i < parameters.size(); ++i) set_parameter(now, handles.at(i), parameters[i]);
  RecordedPaths ways{.head = head_of(given, variant, *recording),
                     .files = {},
                     .duration = recording->duration(),
                     .sample_rate = 1000.0};
  std::vector<ZipFile> files;
  for (std::size_t i = 0; i < tools.size(); ++i) {
    ways.files.push_back(way_file(tools, i));
    files.push_back({ways.files.back(), [recording, i](const TextSink& out) { recording->way_csv(i, out); }});
  }
  files.push_back({"forces.csv", [recording, tools](const TextSink& out) { recording->forces_csv(tools, out); }});
  const std::filesystem::path base = given.file.parent_path();
  const std::string text = recorded_scene(given.source, given.file.string(), base, overrides, now, ways);
  files.push_back(text_file("scene.toml", valid_utf8(text)));
  return files;
}

RecordingWriter recording_writer(Scene scene, Variant variant, std::vector<Override> overrides,
                                 std::vector<ToolInfo> tools) {
  return [=](std::shared_ptr<const Recording> recording, const std::vector<double>& parameters) {
    return recording_files(scene, variant, overrides, tools, std::move(recording), parameters);
  };
}

}  // namespace glisson::view
