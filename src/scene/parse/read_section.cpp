// read_section.cpp — the checker: walks a table along its section.
#include <algorithm>
#include <cmath>

#include "base/nearest.h"
#include "scene/parse/allowed_range.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

std::string in_ticks(const std::string& key) { return "`" + key + "`"; }

/// The keys a table of this section may have, given its kind.
std::vector<const KeySpec*> keys_of(const SectionSpec& section, const KindSpec* kind) {
  std::vector<const KeySpec*> keys;
  for (const KeySpec& key : section.keys) keys.push_back(&key);
  if (kind) {
    for (const KeySpec& key : kind->section.keys) keys.push_back(&key);
  }
  return keys;
}

/// A section of the document and the heading under which it is written.
struct Headed {
  const SectionSpec* section;
  std::string path;  ///< "motion.implicit"; empty: the top of the file
  bool list = false;

  std::string heading() const {
    if (path.empty()) return "the top of the file";
    return list ? "[[" + path + "]]" : "[" + path + "]";
  }
};

/// All sections of a document, those nearer to its top first.
std::vector<Headed> headed_sections(const std::vector<const SectionSpec*>& roots) {
  std::vector<Headed> all;
  for (const SectionSpec* root : roots) all.push_back({root, ""});
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto go_down = [&](const SectionSpec& section, const std::string& path) {
      for (const KeySpec& key : section.keys) {
        if (key.section) all.push_back({key.section, join_path(path, key.name), key.shape == Shape::list});
      }
    };
    const Headed here = all[i];
    go_down(*here.section, here.path);
    for (const KindSpec& kind : here.section->kinds) go_down(kind.section, here.path);
  }
  return all;
}

/// The kind of a section that has the key: "[[instrument]] of kind "punch""; empty: none.
std::string kind_with(const Headed& h, const std::string& key) {
  for (const KindSpec& kind : h.section->kinds) {
    if (kind.section.find(key)) return h.heading() + " of kind \"" + kind.section.name + "\"";
  }
  return "";
}

/// Where a key exists, e.g. "[motion]": in another kind of the section it was given in, in the sections' own keys, in those of
/// their kinds; empty: nowhere.
std::string home_of_key(const std::string& key, const SectionSpec& given_in,
                        const std::vector<const SectionSpec*>& roots) {
  const std::vector<Headed> all = headed_sections(roots);
  for (const Headed& h : all) {
    if (h.section != &given_in) continue;
    if (std::string home = kind_with(h, key); !home.empty()) return home;
  }
  for (const Headed& h : all) {
    if (h.section->find(key)) return h.heading();
  }
  for (const Headed& h : all) {
    if (std::string home = kind_with(h, key); !home.empty()) return home;
  }
  return "";
}

std::string unknown_key(const SectionSpec& section, const KindSpec* kind, const std::string& word,
                        const std::vector<const SectionSpec*>& roots) {
  std::vector<std::string> known = section.other_words;
  if (!section.kinds.empty()) known.push_back("kind");
  for (const KeySpec* key : keys_of(section, kind)) known.push_back(key->name);
  if (const std::string meant = nearest(word, known); !meant.empty() && meant != word) {
    return "unknown key; did you mean " + in_ticks(meant) + "?";
  }
  if (const std::string home = home_of_key(word, section, roots); !home.empty())
    return "unknown key here; it belongs in " + home;
  return "unknown key; known here: " + listed(known);
}

/// One value that is no list: its type, its words, its range.
bool check_single(const KeySpec& key, const Node& node, const Place& place) {
  const auto wrong_type = [&] {
    place.complain("expected " + expected(key) + ", got " + describe(node));
    return false;
  };
  const bool whole = std::holds_alternative<std::int64_t>(node.value);
  const bool number = whole || std::holds_alternative<double>(node.value);
  if (key.type == ValueType::boolean) return std::holds_alternative<bool>(node.value) || wrong_type();
  if (key.type == ValueType::text) {
    if (!node.text()) return wrong_type();
    const auto allowed = [&](const AllowedWord& w) { return w.word == *node.text(); };
    if (key.words.empty() || std::any_of(key.words.begin(), key.words.end(), allowed)) return true;
    std::vector<std::string> words;
    for (const AllowedWord& w : key.words) words.push_back(w.word);
    const std::string meant = nearest(*node.text(), words);
    place.complain("expected " + expected(key) + ", got \"" + *node.text() + "\"" +
                   (meant.empty() ? "" : "; did you mean \"" + meant + "\"?"));
    return false;
  }
  if (key.accepts_auto && node.text() && *node.text() == "auto") return true;
  if (!number || (key.type == ValueType::integer && !whole)) return wrong_type();
  const double value = number_of(node);
  const Range range = allowed_range(key);
  if (std::isfinite(value) && range.contains(value)) return true;
  std::string unit;
  if (!key.unit.empty() && key.unit != "-") unit.append(" ").append(key.unit);
  const std::string allowed = range.bounded() ? range.text() + unit : "any finite number";
  place.complain(describe(node) + unit + " is out of range; allowed: " + allowed +
                 (key.advice.empty() ? "" : "; " + key.advice));
  return false;
}

bool check_value(const KeySpec& key, const Node& node, const Place& place) {
  if (key.shape == Shape::one) return check_single(key, node, place);
  const Array* elements = node.array();
  if (!elements || (key.shape == Shape::three && elements->size() != 3)) {
    place.complain("expected " + expected(key) + ", got " + describe(node));
    return false;
  }
  KeySpec single = key;
  single.shape = Shape::one;
  bool right = true;
  for (std::size_t i = 0; i < elements->size(); ++i) {
    const Node& element = (*elements)[i];
    right = check_single(single, element, place.inside(std::to_string(i), element.where)) && right;
  }
  const auto is_short = [](const Node& x) { return std::abs(number_of(x)) < detail::kShortestDirection; };
  if (right && key.is_direction && std::ranges::all_of(*elements, is_short)) {
    std::string vector;
    for (const Node& element : *elements) vector += (vector.empty() ? "[" : ", ") + describe(element);
    place.complain(vector + "] has no direction; give a vector that is not zero, such as [0, 0, -1]");
    return false;
  }
  return right;
}

void read_tables(const KeySpec& key, const Node& node, void* target, const Place& place) {
  const auto slot = [&](const std::string& name) { return target ? key.slot(target, name) : nullptr; };
  const bool right_type = key.shape == Shape::list ? node.array() != nullptr : node.table() != nullptr;
  if (!right_type) {
    const bool names_kind = node.text() && key.shape == Shape::one && key.section && key.section->kind(*node.text());
    place.complain("expected " + expected(key) + ", got " + describe(node) +
                   (names_kind ? "; write { kind = \"" + *node.text() + "\" }" : ""));
  } else if (!key.section) {
    return;
  } else if (key.shape == Shape::one) {
    read_section(*key.section, node, slot(key.name), place);
  } else if (key.shape == Shape::named) {
    for (const Member& m : *node.table()) {
      read_section(*key.section, m.value, slot(m.key), place.inside(m.key, m.value.where));
    }
  } else {
    for (std::size_t i = 0; i < node.array()->size(); ++i) {
      const Node& element = (*node.array())[i];
      read_section(*key.section, element, slot(std::to_string(i)), place.inside(std::to_string(i), element.where));
    }
  }
}

void read_member(const KeySpec& key, const Member& member, void* target, const Place& place) {
  const Place here = place.inside(member.key, member.value.where);
  if (key.type == ValueType::table) {
    read_tables(key, member.value, target, here);
  } else if (check_value(key, member.value, here) && target && key.store) {
    key.store(target, member.value);
  }
}

/// The kind a table names; complains where it names none or an unknown one.
const KindSpec* chosen_kind(const SectionSpec& section, const Node& node, bool complete, const Place& place) {
  KeySpec key{.name = "kind", .type = ValueType::text};
  for (const KindSpec& k : section.kinds) key.words.push_back({k.section.name, k.section.help});
  const Node* word = node.find("kind");
  if (!word) {
    if (complete) place.complain("missing key `kind`: " + expected(key));
    return nullptr;
  }
  return check_single(key, *word, place.inside("kind", word->where)) ? section.kind(*word->text()) : nullptr;
}

/// The key of group `group` that the table has first; nullptr where it has none.
const Member* first_given(const Node& node, const std::vector<std::string>& group) {
  for (const Member& m : *node.table()) {
    if (std::find(group.begin(), group.end(), m.key) != group.end()) return &m;
  }
  return nullptr;
}

bool earlier(const Origin& a, const Origin& b) { return std::pair(a.line, a.column) < std::pair(b.line, b.column); }

/// Line of a key for "contradicts", or how --set gave it.
std::string source_of(const Origin& where) {
  return where.override_key.empty() ? "line " + std::to_string(where.line) : "--set " + where.override_key;
}

void check_exclusion(const Exclusion& exclusion, const Node& node, bool complete, const Place& place) {
  std::vector<std::string> all;
  const Member* given = nullptr;
  for (const auto& group : exclusion.groups) {
    for (const std::string& key : group) all.push_back(in_ticks(key));
    const Member* member = first_given(node, group);
    if (given && member) {
      const bool later = earlier(given->where, member->where);
      const Member& second = later ? *member : *given;
      const Member& first = later ? *given : *member;
      place.problems.add(
          second.where, join_path(place.path, second.key),
          "contradicts " + in_ticks(first.key) + " (" + source_of(first.where) + "); give one of the two");
    }
    if (member) given = member;
  }
  if (exclusion.one_needed && !given && complete) place.complain("give one of " + listed(all));
}

void check_missing(const std::vector<const KeySpec*>& keys, const Node& node, const Place& place) {
  for (const KeySpec* key : keys) {
    if (!key->required || node.find(key->name)) continue;
    std::string takes = expected(*key);
    if (key->range.bounded()) takes.append(" ").append(key->range.text());
    place.complain("missing key " + in_ticks(key->name) + ": " + takes + "; " + key->help);
  }
}

}  // namespace

void read_section(const SectionSpec& section, const Node& node, void* target, const Place& place) {
  if (!node.table()) {
    place.complain("expected a table, got " + describe(node));
    return;
  }
  const std::size_t before = place.problems.count();
  const bool complete = target != nullptr;
  const KindSpec* kind = nullptr;
  if (!section.kinds.empty()) {
    kind = chosen_kind(section, node, complete, place);
    if (!kind) return;
  }
  void* filled = kind && complete ? kind->create(target) : target;
  for (const Member& member : *node.table()) {
    if (kind && member.key == "kind") continue;
    const KeySpec* own = section.find(member.key);
    const KeySpec* key = own || !kind ? own : kind->section.find(member.key);
    if (key) {
      read_member(*key, member, own ? target : filled, place);
    } else {
      place.problems.add(member.where, join_path(place.path, member.key),
                         unknown_key(section, kind, member.key, place.problems.sections()));
    }
  }
  if (complete) check_missing(keys_of(section, kind), node, place);
  for (const Exclusion& exclusion : section.exclusions) check_exclusion(exclusion, node, complete, place);
  if (!complete || place.problems.count() > before) return;
  if (section.finish) section.finish(target, node, place);
  if (kind && kind->section.finish) kind->section.finish(filled, node, place);
}

}  // namespace glisson::scene
