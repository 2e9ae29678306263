// messages.cpp — see messages.h.
#include "view/protocol/messages.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/fractions.h"
#include "report/json_text.h"
#include "view/protocol/bytes.h"
#include "view/wire/wire.h"

namespace glisson::view {
namespace {

using nlohmann::json;

constexpr std::size_t kMostSamples = 4000;

wire::Tool wire_of(const ToolState& tool) {
  wire::Tool out{.depth = tool.depth,
                 .force = tool.force,
                 .axes = {},
                 .aside = {tool.aside[0], tool.aside[1]},
                 .points = tool.line};
  for (std::size_t k = 0; k < 9; ++k) out.axes[k] = tool.axes.m[k / 3][k % 3];
  return out;
}

/// All of a frame but its displacements.
wire::Frame frame_without_places(const Snapshot& state, std::uint32_t keyframe) {
  wire::Frame frame;
  frame.paused = state.paused;
  frame.building = state.building;
  frame.playing = state.playing;
  frame.grabbing = state.grabbing;
  frame.stopped = state.stopped;
  frame.keyframe = keyframe;
  frame.epoch = state.epoch;
  frame.echo = state.echo;
  frame.time = state.time;
  frame.realtime_factor = state.realtime_factor;
  frame.p50 = state.p50_us;
  frame.p99 = state.p99_us;
  frame.dropped = static_cast<std::uint32_t>(state.dropped);
  frame.grab_force = state.grab_force;
  for (const ToolState& tool : state.tools) frame.tools.push_back(wire_of(tool));
  return frame;
}

/// A displacement as it is drawn: at the rim of the picture where it leads beyond, since all are fractions of the largest.
Vec3d shown(const Vec3d& u, const Surface& surface) {
  const double far = norm(u), most = surface.rim();
  return far > most ? u * (most / far) : u;
}

std::vector<double> numbers(const Vec3d& v) { return {v.x, v.y, v.z}; }

wire::ToolInfo wire_of(const ToolInfo& x) {
  return {.name = x.name,
          .instrument = x.instrument,
          .direction = numbers(x.direction),
          .side = numbers(x.side),
          .third = numbers(x.third),
          .least_m = x.least_depth,
          .most_m = x.most_depth,
          .speed_m_s = x.speed,
          .can_play = x.can_play};
}

wire::ParameterInfo wire_of(const ParameterInfo& x) {
  return {.label = x.label,
          .unit = x.unit,
          .least = x.least,
          .most = x.most,
          .value = x.value,
          .log = x.log,
          .tissue = x.tissue,
          .group = x.group,
          .formula = x.formula,
          .help = x.help};
}

template <class Text>
std::string text_of(const Text& text) {
  return json_text(wire::json_of<json>(text));
}

}  // namespace

std::string keyframe_message(const Surface& surface, std::uint32_t number) {
  wire::Inside inside{.kinds = surface.kinds(), .tissue = surface.tissue(), .regions = {}, .whole = {}};
  for (const Surface::Region& region : surface.regions()) inside.regions.push_back({region.name, region.triangles});
  if (!surface.tets().empty()) inside.whole = wire::Tets{surface.tets()};
  wire::Keyframe keyframe{
      .number = number, .rest = {}, .triangles = surface.triangles(), .marks = {}, .inside = std::move(inside)};
  for (std::size_t i = 0; i < surface.size(); ++i) {
    keyframe.rest.push_back(surface.rest(i));
    keyframe.marks.push_back(surface.mark(i));
  }
  Bytes out;
  out.reserve(64 + 13 * surface.size() + 5 * surface.triangles().size());
  put(out, keyframe);
  return out.take();
}

std::string frame_message(const Snapshot& state, const Surface& surface, std::uint32_t keyframe) {
  wire::Frame frame = frame_without_places(state, keyframe);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const Vec3d u = shown(state.displacement[surface.mesh_vertex(i)], surface);
    for (std::size_t k = 0; k < 3; ++k) frame.reach = std::max(frame.reach, std::isfinite(u[k]) ? std::abs(u[k]) : 0.0);
  }
  frame.displacement.reserve(3 * surface.size());
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const Vec3d u = shown(state.displacement[surface.mesh_vertex(i)], surface);
    for (std::size_t k = 0; k < 3; ++k) frame.displacement.push_back(fraction16(u[k], frame.reach));
  }
  Bytes out;
  out.reserve(256 + 7 * surface.size());
  put(out, frame);
  return out.take();
}

std::string with_field(std::string frame, Field field, const std::vector<double>& values) {
  double low = field == Field::shape ? 1.0 : 0.0, high = low;  // what there is at rest is in the range
  for (const double x : values) {
    if (!std::isfinite(x)) continue;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  Bytes tail;
  tail.f32(low);
  tail.f32(high);
  for (const double x : values) tail.u8(fraction8(x - low, high - low));
  const std::string bytes = tail.take();
  constexpr std::size_t kRange = wire::FrameAt::end - wire::FrameAt::low;
  frame[wire::FrameAt::field] = static_cast<char>(field);
  frame.replace(wire::FrameAt::low, kRange, bytes, 0, kRange);
  return frame.append(bytes, kRange, std::string::npos);
}

std::string samples_message(const std::deque<ForceSample>& history, std::size_t from, std::size_t tools) {
  const std::size_t first = std::max(from, history.size() > kMostSamples ? history.size() - kMostSamples : 0);
  wire::Samples samples{.tools = static_cast<std::uint8_t>(tools), .rows = {}};
  for (std::size_t i = first; i < history.size(); ++i) {
    wire::Sample row{.epoch = history[i].epoch, .time = static_cast<double>(history[i].time), .readings = {}};
    for (std::size_t k = 0; k < tools; ++k) {
      row.readings.push_back(static_cast<double>(history[i].depth[k]));
      row.readings.push_back(static_cast<double>(history[i].force[k]));
    }
    samples.rows.push_back(std::move(row));
  }
  Bytes out;
  put(out, samples);
  return out.take();
}

std::string hello_message(const Source& source, const SceneFacts& facts, const std::string& session) {
  wire::Hello hello{.title = facts.title,
                    .variant = facts.variant,
                    .version = facts.version,
                    .session = session,
                    .vertices = source.vertices(),
                    .tets = source.tets(),
                    .can_grab = source.can_grab(),
                    .why_no_cut = source.why_no_cut(),
                    .has_stress = source.has_stress(),
                    .tools = {},
                    .parameters = {},
                    .recorded = {},
                    .can_record = static_cast<bool>(facts.recorder),
                    .container = source.vessel(),
                    .instruments = facts.instruments};
  for (const ToolInfo& x : source.tools()) hello.tools.push_back(wire_of(x));
  for (const ParameterInfo& x : source.parameters()) hello.parameters.push_back(wire_of(x));
  if (const Recorded* x = source.recorded()) hello.recorded = {x->start, x->end, x->frames};
  return text_of(hello);
}

std::string role_message(bool drives, bool led, std::size_t viewers) {
  return text_of(wire::Role{.drives = drives, .led = led, .viewers = viewers});
}

std::string state_message(const Snapshot& state, std::size_t pieces) {
  wire::SlowState slow{.epoch = state.epoch,
                       .parameters = state.parameters,
                       .speeds_m_s = state.speeds,
                       .cut_area_m2 = state.cut_area,
                       .cut_longest_s = state.cut_longest,
                       .pieces = pieces,
                       .events_before = state.events_before,
                       .events = {}};
  for (const LiveEvent& x : state.events) slow.events.push_back({x.tool, x.what, x.time, x.depth});
  return text_of(slow);
}

std::string notice_message(const std::string& text) { return text_of(wire::Notice{text}); }

}  // namespace glisson::view
