// bytes.h — little-endian numbers one after the other, as the blocks of view/wire/wire.h are put into messages.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <utility>

#include "glisson/math.h"

namespace glisson::view {

class Bytes {
 public:
  void u8(std::uint8_t x) { text_.push_back(static_cast<char>(x)); }
  void i16(std::int16_t x) { put_low(static_cast<std::uint16_t>(x), 2); }
  void u32(std::uint32_t x) { put_low(x, 4); }
  void f32(double x) { u32(std::bit_cast<std::uint32_t>(static_cast<float>(x))); }
  void f64(double x) { put_low(std::bit_cast<std::uint64_t>(x), 8); }
  void vec3(const Vec3d& v) {
    for (std::size_t k = 0; k < 3; ++k) f32(v[k]);
  }
  /// Zeros up to a multiple of 4.
  void align() {
    while (text_.size() % 4 != 0) u8(0);
  }
  void string(const std::string& text) {
    u32(static_cast<std::uint32_t>(text.size()));
    text_ += text;
    align();
  }
  std::string take() { return std::move(text_); }
  void reserve(std::size_t bytes) { text_.reserve(bytes); }

 private:
  void put_low(std::uint64_t x, int bytes) {
    for (int i = 0; i < bytes; ++i) u8(static_cast<std::uint8_t>(x >> (8 * i) & 255u));
  }
  std::string text_;
};

}  // namespace glisson::view
