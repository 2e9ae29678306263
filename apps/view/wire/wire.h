// wire.h — what page and program of the live view send each other. Written by scripts/make_wire from messages.toml: change that.
// clang-format off
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "glisson/math.h"
#include "view/wire/payload.h"

namespace glisson::view {

/// What a surface can be coloured by. The page has the displacement anyway.
enum class Field : std::uint8_t { none = 0, intensity = 1, shape = 2, pressure = 3, von_mises = 4, contact_pressure = 5 };
inline constexpr std::size_t kFields = 6;

enum class CommandKind : std::uint8_t {
  place = 1,  ///< where a tool goes: depth, aside
  speed = 2,  ///< at which a tool goes there: speed
  grab = 3,  ///< takes a patch of the surface to a target: vertex, target
  drag = 4,  ///< takes what is grabbed to another target: target
  let_go = 5,  ///< lets go of what is grabbed
  pause = 6,  ///< rests or goes on: paused
  step = 7,  ///< one frame while paused
  reset = 8,  ///< back to rest, tools in hand
  play = 9,  ///< back to rest, then the scene's own motion
  parameter = 10,  ///< changes the tissue: parameter, value
  take = 11,  ///< asks for the lead; needs no lead
  give = 12,  ///< gives the lead away
  cut = 13,  ///< moves the blade: begins, edge
  colour = 14,  ///< the field that this viewer is sent; needs no lead: field
  seek = 15,  ///< of a recorded run: goes to a time: time
  rate = 16,  ///< of a recorded run: how fast it plays: rate
  visible = 17,  ///< whether the page is seen, a hidden one gets no frames; needs no lead: visible
  undo = 18,  ///< back to before the last stroke of the blade
  inside = 19,  ///< whether the whole body is sent; needs no lead: inside
};

/// Of the commands, from number 1 on.
inline constexpr std::array<Payload, 19> kPayloads{
    Payload{.values = 3, .least = -100.0f, .largest = 100.0f},
    Payload{.values = 1, .least = kAbove0, .largest = 10.0f},
    Payload{.index = true, .values = 3, .least = -100.0f, .largest = 100.0f},
    Payload{.values = 3, .least = -100.0f, .largest = 100.0f},
    Payload{},
    Payload{.index = true, .most_index = 1},
    Payload{},
    Payload{},
    Payload{},
    Payload{.index = true, .values = 1},
    Payload{},
    Payload{},
    Payload{.index = true, .values = 6, .most_index = 1, .least = -100.0f, .largest = 100.0f},
    Payload{.index = true, .most_index = 5},
    Payload{.values = 1, .least = 0.0f, .largest = 1000000000.0f},
    Payload{.values = 1, .least = 0.0001f, .largest = 1000.0f},
    Payload{.index = true, .most_index = 1},
    Payload{},
    Payload{.index = true, .most_index = 1},
};

namespace wire {

// Bytes: `Out` has a member of each type, and align().

/// Head of a command, from the page.
struct Command {
  std::uint8_t kind = 0;
  std::uint8_t tool = 0;
  std::uint32_t sequence = 0;  ///< counted from 1, which `echo` of a frame tells back
};
struct CommandAt {  // where its fields are
  static constexpr std::size_t kind = 0, tool = 1, sequence = 4, end = 8;
};
template <class Out>
void put(Out& out, const Command& x) {
  out.u8(x.kind);
  out.u8(x.tool);
  out.align();
  out.u32(x.sequence);
}

/// A region inside the body, a closed surface.
struct Region {
  std::string name;
  std::vector<std::uint32_t> triangles;
};
template <class Out>
void put(Out& out, const Region& x) {
  out.string(x.name);
  out.u32(static_cast<std::uint32_t>(x.triangles.size() / 3));
  for (const auto& each : x.triangles) out.u32(each);
}

/// Tets of the whole body, whose inner vertices come last.
struct Tets {
  std::vector<std::uint32_t> tets;
};
template <class Out>
void put(Out& out, const Tets& x) {
  out.u32(static_cast<std::uint32_t>(x.tets.size() / 4));
  for (const auto& each : x.tets) out.u32(each);
}

/// What the triangles of a keyframe are, and what is inside.
struct Inside {
  std::vector<std::uint8_t> kinds;  ///< 1 a face that was cut, 2 skin whose capsule is torn
  std::string tissue;  ///< name of the largest region; may be empty
  std::vector<Region> regions;
  std::optional<Tets> whole;  ///< to those who asked for the inside; bit 31 of `number` is set then
};
template <class Out>
void put(Out& out, const Inside& x) {
  for (const auto& each : x.kinds) out.u8(each);
  out.align();
  out.string(x.tissue);
  out.u32(static_cast<std::uint32_t>(x.regions.size()));
  for (const auto& each : x.regions) put(out, each);
  if (x.whole) put(out, *x.whole);
}

/// The surface at rest; first, and again when a cut has changed it.
struct Keyframe {
  std::uint32_t number = 0;  ///< that frames refer to
  std::vector<Vec3d> rest;  ///< [m]
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint8_t> marks;  ///< 1 held, 2 driven
  std::optional<Inside> inside;  ///< an old program sends none
};
template <class Out>
void put(Out& out, const Keyframe& x) {
  out.u8(1);
  out.align();
  out.u32(x.number);
  out.u32(static_cast<std::uint32_t>(x.rest.size()));
  out.u32(static_cast<std::uint32_t>(x.triangles.size() / 3));
  for (const auto& each : x.rest) out.vec3(each);
  for (const auto& each : x.triangles) out.u32(each);
  for (const auto& each : x.marks) out.u8(each);
  if (x.inside) put(out, *x.inside);
}

/// A tool in a frame.
struct Tool {
  double depth = 0.0;  ///< [m]
  Vec3d force{};  ///< [N], on the tissue
  std::array<double, 9> axes{};  ///< rows of its rotation
  std::array<double, 2> aside{};  ///< [m], along its x and y
  std::vector<Vec3d> points;  ///< [m], a needle's line from the hand to the tip, else the tip
};
template <class Out>
void put(Out& out, const Tool& x) {
  out.f32(x.depth);
  out.vec3(x.force);
  for (const auto& each : x.axes) out.f32(each);
  for (const auto& each : x.aside) out.f32(each);
  out.u32(static_cast<std::uint32_t>(x.points.size()));
  for (const auto& each : x.points) out.vec3(each);
}

/// One instant.
struct Frame {
  bool paused = false;
  bool building = false;
  bool playing = false;
  bool grabbing = false;
  bool stopped = false;
  std::uint8_t field = 0;  ///< `Field` of the values
  std::uint32_t keyframe = 0;  ///< number of the keyframe it is read with
  std::uint32_t epoch = 0;  ///< counts the bodies made
  std::uint32_t echo = 0;  ///< sequence of the last command that acted with all before it
  double time = 0.0;  ///< [s], simulated
  double realtime_factor = 0.0;
  double p50 = 0.0;  ///< [µs], of the computing of 1 ms
  double p99 = 0.0;  ///< [µs]
  std::uint32_t dropped = 0;  ///< frames that were over before their turn
  Vec3d grab_force{};  ///< [N]
  double reach = 0.0;  ///< [m], largest component of a displacement
  double low = 0.0;  ///< least of the field's values
  double high = 0.0;  ///< largest of them
  std::vector<Tool> tools;
  std::vector<std::int16_t> displacement;  ///< × `reach` / 32767, in m
  std::vector<std::uint8_t> values;  ///< `low` + (`high` − `low`) × this / 255
};
struct FrameAt {  // where its fields are
  static constexpr std::size_t kind = 0, flags = 1, tool_count = 2, field = 3, keyframe = 4, epoch = 8, echo = 12, time = 16, realtime_factor = 24, p50 = 28, p99 = 32, dropped = 36, grab_force = 40, reach = 52, low = 56, high = 60, end = 64;
};
template <class Out>
void put(Out& out, const Frame& x) {
  out.u8(2);
  out.u8(static_cast<std::uint8_t>((x.paused ? 1u : 0u) | (x.building ? 2u : 0u) | (x.playing ? 4u : 0u) | (x.grabbing ? 8u : 0u) | (x.stopped ? 16u : 0u)));
  out.u8(static_cast<std::uint8_t>(x.tools.size()));
  out.u8(x.field);
  out.u32(x.keyframe);
  out.u32(x.epoch);
  out.u32(x.echo);
  out.f64(x.time);
  out.f32(x.realtime_factor);
  out.f32(x.p50);
  out.f32(x.p99);
  out.u32(x.dropped);
  out.vec3(x.grab_force);
  out.f32(x.reach);
  out.f32(x.low);
  out.f32(x.high);
  for (const auto& each : x.tools) put(out, each);
  for (const auto& each : x.displacement) out.i16(each);
  for (const auto& each : x.values) out.u8(each);
}

/// Forces of a millisecond.
struct Sample {
  std::uint32_t epoch = 0;
  double time = 0.0;  ///< [s]
  std::vector<double> readings;  ///< depth in m and force along its direction in N, of each tool
};
template <class Out>
void put(Out& out, const Sample& x) {
  out.u32(x.epoch);
  out.f32(x.time);
  for (const auto& each : x.readings) out.f32(each);
}

/// Forces since this viewer's last frame, 4000 at most.
struct Samples {
  std::uint8_t tools = 0;
  std::vector<Sample> rows;
};
template <class Out>
void put(Out& out, const Samples& x) {
  out.u8(3);
  out.u8(x.tools);
  out.align();
  out.u32(static_cast<std::uint32_t>(x.rows.size()));
  for (const auto& each : x.rows) put(out, each);
}

// JSON.

template <class Json, class T>
Json list_of(const std::vector<T>& all) {
  Json list = Json::array();
  for (const T& each : all) list.push_back(json_of<Json>(each));
  return list;
}

/// A tool, before anything moves.
struct ToolInfo {
  std::string name;
  bool instrument = false;  ///< false: a set of vertices that is driven
  std::vector<double> direction;  ///< of its depth, a unit vector
  std::vector<double> side;  ///< across it: its own x
  std::vector<double> third;  ///< across both: its own y
  double least_m = 0.0;  ///< [m], least depth
  double most_m = 0.0;  ///< [m], largest depth
  double speed_m_s = 0.0;  ///< [m/s], that of the scene
  bool can_play = false;  ///< the scene moves it
};
template <class Json>
Json json_of(const ToolInfo& x) {
  return {{"name", x.name},
          {"instrument", x.instrument},
          {"direction", x.direction},
          {"side", x.side},
          {"third", x.third},
          {"least_m", x.least_m},
          {"most_m", x.most_m},
          {"speed_m_s", x.speed_m_s},
          {"can_play", x.can_play}};
}

/// A number of a tissue that can be changed while the body moves.
struct ParameterInfo {
  std::string label;
  std::string unit;
  double least = 0.0;
  double most = 0.0;
  double value = 0.0;
  bool log = false;  ///< better chosen by its logarithm
  std::string tissue;
  std::string group;  ///< of numbers that belong together
  std::string formula;  ///< may be empty
  std::string help;
};
template <class Json>
Json json_of(const ParameterInfo& x) {
  return {{"label", x.label},
          {"unit", x.unit},
          {"least", x.least},
          {"most", x.most},
          {"value", x.value},
          {"log", x.log},
          {"tissue", x.tissue},
          {"group", x.group},
          {"formula", x.formula},
          {"help", x.help}};
}

/// A run that is played, not simulated.
struct Recorded {
  double start_s = 0.0;  ///< [s], time of the first frame
  double end_s = 0.0;  ///< [s], time of the last frame
  std::uint64_t frames = 0;
};
template <class Json>
Json json_of(const Recorded& x) {
  return {{"start_s", x.start_s},
          {"end_s", x.end_s},
          {"frames", x.frames}};
}

/// Something that a tool met.
struct LiveEvent {
  std::string tool;
  std::string event;
  double time_s = 0.0;  ///< [s]
  double depth_m = 0.0;  ///< [m]
};
template <class Json>
Json json_of(const LiveEvent& x) {
  return {{"tool", x.tool},
          {"event", x.event},
          {"time_s", x.time_s},
          {"depth_m", x.depth_m}};
}

/// The scene; once, first of all.
struct Hello {
  std::string title;
  std::string variant;
  std::string version;  ///< of the program
  std::string session;  ///< key of this viewer
  std::uint64_t vertices = 0;
  std::uint64_t tets = 0;
  bool can_grab = false;
  std::string why_no_cut;  ///< empty: the body can be cut
  bool has_stress = false;  ///< stress and contact pressure can be shown
  std::vector<ToolInfo> tools;
  std::vector<ParameterInfo> parameters;
  std::optional<Recorded> recorded;
  bool can_record = false;
  std::string container;  ///< JSON; empty: none
  std::string instruments;  ///< JSON; empty: none
};
template <class Json>
Json json_of(const Hello& x) {
  return {{"type", "hello"},
          {"title", x.title},
          {"variant", x.variant},
          {"version", x.version},
          {"session", x.session},
          {"vertices", x.vertices},
          {"tets", x.tets},
          {"can_grab", x.can_grab},
          {"why_no_cut", x.why_no_cut},
          {"has_stress", x.has_stress},
          {"tools", list_of<Json>(x.tools)},
          {"parameters", list_of<Json>(x.parameters)},
          {"recorded", x.recorded ? json_of<Json>(*x.recorded) : Json()},
          {"can_record", x.can_record},
          {"container", x.container.empty() ? Json() : Json::parse(x.container)},
          {"instruments", x.instruments.empty() ? Json() : Json::parse(x.instruments)}};
}

/// Who leads; on each change.
struct Role {
  bool drives = false;  ///< this viewer leads
  bool led = false;  ///< some viewer leads
  std::uint64_t viewers = 0;
};
template <class Json>
Json json_of(const Role& x) {
  return {{"type", "role"},
          {"drives", x.drives},
          {"led", x.led},
          {"viewers", x.viewers}};
}

/// What changes seldom; ten a second at most.
struct SlowState {
  std::uint64_t epoch = 0;  ///< counts the bodies made
  std::vector<double> parameters;  ///< in the order of `hello`
  std::vector<double> speeds_m_s;  ///< [m/s], of each tool
  double cut_area_m2 = 0.0;  ///< [m²], of what the blade has cut, at rest
  double cut_longest_s = 0.0;  ///< [s], that a piece of a cut took
  std::uint64_t pieces = 0;  ///< that the body is in
  std::uint64_t events_before = 0;  ///< how many came before these
  std::vector<LiveEvent> events;  ///< the last 32
};
template <class Json>
Json json_of(const SlowState& x) {
  return {{"type", "state"},
          {"epoch", x.epoch},
          {"parameters", x.parameters},
          {"speeds_m_s", x.speeds_m_s},
          {"cut_area_m2", x.cut_area_m2},
          {"cut_longest_s", x.cut_longest_s},
          {"pieces", x.pieces},
          {"events_before", x.events_before},
          {"events", list_of<Json>(x.events)}};
}

/// Errors and the like; empty: no more.
struct Notice {
  std::string text;
};
template <class Json>
Json json_of(const Notice& x) {
  return {{"type", "notice"},
          {"text", x.text}};
}

}  // namespace wire
}  // namespace glisson::view
