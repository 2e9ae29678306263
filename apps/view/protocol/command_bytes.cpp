// command_bytes.cpp — see command_bytes.h.
#include "view/protocol/command_bytes.h"

#include <bit>
#include <cmath>

#include "view/protocol/bytes.h"

namespace glisson::view {
namespace {

using wire::CommandAt;

static_assert(kLongestCommand <= CommandAt::end + 4 + sizeof(Command::values), "a Command holds what a message says");

bool known(std::uint8_t kind) { return kind >= 1 && kind <= kPayloads.size(); }

std::uint32_t u32_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16 | static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

bool is_place(CommandKind kind) {
  return kind == CommandKind::place || kind == CommandKind::grab || kind == CommandKind::drag ||
         kind == CommandKind::cut;
}

std::string index_trouble(CommandKind kind) {
  if (kind == CommandKind::pause) return "pause is 0 or 1";
  if (kind == CommandKind::visible) return "visible is 0 or 1";
  if (kind == CommandKind::inside) return "inside is 0 or 1";
  if (kind == CommandKind::colour) return "there is no such field";
  return "a cut begins, 1, or goes on, 0";
}

std::string range_trouble(const Command& command) {
  const Payload& payload = payload_of(command.kind);
  for (std::size_t i = 0; i < payload.values; ++i) {
    const float x = command.values[i];
    if (!std::isfinite(x)) return "a number is not finite";
    if (x < payload.least || x > payload.largest) return "a number is out of range";
  }
  return command.index > payload.most_index ? index_trouble(command.kind) : "";
}

}  // namespace

std::variant<Command, BadPlace, std::string> decode_command(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < CommandAt::end) return "a message has 8 bytes or more";
  if (!known(bytes[CommandAt::kind])) return "unknown kind of message";
  if (bytes[CommandAt::tool + 1] != 0 || bytes[CommandAt::tool + 2] != 0) return "reserved bytes are 0";
  Command command{.kind = static_cast<CommandKind>(bytes[CommandAt::kind]),
                  .tool = bytes[CommandAt::tool],
                  .sequence = u32_at(bytes, CommandAt::sequence)};
  const Payload& payload = payload_of(command.kind);
  std::size_t at = CommandAt::end;
  if (bytes.size() != at + payload.bytes()) return "a message of this kind has another length";
  if (payload.index) {
    command.index = u32_at(bytes, at);
    at += 4;
  }
  for (std::size_t i = 0; i < payload.values; ++i, at += 4) command.values[i] = std::bit_cast<float>(u32_at(bytes, at));
  std::string trouble = range_trouble(command);
  if (trouble.empty()) return command;
  if (is_place(command.kind)) return BadPlace{std::move(trouble)};
  return trouble;
}

std::string encode_command(const Command& command) {
  Bytes out;
  put(out, wire::Command{
               .kind = static_cast<std::uint8_t>(command.kind), .tool = command.tool, .sequence = command.sequence});
  const Payload& payload = payload_of(command.kind);
  if (payload.index) out.u32(command.index);
  for (std::size_t i = 0; i < payload.values; ++i) out.f32(static_cast<double>(command.values[i]));
  return out.take();
}

}  // namespace glisson::view
