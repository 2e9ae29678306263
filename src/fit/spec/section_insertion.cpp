#include "fit/spec/insertion_spec.h"
#include "fit/spec/section_fit.h"
#include "scene/parse/section.h"

namespace glisson::fit {

const scene::SectionSpec& insertion_section() {
  static const scene::SectionSpec section = [] {
    using I = InsertionSpec;
    scene::Section<I> s(
        "insertion",
        "The inner membranes of a needle, fitted to one measured curve of force over position, in place "
        "of `[[parameter]]`. The scene keeps all else.");
    s.key("instrument", &I::instrument, "the needle's name").otherwise("the only instrument");
    s.key<scene::Milli>("start_mm", &I::start, "measured position at which the tip of the scene starts").in("mm");
    s.key("drop_N", &I::least_drop, "a fall of the force by this much is a membrane that breaks")
        .in("N")
        .within(above(0));
    s.key<scene::Milli>("within_mm", &I::within, "… where it takes no longer than this").in("mm").within(above(0));
    s.key<scene::Milli>("piece_mm", &I::piece, "length of the pieces of constant cutting force between two drops")
        .in("mm")
        .within(above(0));
    s.key<scene::Milli>("grid_mm", &I::grid, "distance of the positions at which the curves are compared")
        .in("mm")
        .within(above(0));
    s.key<scene::Milli>("margin_mm", &I::margin, "nearer to a drop they are not").in("mm").within(at_least(0));
    s.key<scene::Milli>("peak_mm", &I::peak, "the force before a drop counts as much as this length of the curve")
        .in("mm")
        .within(at_least(0));
    s.key("runs", &I::runs, "largest number of runs of the scene").within(between(2, 100));
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::fit
