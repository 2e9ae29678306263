// messages.cpp — see messages.h.
#include "view/protocol/messages.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/fractions.h"
#include "report/json_text.h"

namespace glisson::view {
namespace {

using nlohmann::json;

constexpr std::size_t kMostSamples = 4000;
constexpr std::size_t kFieldAt = 3, kRangeAt = 56;  // of a frame

/// Little-endian numbers one after the other.
class Bytes {
 public:
  void u8(std::uint8_t x) { text_.push_back(static_cast<char>(x)); }
  void u16(std::uint16_t x) { put(x, 2); }
  void u32(std::uint32_t x) { put(x, 4); }
  void f32(double x) { u32(std::bit_cast<std::uint32_t>(static_cast<float>(x))); }
  void f64(double x) { put(std::bit_cast<std::uint64_t>(x), 8); }
  void vec(const Vec3d& v) {
    for (std::size_t k = 0; k < 3; ++k) f32(v[k]);
  }
  void align() {
    while (text_.size() % 4 != 0) u8(0);
  }
  void words(const std::string& text) {
    u32(static_cast<std::uint32_t>(text.size()));
    text_ += text;
    align();
  }
  void triangles(const std::vector<std::uint32_t>& corners) {
    for (const std::uint32_t corner : corners) u32(corner);
  }
  std::string take() { return std::move(text_); }
  void reserve(std::size_t bytes) { text_.reserve(bytes); }

 private:
  void put(std::uint64_t x, int bytes) {
    for (int i = 0; i < bytes; ++i) u8(static_cast<std::uint8_t>(x >> (8 * i) & 255u));
  }
  std::string text_;
};

std::uint8_t flags_of(const Snapshot& state) {
  unsigned flags = 0;
  const std::array<bool, 5> bits{state.paused, state.building, state.playing, state.grabbing, state.stopped};
  for (std::size_t i = 0; i < bits.size(); ++i) flags |= bits[i] ? 1u << i : 0u;
  return static_cast<std::uint8_t>(flags);
}

void put_head(Bytes& out, const Snapshot& state, std::uint32_t keyframe) {
  out.u8(static_cast<std::uint8_t>(MessageKind::frame));
  out.u8(flags_of(state));
  out.u8(static_cast<std::uint8_t>(state.tools.size()));
  out.u8(static_cast<std::uint8_t>(Field::none));
  out.u32(keyframe);
  out.u32(state.epoch);
  out.u32(state.echo);
  out.f64(state.time);
  out.f32(state.realtime_factor);
  out.f32(state.p50_us);
  out.f32(state.p99_us);
  out.u32(static_cast<std::uint32_t>(state.dropped));
  out.vec(state.grab_force);
}

void put_tool(Bytes& out, const ToolState& tool) {
  out.f32(tool.depth);
  out.vec(tool.force);
  for (const auto& row : tool.axes.m) {
    for (const double x : row) out.f32(x);
  }
  for (const double x : tool.aside) out.f32(x);
  out.u32(static_cast<std::uint32_t>(tool.line.size()));
  for (const Vec3d& x : tool.line) out.vec(x);
}

/// A displacement as it is drawn: at the rim of the picture where it leads beyond, since all are fractions of the largest.
Vec3d shown(const Vec3d& u, const Surface& surface) {
  const double far = norm(u), most = surface.rim();
  return far > most ? u * (most / far) : u;
}

json numbers(const Vec3d& v) { return {v.x, v.y, v.z}; }

json tool_json(const ToolInfo& x) {
  return {{"name", x.name},          {"instrument", x.instrument}, {"direction", numbers(x.direction)},
          {"side", numbers(x.side)}, {"third", numbers(x.third)},  {"least_m", x.least_depth},
          {"most_m", x.most_depth},  {"speed_m_s", x.speed},       {"can_play", x.can_play}};
}

json recorded_json(const Recorded* recorded) {
  if (recorded == nullptr) return nullptr;
  return {{"start_s", recorded->start}, {"end_s", recorded->end}, {"frames", recorded->frames}};
}

}  // namespace

std::string keyframe_message(const Surface& surface, std::uint32_t number) {
  Bytes out;
  out.reserve(64 + 13 * surface.size() + 5 * surface.triangles().size());
  out.u8(static_cast<std::uint8_t>(MessageKind::keyframe));
  out.align();
  out.u32(number);
  out.u32(static_cast<std::uint32_t>(surface.size()));
  out.u32(static_cast<std::uint32_t>(surface.triangles().size() / 3));
  for (std::size_t i = 0; i < surface.size(); ++i) out.vec(surface.rest(i));
  out.triangles(surface.triangles());
  for (std::size_t i = 0; i < surface.size(); ++i) out.u8(surface.mark(i));
  for (const std::uint8_t kind : surface.kinds()) out.u8(kind);
  out.align();
  out.words(surface.tissue());
  out.u32(static_cast<std::uint32_t>(surface.regions().size()));
  for (const Surface::Region& region : surface.regions()) {
    out.words(region.name);
    out.u32(static_cast<std::uint32_t>(region.triangles.size() / 3));
    out.triangles(region.triangles);
  }
  if (!surface.tets().empty()) {
    out.u32(static_cast<std::uint32_t>(surface.tets().size() / 4));
    out.triangles(surface.tets());
  }
  return out.take();
}

std::string frame_message(const Snapshot& state, const Surface& surface, std::uint32_t keyframe) {
  double reach = 0.0;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const Vec3d u = shown(state.displacement[surface.mesh_vertex(i)], surface);
    for (std::size_t k = 0; k < 3; ++k) reach = std::max(reach, std::isfinite(u[k]) ? std::abs(u[k]) : 0.0);
  }
  Bytes out;
  out.reserve(256 + 7 * surface.size());
  put_head(out, state, keyframe);
  out.f32(reach);
  out.f32(0.0);  // with_field puts the range here
  out.f32(0.0);
  for (const ToolState& tool : state.tools) put_tool(out, tool);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const Vec3d u = shown(state.displacement[surface.mesh_vertex(i)], surface);
    for (std::size_t k = 0; k < 3; ++k) out.u16(static_cast<std::uint16_t>(fraction16(u[k], reach)));
  }
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
  frame[kFieldAt] = static_cast<char>(field);
  frame.replace(kRangeAt, 8, bytes, 0, 8);
  return frame.append(bytes, 8, std::string::npos);
}

std::string samples_message(const std::deque<ForceSample>& history, std::size_t from, std::size_t tools) {
  const std::size_t first = std::max(from, history.size() > kMostSamples ? history.size() - kMostSamples : 0);
  Bytes out;
  out.u8(static_cast<std::uint8_t>(MessageKind::samples));
  out.u8(static_cast<std::uint8_t>(tools));
  out.align();
  out.u32(static_cast<std::uint32_t>(history.size() - first));
  for (std::size_t i = first; i < history.size(); ++i) {
    out.u32(history[i].epoch);
    out.f32(static_cast<double>(history[i].time));
    for (std::size_t k = 0; k < tools; ++k) {
      out.f32(static_cast<double>(history[i].depth[k]));
      out.f32(static_cast<double>(history[i].force[k]));
    }
  }
  return out.take();
}

std::string hello_message(const Source& source, const SceneFacts& facts, const std::string& session) {
  json tools = json::array(), parameters = json::array();
  for (const ToolInfo& x : source.tools()) tools.push_back(tool_json(x));
  for (const ParameterInfo& x : source.parameters()) {
    parameters.push_back({{"label", x.label},
                          {"unit", x.unit},
                          {"least", x.least},
                          {"most", x.most},
                          {"value", x.value},
                          {"log", x.log},
                          {"tissue", x.tissue},
                          {"group", x.group},
                          {"formula", x.formula},
                          {"help", x.help}});
  }
  return json_text(json{{"type", "hello"},
                        {"title", facts.title},
                        {"variant", facts.variant},
                        {"version", facts.version},
                        {"session", session},
                        {"vertices", source.vertices()},
                        {"tets", source.tets()},
                        {"can_grab", source.can_grab()},
                        {"why_no_cut", source.why_no_cut()},
                        {"has_stress", source.has_stress()},
                        {"tools", std::move(tools)},
                        {"parameters", std::move(parameters)},
                        {"recorded", recorded_json(source.recorded())},
                        {"can_record", static_cast<bool>(facts.recorder)},
                        {"container", source.vessel().empty() ? json() : json::parse(source.vessel())},
                        {"instruments", json::parse(facts.instruments)}});
}

std::string role_message(bool drives, bool led, std::size_t viewers) {
  return json_text(json{{"type", "role"}, {"drives", drives}, {"led", led}, {"viewers", viewers}});
}

std::string state_message(const Snapshot& state, std::size_t pieces) {
  json events = json::array();
  for (const LiveEvent& x : state.events) {
    events.push_back({{"tool", x.tool}, {"event", x.what}, {"time_s", x.time}, {"depth_m", x.depth}});
  }
  return json_text(json{{"type", "state"},
                        {"epoch", state.epoch},
                        {"parameters", state.parameters},
                        {"speeds_m_s", state.speeds},
                        {"cut_area_m2", state.cut_area},
                        {"cut_longest_s", state.cut_longest},
                        {"pieces", pieces},
                        {"events_before", state.events_before},
                        {"events", std::move(events)}});
}

std::string notice_message(const std::string& text) { return json_text(json{{"type", "notice"}, {"text", text}}); }

}  // namespace glisson::view
