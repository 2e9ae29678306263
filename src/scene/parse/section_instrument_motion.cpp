// section_instrument_motion.cpp — [instrument.motion]: strokes, press, sine, record, push.
#include "glisson/scene/scene.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

SectionSpec press_kind() {
  Section<PressMotion> s("press", "To a depth, and back with `returns`.");
  s.fields({}, {"direction"});
  return s.spec();
}

SectionSpec strokes_kind() {
  Section<StrokesSpec> s("strokes", "Straight moves in sequence: insert, rest, sideways, withdraw.");
  s.key<Milli>("velocity_mm_s", &StrokesSpec::velocity, "speed of strokes without their own")
      .in("mm/s")
      .within(above(0));
  s.key("start_s", &StrokesSpec::start, "start of the first").in("s").within(at_least(0));
  s.tables("strokes", stroke_section(), &StrokesSpec::strokes, "the moves, one or more").must();
  s.finish([](StrokesSpec& x, const Node& table, const Place& place) {
    if (x.strokes.empty()) place.complain(*table.find("strokes"), "strokes", "is empty; give at least one stroke");
  });
  return s.spec();
}

SectionSpec sine_kind() {
  Section<SineMotion> s("sine", "Oscillation about a mean depth, rising smoothly over `ramp_s`.");
  s.fields({}, {"direction"});
  return s.spec();
}

SectionSpec push_kind() {
  Section<PushSpec> s("push", "A mass pushed by a given force; its path follows from the resistance of the tissue.");
  s.key("force_N", &PushSpec::force, "mean force").in("N");
  s.key("swing_N", &PushSpec::swing, "amplitude of an oscillation about it").in("N").within(at_least(0));
  s.key("frequency_hz", &PushSpec::frequency, "frequency of the oscillation").in("Hz").within(above(0));
  s.key("start_s", &PushSpec::start, "start of the motion").in("s").within(at_least(0));
  s.key("ramp_s", &PushSpec::ramp, "time over which it rises").in("s").within(at_least(0));
  s.key("duration_s", &PushSpec::duration, "duration, for the end of the run")
      .in("s")
      .within(above(0))
      .otherwise("unlimited");
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
        "record",
        "A recorded path: a .csv with a line of names, `time_s` and `depth_m`, or `time_s`, `x_m`, `y_m` and `z_m` (or "
        "_mm). It is followed from its first line on, smoothly between its points.");
    s.key("path", &RecordSpec::path, "the file, relative to the scene").must();
    s.key("start_s", &RecordSpec::start, "start of the record").in("s").within(at_least(0));
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
    s.spec().kinds = {motion_kind<PressMotion>(press_kind()), motion_kind<StrokesSpec>(strokes_kind()),
                      motion_kind<SineMotion>(sine_kind()), motion_kind<PushSpec>(push_kind()),
                      motion_kind<RecordSpec>(record_section())};
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
