// section_instrument_motion.cpp — [instrument.motion]: strokes, press, sine, record, push.
#include "glisson/scene/scene.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

using Stroke = StrokesSpec::One;

SectionSpec press_kind() {
  Section<PressMotion> s("press", "To a depth, and back where `returns` says so.");
  s.key<Milli>("velocity_mm_s", &PressMotion::velocity, "speed").in("mm/s").within(above(0));
  s.key<Milli>("depth_mm", &PressMotion::depth, "how far it goes").in("mm").within(above(0));
  s.key("start_s", &PressMotion::start, "when it begins").in("s").within(at_least(0));
  s.key("ramp_s", &PressMotion::ramp, "time over which the speed rises from 0").in("s").within(at_least(0));
  s.key("hold_s", &PressMotion::hold, "rest at depth").in("s").within(at_least(0));
  s.key("returns", &PressMotion::returns, "withdraw at the same speed after the hold");
  return s.spec();
}

SectionSpec strokes_kind() {
  Section<StrokesSpec> s("strokes", "Straight moves one after the other: insert, rest, aside, withdraw.");
  s.key<Milli>("velocity_mm_s", &StrokesSpec::velocity, "speed of strokes that give none").in("mm/s").within(above(0));
  s.key("start_s", &StrokesSpec::start, "when the first begins").in("s").within(at_least(0));
  s.tables("strokes", stroke_section(), &StrokesSpec::strokes, "the moves, one or more").must();
  s.finish([](StrokesSpec& x, const Node& table, const Place& place) {
    if (x.strokes.empty()) place.complain(*table.find("strokes"), "strokes", "is empty; give at least one stroke");
  });
  return s.spec();
}

SectionSpec sine_kind() {
  Section<SineMotion> s("sine", "Back and forth about a mean depth, coming up smoothly over `ramp_s`.");
  s.key<Milli>("amplitude_mm", &SineMotion::amplitude, "half of the way").in("mm").within(above(0));
  s.key("frequency_hz", &SineMotion::frequency, "swings a second").in("Hz").within(above(0));
  s.key<Milli>("mean_mm", &SineMotion::mean, "depth about which it swings").in("mm");
  s.key("start_s", &SineMotion::start, "when it begins").in("s").within(at_least(0));
  s.key("ramp_s", &SineMotion::ramp, "time over which it comes up").in("s").within(at_least(0));
  s.key("duration_s", &SineMotion::duration, "how long it goes on").in("s").within(above(0));
  return s.spec();
}

SectionSpec push_kind() {
  Section<PushSpec> s("push",
                      "A mass that is pushed: the force is given, the way follows from what the tissue answers.");
  s.key("force_N", &PushSpec::force, "the push").in("N");
  s.key("swing_N", &PushSpec::swing, "amplitude of a push that swings about it").in("N").within(at_least(0));
  s.key("frequency_hz", &PushSpec::frequency, "of the swing").in("Hz").within(above(0));
  s.key("start_s", &PushSpec::start, "when it begins").in("s").within(at_least(0));
  s.key("ramp_s", &PushSpec::ramp, "time over which it comes up").in("s").within(at_least(0));
  s.key("duration_s", &PushSpec::duration, "how long it goes on, for the end of the run")
      .in("s")
      .within(above(0))
      .otherwise("no end of its own");
  s.key("mass_kg", &PushSpec::mass, "of the tool and the hand behind it").in("kg").within(above(0));
  s.key("damping_N_s_m", &PushSpec::damping, "of the hand").in("N s/m").within(at_least(0));
  s.key("guided", &PushSpec::guided, "moves along the direction only; else sideways, too");
  s.key<OptionalMilli>("stop_mm", &PushSpec::stop, "how far it can go").in("mm").within(above(0)).otherwise("no stop");
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
        "A recorded way: a .csv with a line of names, `time_s` and `depth_m`, or `time_s`, `x_m`, `y_m` and "
        "`z_m` (or _mm), gone from its first line on, smoothly between its points.");
    s.key("path", &RecordSpec::path, "the file, relative to the scene").must();
    s.key("start_s", &RecordSpec::start, "when the record begins").in("s").within(at_least(0));
    return s.spec();
  }();
  return section;
}

const SectionSpec& stroke_section() {
  static const SectionSpec section = [] {
    Section<Stroke> s("instrument.motion.strokes", "A straight move at one speed, and a rest after it.");
    s.key<Milli>("depth_mm", &Stroke::depth, "where it ends, along the direction from the start").in("mm").must();
    s.key<MilliVector>("aside_mm", &Stroke::aside, "and beside that").in("mm");
    s.key<OptionalMilli>("velocity_mm_s", &Stroke::velocity, "speed")
        .in("mm/s")
        .within(above(0))
        .otherwise("the common one");
    s.key("ramp_s", &Stroke::ramp, "time over which the speed rises, and falls").in("s").within(at_least(0));
    s.key("rest_s", &Stroke::rest, "rest at its end").in("s").within(at_least(0));
    return s.spec();
  }();
  return section;
}

const SectionSpec& instrument_motion_section() {
  static const SectionSpec section = [] {
    Section<InstrumentMotion> s("instrument.motion", "How an instrument moves, chosen by `kind`.");
    s.key("direction", &InstrumentMotion::direction, "in which it moves, of any length")
        .in("-")
        .otherwise("the instrument's");
    s.spec().kinds = {motion_kind<PressMotion>(press_kind()), motion_kind<StrokesSpec>(strokes_kind()),
                      motion_kind<SineMotion>(sine_kind()), motion_kind<PushSpec>(push_kind()),
                      motion_kind<RecordSpec>(record_section())};
    s.finish([](InstrumentMotion& m, const Node& table, const Place& place) {
      if (m.direction) require_direction(*m.direction, table, "direction", place);
    });
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
