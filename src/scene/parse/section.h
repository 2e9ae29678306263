// section.h — describing a section by the struct it fills.
//
//   Section<Tissue> s("tissue", "What the body is made of.");
//   s.key("density_kg_m3", &Tissue::density, "density ρ").in("kg/m³").within(above(0));
//
// One line names the key, its type (that of the member), its default (the member's initial value), unit, range
// and meaning. An accessor is a pointer to a member or a callable S& → T&.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "glisson/math.h"
#include "scene/parse/schema.h"

namespace glisson::scene {

/// How a C++ type is written in a scene: its type and shape, reading a checked node, showing a default.
template <class T>
struct Codec;

template <>
struct Codec<bool> {
  static constexpr ValueType kType = ValueType::boolean;
  static constexpr Shape kShape = Shape::one;
  static bool read(const Node& n) { return std::get<bool>(n.value); }
  static std::string show(bool b) { return b ? "true" : "false"; }
};

template <>
struct Codec<double> {
  static constexpr ValueType kType = ValueType::number;
  static constexpr Shape kShape = Shape::one;
  static double read(const Node& n) { return number_of(n); }
  static std::string show(double x) { return scene::show(x); }
};

/// A double in SI whose key is in thousandths: mm, mm/s.
struct Milli {
  static constexpr ValueType kType = ValueType::number;
  static constexpr Shape kShape = Shape::one;
  static double read(const Node& n) { return number_of(n) / 1000.0; }
  static std::string show(double x) { return scene::show(x * 1000.0); }
};

struct OptionalMilli {
  static constexpr ValueType kType = ValueType::number;
  static constexpr Shape kShape = Shape::one;
  static std::optional<double> read(const Node& n) { return Milli::read(n); }
  static std::string show(const std::optional<double>& x) { return x ? Milli::show(*x) : ""; }
};

template <class T>
requires(std::is_integral_v<T> && !std::is_same_v<T, bool>) struct Codec<T> {
  static constexpr ValueType kType = ValueType::integer;
  static constexpr Shape kShape = Shape::one;
  static constexpr double kLargest = std::min(9.0e15, static_cast<double>(std::numeric_limits<T>::max()));
  static T read(const Node& n) { return static_cast<T>(std::get<std::int64_t>(n.value)); }
  static std::string show(T i) { return std::to_string(i); }
};

template <>
struct Codec<std::string> {
  static constexpr ValueType kType = ValueType::text;
  static constexpr Shape kShape = Shape::one;
  static std::string read(const Node& n) { return *n.text(); }
  static std::string show(const std::string& s) { return s.empty() ? "" : "\"" + s + "\""; }
};

template <>
struct Codec<std::filesystem::path> {
  static constexpr ValueType kType = ValueType::text;
  static constexpr Shape kShape = Shape::one;
  static std::filesystem::path read(const Node& n) { return *n.text(); }
  static std::string show(const std::filesystem::path& p) { return Codec<std::string>::show(p.string()); }
};

/// None where the key is not given, or is "auto".
template <class T>
struct Codec<std::optional<T>> {
  static constexpr ValueType kType = Codec<T>::kType;
  static constexpr Shape kShape = Codec<T>::kShape;
  static std::optional<T> read(const Node& n) {
    if (n.text() && kType != ValueType::text) return std::nullopt;
    return Codec<T>::read(n);
  }
  static std::string show(const std::optional<T>& x) { return x ? Codec<T>::show(*x) : ""; }
};

template <class List, class T>
struct ListCodec {
  static constexpr ValueType kType = Codec<T>::kType;
  static List read(const Node& n) {
    List list{};
    for (std::size_t i = 0; i < n.array()->size(); ++i) {
      if constexpr (requires { list.push_back(T{}); })
        list.push_back(Codec<T>::read((*n.array())[i]));
      else
        list[i] = Codec<T>::read((*n.array())[i]);
    }
    return list;
  }
  template <class Range>
  static std::string show_all(const Range& list) {
    std::string text;
    for (const T& x : list) text += (text.empty() ? "" : ", ") + Codec<T>::show(x);
    return "[" + text + "]";
  }
};

template <>
struct Codec<Vec3d> : ListCodec<Vec3d, double> {
  static constexpr Shape kShape = Shape::three;
  static std::string show(const Vec3d& v) { return show_all(std::array{v.x, v.y, v.z}); }
};

/// Three of them.
struct MilliVector {
  static constexpr ValueType kType = ValueType::number;
  static constexpr Shape kShape = Shape::three;
  static Vec3d read(const Node& n) { return Codec<Vec3d>::read(n) * 1e-3; }
  static std::string show(const Vec3d& v) { return Codec<Vec3d>::show(v * 1e3); }
};

template <class T>
struct Codec<std::array<T, 3>> : ListCodec<std::array<T, 3>, T> {
  static constexpr Shape kShape = Shape::three;
  static std::string show(const std::array<T, 3>& v) { return Codec::show_all(v); }
};

template <class T>
struct Codec<std::vector<T>> : ListCodec<std::vector<T>, T> {
  static constexpr Shape kShape = Shape::list;
  static std::string show(const std::vector<T>& v) { return Codec::show_all(v); }
};

template <HasWords E>
struct Codec<E> {
  static constexpr ValueType kType = ValueType::text;
  static constexpr Shape kShape = Shape::one;
  static E read(const Node& n) {
    const auto is_it = [&](const Word<E>& w) { return w.word == *n.text(); };
    return std::find_if(std::begin(kWords<E>), std::end(kWords<E>), is_it)->value;
  }
  static std::string show(E value) { return "\"" + std::string(word_of(value)) + "\""; }
};

/// One word of a choice and the value it stands for.
template <class T>
struct Choice {
  std::string word;
  T value;
  std::string help;
};

template <class S>
class Section {
 public:
  explicit Section(std::string name, std::string help = {}) {
    spec_.name = std::move(name);
    spec_.help = std::move(help);
  }

  /// A value; `C` is the codec where it is not that of the member's type.
  template <class C = void, class Access>
  KeySpec& key(std::string name, Access access, std::string help) {
    using T = std::remove_cvref_t<decltype(std::invoke(access, std::declval<S&>()))>;
    using Code = std::conditional_t<std::is_void_v<C>, Codec<T>, std::type_identity<C>>;
    return add_value<T, unwrapped<Code>>(std::move(name), access, std::move(help));
  }

  /// A value that is one of some words: of types that have none of their own (glisson/words.h).
  template <class T, class Access>
  KeySpec& choice(std::string name, Access access, std::vector<Choice<T>> choices, std::string help) {
    KeySpec key{.name = std::move(name), .help = std::move(help), .type = ValueType::text};
    S initial{};
    for (const Choice<T>& c : choices) {
      key.words.push_back({c.word, c.help});
      if (same(c.value, std::invoke(access, initial))) key.default_text = "\"" + c.word + "\"";
    }
    key.store = [access, choices](void* target, const Node& node) {
      for (const Choice<T>& c : choices) {
        if (c.word == *node.text()) std::invoke(access, *static_cast<S*>(target)) = c.value;
      }
    };
    return push(std::move(key));
  }

  /// A table, filling what `access` returns.
  template <class Access>
  KeySpec& table(std::string name, const SectionSpec& section, Access access, std::string help) {
    KeySpec key = table_key(std::move(name), std::move(help), Shape::one, &section);
    key.slot = [access](void* target, const std::string&) -> void* {
      return &std::invoke(access, *static_cast<S*>(target));
    };
    return push(std::move(key));
  }

  /// A list of tables `[[name]]`, each a new last element of the vector that `access` returns.
  template <class Access>
  KeySpec& tables(std::string name, const SectionSpec& section, Access access, std::string help) {
    KeySpec key = table_key(std::move(name), std::move(help), Shape::list, &section);
    key.slot = [access](void* target, const std::string&) -> void* {
      return &std::invoke(access, *static_cast<S*>(target)).emplace_back();
    };
    return push(std::move(key));
  }

  /// A table for each name, filling the entries of the map that `access` returns.
  template <class Access>
  KeySpec& named_tables(std::string name, const SectionSpec& section, Access access, std::string help) {
    KeySpec key = table_key(std::move(name), std::move(help), Shape::named, &section);
    key.slot = [access](void* target, const std::string& entry) -> void* {
      return &std::invoke(access, *static_cast<S*>(target))[entry];
    };
    return push(std::move(key));
  }

  /// A key that is only checked here; the section's finish() reads it.
  KeySpec& bare(KeySpec key) { return push(std::move(key)); }

  /// What must hold between keys; called once all keys of the table are right.
  void finish(std::function<void(S&, const Node&, const Place&)> check) {
    spec_.finish = [check = std::move(check)](void* target, const Node& node, const Place& place) {
      check(*static_cast<S*>(target), node, place);
    };
  }

  SectionSpec& spec() { return spec_; }

 private:
  template <class Code>
  struct Unwrap {
    using type = Code;
  };
  template <class C>
  struct Unwrap<std::type_identity<C>> {
    using type = C;
  };
  template <class Code>
  using unwrapped = typename Unwrap<Code>::type;

  template <class T, class Code, class Access>
  KeySpec& add_value(std::string name, Access access, std::string help) {
    KeySpec key{.name = std::move(name), .help = std::move(help), .type = Code::kType, .shape = Code::kShape};
    if constexpr (requires { Code::kLargest; }) key.range = between(0.0, Code::kLargest);
    if constexpr (HasWords<T>) {
      for (const Word<T>& w : kWords<T>) key.words.push_back({std::string(w.word), std::string(w.help)});
    }
    if constexpr (std::is_default_constructible_v<S>) {
      const auto initial = std::make_unique<S>();
      key.default_text = Code::show(std::invoke(access, *initial));
    }
    key.store = [access](void* target, const Node& node) {
      std::invoke(access, *static_cast<S*>(target)) = Code::read(node);
    };
    return push(std::move(key));
  }

  template <class T>
  static bool same(const T& a, const T& b) {
    if constexpr (requires { a == b; })
      return a == b;
    else
      return false;
  }

  static KeySpec table_key(std::string name, std::string help, Shape shape, const SectionSpec* section) {
    return {
        .name = std::move(name), .help = std::move(help), .type = ValueType::table, .shape = shape, .section = section};
  }

  KeySpec& push(KeySpec key) {
    spec_.keys.push_back(std::move(key));
    return spec_.keys.back();
  }

  SectionSpec spec_;
};

}  // namespace glisson::scene
