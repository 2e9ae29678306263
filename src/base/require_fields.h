// require_fields.h — refuses the members of a described struct (glisson/field.h), always as
//   WHERE: NAME [UNIT] = VALUE is outside the allowed range, RANGE; ADVICE
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "glisson/field.h"
#include "glisson/math.h"
#include "glisson/words.h"

namespace glisson::detail {

[[noreturn]] void refuse(const std::string& where, std::string name, const std::string& what);
/// @param value  in SI
void require_number(const std::string& where, const std::string& name, const FieldText& field, double value);
/// @param number  that is none of the enumerators with these words
[[noreturn]] void refuse_enumerator(const std::string& where, const std::string& name, long long number,
                                    const std::vector<std::string_view>& words);
void require_vector(const std::string& where, const std::string& name, const FieldText& field, const Vec3d& value);

/// Walks through the members, and those of members that are described.
struct Requirement {
  const std::string& where;

  template <Described S>
  void all_of(const std::string& path, const S& s) const {
    each_field<S>([&](const auto& f) { value(path + std::string(f.name), f, s.*f.member); });
    if constexpr (requires { s.check(); }) {
      const Fault fault{s.check()};
      if (!fault.what.empty()) refuse(where, path + std::string(fault.field), fault.what);
    }
  }

  template <class T>
  void value(const std::string& name, const FieldText& field, const T& x) const {
    if constexpr (HasWords<T>) {
      if (word_of(x).empty()) {
        std::vector<std::string_view> words;
        for (const Word<T>& w : kWords<T>) words.push_back(w.word);
        refuse_enumerator(where, name, static_cast<long long>(x), words);
      }
    } else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
      require_number(where, name, field, static_cast<double>(x));
    } else if constexpr (requires { T::kName; }) {
      all_of(name + " (" + std::string(T::kName) + ").", x);
    } else if constexpr (Described<T>) {
      all_of(name + ".", x);
    }
  }
  void value(const std::string& name, const FieldText& field, const Vec3d& x) const {
    require_vector(where, name, field, x);
  }
  template <class T>
  void value(const std::string& name, const FieldText& field, const std::optional<T>& x) const {
    if (x) value(name, field, *x);
  }
  template <class... T>
  void value(const std::string& name, const FieldText& field, const std::variant<T...>& x) const {
    std::visit([&](const auto& one) { value(name, field, one); }, x);
  }
  template <class T, std::size_t N>
  void value(const std::string& name, const FieldText& field, const std::array<T, N>& list) const {
    for (std::size_t i = 0; i < N; ++i) value(name + "[" + std::to_string(i) + "]", field, list[i]);
  }
  template <class T>
  void value(const std::string& name, const FieldText& field, const std::vector<T>& list) const {
    for (std::size_t i = 0; i < list.size(); ++i) value(name + "[" + std::to_string(i) + "]", field, list[i]);
  }
  template <class T>
  void value(const std::string& name, const FieldText& field, const std::map<int, T>& map) const {
    for (const auto& [key, x] : map) value(name + "[" + std::to_string(key) + "]", field, x);
  }
};

/// @param where  what is refused: "needle biopsy" @throws std::invalid_argument for the first member that is not allowed
template <Described S>
void require_fields(const std::string& where, const S& s) {
  Requirement{where}.all_of("", s);
}

}  // namespace glisson::detail
