// form.h — what an instrument looks like: one of a few solids, in its own axes from its tip (z = 0) up.
#pragma once

#include "glisson/math.h"
#include "glisson/words.h"

namespace glisson {

/// Lengths in metres; those that a kind does not name are 0.
struct InstrumentForm {
  enum class Kind {
    none,    ///< nothing
    point,   ///< only its place
    needle,  ///< a tube of `radius` about Instrument::centre_line()
    punch,   ///< a cylinder: `radius`, `length`
    ball,    ///< `radius`, its centre at z = radius
    probe,   ///< a cylinder with a tip: `radius`, `length`, and `tip`, the part of it that is the tip
    plate,   ///< all of z ≥ 0
    wall,    ///< a cylinder of `radius` without end, from inside
    block,   ///< a box on the middle of its lower face: `size`
    blade    ///< a sheet that stands on the edge from `from` to `to`
  } kind = Kind::point;
  double radius = 0.0, length = 0.0, tip = 0.0;
  Vec3d size{}, from{}, to{};
};
template <>
inline constexpr Word<InstrumentForm::Kind> kWords<InstrumentForm::Kind>[] = {
    {"none", InstrumentForm::Kind::none},     {"point", InstrumentForm::Kind::point},
    {"needle", InstrumentForm::Kind::needle}, {"punch", InstrumentForm::Kind::punch},
    {"ball", InstrumentForm::Kind::ball},     {"probe", InstrumentForm::Kind::probe},
    {"plate", InstrumentForm::Kind::plate},   {"wall", InstrumentForm::Kind::wall},
    {"block", InstrumentForm::Kind::block},   {"blade", InstrumentForm::Kind::blade}};

}  // namespace glisson
