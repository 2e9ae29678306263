// field.h — how an option struct describes its members: once, for scenes and their reference, checks, Python, checkpoints.
//
//   struct Sine {
//     double amplitude = 0.001;  ///< [m]
//     template <class Take>
//     static constexpr auto fields(Take take) {
//       return take(field("amplitude", &Sine::amplitude, "mm", above(0), "amplitude"));
//     }
//   };
//
// fields() passes all descriptions to a function; as a template it costs nothing where it is not called.
// A scene's key is name and unit, `amplitude_mm`; C++ and Python know the name. A member is in SI; its range and key are in
// the unit given here, of which mm (and mm/s …) and ° (radians of the member) differ from SI. Conditions between members go into
//   Fault check() const;   // or std::string
// Every member is described, in the order of the struct: each_field() does not compile otherwise.
#pragma once

#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace glisson {

/// Allowed numbers.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false, max_open = false;  ///< the bound itself is not allowed

  constexpr bool contains(double x) const { return (min_open ? x > min : x >= min) && (max_open ? x < max : x <= max); }
  bool bounded() const;
  /// `> 0`, `≥ 0`, `1 to 1000`, `> -1 and < 0.5`; empty where everything is allowed.
  std::string text() const;
};
constexpr Range above(double min) { return {.min = min, .min_open = true}; }
constexpr Range at_least(double min) { return {.min = min}; }
constexpr Range between(double min, double max) { return {.min = min, .max = max}; }
constexpr Range strictly_between(double min, double max) { return {min, max, true, true}; }

/// Description of a field, whatever its type.
struct FieldText {
  std::string_view name{};  ///< of the member
  std::string_view unit{};  ///< of the key; empty: has none, "-": a pure number
  Range range{};            ///< of the key's number, or of each of its numbers
  std::string_view help{};
  std::string_view own_key{};       ///< where the key is not name and unit
  std::string_view default_text{};  ///< in place of the member's first value
  std::string_view advice{};        ///< what to do about a value that is not allowed
  std::string_view infinite{};      ///< what infinity means, where C++ may give it
  bool required = false;            ///< in scenes
  bool in_scenes = true;
  bool accepts_auto = false;  ///< the word "auto" instead of a number
  bool is_direction = false;  ///< a vector that is not zero

  /// Of a scene: "density_kg_m3".
  std::string key() const;
  /// The member's number over the key's.
  constexpr double scale() const {
    if (unit == "°") return std::numbers::pi / 180.0;
    return unit.starts_with("mm") ? 1e-3 : 1.0;
  }
  std::string si_unit() const;
};

/// A member of S with its description.
template <class S, class T>
struct FieldOf : FieldText {
  T S::*member;

  constexpr FieldOf must() const { return with(&FieldText::required, true); }
  constexpr FieldOf or_auto() const { return with(&FieldText::accepts_auto, true); }
  constexpr FieldOf direction() const { return with(&FieldText::is_direction, true); }
  constexpr FieldOf keyed(std::string_view key) const { return with(&FieldText::own_key, key); }
  constexpr FieldOf otherwise(std::string_view text) const { return with(&FieldText::default_text, text); }
  constexpr FieldOf advise(std::string_view text) const { return with(&FieldText::advice, text); }
  constexpr FieldOf or_infinite(std::string_view meaning) const { return with(&FieldText::infinite, meaning); }

 private:
  template <class V>
  constexpr FieldOf with(V FieldText::*what, V value) const {
    FieldOf other = *this;
    other.*what = value;
    return other;
  }
};

template <class S, class T>
constexpr FieldOf<S, T> field(std::string_view name, T S::*member, std::string_view unit, Range range,
                              std::string_view help) {
  return {{.name = name, .unit = unit, .range = range, .help = help}, member};
}
template <class S, class T>
constexpr FieldOf<S, T> field(std::string_view name, T S::*member, std::string_view unit, std::string_view help) {
  return field(name, member, unit, Range{}, help);
}
template <class S, class T>
constexpr FieldOf<S, T> field(std::string_view name, T S::*member, Range range, std::string_view help) {
  return field(name, member, {}, range, help);
}
template <class S, class T>
constexpr FieldOf<S, T> field(std::string_view name, T S::*member, std::string_view help) {
  return field(name, member, {}, Range{}, help);
}

/// A field that scenes have no key for.
template <class S, class T>
constexpr FieldOf<S, T> no_key(std::string_view name, T S::*member, std::string_view unit, Range range) {
  FieldOf<S, T> f = field(name, member, unit, range, {});
  f.in_scenes = false;
  return f;
}
template <class S, class T>
constexpr FieldOf<S, T> no_key(std::string_view name, T S::*member, Range range = {}) {
  return no_key(name, member, {}, range);
}

/// A contradiction between members of a struct, and the member to change; none if `what` is empty.
struct Fault {
  std::string what{};
  std::string_view field{};
};

/// Takes fields and does nothing.
struct TakeAny {
  template <class... Fields>
  constexpr void operator()(const Fields&...) const {}
};
template <class S>
concept Described = requires {
  S::fields(TakeAny());
};

/// Whether the members of an aggregate are of these types, in this order, and no others.
template <class S, class... T>
inline constexpr bool kHasMembers = requires {
  S{std::declval<T>()...};
}
&&!requires { S{std::declval<T>()..., {}}; };
/// Whether its fields are all members of S, in their order.
template <Described S>
inline constexpr bool kDescribesAll = S::fields([]<class... T>(const FieldOf<S, T>&...) {
  return kHasMembers<S, T...>;
});

/// Calls `visit` with each field of S.
template <Described S, class Visit>
constexpr void each_field(Visit&& visit) {
  static_assert(kDescribesAll<S>, "S::fields does not describe every member of S, in its order");
  S::fields([&](const auto&... fields) { (visit(fields), ...); });
}

}  // namespace glisson
