#include "scene/parse/document.h"

#include <toml++/toml.h>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "glisson/scene/scene.h"

namespace glisson::scene {
namespace {

constexpr int kDeepest = 32;            // tables and lists in one another; a scene needs 5
constexpr int kMostDotsInOneKey = 200;  // the parser and its destructors recurse once a dot
constexpr std::size_t kLargestText = std::size_t(8) << 20;

Origin origin_of(const toml::source_region& region) {
  return {static_cast<std::uint32_t>(region.begin.line), static_cast<std::uint32_t>(region.begin.column), {}};
}

[[noreturn]] void fail(const std::string& name, const Origin& at, const std::string& what) {
  throw SceneError(name + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " + what);
}

bool earlier(const Member& a, const Member& b) {
  return std::pair(a.where.line, a.where.column) < std::pair(b.where.line, b.where.column);
}

Node convert(const toml::node& from, const std::string& name, int depth);

Table convert_table(const toml::table& from, const std::string& name, int depth) {
  Table members;
  for (const auto& [key, value] : from) {
    members.push_back({std::string(key.str()), origin_of(key.source()), convert(value, name, depth + 1)});
  }
  std::sort(members.begin(), members.end(), earlier);
  return members;
}

Array convert_array(const toml::array& from, const std::string& name, int depth) {
  Array elements;
  for (const auto& element : from) elements.push_back(convert(element, name, depth + 1));
  return elements;
}

Node convert(const toml::node& from, const std::string& name, int depth) {
  Node node;
  node.where = origin_of(from.source());
  if (depth > kDeepest) fail(name, node.where, "nested deeper than " + std::to_string(kDeepest) + " levels");
  switch (from.type()) {
    case toml::node_type::table:
      node.value = convert_table(*from.as_table(), name, depth);
      break;
    case toml::node_type::array:
      node.value = convert_array(*from.as_array(), name, depth);
      break;
    case toml::node_type::string:
      node.value = from.as_string()->get();
      break;
    case toml::node_type::integer:
      node.value = from.as_integer()->get();
      break;
    case toml::node_type::floating_point:
      node.value = from.as_floating_point()->get();
      break;
    case toml::node_type::boolean:
      node.value = from.as_boolean()->get();
      break;
    default:
      node.value = Foreign{"a date or time"};
      break;
  }
  return node;
}

/// Refuses what would make the recursive parser run out of stack, before it sees the text.
void require_harmless(std::string_view text, const std::string& name) {
  if (text.size() > kLargestText) {
    throw SceneError(name + ": " + std::to_string(text.size()) + " bytes, at most " + std::to_string(kLargestText) +
                     " are read; long lists of numbers belong in the mesh file");
  }
  Origin at{1, 1, {}};
  int dots = 0;
  for (const char c : text) {
    dots = c == '.' ? dots + 1 : (std::string_view(",={}[]\n").find(c) != std::string_view::npos ? 0 : dots);
    if (dots > kMostDotsInOneKey) {
      fail(name, at, "more than " + std::to_string(kMostDotsInOneKey) + " dots in one key or line of text");
    }
    at.column = c == '\n' ? 1 : at.column + 1;
    at.line += c == '\n';
  }
}

}  // namespace

void set_origin(Node& node, const Origin& where) {
  node.where = where;
  if (Array* elements = node.array()) {
    for (Node& element : *elements) set_origin(element, where);
  }
  if (Table* members = node.table()) {
    for (Member& member : *members) {
      member.where = where;
      set_origin(member.value, where);
    }
  }
}

const Node* Node::find(std::string_view key) const {
  const Table* members = table();
  if (!members) return nullptr;
  const auto it = std::find_if(members->begin(), members->end(), [&](const Member& m) { return m.key == key; });
  return it == members->end() ? nullptr : &it->value;
}

Node* Node::find(std::string_view key) { return const_cast<Node*>(static_cast<const Node*>(this)->find(key)); }

double number_of(const Node& node) {
  if (const auto* whole = std::get_if<std::int64_t>(&node.value)) return static_cast<double>(*whole);
  return std::get<double>(node.value);
}

std::string describe(const Node& node) {
  struct {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return std::to_string(i); }
    std::string operator()(double d) const { return show(d); }
    std::string operator()(const std::string& s) const {
      return "text \"" + (s.size() > 60 ? s.substr(0, 57) + "..." : s) + "\"";
    }
    std::string operator()(const Foreign& f) const { return f.type; }
    std::string operator()(const Array& a) const { return "a list of " + std::to_string(a.size()); }
    std::string operator()(const Table&) const { return "a table"; }
  } text;
  return std::visit(text, node.value);
}

namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    constexpr char kHex[] = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      (out += '\\') += c;
    else if (byte < 0x20 || byte == 0x7f)
      ((out += "\\u00") += kHex[byte >> 4]) += kHex[byte & 15];
    else
      out += c;
  }
  return out + '"';
}

}  // namespace

std::string toml_key(const std::string& key) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !key.empty() && std::all_of(key.begin(), key.end(), plain) ? key : quoted(key);
}

std::string toml_text(const Node& node) {
  struct {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return std::to_string(i); }
    std::string operator()(double d) const { return show(d); }
    std::string operator()(const std::string& s) const { return quoted(s); }
    std::string operator()(const Foreign&) const { return "\"\""; }
    std::string operator()(const Array& a) const {
      std::string list;
      for (const Node& element : a) list += (list.empty() ? "" : ", ") + toml_text(element);
      return "[" + list + "]";
    }
    std::string operator()(const Table& t) const {
      std::string members;
      for (const Member& m : t)
        members += (members.empty() ? " " : ", ") + toml_key(m.key) + " = " + toml_text(m.value);
      return members.empty() ? "{}" : "{" + members + " }";
    }
  } text;
  return std::visit(text, node.value);
}

Node parse_document(std::string_view text, const std::string& name) {
  require_harmless(text, name);
  try {
    const toml::table table = toml::parse(text);
    Node root = convert(table, name, 0);
    root.where = {1, 1, {}};
    return root;
  } catch (const toml::parse_error& error) {
    fail(name, origin_of(error.source()), "not valid TOML: " + std::string(error.description()));
  }
}

Node parse_override_value(const std::string& key, const std::string& text) {
  const Origin where{0, 0, key};
  Node result;
  result.value = text;
  try {
    Node parsed = parse_document("value = " + text, "--set " + key);
    if (parsed.table()->size() == 1) result = parsed.table()->front().value;
  } catch (const SceneError&) {
    // Not TOML: a bare word, kept as text.
  }
  set_origin(result, where);
  return result;
}

std::vector<std::string> split_key(std::string_view dotted) {
  std::vector<std::string> parts(1);
  char quote = 0;
  bool quoted = false;
  for (const char c : dotted) {
    if (quote) {
      if (c == quote)
        quote = 0;
      else
        parts.back() += c;
    } else if (c == '"' || c == '\'') {
      quote = c;
      quoted = true;
    } else if (c == '.') {
      if (parts.back().empty() && !quoted) return {};
      parts.emplace_back();
      quoted = false;
    } else {
      parts.back() += c;
    }
  }
  if (quote || parts.back().empty() || parts.size() > kDeepest) return {};
  return parts;
}

}  // namespace glisson::scene
