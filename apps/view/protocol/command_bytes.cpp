// command_bytes.cpp — see command_bytes.h.
#include "view/protocol/command_bytes.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace glisson::view {
namespace {

constexpr std::size_t kHead = 8;

/// What follows the head: a number and some floats.
struct Payload {
  bool index = false;
  std::size_t values = 0;
  std::size_t bytes() const { return (index ? 4 : 0) + 4 * values; }
};

bool known(std::uint8_t kind) { return kind >= 1 && kind <= 19; }

Payload payload_of(CommandKind kind) {
  switch (kind) {
    case CommandKind::place:
    case CommandKind::drag:
      return {false, 3};
    case CommandKind::speed:
    case CommandKind::seek:
    case CommandKind::rate:
      return {false, 1};
    case CommandKind::grab:
      return {true, 3};
    case CommandKind::pause:
    case CommandKind::colour:
    case CommandKind::visible:
    case CommandKind::inside:
      return {true, 0};
    case CommandKind::parameter:
      return {true, 1};
    case CommandKind::cut:
      return {true, 6};
    default:
      return {};
  }
}

std::uint32_t u32_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16 | static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

void put_u32(std::string& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<char>(value >> shift & 255u));
}

bool in_range(CommandKind kind, float x) {
  if (kind == CommandKind::speed) return x > 0.0f && x <= kFastest;
  if (kind == CommandKind::seek) return x >= 0.0f && x <= kLatest;
  if (kind == CommandKind::rate) return x >= kSlowestRate && x <= kFastestRate;
  return std::abs(x) <= kFarthest;
}

bool is_place(CommandKind kind) {
  return kind == CommandKind::place || kind == CommandKind::grab || kind == CommandKind::drag ||
         kind == CommandKind::cut;
}

std::string range_trouble(const Command& command, std::size_t values) {
  for (std::size_t i = 0; i < values; ++i) {
    const float x = command.values[i];
    if (!std::isfinite(x)) return "a number is not finite";
    if (command.kind == CommandKind::parameter) continue;  // the engine knows its range
    if (!in_range(command.kind, x)) return "a number is out of range";
  }
  if (command.kind == CommandKind::pause && command.index > 1) return "pause is 0 or 1";
  if (command.kind == CommandKind::visible && command.index > 1) return "visible is 0 or 1";
  if (command.kind == CommandKind::inside && command.index > 1) return "inside is 0 or 1";
  if (command.kind == CommandKind::colour && command.index >= kFields) return "there is no such field";
  if (command.kind == CommandKind::cut && command.index > 1) return "a cut begins, 1, or goes on, 0";
  return {};
}

}  // namespace

std::variant<Command, BadPlace, std::string> decode_command(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHead) return "a message has 8 bytes or more";
  if (!known(bytes[0])) return "unknown kind of message";
  if (bytes[2] != 0 || bytes[3] != 0) return "reserved bytes are 0";
  Command command{.kind = static_cast<CommandKind>(bytes[0]), .tool = bytes[1], .sequence = u32_at(bytes, 4)};
  const Payload payload = payload_of(command.kind);
  if (bytes.size() != kHead + payload.bytes()) return "a message of this kind has another length";
  std::size_t at = kHead;
  if (payload.index) {
    command.index = u32_at(bytes, at);
    at += 4;
  }
  for (std::size_t i = 0; i < payload.values; ++i, at += 4) command.values[i] = std::bit_cast<float>(u32_at(bytes, at));
  std::string trouble = range_trouble(command, payload.values);
  if (trouble.empty()) return command;
  if (is_place(command.kind)) return BadPlace{std::move(trouble)};
  return trouble;
}

std::string encode_command(const Command& command) {
  std::string out{static_cast<char>(command.kind), static_cast<char>(command.tool), 0, 0};
  put_u32(out, command.sequence);
  const Payload payload = payload_of(command.kind);
  if (payload.index) put_u32(out, command.index);
  for (std::size_t i = 0; i < payload.values; ++i) put_u32(out, std::bit_cast<std::uint32_t>(command.values[i]));
  return out;
}

}  // namespace glisson::view
