// section_instrument.cpp — [[instrument]]: needles that pierce and shapes that press.
#include <string>
#include <variant>

#include "glisson/scene/scene.h"
#include "scene/parse/result_names.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

/// The shape of a contact tool; that of its kind from its creation on, any in the defaults.
template <class Form>
Form& form_of(ContactOptions& x) {
  Form* form = std::get_if<Form>(&x.shape);
  return form != nullptr ? *form : x.shape.emplace<Form>();
}

/// A shape that presses: its sizes, then what all of them have.
template <class Form>
KindSpec contact_kind(const std::string& help) {
  Section<ContactOptions> s(std::string(Form::kName), help);
  s.fields(form_of<Form>);
  s.fields();
  return {s.spec(), [](void* spec) -> void* {
            auto& options = static_cast<InstrumentSpec*>(spec)->what.emplace<ContactOptions>();
            options.shape.emplace<Form>();
            return &options;
          }};
}

SectionSpec blade_kind() {
  Section<BladeOptions> s(std::string(BladeOptions::kName),
                          "A cutting edge that separates the tissue along its path (docs/cutting.md); the flat of the "
                          "blade does not touch it.");
  s.fields();
  s.fields(&BladeOptions::cutting);
  return s.spec();
}

template <class What>
KindSpec instrument_kind(SectionSpec section) {
  return {std::move(section),
          [](void* spec) -> void* { return &static_cast<InstrumentSpec*>(spec)->what.emplace<What>(); }};
}

/// What must hold of an instrument's directions, and where it was written.
void check_instrument(InstrumentSpec& x, const Node& table, const Place& place) {
  x.origin = place.text();
  const std::string unfit = unfit_as_table(x.name);
  if (const Node* name = table.find("name"); name && !unfit.empty()) place.complain(*name, "name", unfit);
  const bool turns =
      std::holds_alternative<RotationMotion>(x.motion.how) || std::holds_alternative<PosesSpec>(x.motion.how);
  if (turns && std::holds_alternative<NeedleOptions>(x.what)) {
    place.complain(
        *table.find("motion"), "motion",
        "a needle keeps its direction and cannot turn; use kind = \"strokes\" or \"record\", or another kind of "
        "instrument");
  }
  if (norm(cross(x.side, x.direction)) > 1e-6 * norm(x.side) * norm(x.direction)) return;
  place.complain(table.find("side") ? *table.find("side") : *table.find("direction"),
                 table.find("side") ? "side" : "direction",
                 "`side` " + Codec<Vec3d>::show(x.side) + " does not point across `direction` " +
                     Codec<Vec3d>::show(x.direction) + "; give another side, such as [0, 1, 0]");
}

}  // namespace

const SectionSpec& rupture_section() {
  static const SectionSpec section = [] {
    SectionSpec s = described<Rupture>(
        "instrument.rupture",
        "Puncture of the surface under a needle's tip. With neither key: at the cutting force of the tissue below.");
    s.exclusions = {{{{"force_N"}, {"toughness_J_m2"}}, false}};
    return s;
  }();
  return section;
}

const SectionSpec& tip_section() {
  static const SectionSpec section = described<TipResistance>(
      "instrument.tip",
      "Resistance at a needle's tip. `regions.NAME` sets it for a region, whose boundary may resist more: "
      "`regions.vessel = { cutting_N = 0.5, puncture_N = 1.2 }`.");
  return section;
}

const SectionSpec& inner_membrane_section() {
  static const SectionSpec section = described<InnerMembrane>(
      "instrument.membranes",
      "A membrane across a needle's path, which holds the tip until it pushes hard enough: an inner puncture. With "
      "`puncture_N = 0` only the cutting force changes.");
  return section;
}

const SectionSpec& membrane_process_section() {
  static const SectionSpec section =
      described<MembraneProcess>("instrument.drawn_membranes",
                                 "Membranes at random down to the needle's length: exponential distances, normally "
                                 "distributed forces. A seed gives "
                                 "the same membranes on every machine.");
  return section;
}

const SectionSpec& shaft_friction_section() {
  static const SectionSpec section = described<ShaftFriction>(
      "instrument.friction",
      "Stick–slip along a needle's inserted shaft, per metre: `_in` during insertion, `_out` during withdrawal.");
  return section;
}

const SectionSpec& aim_section() {
  static const SectionSpec section = [] {
    Section<AimSpec> s("instrument.aim",
                       "Where an instrument starts, found from the body, so that it fits any: on the line through the "
                       "middle of the body, or another point of it, along the instrument's direction.");
    s.fields(&AimSpec::at);
    s.fields();
    s.spec().exclusions = {{{{"region"}, {"point_m"}}, false}, {{{"distance_mm"}, {"clearance_mm"}}, false}};
    return s.spec();
  }();
  return section;
}

const SectionSpec& instrument_section() {
  static const SectionSpec section = [] {
    Section<InstrumentSpec> s(
        "instrument",
        "A rigid or bending tool, selected by `kind`: it touches the surface in contact, or "
        "pierces it. Needs the integrator " +
            supporting_integrators() +
            "; needles, blades and rigid tools in contact act under implicit (with backward Euler) and "
            "quasi_static too, and in viscous tissue under semi_implicit.");
    s.key("name", &InstrumentSpec::name, "name; no two tools or instruments of an experiment share one");
    s.key("tip_m", &InstrumentSpec::tip, "position of its tip at the start").in("m").otherwise("");
    s.table(
        "aim", aim_section(), [](InstrumentSpec & x) -> auto& { return x.aim.emplace(); },
        "where it starts, found from the body, in place of `tip_m`");
    s.key("direction", &InstrumentSpec::direction, "direction of its tip, of any length").in("-").direction();
    s.key("side", &InstrumentSpec::side,
          "direction of its own x axis, and of a bevelled tip; the component across `direction` counts")
        .in("-");
    s.table("motion", instrument_motion_section(), &InstrumentSpec::motion, "how it moves").must();
    s.named_tables("regions", tip_section(), &InstrumentSpec::regions, "of a needle: resistance at its tip by region");
    s.spec().exclusions = {{{{"tip_m"}, {"aim"}}, true}};
    s.spec().kinds = {
        instrument_kind<NeedleOptions>(described<NeedleOptions>(
            "A needle that presses, pierces, cuts, rubs along its shaft and withdraws (docs/needles.md).")),
        contact_kind<FlatPunch>("A cylinder with a flat end that presses on the surface."),
        contact_kind<Ball>("A ball that presses on the surface; its tip is its lowest point."),
        contact_kind<NeedleShape>("The outside of a needle, which presses and does not pierce."),
        contact_kind<Plate>("An infinite plane that presses on the surface."),
        contact_kind<Block>("A box that presses with its lower face."),
        instrument_kind<BladeOptions>(blade_kind())};
    s.finish(check_instrument);
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
