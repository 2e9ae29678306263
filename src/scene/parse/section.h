// section.h — describing a section by the struct it fills.
//
//   Section<Tissue> s("tissue", "What the body is made of.");
//   s.fields();                                                                  // all that Tissue::fields describes
//   s.key("youngs_modulus_Pa", &Tissue::youngs_modulus, "E").in("Pa").within(above(0));       // of structs without it
//
// The type of a key is that of the member, its default the member's initial value. An accessor is a pointer to a member or
// a callable S& → T&.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "glisson/math.h"
#include "scene/parse/sections.h"

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

/// A type in SI whose key is in thousandths.
template <class T>
using Thousandth = std::conditional_t<
    std::is_same_v<T, double>, Milli,
    std::conditional_t<std::is_same_v<T, Vec3d>, MilliVector,
                       std::conditional_t<std::is_same_v<T, std::optional<double>>, OptionalMilli, Codec<T>>>>;

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

/// A type that is a table in a scene; one that holds such a type: an optional, a list.
template <class T>
concept HasSection = requires {
  section_of(std::type_identity<T>());
};
template <class T>
concept HoldsSection = HasSection<typename T::value_type>;

/// One word of a choice and the value it stands for.
template <class T>
struct Choice {
  std::string word;
  T value;
  std::string help;
  bool alias = false;  ///< as AllowedWord's
};

template <class S>
class Section {
 public:
  explicit Section(std::string name, std::string help = {}) {
    spec_.name = std::move(name);
    spec_.help = std::move(help);
  }

  /// The keys of a described struct (glisson/field.h), in its order: of S, or of the part of it that `access` returns.
  template <class Access = std::identity>
  void fields(Access access = {}, const std::vector<std::string_view>& without = {}) {
    using Part = std::remove_cvref_t<std::invoke_result_t<Access, S&>>;
    each_field<Part>([&](const auto& f) {
      const auto at = f.member;
      const auto member = [=](S & s) -> auto& { return std::invoke(at, std::invoke(access, s)); };
      const bool left_out = std::find(without.begin(), without.end(), f.name) != without.end();
      if (f.in_scenes && !left_out) add_field<std::remove_cvref_t<decltype(member(std::declval<S&>()))>>(f, member);
    });
    if constexpr (requires(const Part& part) { part.check(); }) {
      finish([access](S& s, const Node& table, const Place& place) {
        const Fault fault{std::invoke(access, s).check()};
        if (!fault.what.empty()) complain<Part>(fault, table, place);
      });
    }
  }

  /// A key that is there.
  KeySpec& at(std::string_view name) { return const_cast<KeySpec&>(*spec_.find(name)); }

  /// Puts keys that are only checked here behind another one; the section's finish() reads them.
  void bare_after(std::string_view other, std::vector<KeySpec> keys) {
    const auto is_it = [&](const KeySpec& key) { return key.name == other; };
    const auto at = std::find_if(spec_.keys.begin(), spec_.keys.end(), is_it) + 1;
    spec_.keys.insert(at, std::move_iterator(keys.begin()), std::move_iterator(keys.end()));
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
      key.words.push_back({c.word, c.help, c.alias});
      if (!c.alias && same(c.value, std::invoke(access, initial))) key.default_text = "\"" + c.word + "\"";
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

  /// What must hold between keys; called once all keys of the table are right, the last that was given first.
  void finish(std::function<void(S&, const Node&, const Place&)> check) {
    const auto then = std::move(spec_.finish);
    spec_.finish = [check, then](void* target, const Node& node, const Place& place) {
      const std::size_t before = place.problems.count();
      check(*static_cast<S*>(target), node, place);
      if (then && place.problems.count() == before) then(target, node, place);
    };
  }

  SectionSpec& spec() { return spec_; }

 private:
  /// A described member, as a table where its type is one.
  template <class T, class Access>
  void add_field(const FieldText& f, Access access) {
    KeySpec* key = nullptr;
    if constexpr (HasSection<T>) {
      key = &table(f.key(), section_of(std::type_identity<T>()), access, std::string(f.help));
    } else if constexpr (HoldsSection<T>) {
      const SectionSpec& section = section_of(std::type_identity<typename T::value_type>());
      if constexpr (std::is_same_v<T, std::vector<typename T::value_type>>) {
        key = &tables(f.key(), section, access, std::string(f.help));
      } else {
        const auto made = [access](S & s) -> auto& { return std::invoke(access, s).emplace(); };
        key = &table(f.key(), section, made, std::string(f.help));
      }
    } else if constexpr (requires { Codec<T>::kType; }) {
      // NOLINTNEXTLINE(bugprone-branch-clone): the codecs differ
      key = &(f.scale() == 1.0 ? add_value<T, Codec<T>>(f.key(), access, std::string(f.help))
                               : add_value<T, Thousandth<T>>(f.key(), access, std::string(f.help)));
    } else {
      throw std::logic_error(f.key() + ": no scene can hold a value of its type; it is no_key()");
    }
    key->unit = f.unit;
    if (f.range.bounded()) key->range = f.range;
    key->advice = f.advice;
    key->accepts_auto = f.accepts_auto;
    key->is_direction = f.is_direction;
    if (!f.default_text.empty()) key->default_text = f.default_text;
    if (f.required) key->must();
  }

  /// A fault between members, at the key of the one that it names.
  template <class Part>
  static void complain(const Fault& fault, const Node& table, const Place& place) {
    std::string key;
    each_field<Part>([&](const FieldText& f) { key = f.name == fault.field ? f.key() : key; });
    if (key.empty()) return place.complain(fault.what);
    const Node* given = table.find(key);
    place.complain(given ? *given : table, key, fault.what);
  }

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
      for (const Word<T>& w : kWords<T>) key.words.push_back({std::string(w.word), std::string(w.help), is_alias(w)});
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

/// The section of a described struct.
template <Described S>
SectionSpec described(std::string name, std::string help) {
  Section<S> s(std::move(name), std::move(help));
  s.fields();
  return std::move(s.spec());
}

/// The same of one that has the word of its `kind`.
template <Described S>
SectionSpec described(std::string help) requires requires {
  S::kName;
}
{ return described<S>(std::string(S::kName), std::move(help)); }

}  // namespace glisson::scene
