// command_bytes.h — the bytes of a message that hold a command.
//
//   head (wire::Command) │ index u32, where its kind has one │ values f32            little-endian; view/wire/messages.toml
//
// A message is read in one place, into plain numbers within their ranges, or refused with a reason; nothing of it is
// kept. view_fuzz.cpp feeds it any bytes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>

#include "view/state/command.h"

namespace glisson::view {

/// No message is longer [bytes].
inline constexpr std::size_t kLongestCommand = [] {
  std::size_t longest = 0;
  for (const Payload& payload : kPayloads) longest = std::max(longest, payload.bytes());
  return wire::CommandAt::end + longest;
}();

/// A place of a tool, a hand or a blade that makes no sense: it is counted, and the last good one stays.
struct BadPlace {
  std::string why;
};

/// @return the command, or why the bytes are none
std::variant<Command, BadPlace, std::string> decode_command(std::span<const std::uint8_t> bytes);
std::string encode_command(const Command& command);

}  // namespace glisson::view
