// section_instrument.cpp — [[instrument]]: needles that pierce and shapes that press.
#include <cmath>

#include "glisson/scene/scene.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"
#include "scene/run/result_names.h"

namespace glisson::scene {
namespace {

template <class Form>
using Contact = ContactSpec<Form>;

/// What all shapes that press have beside their sizes.
template <class Form>
void add_contact_keys(Section<Contact<Form>>& s) {
  s.key("friction", &Contact<Form>::friction, "Coulomb's μ against the surface").in("-").within(at_least(0));
  s.key("bonded", &Contact<Form>::bonded, "points that touched stay in place, in tension and compression");
  s.template key<Milli>("push_out_speed_mm_s", &Contact<Form>::push_out_speed,
                        "largest speed of tissue that starts inside the tool")
      .in("mm/s")
      .within(above(0));
}

/// A size of a shape [m], written in mm.
template <class Form, class Member>
KeySpec& size_key(Section<Contact<Form>>& s, const std::string& name, Member member, const std::string& help) {
  return s
      .template key<Milli>(
          name, [member](Contact<Form> & x) -> auto& { return x.form.*member; }, help)
      .in("mm")
      .within(above(0));
}

template <class Form>
SectionSpec checked(Section<Contact<Form>> s) {
  add_contact_keys(s);
  s.finish([](Contact<Form>& x, const Node&, const Place& place) {
    try {
      require_valid(glisson::Shape(x.form));
    } catch (const std::invalid_argument& error) {
      place.complain(error.what());
    }
  });
  return s.spec();
}

SectionSpec punch_kind() {
  Section<Contact<FlatPunch>> s("punch", "A cylinder with a flat end that presses on the surface.");
  size_key(s, "radius_mm", &FlatPunch::radius, "radius");
  size_key(s, "edge_radius_mm", &FlatPunch::edge_radius, "radius of the rounded edge").within(at_least(0));
  size_key(s, "length_mm", &FlatPunch::length, "length");
  return checked(s);
}

SectionSpec ball_kind() {
  Section<Contact<Ball>> s("ball", "A ball that presses on the surface; its tip is its lowest point.");
  size_key(s, "radius_mm", &Ball::radius, "radius");
  return checked(s);
}

SectionSpec probe_kind() {
  Section<Contact<NeedleShape>> s("probe", "The outside of a needle, which presses and does not pierce.");
  size_key(s, "diameter_mm", &NeedleShape::diameter, "diameter");
  size_key(s, "length_mm", &NeedleShape::length, "length with the tip");
  s.key(
      "tip", [](Contact<NeedleShape> & x) -> auto& { return x.form.tip; }, "shape of the tip");
  s.key(
       "tip_angle_rad", [](Contact<NeedleShape> & x) -> auto& { return x.form.tip_angle; },
       "full angle of the cone, or between the bevel and the shaft")
      .in("rad")
      .within(between(0.02, 3.1));
  return checked(s);
}

SectionSpec plate_kind() {
  Section<Contact<Plate>> s("plate", "An infinite plane that presses on the surface.");
  return checked(s);
}

SectionSpec block_kind() {
  Section<Contact<Block>> s("block", "A box that presses with its lower face.");
  s.key<MilliVector>(
       "size_mm", [](Contact<Block> & x) -> auto& { return x.form.size; }, "edges along its own x, y and z")
      .in("mm")
      .within(above(0));
  size_key(s, "edge_radius_mm", &Block::edge_radius, "radius of the rounded edges").within(at_least(0));
  return checked(s);
}

SectionSpec needle_kind() {
  Section<NeedleOptions> s(
      "needle", "A needle that presses, pierces, cuts, rubs along its shaft and withdraws (docs/needles.md).");
  s.key<Milli>("diameter_mm", &NeedleOptions::diameter, "diameter").in("mm").within(above(0));
  s.key<Milli>("length_mm", &NeedleOptions::length, "from the hand to the tip").in("mm").within(above(0));
  s.key<Milli>("zone_mm", &NeedleOptions::zone, "radius of the tissue around a path point that carries its force")
      .in("mm")
      .within(above(0));
  s.key<Milli>("spacing_mm", &NeedleOptions::spacing, "distance of the path points").in("mm").within(above(0));
  s.table("rupture", rupture_section(), &NeedleOptions::rupture, "when the surface is punctured");
  s.table("tip", tip_section(), &NeedleOptions::tip, "resistance at the tip");
  s.table("friction", shaft_friction_section(), &NeedleOptions::friction, "friction along the inserted shaft");
  s.key("youngs_modulus_Pa", &NeedleOptions::youngs_modulus,
        "Young's modulus of the needle, a cantilever clamped at the hand")
      .in("Pa")
      .within(above(0))
      .otherwise("rigid");
  s.key<Milli>("inner_diameter_mm", &NeedleOptions::inner_diameter, "inner diameter of a tube, for its bending")
      .in("mm")
      .within(at_least(0));
  s.key("bevel_share", &NeedleOptions::bevel_share, "sideways force of a bevelled tip over its cutting force")
      .in("-")
      .within(at_least(0));
  s.finish([](NeedleOptions& x, const Node& table, const Place& place) {
    if (x.inner_diameter >= x.diameter && x.inner_diameter > 0.0) {
      place.complain(*table.find("inner_diameter_mm"), "inner_diameter_mm",
                     show(1e3 * x.inner_diameter) +
                         " mm is out of range; allowed: below `diameter_mm` = " + show(1e3 * x.diameter) + " mm");
    }
  });
  return s.spec();
}

SectionSpec blade_kind() {
  Section<BladeOptions> s("blade",
                          "A cutting edge that separates the tissue along its path (docs/cutting.md); the flat of the "
                          "blade does not touch it.");
  const auto cutting = [](auto member) {
    return [member](BladeOptions & x) -> auto& { return x.cutting.*member; };
  };
  s.key<MilliVector>("edge_from_mm", &BladeOptions::edge_from,
                     "one end of its edge, in its own axes, relative to its tip")
      .in("mm");
  s.key<MilliVector>("edge_to_mm", &BladeOptions::edge_to, "the other end").in("mm");
  s.key("toughness_J_m2", &BladeOptions::toughness, "fracture toughness of the tissue: work per area cut")
      .in("J/m²")
      .within(at_least(0));
  s.key("cut_every_s", &BladeOptions::cut_every, "interval at which the passed tissue is separated")
      .in("s")
      .within(above(0));
  s.key("snap", cutting(&CutOptions::snap), "moves vertices onto the cut; otherwise it follows existing faces");
  s.key("least_quality", cutting(&CutOptions::least_quality), "least mean ratio of a tet after such a move")
      .in("-")
      .within(between(0.01, 0.5));
  s.key("least_step", cutting(&CutOptions::least_step),
        "least stable step after such a move, relative to the body's before")
      .in("-")
      .within(between(0.05, 1));
  s.finish([](BladeOptions& x, const Node& table, const Place& place) {
    if (norm(x.edge_to - x.edge_from) > 0.0) return;
    const char* key = table.find("edge_to_mm") ? "edge_to_mm" : "edge_from_mm";
    place.complain(*table.find(key), key, "is the other end, too: the edge has no length; give two ends");
  });
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
  if (norm(cross(x.side, x.direction)) > 1e-6 * norm(x.side) * norm(x.direction)) return;
  place.complain(table.find("side") ? *table.find("side") : *table.find("direction"),
                 table.find("side") ? "side" : "direction",
                 "`side` " + Codec<Vec3d>::show(x.side) + " does not point across `direction` " +
                     Codec<Vec3d>::show(x.direction) + "; give another side, such as [0, 1, 0]");
}

}  // namespace

const SectionSpec& rupture_section() {
  static const SectionSpec section = [] {
    Section<Rupture> s(
        "instrument.rupture",
        "Puncture of the surface under a needle's tip. With neither key: at the cutting force of the tissue below.");
    s.key("force_N", &Rupture::force, "force of the tip at the puncture").in("N").within(above(0)).otherwise("");
    s.key("toughness_J_m2", &Rupture::toughness,
          "puncture when spring-back releases this energy per area of the slit, one diameter long")
        .in("J/m²")
        .within(above(0))
        .otherwise("");
    s.key<Milli>("membrane_thickness_mm", &Rupture::membrane_thickness, "depth of the slit").in("mm").within(above(0));
    s.spec().exclusions = {{{{"force_N"}, {"toughness_J_m2"}}, false}};
    return s.spec();
  }();
  return section;
}

const SectionSpec& tip_section() {
  static const SectionSpec section = [] {
    Section<TipResistance> s("instrument.tip",
                             "Resistance at a needle's tip. `regions.NAME` sets it for a region, whose boundary may "
                             "resist more: `regions.vessel = { cutting_N = 0.5, puncture_N = 1.2 }`.");
    s.key("cutting_N", &TipResistance::cutting, "cutting force").in("N").within(at_least(0));
    s.key("puncture_N", &TipResistance::puncture, "of a region: force to enter it; 0: the cutting force")
        .in("N")
        .within(at_least(0));
    return s.spec();
  }();
  return section;
}

const SectionSpec& shaft_friction_section() {
  static const SectionSpec section = [] {
    using F = ShaftFriction;
    Section<F> s(
        "instrument.friction",
        "Stick–slip along a needle's inserted shaft, per metre: `_in` during insertion, `_out` during withdrawal.");
    s.key("static_in_N_m", &F::static_in, "largest force while it sticks").in("N/m").within(at_least(0));
    s.key("static_out_N_m", &F::static_out, "the same during withdrawal").in("N/m").within(at_least(0));
    s.key("dynamic_in_N_m", &F::dynamic_in, "force while it slips").in("N/m").within(at_least(0));
    s.key("dynamic_out_N_m", &F::dynamic_out, "the same during withdrawal").in("N/m").within(at_least(0));
    s.key("viscous_in_N_s_m2", &F::viscous_in, "additional force per speed of slip").in("N s/m²").within(at_least(0));
    s.key("viscous_out_N_s_m2", &F::viscous_out, "the same during withdrawal").in("N s/m²").within(at_least(0));
    s.key<Milli>("stick_speed_mm_s", &F::stick_speed, "below this slip speed it may stick again")
        .in("mm/s")
        .within(above(0));
    s.finish([](F& x, const Node& table, const Place& place) {
      const auto check = [&](double dynamic, double most, const char* key, const char* other) {
        if (dynamic <= most) return;
        place.complain(
            table.find(key) ? *table.find(key) : table, key,
            show(dynamic) + " N/m is out of range; allowed: at most `" + other + "` = " + show(most) + " N/m");
      };
      check(x.dynamic_in, x.static_in, "dynamic_in_N_m", "static_in_N_m");
      check(x.dynamic_out, x.static_out, "dynamic_out_N_m", "static_out_N_m");
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& instrument_section() {
  static const SectionSpec section = [] {
    Section<InstrumentSpec> s("instrument",
                              "A rigid or bending tool, selected by `kind`: it touches the surface in contact, or "
                              "pierces it. Needs the integrator explicit, or semi_implicit without viscosity.");
    s.key("name", &InstrumentSpec::name, "name; no two tools or instruments of an experiment share one");
    s.key("tip_m", &InstrumentSpec::tip, "position of its tip at the start").in("m").must();
    s.key("direction", &InstrumentSpec::direction, "direction of its tip, of any length").in("-").direction();
    s.key("side", &InstrumentSpec::side,
          "direction of its own x axis, and of a bevelled tip; the component across `direction` counts")
        .in("-");
    s.table("motion", instrument_motion_section(), &InstrumentSpec::motion, "how it moves").must();
    s.named_tables("regions", tip_section(), &InstrumentSpec::regions, "of a needle: resistance at its tip by region");
    s.spec().kinds = {
        instrument_kind<NeedleOptions>(needle_kind()), instrument_kind<Contact<FlatPunch>>(punch_kind()),
        instrument_kind<Contact<Ball>>(ball_kind()),   instrument_kind<Contact<NeedleShape>>(probe_kind()),
        instrument_kind<Contact<Plate>>(plate_kind()), instrument_kind<Contact<Block>>(block_kind()),
        instrument_kind<BladeOptions>(blade_kind())};
    s.finish(check_instrument);
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
