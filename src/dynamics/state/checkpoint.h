// checkpoint.h — the numbers of a running simulation as bytes, and back.
//
//   "GLISCHK1" │ version u32 │ size of the rest u64 │ numbers … │ FNV-1a of them u64        all little-endian
//
// What is not in it: mesh, tissues, options, motions and loads, which the one who loads has made anew, and checks by
// fingerprints that they are the same.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <iosfwd>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "glisson/math.h"

namespace glisson {

/// FNV-1a over bytes, from where an earlier one left off.
inline constexpr std::uint64_t kHashStart = 14695981039346656037ULL;
std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t hash = kHashStart);
template <class T>
std::uint64_t hash_numbers(std::span<const T> numbers, std::uint64_t hash = kHashStart) {
  return hash_bytes(std::as_bytes(numbers), hash);
}

class CheckpointWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    bytes_.append(bytes.data(), bytes.size());
  }
  void put(const Vec3d& v) { put(v.x), put(v.y), put(v.z); }
  template <class T>
  void put(const std::vector<T>& list) {
    put(static_cast<std::uint64_t>(list.size()));
    for (const T& value : list) put(value);
  }
  /// A struct of nothing but doubles.
  template <class T>
  void put_doubles(const T& value) {
    for (const double d : std::bit_cast<std::array<double, sizeof(T) / sizeof(double)>>(value)) put(d);
  }
  /// The whole file.
  void write(std::ostream& out) const;

 private:
  std::string bytes_;
};

/// @throws std::runtime_error saying what is wrong with the file
class CheckpointReader {
 public:
  explicit CheckpointReader(std::istream& in);

  template <class T>
  requires std::is_arithmetic_v<T>
  void get(T& value) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), take(sizeof(T)), sizeof(T));
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    if constexpr (std::is_same_v<T, bool>) {
      if (bytes[0] != 0 && bytes[0] != 1) fail();
    }
    value = std::bit_cast<T>(bytes);
  }
  template <class T>
  T get() {
    T value{};
    get(value);
    return value;
  }
  void get(Vec3d& v) { get(v.x), get(v.y), get(v.z); }
  template <class T>
  void get(std::vector<T>& list) {
    const auto size = get<std::uint64_t>();
    if (size > left()) fail();
    list.assign(size, T{});
    for (T& value : list) get(value);
  }
  /// A list that must be as long as it is already.
  template <class T>
  void get_same_size(std::vector<T>& list) {
    const std::size_t size = list.size();
    get(list);
    if (list.size() != size) fail();
  }
  template <class T>
  void get_doubles(T& value) {
    std::array<double, sizeof(T) / sizeof(double)> numbers;
    for (double& d : numbers) get(d);
    value = std::bit_cast<T>(numbers);
  }
  std::size_t left() const { return bytes_.size() - at_; }
  [[noreturn]] static void fail();

 private:
  const char* take(std::size_t n);
  std::string bytes_;
  std::size_t at_ = 0;
};

}  // namespace glisson
