// checkpoint.h — the file of a checkpoint.
//
//   "GLISSON1" │ size of the contents u64 │ contents (glisson/archive.h) │ their checksum u64        all little-endian
//
// What is not in it: mesh, tissues, options, motions and loads of the start, which the one who loads has made anew, and checks
// by fingerprints that they are the same.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <span>

#include "glisson/archive.h"

namespace glisson {

/// FNV-1a over bytes, from where an earlier one left off.
inline constexpr std::uint64_t kHashStart = 14695981039346656037ULL;
std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t hash = kHashStart);
template <class T>
std::uint64_t hash_numbers(std::span<const T> numbers, std::uint64_t hash = kHashStart) {
  return hash_bytes(std::as_bytes(numbers), hash);
}

/// @throws std::runtime_error where it cannot be written
void write_checkpoint(const Archive& contents, std::ostream& out);
/// What write_checkpoint was given, to be read. @throws std::runtime_error saying what is wrong with the file
Archive read_checkpoint(std::istream& in);

}  // namespace glisson
