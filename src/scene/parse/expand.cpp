#include "scene/parse/expand.h"

#include <algorithm>

#include "base/nearest.h"
#include "scene/parse/presets.h"
#include "scene/parse/sections.h"
#include "scene/parse/tissue_file.h"

namespace glisson::scene {
namespace {

constexpr std::size_t kMostVariants = 1000;

/// One --set, ready to be laid over: the path as nested tables.
struct Overlay {
  std::string variant;  ///< empty: all
  bool scene_key = false;
  Node tree;
};

Node nested(std::span<const std::string> path, const Node& value) {
  if (path.empty()) return value;
  return {Table{{path.front(), value.where, nested(path.subspan(1), value)}}, value.where};
}

std::vector<Overlay> overlays_of(std::span<const Override> overrides, Problems& problems) {
  std::vector<Overlay> overlays;
  for (const Override& o : overrides) {
    const std::vector<std::string> path = split_key(o.key);
    const Node value = parse_override_value(o.key, o.value);
    const bool for_one = !path.empty() && path.front() == "variant";
    if (path.empty() || (for_one && path.size() < 3)) {
      problems.add(value.where, "",
                   "not a key; write --set tissue.density_kg_m3=1060, tool.0.depth_mm=5 or variant.NAME.tissue.…");
      continue;
    }
    const std::span<const std::string> all(path);
    if (for_one)
      overlays.push_back({path[1], false, nested(all.subspan(2), value)});
    else
      overlays.push_back({"", scene_section().find(path.front()) != nullptr, nested(all, value)});
  }
  return overlays;
}

/// The variants as written; one without overrides where there are none.
Array written_variants(const Node& root, Problems& problems) {
  const Node* list = root.find("variant");
  Node main{Table{}, root.where};
  if (!list) return {main};
  if (!list->array() || list->array()->empty() || list->array()->size() > kMostVariants) {
    problems.add(
        list->where, "variant",
        "expected 1 to " + std::to_string(kMostVariants) + " tables, each headed [[variant]], got " + describe(*list));
    return {main};
  }
  Array variants;
  for (const Node& v : *list->array()) {
    if (!v.table())
      problems.add(v.where, "variant", "expected a table, got " + describe(v));
    else if (!v.find("name"))
      problems.add(v.where, "variant", "missing key `name`: text in quotes; its results go to OUT/NAME/");
    else
      variants.push_back(v);
  }
  return variants.empty() ? Array{main} : variants;
}

std::string name_of(const Node& variant) {
  const Node* name = variant.find("name");
  return name && name->text() ? *name->text() : "main";
}

void require_known(const Overlay& overlay, const Array& variants, Problems& problems) {
  std::vector<std::string> names;
  for (const Node& v : variants) names.push_back(name_of(v));
  if (overlay.variant.empty() || std::find(names.begin(), names.end(), overlay.variant) != names.end()) return;
  const std::string meant = nearest(overlay.variant, names);
  problems.add(overlay.tree.where, "",
               "no variant \"" + overlay.variant + "\"; " +
                   (meant.empty() ? "the scene has: " + listed(names) : "did you mean \"" + meant + "\"?"));
}

/// Puts in what the presets and files of the body and its regions stand for. Twice is as once.
void put_presets(Node& experiment, const std::filesystem::path& files, Problems& problems) {
  const auto put = [&](Node& tissue, bool named, const Place& place) {
    tissue = with_tissue_file(tissue, files, place);
    tissue = with_preset(tissue, named, place);
  };
  if (Node* tissue = experiment.find("tissue")) put(*tissue, true, {problems, "tissue", tissue->where});
  Node* heat = experiment.find("heat");
  Node* thermal = heat && heat->table() ? heat->find("tissue") : nullptr;
  for (std::size_t i = 0; thermal && thermal->array() && i < thermal->array()->size(); ++i) {
    Node& own = (*thermal->array())[i];
    if (own.table()) own = with_thermal_preset(own, {problems, "heat.tissue." + std::to_string(i), own.where});
  }
  Node* regions = experiment.find("region");
  if (!regions || !regions->array()) return;
  for (std::size_t i = 0; i < regions->array()->size(); ++i) {
    Node* own = (*regions->array())[i].find("tissue");
    if (own) put(*own, false, {problems, "region." + std::to_string(i) + ".tissue", own->where});
  }
}

/// `overlay` over `base`, presets put in: what is laid over it next may change single keys of theirs.
Node laid(const Node& base, const Node& overlay, const std::filesystem::path& files, Problems& problems) {
  Node experiment = merged(variant_section(), base, overlay, {problems, "", overlay.where});
  put_presets(experiment, files, problems);
  return experiment;
}

/// Gives each region the keys of [tissue] that it does not set itself; none where it has a preset of its own.
void inherit_tissue(Node& experiment, Problems& problems) {
  const Node* tissue = experiment.find("tissue");
  Node* regions = experiment.find("region");
  if (!regions || !regions->array()) return;
  Node base = tissue && tissue->table() ? *tissue : Node{Table{}, {}};
  std::erase_if(*base.table(), [](const Member& m) { return m.key == "name"; });
  for (Node& region : *regions->array()) {
    if (!region.table()) continue;
    if (Node* own = region.find("tissue")) {
      *own = merged(tissue_section(), base, *own, {problems, "region.tissue", own->where});
    } else {
      base.where = region.where;
      region.table()->push_back({"tissue", region.where, base});
    }
  }
}

}  // namespace

Expanded expand(const Node& root, std::span<const Override> overrides, const std::filesystem::path& files,
                Problems& problems) {
  Expanded result{Node{Table{}, root.where}, Node{Table{}, root.where}, {}};
  for (const Member& m : *root.table()) {
    if (m.key == "variant") continue;
    (scene_section().find(m.key) ? result.scene : result.base).table()->push_back(m);
  }
  const Array variants = written_variants(root, problems);
  const std::vector<Overlay> overlays = overlays_of(overrides, problems);
  for (const Overlay& o : overlays) {
    require_known(o, variants, problems);
    if (o.scene_key) result.scene = merged(scene_section(), result.scene, o.tree, {problems, "", o.tree.where});
  }
  Node base = result.base;
  put_presets(base, files, problems);
  for (const Node& variant : variants) {
    Node experiment = laid(base, variant, files, problems);
    for (const Overlay& o : overlays) {
      const bool meant = !o.scene_key && (o.variant.empty() || o.variant == name_of(variant));
      if (meant) experiment = laid(experiment, o.tree, files, problems);
    }
    experiment.where = variant.where;
    inherit_tissue(experiment, problems);
    result.variants.push_back(std::move(experiment));
  }
  return result;
}

}  // namespace glisson::scene
