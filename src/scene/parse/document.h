// document.h — a scene as a tree of values that remember where they were written.
//
// The one place that knows toml++ is document.cpp. Everything else works on this tree, which survives merging:
// a value of a variant or of --set keeps its own origin when it replaces one of the scene, so that every message
// points at the text the user has to change.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/text.h"

namespace glisson::scene {

/// Where something was written: line and column of the file (from 1), or the key given to --set.
struct Origin {
  std::uint32_t line = 0, column = 0;
  std::string override_key;  ///< not empty: from --set
};

struct Node;
struct Member;
using Array = std::vector<Node>;
using Table = std::vector<Member>;
/// A value that no key of a scene takes (dates and times).
struct Foreign {
  std::string type;
};

struct Node {
  std::variant<bool, std::int64_t, double, std::string, Foreign, Array, Table> value;
  Origin where;

  const Table* table() const { return std::get_if<Table>(&value); }
  Table* table() { return std::get_if<Table>(&value); }
  const Array* array() const { return std::get_if<Array>(&value); }
  Array* array() { return std::get_if<Array>(&value); }
  const std::string* text() const { return std::get_if<std::string>(&value); }
  /// The member of a table; nullptr where this is no table or has no such key.
  const Node* find(std::string_view key) const;
  Node* find(std::string_view key);
};

struct Member {
  std::string key;
  Origin where;  ///< of the key
  Node value;
};

/// Says of a whole tree that it was written at one place.
void set_origin(Node& node, const Origin& where);
/// A whole or broken number as double; the node must hold one.
double number_of(const Node& node);
/// What a node holds, for messages: `text "abc"`, `5`, `a list of 3`.
std::string describe(const Node& node);
/// The shortest text that reads back as the same number.
using detail::show;

/// The value as TOML on one line, as --set takes it: `{ kind = "linear", slope_Pa = 20000 }`. A date is written as an empty text.
std::string toml_text(const Node& node);
/// A key as TOML: bare, or in quotes where it has to be.
std::string toml_key(const std::string& key);

/// Members in the order of the file. @param name  stands for the file in messages. @throws SceneError
Node parse_document(std::string_view text, const std::string& name);
/// The value of --set KEY=TEXT: TOML where it is TOML, the text itself otherwise.
Node parse_override_value(const std::string& key, const std::string& text);
/// `a.b."c.d"` → a, b, c.d. Empty where the key is not well-formed.
std::vector<std::string> split_key(std::string_view dotted);

}  // namespace glisson::scene
