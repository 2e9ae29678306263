// command_bytes.h — the bytes of a message that hold a command.
//
//   kind u8 │ tool u8 │ 0 u16 │ sequence u32 │ payload            little-endian; docs/view.md has the payloads
//
// A message is read in one place, into plain numbers within their ranges, or refused with a reason; nothing of it is
// kept. view_fuzz.cpp feeds it any bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>

#include "view/state/command.h"

namespace glisson::view {

/// No message is longer [bytes].
inline constexpr std::size_t kLongestCommand = 36;

/// A place of a tool, a hand or a blade that makes no sense: it is counted, and the last good one stays.
struct BadPlace {
  std::string why;
};

/// @return the command, or why the bytes are none
std::variant<Command, BadPlace, std::string> decode_command(std::span<const std::uint8_t> bytes);
std::string encode_command(const Command& command);

}  // namespace glisson::view
