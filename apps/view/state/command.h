// command.h — what a viewer may ask for: plain numbers within their ranges. view/wire/messages.toml has the kinds and
// what each of them says; view/protocol/command_bytes.h reads them from messages.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "view/wire/wire.h"

namespace glisson::view {

struct Command {
  CommandKind kind = CommandKind::pause;
  std::uint8_t tool = 0;
  std::uint32_t sequence = 0;  ///< counted by the viewer from 1; a frame tells the last one that acted
  std::uint32_t index = 0;
  std::array<float, 6> values{};
};

/// Whether a field follows from the stress.
constexpr bool is_of_stress(Field field) { return field == Field::pressure || field == Field::von_mises; }

/// What follows the head of a command of this kind, within which bounds.
constexpr const Payload& payload_of(CommandKind kind) { return kPayloads[static_cast<std::size_t>(kind) - 1]; }

}  // namespace glisson::view
