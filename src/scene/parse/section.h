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
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
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

/// An angle in radians whose key is in degrees.
struct Degrees {
  static constexpr ValueType kType = ValueType::number;
  static constexpr Shape kShape = Shape::one;
  static double read(const Node& n) { return number_of(n) * std::numbers::pi / 180.0; }
  static std::string show(double x) { return scene::show(x * 180.0 / std::numbers::pi); }
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

/// A value of some C++ type, the type erased: how a key reads and shows it.
struct ValueCode {
  ValueType type;
  Shape shape;
  double largest = 0.0;                           ///< of an integer; 0: no bound
  std::vector<AllowedWord> (*words)() = nullptr;  ///< nullptr: any text
  void (*read)(const Node& node, void* value);
  std::string (*show)(const void* value);
};

template <class T, class Code = Codec<T>>
ValueCode value_code() {
  ValueCode code{.type = Code::kType,
                 .shape = Code::kShape,
                 .read = [](const Node& node, void* value) { *static_cast<T*>(value) = Code::read(node); },
                 .show = [](const void* value) { return Code::show(*static_cast<const T*>(value)); }};
  if constexpr (requires { Code::kLargest; }) code.largest = Code::kLargest;
  if constexpr (HasWords<T>) {
    code.words = [] {
      std::vector<AllowedWord> words;
      for (const Word<T>& w : kWords<T>) words.push_back({std::string(w.word), std::string(w.help), is_alias(w)});
      return words;
    };
  }
  return code;
}

/// The struct that a table of the scene fills, within the member of that table; makes it where it is not yet.
using Slot = void* (*)(void* member, const std::string& entry);

/// A described member in a scene, its type erased: a value, or one or several tables.
struct MemberKind {
  ValueCode (*value)() = nullptr;             ///< nullptr: not a value
  ValueCode (*thousandth)() = nullptr;        ///< of a key in thousandths
  ValueCode (*degrees)() = nullptr;           ///< of a key in degrees
  const SectionSpec& (*section)() = nullptr;  ///< of tables
  Shape shape = Shape::one;                   ///< of tables
  Slot slot = nullptr;                        ///< of tables
};

template <class T>
constexpr MemberKind member_kind() {
  if constexpr (HasSection<T>) {
    return {.section = []() -> const SectionSpec& { return section_of(std::type_identity<T>()); },
            .slot = [](void* member, const std::string&) { return member; }};
  } else if constexpr (HoldsSection<T>) {
    constexpr bool list = std::is_same_v<T, std::vector<typename T::value_type>>;
    return {.section = []() -> const SectionSpec& { return section_of(std::type_identity<typename T::value_type>()); },
            .shape = list ? Shape::list : Shape::one,
            .slot = [](void* member, const std::string&) -> void* {
              if constexpr (list)
                return &static_cast<T*>(member)->emplace_back();
              else
                return &static_cast<T*>(member)->emplace();
            }};
  } else if constexpr (requires { Codec<T>::kType; }) {
    MemberKind kind{.value = value_code<T>, .thousandth = value_code<T, Thousandth<T>>};
    if constexpr (std::is_same_v<T, double>) kind.degrees = value_code<double, Degrees>;
    return kind;
  } else {
    return {};
  }
}

/// Finds a member in the struct of a section, both without their types: at an offset in that struct or in a part of it.
struct MemberPlace {
  std::function<void*(void* target)> part{};  ///< empty: the struct itself
  std::ptrdiff_t offset = 0;

  void* in(void* target) const { return static_cast<char*>(part ? part(target) : target) + offset; }
};

/// What Section does without the type of its struct: compiled once, not for each member.
class SectionBuilder {
 public:
  /// A key that is there.
  KeySpec& at(std::string_view name) { return const_cast<KeySpec&>(*spec_.find(name)); }
  /// Puts keys that are only checked here behind another one; the section's finish() reads them.
  void bare_after(std::string_view other, std::vector<KeySpec> keys);
  /// A key that is only checked here; the section's finish() reads it.
  KeySpec& bare(KeySpec key) { return push(std::move(key)); }
  SectionSpec& spec() { return spec_; }

 protected:
  using Check = std::function<void(void* target, const Node& table, const Place& place)>;
  /// Described members of a struct that are added: of which part, and the keys of them all.
  struct Fields {
    MemberPlace part;
    void* initial;  ///< a part with its initial values
    const std::vector<std::string_view>& without;
    std::vector<std::pair<std::string_view, std::string>> keys{};  ///< by the member's name
  };

  SectionBuilder(std::string name, std::string help);
  /// @param initial  the member's initial value
  KeySpec& add_value(std::string name, const ValueCode& code, MemberPlace place, const void* initial, std::string help);
  KeySpec& add_tables(std::string name, Shape shape, const SectionSpec& section, MemberPlace place, Slot slot,
                      std::string help);
  /// @param member  the field's member in the initial part
  void add_field(Fields& fields, const FieldText& field, const MemberKind& kind, void* member);
  /// A check between members of a part; a fault is reported at the key of the member that it names.
  void check_part(std::function<Fault(void* target)> check, std::vector<std::pair<std::string_view, std::string>> keys);
  void add_check(Check check);
  KeySpec& push(KeySpec key);

  SectionSpec spec_;
};

template <class S>
class Section : public SectionBuilder {
 public:
  explicit Section(std::string name, std::string help = {}) : SectionBuilder(std::move(name), std::move(help)) {}

  /// The keys of a described struct (glisson/field.h), in its order: of S, or of the part of it that `access` returns.
  template <class Access = std::identity>
  void fields(Access access = {}, const std::vector<std::string_view>& without = {}) {
    using Part = Member<Access>;
    const std::unique_ptr<S> initial = made();
    Part& part = std::invoke(access, *initial);
    Fields fields{.part = place_of(access), .initial = &part, .without = without};
    each_field<Part>(
        [&]<class T>(const FieldOf<Part, T>& f) { add_field(fields, f, member_kind<T>(), &(part.*f.member)); });
    if constexpr (requires { part.check(); }) {
      check_part([access](void* target) { return Fault{std::invoke(access, *static_cast<S*>(target)).check()}; },
                 std::move(fields.keys));
    }
  }

  /// A value; `C` is the codec where it is not that of the member's type.
  template <class C = void, class Access>
  KeySpec& key(std::string name, Access access, std::string help) {
    using T = Member<Access>;
    using Code = typename std::conditional_t<std::is_void_v<C>, Wrapped<Codec<T>>, Wrapped<C>>::type;
    const std::unique_ptr<S> initial = made();
    return add_value(std::move(name), value_code<T, Code>(), place_of(access), &std::invoke(access, *initial),
                     std::move(help));
  }

  /// A value that is one of some words: of types that have none of their own (glisson/words.h).
  template <class T, class Access>
  KeySpec& choice(std::string name, Access access, std::vector<Choice<T>> choices, std::string help) {
    KeySpec key{.name = std::move(name), .help = std::move(help), .type = ValueType::text};
    const std::unique_ptr<S> initial = made();
    for (const Choice<T>& c : choices) {
      key.words.push_back({c.word, c.help, c.alias});
      if constexpr (requires { c.value == c.value; }) {
        if (!c.alias && c.value == std::invoke(access, *initial)) key.default_text = "\"" + c.word + "\"";
      }
    }
    key.store = [place = place_of(access), choices](void* target, const Node& node) {
      for (const Choice<T>& c : choices) {
        if (c.word == *node.text()) *static_cast<T*>(place.in(target)) = c.value;
      }
    };
    return push(std::move(key));
  }

  /// A table, filling what `access` returns.
  template <class Access>
  KeySpec& table(std::string name, const SectionSpec& section, Access access, std::string help) {
    return add_tables(
        std::move(name), Shape::one, section, place_of(access), [](void* member, const std::string&) { return member; },
        std::move(help));
  }

  /// A list of tables `[[name]]`, each a new last element of the vector that `access` returns.
  template <class Access>
  KeySpec& tables(std::string name, const SectionSpec& section, Access access, std::string help) {
    const Slot added = [](void* member, const std::string&) -> void* {
      return &static_cast<Member<Access>*>(member)->emplace_back();
    };
    return add_tables(std::move(name), Shape::list, section, place_of(access), added, std::move(help));
  }

  /// A table for each name, filling the entries of the map that `access` returns.
  template <class Access>
  KeySpec& named_tables(std::string name, const SectionSpec& section, Access access, std::string help) {
    const Slot entry = [](void* member, const std::string& named) -> void* {
      return &(*static_cast<Member<Access>*>(member))[named];
    };
    return add_tables(std::move(name), Shape::named, section, place_of(access), entry, std::move(help));
  }

  /// What must hold between keys: `check(S&, const Node& table, const Place&)`, called once all keys of the table are right,
  /// the check that was given last first.
  template <class CheckOfS>
  void finish(CheckOfS check) {
    add_check([check](void* target, const Node& table, const Place& place) {
      check(*static_cast<S*>(target), table, place);
    });
  }

 private:
  template <class Access>
  using Member = std::remove_cvref_t<std::invoke_result_t<Access, S&>>;
  template <class Code>
  using Wrapped = std::type_identity<Code>;

  static std::unique_ptr<S> made() { return std::make_unique<S>(); }

  static MemberPlace place_of(std::identity) { return {}; }
  template <class T, class Base>
  static MemberPlace place_of(T Base::*member) {
    const std::unique_ptr<S> any = made();
    return {.offset = reinterpret_cast<char*>(&((*any).*member)) - reinterpret_cast<char*>(any.get())};
  }
  template <class Access>
  static MemberPlace place_of(Access access) {
    return {.part = [access](void* target) -> void* { return &std::invoke(access, *static_cast<S*>(target)); }};
  }
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
