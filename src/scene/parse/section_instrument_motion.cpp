// section_instrument_motion.cpp — [instrument.motion]: strokes, press, sine, record, push, palpation.
#include "glisson/scene/scene.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

/// Its direction is that of the table it is in.
template <class How>
SectionSpec directed(const std::string& help) {
  Section<How> s(std::string(How::kName), help);
  s.fields({}, {"direction"});
  return s.spec();
}

SectionSpec push_kind() {
  Section<PushSpec> s(std::string(PushSpec::kName),
                      "A mass pushed by a given force; its path follows from the resistance of the tissue.");
  s.fields();
  s.fields(&PushSpec::tool);
  return s.spec();
}

template <class How>
KindSpec motion_kind(SectionSpec section) {
  return {std::move(section),
          [](void* motion) -> void* { return &static_cast<InstrumentMotion*>(motion)->how.emplace<How>(); }};
}

}  // namespace

const SectionSpec& record_section() {
  static const SectionSpec section = [] {
    Section<RecordSpec> s(
        std::string(RecordSpec::kName),
        "A recorded path: a .csv with a line of names, `time_s` and `depth_m`, or `time_s`, `x_m`, `y_m` and `z_m` (or "
        "_mm). It is followed from its first line on, smoothly between its points.");
    s.key("path", &RecordSpec::path, "the file, relative to the scene").must();
    s.key("start_s", &RecordSpec::start, "start of the record").in("s").within(at_least(0));
    return s.spec();
  }();
  return section;
}

const SectionSpec& rotation_section() {
  static const SectionSpec section = [] {
    SectionSpec s = described<RotationMotion>(
        "Rotation about an axis fixed in space, by an angle over time: at a speed to an angle, or through angles of a "
        "table.");
    s.exclusions = {
        {{{"times_s", "angles_deg"}, {"angle_deg", "rate_deg_s", "start_s", "ramp_s", "hold_s", "returns"}}, false}};
    return s;
  }();
  return section;
}

const SectionSpec& poses_section() {
  static const SectionSpec section = [] {
    Section<PosesSpec> s(
        std::string(PosesSpec::kName),
        "Poses from a .csv with a line of names, `time_s`, `x_m`, `y_m`, `z_m` (or _mm) and a quaternion `qw`, `qx`, "
        "`qy`, `qz`. What it moves goes with them from the first line on: positions smoothly, rotations by the "
        "shortest "
        "turn at a constant rate between two lines.");
    s.key("path", &PosesSpec::path, "the file, relative to the scene").must();
    s.key("start_s", &PosesSpec::start, "start of the poses").in("s").within(at_least(0));
    return s.spec();
  }();
  return section;
}

const SectionSpec& stroke_section() {
  static const SectionSpec section =
      described<StrokesSpec::One>("instrument.motion.strokes", "A straight move at one speed, and a rest after it.");
  return section;
}

const SectionSpec& instrument_motion_section() {
  static const SectionSpec section = [] {
    Section<InstrumentMotion> s("instrument.motion", "Motion of an instrument, selected by `kind`.");
    s.key("direction", &InstrumentMotion::direction, "direction of motion, of any length")
        .in("-")
        .direction()
        .otherwise("the instrument's");
    s.spec().kinds = {
        motion_kind<PressMotion>(directed<PressMotion>("To a depth, and back with `returns`.")),
        motion_kind<StrokesSpec>(
            described<StrokesSpec>("Straight moves in sequence: insert, rest, sideways, withdraw.")),
        motion_kind<SineMotion>(directed<SineMotion>("Oscillation about a mean depth, rising smoothly over `ramp_s`.")),
        motion_kind<PushSpec>(push_kind()),
        motion_kind<RecordSpec>(record_section()),
        motion_kind<RotationMotion>(rotation_section()),
        motion_kind<PosesSpec>(poses_section()),
        motion_kind<PalpationSpec>(described<PalpationSpec>(
            "Presses at the points of a grid about the instrument's tip, one after the other: each to the same depth "
            "below the surface at rest, as the instrument meets it along its direction. For `punch`, `ball`, `probe`, "
            "`plate` and `block`; `value` of a `[[chart]]` shows the forces as a map."))};
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
