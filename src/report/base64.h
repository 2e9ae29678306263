// base64.h — arrays of numbers as text, for the report page.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <type_traits>

namespace glisson {

/// RFC 4648 with padding.
std::string base64(std::span<const std::byte> bytes);

/// The bytes of an array of numbers as they lie in memory, little-endian on every machine we build for.
template <class T>
std::string base64_of(std::span<const T> values) {
  static_assert(std::is_arithmetic_v<T>);
  return base64(std::as_bytes(values));
}

}  // namespace glisson
