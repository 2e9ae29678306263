// words.h — the words of enumerators in scenes, Python and messages: one table next to each enumeration.
#pragma once

#include <string_view>
#include <type_traits>

namespace glisson {

/// A word, its enumerator and its meaning.
template <class E>
struct Word {
  std::string_view word;
  E value;
  std::string_view help{};
};

/// The table of an enumeration, an array; other types have none.
template <class E>
inline constexpr const Word<E>* kWords = nullptr;

template <class E>
concept HasWords = std::is_array_v<decltype(kWords<E>)>;

/// The word of an enumerator, the first of its entries; empty for a number that is none.
template <HasWords E>
constexpr std::string_view word_of(E value) {
  for (const Word<E>& w : kWords<E>) {
    if (w.value == value) return w.word;
  }
  return {};
}

/// The meaning of an enumerator.
template <HasWords E>
constexpr std::string_view meaning_of(E value) {
  for (const Word<E>& w : kWords<E>) {
    if (w.value == value) return w.help;
  }
  return {};
}

/// Whether it is another word of the same enumerator: read, but never written.
template <HasWords E>
constexpr bool is_alias(const Word<E>& w) {
  return word_of(w.value) != w.word;
}

}  // namespace glisson
