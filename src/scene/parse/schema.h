// schema.h — how the keys of a scene are described: once, for reading, checking, defaults and documentation.
//
//   SectionSpec ─ a table of the scene: its keys, its kinds (`kind = "box"` chooses further keys), which keys
//        │        exclude each other, and what must hold between keys
//        └─ KeySpec ─ name, type, unit, range, default, meaning, and how the value is stored in the C++ struct
//
// The descriptions are erased of types so that the checker and the documentation walk them alike; section.h
// builds them from the members of the structs, whose initial values are the defaults.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "glisson/field.h"
#include "scene/parse/document.h"
#include "scene/parse/problems.h"

namespace glisson::scene {

enum class ValueType { boolean, integer, number, text, table };
enum class Shape {
  one,
  three,  ///< exactly three values in a list
  list,   ///< any number of values in a list; for tables: `[[name]]`
  named   ///< tables only: one table for each name the user gives
};

struct AllowedWord {
  std::string word, help;
  bool alias = false;  ///< of the word before it: read, and not among those that messages list
};

struct SectionSpec;

struct KeySpec {
  std::string name{}, help{};
  ValueType type = ValueType::number;
  Shape shape = Shape::one;
  std::string unit{};  ///< empty: has none, "-": a pure number
  Range range{};       ///< of the number or of each number
  bool required = false;
  bool accepts_auto = false;                                           ///< the word "auto" instead of a number
  bool is_direction = false;                                           ///< three numbers, not all zero
  std::vector<AllowedWord> words{};                                    ///< not empty: the only texts allowed
  std::string default_text{};                                          ///< in TOML, or a few words; empty: none
  std::string advice{};                                                ///< the way out of a value that is not allowed
  std::function<void(void* target, const Node& value)> store{};        ///< of a checked value
  const SectionSpec* section = nullptr;                                ///< of tables; none: checked elsewhere
  std::function<void*(void* target, const std::string& name)> slot{};  ///< what a table of this key fills

  KeySpec& in(std::string u) {
    unit = std::move(u);
    return *this;
  }
  KeySpec& within(Range r) {
    range = r;
    return *this;
  }
  KeySpec& must() {
    required = true;
    default_text.clear();
    return *this;
  }
  KeySpec& otherwise(std::string text) {
    default_text = std::move(text);
    return *this;
  }
  KeySpec& direction() {
    is_direction = true;
    return *this;
  }
  KeySpec& advise(std::string text) {
    advice = std::move(text);
    return *this;
  }
};

/// What a section's own check may use: where it is and how to complain.
struct Place {
  Problems& problems;
  std::string path;
  Origin where;

  void complain(const std::string& what) const { problems.add(where, path, what); }
  void complain(const Node& at, const std::string& key, const std::string& what) const {
    problems.add(at.where, join_path(path, key), what);
  }
  std::string text() const { return problems.locate(where, path); }
  Place inside(const std::string& key, const Origin& at) const { return {problems, join_path(path, key), at}; }
};

struct KindSpec;

/// Keys of two different groups contradict each other.
struct Exclusion {
  std::vector<std::vector<std::string>> groups;
  bool one_needed = false;  ///< one of the groups must be given
};

struct SectionSpec {
  std::string name{};  ///< as in a heading: "tissue"
  std::string help{};
  std::vector<KeySpec> keys{};
  std::vector<KindSpec> kinds;  ///< not empty: the key `kind` chooses one, whose keys are allowed too
  std::vector<Exclusion> exclusions{};
  std::vector<std::string> starts{};  ///< a table that gives one of these takes nothing over from the one it is laid on
  std::vector<std::string> other_words{};  ///< further keys to suggest for a misspelt one
  std::function<void(void* target, const Node& table, const Place&)> finish{};  ///< what must hold between keys

  const KeySpec* find(std::string_view key) const;
  const KindSpec* kind(std::string_view word) const;
};

struct KindSpec {
  SectionSpec section;  ///< name: the word of `kind`
  std::function<void*(void* target)> create;
};

/// Checks a table against its section and stores what is right in `target`; complains about the rest.
/// With no target nothing is stored and nothing is missing: the check of a table that others complete.
void read_section(const SectionSpec& section, const Node& node, void* target, const Place& place);

/// `a number > 0 [Pa]`, `one of box, cylinder, file`: what a key takes, for messages and documentation.
std::string expected(const KeySpec& key);

/// The element of a list that `name` means: by its name (or set), else by its index from 0; nullptr where there is none.
const Node* element_called(const Array& elements, const std::string& name);

/// `overlay` over `base`: tables are joined key by key, everything else is replaced. A table of another `kind`
/// replaces the whole table, as does one with the section's `start` key; a key removes those it excludes, and a list of
/// tables is replaced by a list or changed in its elements by a table of names or indices.
Node merged(const SectionSpec& section, const Node& base, const Node& overlay, const Place& place);

}  // namespace glisson::scene
