// merge.cpp — variants and --set laid over a scene, along the schema.
#include <algorithm>
#include <charconv>

#include "scene/parse/schema.h"

namespace glisson::scene {
namespace {

constexpr const char* kEach = "*";  // each element of a list: heat.probe.*.radius_mm

bool contains(const std::vector<std::string>& group, const std::string& key) {
  return std::find(group.begin(), group.end(), key) != group.end();
}

/// The section of a kind, with the keys that only tables of this kind have; none: the section has no kinds, or not this one.
const SectionSpec* section_of_kind(const SectionSpec& section, const Node* kind) {
  if (!kind || !kind->text()) return nullptr;
  const KindSpec* of = section.kind(*kind->text());
  return of ? &of->section : nullptr;
}

/// Removes from `table` the keys that `key` excludes.
void drop_excluded(const SectionSpec& section, Table& table, const std::string& key) {
  for (const Exclusion& exclusion : section.exclusions) {
    const auto& groups = exclusion.groups;
    const auto has_key = [&](const auto& group) { return contains(group, key); };
    if (std::none_of(groups.begin(), groups.end(), has_key)) continue;
    for (const auto& group : groups) {
      if (!has_key(group)) std::erase_if(table, [&](const Member& t) { return contains(group, t.key); });
    }
  }
}

bool names(const Node& element, const std::string& name) {
  for (const char* key : {"name", "set"}) {
    if (const Node* value = element.find(key)) return value->text() && *value->text() == name;
  }
  return false;
}

std::string names_of(const Array& elements) {
  std::string text;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const Node* name = elements[i].find("name");
    if (!name) name = elements[i].find("set");
    text += (i ? ", " : "") + std::to_string(i) + (name && name->text() ? " (" + *name->text() + ")" : "");
  }
  return text.empty() ? "the scene has none" : "known: " + text;
}

Node merged_list(const KeySpec& key, Node list, const Table& overlay, const Place& place) {
  for (const Member& m : overlay) {
    const Place here = place.inside(m.key, m.where);
    if (m.key == kEach && !list.array()->empty()) {
      for (Node& element : *list.array()) element = merged(*key.section, element, m.value, here);
    } else if (const Node* called = element_called(*list.array(), m.key)) {
      Node* element = list.array()->data() + (called - list.array()->data());
      *element = merged(*key.section, *element, m.value, here);
    } else {
      here.complain("no such " + key.name + "; " + names_of(*list.array()));
    }
  }
  return list;
}

Node merged_member(const KeySpec& key, const Node& base, const Node& overlay, const Place& place) {
  if (key.type != ValueType::table || !key.section || !overlay.table()) return overlay;
  if (key.shape == Shape::list) {
    return base.array() ? merged_list(key, base, *overlay.table(), place) : overlay;
  }
  if (key.shape == Shape::one || !base.table()) return merged(*key.section, base, overlay, place);
  Node all = base;
  all.where = overlay.where;
  for (const Member& m : *overlay.table()) {
    if (Node* own = all.find(m.key))
      *own = merged(*key.section, *own, m.value, place.inside(m.key, m.where));
    else
      all.table()->push_back(m);
  }
  return all;
}

}  // namespace

const Node* element_called(const Array& elements, const std::string& name) {
  const auto it = std::find_if(elements.begin(), elements.end(), [&](const Node& e) { return names(e, name); });
  if (it != elements.end()) return &*it;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
  const bool number = error == std::errc{} && end == name.data() + name.size();
  return number && index < elements.size() ? &elements[index] : nullptr;
}

Node merged(const SectionSpec& section, const Node& base, const Node& overlay, const Place& place) {
  if (!base.table() || !overlay.table()) return overlay;
  const Node* kind = base.find("kind");
  const Node* other_kind = overlay.find("kind");
  const bool replaced = !section.kinds.empty() && other_kind && kind && kind->text() && other_kind->text() &&
                        *kind->text() != *other_kind->text();
  const auto given = [&](const std::string& key) { return overlay.find(key) != nullptr; };
  if (replaced || std::any_of(section.starts.begin(), section.starts.end(), given)) return overlay;
  Node result = base;
  result.where = overlay.where;
  const SectionSpec* of_kind = section_of_kind(section, other_kind ? other_kind : kind);
  for (const Member& m : *overlay.table()) {
    drop_excluded(section, *result.table(), m.key);
    if (of_kind) drop_excluded(*of_kind, *result.table(), m.key);
  }
  for (const Member& m : *overlay.table()) {
    const KeySpec* key = section.find(m.key);
    if (!key && of_kind) key = of_kind->find(m.key);
    const auto own =
        std::find_if(result.table()->begin(), result.table()->end(), [&](const Member& r) { return r.key == m.key; });
    if (own == result.table()->end()) {
      const bool empty_list = key && key->section && key->shape == Shape::list && m.value.table();
      if (empty_list)
        merged_list(*key, Node{Array{}, m.value.where}, *m.value.table(), place.inside(m.key, m.where));
      else
        result.table()->push_back(m);
    } else {
      const Node value = key ? merged_member(*key, own->value, m.value, place.inside(m.key, m.where)) : m.value;
      *own = {m.key, m.where, value};
    }
  }
  return result;
}

}  // namespace glisson::scene
