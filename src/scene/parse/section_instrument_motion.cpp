// section_instrument_motion.cpp — [instrument.motion]: strokes, press, sine, record, push.
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
        motion_kind<PushSpec>(push_kind()), motion_kind<RecordSpec>(record_section())};
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
