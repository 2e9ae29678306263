#include "scene/parse/tissue_file.h"

#include <algorithm>
#include <optional>

#include "base/input_file.h"
#include "glisson/scene/scene.h"
#include "scene/parse/presets.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

/// The [tissue] of a file; none, and a complaint, where there is none.
std::optional<Node> read_tissue(const std::filesystem::path& file, const Place& place) {
  const detail::InputFile input = detail::read_input(file, detail::kTomlInput);
  if (!input.problem.empty()) {
    place.complain(input.problem + "; the path is relative to the scene");
    return {};
  }
  try {
    const Node root = parse_document(input.bytes, file.string());
    const Node* tissue = root.find("tissue");
    if (tissue && tissue->table()) return *tissue;
    place.complain(file.string() + " has no [tissue]; it is to hold one, as `glisson fit` writes it");
  } catch (const SceneError& problem) {
    place.complain(problem.what());
  }
  return {};
}

}  // namespace

Node with_tissue_file(const Node& tissue, const std::filesystem::path& base, const Place& place) {
  const Node* word = tissue.find("file");
  if (!word || !word->text() || tissue.find("preset")) return tissue;
  std::filesystem::path path = *word->text();
  if (path.is_relative()) path = base / path;
  const Place here = place.inside("file", word->where);
  std::optional<Node> held = read_tissue(path, here);
  if (!held) return tissue;
  if (held->find("file")) {
    here.complain(path.string() + " names a `file` in turn; a tissue file holds the keys themselves");
    return tissue;
  }
  set_origin(*held, word->where);
  Node own = tissue;
  std::erase_if(*own.table(), [](const Member& m) { return m.key == "file"; });
  if (held->find("preset")) {
    *held = with_preset(*held, true, here);
    std::erase_if(*held->table(), [](const Member& m) { return m.key == "preset"; });
  }
  Node result = merged(tissue_section(), *held, own, place);
  result.table()->push_back({"file", word->where, *word});
  return result;
}

std::string tissue_file_text(const Node& tissue) {
  std::string text = "[tissue]\n";
  for (const Member& m : *tissue.table()) text += toml_key(m.key) + " = " + toml_text(m.value) + "\n";
  return text;
}

}  // namespace glisson::scene
