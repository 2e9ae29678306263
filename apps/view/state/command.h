// command.h — what a viewer may ask for: plain numbers within their ranges. view/protocol/command_bytes.h reads them from messages.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace glisson::view {

enum class CommandKind : std::uint8_t {
  place = 1,       ///< of a tool: depth, aside along its x and y [m]
  speed = 2,       ///< at which a tool goes there [m/s]
  grab = 3,        ///< index: vertex of the surface; where it is to be drawn [m]; tool 1: bonded, 0: by springs
  drag = 4,        ///< of what is grabbed: where to [m]
  let_go = 5,      ///< of what is grabbed
  pause = 6,       ///< index: 1 rest, 0 go on
  step = 7,        ///< one frame while at rest
  reset = 8,       ///< back to rest, tools in hand
  play = 9,        ///< back to rest, then the scene's own motion
  parameter = 10,  ///< index: which one, values[0]: to what
  take = 11,       ///< asks for the lead
  give = 12,       ///< gives the lead away
  cut = 13,        ///< index: 1 puts a blade there, 0 leads it there, cutting; its edge, from where to where [m]
  colour = 14,     ///< index: Field that this viewer wants to see; needs no lead
  seek = 15,       ///< of a recorded run: to this time [s]
  rate = 16,       ///< of a recorded run: simulated time over that of the clock
  undo = 18,       ///< back to before the last stroke of the blade
  inside = 19,     ///< index: 1 this viewer wants the whole body, 0 its surfaces; needs no lead
  visible = 17     ///< index: 1 this viewer is seen, 0 its page is hidden; needs no lead
};

struct Command {
  CommandKind kind = CommandKind::pause;
  std::uint8_t tool = 0;
  std::uint32_t sequence = 0;  ///< counted by the viewer from 1; a frame tells the last one that acted
  std::uint32_t index = 0;
  std::array<float, 6> values{};
};

/// What a surface can be coloured by. Displacement is the page's own affair: it has that anyway.
enum class Field : std::uint8_t { none, intensity, shape, pressure, von_mises, contact_pressure };
inline constexpr std::size_t kFields = 6;
/// Whether a field follows from the stress.
constexpr bool is_of_stress(Field field) { return field == Field::pressure || field == Field::von_mises; }

/// Lengths and speeds beyond are refused, whatever the scene [m], [m/s].
inline constexpr float kFarthest = 100.0f, kFastest = 10.0f;
/// Times and rates of a recorded run beyond are refused [s], [-].
inline constexpr float kLatest = 1e9f, kSlowestRate = 1e-4f, kFastestRate = 1e3f;

}  // namespace glisson::view
