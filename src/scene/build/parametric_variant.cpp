#include "scene/build/parametric_variant.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>

#include "base/nearest.h"
#include "scene/parse/expand.h"
#include "scene/parse/schema.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

/// A key, its index in a list of numbers where it has one, and its dotted form as --set takes it.
struct ParsedKey {
  std::string dotted;
  std::optional<std::size_t> element;
};

/// `a[1].b[0]` → `a.1.b` and element 0.
ParsedKey parse_key(const std::string& key) {
  ParsedKey parsed;
  for (std::size_t i = 0; i < key.size(); ++i) {
    if (key[i] != '[') {
      parsed.dotted += key[i];
      continue;
    }
    const std::size_t close = key.find(']', i);
    std::size_t index = 0;
    const char* const first = key.data() + i + 1;
    const char* const last = key.data() + std::min(close, key.size());
    const auto [end, error] = std::from_chars(first, last, index);
    if (close == std::string::npos || error != std::errc{} || end != last)
      throw SceneError(key + ": not a key; an element of a list is written [0], [1], …");
    if (close + 1 == key.size())
      parsed.element = index;
    else
      parsed.dotted += "." + std::to_string(index);
    i = close;
  }
  return parsed;
}

const Node* go_to(const Node& root, std::span<const std::string> path) {
  const Node* at = &root;
  for (const std::string& step : path) {
    if (at == nullptr) return nullptr;
    at = at->array() ? element_called(*at->array(), step) : at->find(step);
  }
  return at;
}

std::string list_text(const Node* list, const std::string& key) {
  const bool numbers =
      list != nullptr && list->array() && !list->array()->empty() &&
      std::all_of(list->array()->begin(), list->array()->end(), [](const Node& n) {
        return std::holds_alternative<double>(n.value) || std::holds_alternative<std::int64_t>(n.value);
      });
  if (!numbers)
    throw SceneError(key + ": the scene gives no list of numbers there; write the whole list into it first");
  std::string text = "[";
  for (const Node& n : *list->array()) text += (text.size() > 1 ? ", " : "") + show(number_of(n));
  return text + "]";
}

std::size_t index_of(const Expanded& expanded, const std::string& variant, const std::string& file) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < expanded.variants.size(); ++i) {
    const Node* name = expanded.variants[i].find("name");
    names.push_back(name && name->text() ? *name->text() : "main");
    if (names.back() == variant) return i;
  }
  if (variant.empty() && names.size() == 1) return 0;
  throw SceneError(file +
                   (variant.empty() ? ": has several variants; name one with `variant`: "
                                    : ": no variant \"" + variant + "\"; it has: ") +
                   listed(names));
}

Node experiment_of(const Node& root, std::span<const Override> overrides, const std::filesystem::path& base,
                   const std::string& variant, const std::string& file) {
  Problems problems(file, {&scene_section(), &variant_section()});
  Expanded expanded = expand(root, overrides, base, problems);
  problems.throw_if_any();
  return std::move(expanded.variants[index_of(expanded, variant, file)]);
}

/// Child number i of a table or list.
Node& child(Node& node, std::size_t i) { return node.table() ? (*node.table())[i].value : (*node.array())[i]; }
std::size_t children(const Node& node) {
  if (node.table()) return node.table()->size();
  return node.array() ? node.array()->size() : 0;
}

/// Finds the values that came with an override of `key`, by their origin; lists as a whole.
template <class Found>
void find_origin(Node& node, const std::string& key, std::vector<std::size_t>& path, const Found& found) {
  if (!node.table() && node.where.override_key == key) return found(node, path);
  for (std::size_t i = 0; i < children(node); ++i) {
    path.push_back(i);
    find_origin(child(node, i), key, path, found);
    path.pop_back();
  }
}

}  // namespace

ParametricVariant::ParametricVariant(std::string_view text, const std::string& name, const std::filesystem::path& base,
                                     std::span<const Override> overrides, const std::string& variant,
                                     std::span<const std::string> keys)
    : name_(name), base_(base) {
  const Node root = parse_document(text, name);
  const Node plain = experiment_of(root, overrides, base, variant, name);
  std::vector<Override> all(overrides.begin(), overrides.end());
  std::vector<ParsedKey> parsed;
  std::map<std::string, bool> given;
  for (const std::string& key : keys) {
    parsed.push_back(parse_key(key));
    const ParsedKey& p = parsed.back();
    if (!given.emplace(p.dotted, true).second) continue;
    const std::vector<std::string> path = split_key(p.dotted);
    all.push_back({p.dotted, p.element ? list_text(go_to(plain, path), key) : "0.25"});
  }
  experiment_ = experiment_of(root, all, base, variant, name);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const std::size_t before = places_.size();
    std::vector<std::size_t> path;
    find_origin(experiment_, parsed[k].dotted, path, [&](const Node& node, std::vector<std::size_t> at) {
      if (parsed[k].element) at.push_back(*parsed[k].element);
      const std::size_t length = node.array() ? node.array()->size() : 0;
      if (parsed[k].element && *parsed[k].element >= length)
        throw SceneError(keys[k] + ": the list has " + std::to_string(length) + " elements, counted from 0");
      places_.push_back({k, std::move(at)});
    });
    if (places_.size() == before) throw SceneError(keys[k] + ": no key of an experiment; see `glisson schema`");
  }
  for (std::size_t m = 0; m < experiment_.table()->size(); ++m) {
    if ((*experiment_.table())[m].key != "tissue") continue;
    tissue_ = (*experiment_.table())[m].value;
    for (const Place& p : places_) {
      if (p.path.front() == m) tissue_places_.push_back({p.key, {p.path.begin() + 1, p.path.end()}});
    }
  }
  if (!tissue_.table()) tissue_ = Node{Table{}, experiment_.where};
  only_tissue_ = tissue_places_.size() == places_.size();
}

void ParametricVariant::set(Node& root, std::span<const Place> places, std::span<const double> values) const {
  for (const Place& p : places) {
    Node* at = &root;
    for (const std::size_t i : p.path) at = &child(*at, i);
    at->value = values[p.key];
  }
}

Variant ParametricVariant::with(std::span<const double> values) const {
  Node experiment = experiment_;
  set(experiment, places_, values);
  Problems problems(name_, {&scene_section(), &variant_section()});
  Variant variant = read_variant(experiment, base_, problems);
  problems.throw_if_any();
  return variant;
}

Tissue ParametricVariant::tissue_with(std::span<const double> values) const {
  Node node = tissue_;
  set(node, tissue_places_, values);
  Problems problems(name_, {&scene_section(), &variant_section()});
  Tissue tissue;
  read_section(tissue_section(), node, &tissue, {problems, "tissue", node.where});
  problems.throw_if_any();
  return tissue;
}

Node ParametricVariant::tissue_tree(std::span<const double> values) const {
  Node node = tissue_;
  set(node, tissue_places_, values);
  std::erase_if(*node.table(), [](const Member& m) { return m.key == "preset" || m.key == "file"; });
  return node;
}

}  // namespace glisson::scene
