// archive.h — one function both writes and reads a state: it lists the parts, and the archive copies them out or in.
//
//   void archive(Archive& ar) { ar(position, velocity, events); }
//
// Parts are numbers, flags, enumerators that have words, strings, vectors, described structs (field.h), lists and variants of
// them, and types with such a function, member or free. The bytes may have been forged: reading throws where bytes are missing,
// a list is longer than the rest, a flag is neither 0 nor 1, an enumerator has no word, or keys do not ascend. A class checks
// the range of its own numbers as it reads.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "glisson/field.h"
#include "glisson/math.h"
#include "glisson/words.h"

namespace glisson {

class Archive {
 public:
  /// Writes.
  Archive() = default;
  /// Reads the bytes that another archive has written.
  explicit Archive(std::string bytes) : bytes_(std::move(bytes)), reads_(true) {}

  bool reads() const { return reads_; }
  /// Whether it is for a copy in memory, of this simulation alone: instruments and factors are copied beside it.
  bool in_memory() const { return in_memory_; }
  void set_in_memory() { in_memory_ = true; }
  const std::string& bytes() const { return bytes_; }
  std::string take_bytes() { return std::move(bytes_); }
  std::size_t left() const { return bytes_.size() - at_; }

  /// Writes the parts, or reads them. @throws std::runtime_error if the bytes do not fit them
  template <class... Parts>
  void operator()(Parts&... parts) {
    (part(parts), ...);
  }
  /// A list that is as long as it is here.
  template <class T, class Memory>
  void same_size(std::vector<T, Memory>& list) {
    const std::size_t size = list.size();
    part(list);
    check(list.size() == size);
  }
  /// A number below `end`.
  template <class T>
  void below(T& number, std::size_t end) {
    part(number);
    check(number < end);
  }
  /// Numbers below `end`.
  template <class T, class Memory>
  void all_below(std::vector<T, Memory>& numbers, std::size_t end) {
    part(numbers);
    check(std::all_of(numbers.begin(), numbers.end(), [end](const T& n) { return n < end; }));
  }
  /// Rejects the bytes unless a condition on them holds.
  void check(bool sound) const {
    if (reads_ && !sound) refuse();
  }
  /// @throws std::runtime_error saying that the contents do not fit
  [[noreturn]] static void refuse() {
    throw std::runtime_error(
        "checkpoint: its contents do not fit this simulation; make it with the same mesh, tissues, options, "
        "constraints "
        "and loads as the one that was saved");
  }

 private:
  /// Whether the bytes of a list of such parts are those in memory.
  template <class T>
  struct Plain : std::bool_constant<std::is_arithmetic_v<T> && !std::is_same_v<T, bool>> {};
  template <class T>
  struct Plain<Vec3<T>> : Plain<T> {};
  template <class T, std::size_t N>
  struct Plain<std::array<T, N>> : Plain<T> {};

  template <class T>
  void part(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      auto number = static_cast<std::uint8_t>(value);
      part(number);
      check(number < 2);
      if (reads_) value = number != 0;  // writing changes nothing: others may read meanwhile
    } else if constexpr (HasWords<T>) {
      auto number = static_cast<std::uint8_t>(value);
      part(number);
      if (reads_) value = static_cast<T>(number);
      check(!word_of(value).empty());
    } else if constexpr (std::is_arithmetic_v<T>) {
      auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
      if (!reads_) order(bytes);
      raw(bytes.data(), bytes.size());
      if (reads_) order(bytes), value = std::bit_cast<T>(bytes);
    } else if constexpr (requires { value.archive(*this); }) {
      value.archive(*this);
    } else if constexpr (Described<T>) {
      each_field<T>([&](const auto& field) { part(value.*field.member); });
    } else {
      archive(*this, value);
    }
  }
  template <class T>
  void part(Vec3<T>& v) {
    (*this)(v.x, v.y, v.z);
  }
  template <class T>
  void part(Mat3<T>& matrix) {
    part(matrix.m);
  }
  template <class T, std::size_t N>
  void part(std::array<T, N>& list) {
    for (T& value : list) part(value);
  }
  template <class A, class B>
  void part(std::pair<A, B>& pair) {
    (*this)(pair.first, pair.second);
  }
  template <class T>
  void part(std::optional<T>& value) {
    bool there = value.has_value();
    part(there);
    if (reads_) there ? static_cast<void>(value.emplace()) : value.reset();
    if (value) part(*value);
  }
  /// By its place in the list of types.
  template <class... T>
  void part(std::variant<T...>& value) {
    auto index = static_cast<std::uint8_t>(value.index());
    part(index);
    check(index < sizeof...(T));
    const auto becomes = [&]<class One>(std::type_identity<One>, std::size_t i) {
      if (i == index && i != value.index()) value.template emplace<One>();
    };
    std::size_t i = 0;
    (becomes(std::type_identity<T>(), i++), ...);
    std::visit([this](auto& one) { part(one); }, value);
  }
  void part(std::string& text) {
    text.resize(count(text.size(), 1));
    raw(text.data(), text.size());
  }
  template <class T, class Memory>
  void part(std::vector<T, Memory>& list) {
    constexpr bool kPlain = Plain<T>::value && std::endian::native == std::endian::little;
    const std::size_t size = count(list.size(), kPlain ? sizeof(T) : 1);
    if constexpr (kPlain) {
      list.resize(size);
      raw(reinterpret_cast<char*>(list.data()), size * sizeof(T));
    } else {
      if (reads_) list.clear();
      for (std::size_t i = 0; i < size; ++i) part(reads_ ? list.emplace_back() : list[i]);
    }
  }
  template <class T>
  void part(std::set<T>& set) {
    std::vector<T> list(set.begin(), set.end());
    part(list);
    check(std::adjacent_find(list.begin(), list.end(), std::not_fn(std::less<>())) == list.end());
    if (reads_) set = {list.begin(), list.end()};
  }
  template <class Key, class Value>
  void part(std::map<Key, Value>& map) {
    std::vector<std::pair<Key, Value>> list(map.begin(), map.end());
    part(list);
    const auto unordered = [](const auto& a, const auto& b) { return !(a.first < b.first); };
    check(std::adjacent_find(list.begin(), list.end(), unordered) == list.end());
    if (reads_) map = {list.begin(), list.end()};
  }

  template <std::size_t N>
  static void order(std::array<char, N>& bytes) {
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  }
  /// The number of parts that follow. @param least_bytes  smallest size of each
  std::size_t count(std::size_t size, std::size_t least_bytes) {
    auto number = static_cast<std::uint64_t>(size);
    part(number);
    check(number <= left() / least_bytes);
    return static_cast<std::size_t>(number);
  }
  void raw(char* data, std::size_t size) {
    if (!reads_) return static_cast<void>(bytes_.append(data, size));
    check(size <= left());
    if (size > 0) std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }

  std::string bytes_;
  std::size_t at_ = 0;
  bool reads_ = false, in_memory_ = false;
};

/// The bytes that an object writes.
template <class T>
std::string archived(T& object) {
  Archive out;
  object.archive(out);
  return out.bytes();
}
/// Reads an object from the bytes of archived(). @throws std::runtime_error if they do not fit it or are left over
template <class T>
void restore(T& object, std::string bytes) {
  Archive in(std::move(bytes));
  object.archive(in);
  in.check(in.left() == 0);
}

}  // namespace glisson
