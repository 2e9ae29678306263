#include "scene/parse/presets.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "base/nearest.h"
#include "glisson/scene/tissue_presets.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson {
namespace {

using namespace scene;

const Node& preset_list() {
  static const Node root = parse_document(kPresetList, "preset_list.toml");
  return root;
}
const Array& preset_nodes() { return *preset_list().find("preset")->array(); }
const Array& thermal_nodes() { return *preset_list().find("thermal")->array(); }

const Node* find_preset(std::string_view name, const Array& nodes = preset_nodes()) {
  for (const Node& node : nodes) {
    if (*node.find("name")->text() == name) return &node;
  }
  return nullptr;
}

/// A value as TOML, tables in one line.
std::string toml_value(const Node& node) {
  struct {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return std::to_string(i); }
    std::string operator()(double d) const { return show(d); }
    std::string operator()(const std::string& s) const { return '"' + s + '"'; }
    std::string operator()(const Foreign&) const { return {}; }
    std::string operator()(const Array& elements) const {
      std::string text;
      for (const Node& e : elements) text += (text.empty() ? "" : ", ") + toml_value(e);
      return "[" + text + "]";
    }
    std::string operator()(const Table& members) const {
      std::string text;
      for (const Member& m : members) text += (text.empty() ? "" : ", ") + m.key + " = " + toml_value(m.value);
      return "{ " + text + " }";
    }
  } text;
  return std::visit(text, node.value);
}

std::string tissue_toml(const std::string& name, const Node& tissue) {
  std::string text = "[tissue]\nname = \"" + name + "\"\n";
  for (const Member& m : *tissue.table()) text += m.key + " = " + toml_value(m.value) + "\n";
  return text;
}

/// The first member of a tissue that excludes `key`; nullptr where there is none.
const Member* excluder_of(const std::string& key, const Node& tissue) {
  const auto has = [](const std::vector<std::string>& group, const std::string& word) {
    return std::find(group.begin(), group.end(), word) != group.end();
  };
  for (const Exclusion& exclusion : tissue_section().exclusions) {
    const auto with_key = [&](const auto& group) { return has(group, key); };
    if (std::none_of(exclusion.groups.begin(), exclusion.groups.end(), with_key)) continue;
    for (const Member& m : *tissue.table()) {
      const auto other = [&](const auto& group) { return has(group, m.key) && !has(group, key); };
      if (std::any_of(exclusion.groups.begin(), exclusion.groups.end(), other)) return &m;
    }
  }
  return nullptr;
}

const SectionSpec& preset_section() {
  static const SectionSpec section = [] {
    Section<TissuePreset> s("preset", "A tissue with its source.");
    s.key("name", &TissuePreset::name, "name").must();
    s.key("what", &TissuePreset::what, "what it is").must();
    s.key("source", &TissuePreset::source, "the work").must();
    s.key("fitted_to", &TissuePreset::fitted_to, "the measurement").must();
    s.key("validity", &TissuePreset::validity, "where it holds").must();
    s.key("confirmed", &TissuePreset::confirmed, "how the figures were checked").must();
    s.table("tissue", tissue_section(), &TissuePreset::tissue, "its keys").must();
    s.finish([](TissuePreset& p, const Node& table, const Place&) {
      p.tissue.name = p.name;
      p.toml = tissue_toml(p.name, *table.find("tissue"));
    });
    return s.spec();
  }();
  return section;
}

std::vector<ThermalPreset> read_thermal_presets() {
  Problems problems("preset_list.toml");
  std::vector<ThermalPreset> presets;
  for (const Node& node : thermal_nodes()) {
    const auto text = [&node](const char* key) { return *node.find(key)->text(); };
    HeatTissueSpec read;
    read_section(heat_tissue_section(), *node.find("tissue"), &read, {problems, "thermal.tissue", node.where});
    presets.push_back({text("name"), text("what"), text("source"), text("confirmed"), read.tissue});
  }
  problems.throw_if_any();
  return presets;
}

std::vector<TissuePreset> read_presets() {
  Problems problems("preset_list.toml");
  std::vector<TissuePreset> presets;
  for (const Node& node : preset_nodes()) {
    read_section(preset_section(), node, &presets.emplace_back(), {problems, "preset", node.where});
  }
  problems.throw_if_any();
  return presets;
}

}  // namespace

namespace scene {

const std::vector<AllowedWord>& preset_words() {
  static const std::vector<AllowedWord> words = [] {
    std::vector<AllowedWord> list;
    for (const Node& node : preset_nodes()) list.push_back({*node.find("name")->text(), *node.find("what")->text()});
    return list;
  }();
  return words;
}

const std::vector<AllowedWord>& thermal_preset_words() {
  static const std::vector<AllowedWord> words = [] {
    std::vector<AllowedWord> list;
    for (const Node& node : thermal_nodes()) list.push_back({*node.find("name")->text(), *node.find("what")->text()});
    return list;
  }();
  return words;
}

Node with_thermal_preset(const Node& tissue, const Place& place) {
  const Node* word = tissue.find("preset");
  const Node* preset = word && word->text() ? find_preset(*word->text(), thermal_nodes()) : nullptr;
  if (!preset) return tissue;
  Node base = *preset->find("tissue");
  set_origin(base, word->where);
  Node own = tissue;
  std::erase_if(*own.table(), [](const Member& m) { return m.key == "preset"; });
  Node result = merged(heat_tissue_section(), base, own, place);
  result.table()->push_back({"preset", word->where, *word});
  return result;
}

Node with_preset(const Node& tissue, bool named, const Place& place) {
  const Node* word = tissue.find("preset");
  const Node* preset = word && word->text() ? find_preset(*word->text()) : nullptr;
  if (!preset) return tissue;
  Node base = *preset->find("tissue");
  set_origin(base, word->where);
  if (named) base.table()->push_back({"name", word->where, Node{*word->text(), word->where}});
  Node own = tissue;
  std::erase_if(*own.table(), [](const Member& m) { return m.key == "preset"; });
  const Member* excluder = base.find("hyperelastic") ? excluder_of("hyperelastic", own) : nullptr;
  if (excluder) {
    place.problems.add(excluder->where, join_path(place.path, excluder->key),
                       "the preset \"" + *word->text() +
                           "\" has a hyperelastic law, which takes no such key; change that law's own keys in "
                           "`hyperelastic`, or leave out `preset`");
  }
  Node result = merged(tissue_section(), base, own, place);
  result.table()->push_back({"preset", word->where, *word});
  return result;
}

}  // namespace scene

const std::vector<ThermalPreset>& thermal_presets() {
  static const std::vector<ThermalPreset> presets = read_thermal_presets();
  return presets;
}

const ThermalTissue& thermal_preset(std::string_view name) {
  std::vector<std::string> names;
  for (const ThermalPreset& p : thermal_presets()) {
    if (p.name == name) return p.tissue;
    names.push_back(p.name);
  }
  throw std::invalid_argument("there is no thermal preset \"" + std::string(name) + "\"; the presets are " +
                              scene::listed(names));
}

const std::vector<TissuePreset>& tissue_presets() {
  static const std::vector<TissuePreset> presets = read_presets();
  return presets;
}

const TissuePreset& tissue_preset(std::string_view name) {
  const std::vector<TissuePreset>& presets = tissue_presets();
  const auto it = std::find_if(presets.begin(), presets.end(), [&](const TissuePreset& p) { return p.name == name; });
  if (it != presets.end()) return *it;
  std::vector<std::string> names;
  for (const TissuePreset& p : presets) names.push_back(p.name);
  const std::string meant = scene::nearest(name, names);
  throw std::invalid_argument(
      "there is no tissue preset \"" + std::string(name) + "\"; " +
      (meant.empty() ? "the presets are " + scene::listed(names) : "did you mean \"" + meant + "\"?"));
}

}  // namespace glisson
