// section_container.cpp — [container]: a rigid vessel around the body; [[capsule]]: a membrane on its surface.
#include "glisson/scene/scene.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

SectionSpec cylinder_vessel() {
  Section<CylinderVessel> s("cylinder", "A cylinder about the z axis, with a floor, open above.");
  s.key<Milli>("radius_mm", &CylinderVessel::radius, "inside").in("mm").within(above(0)).must();
  s.key<Milli>("height_mm", &CylinderVessel::height, "of the wall").in("mm").within(above(0)).otherwise("without end");
  return s.spec();
}

SectionSpec box_vessel() {
  Section<BoxVessel> s("box", "A box, open above.");
  s.key<Milli>("width_mm", &BoxVessel::width, "inside, along x").in("mm").within(above(0)).must();
  s.key<Milli>("length_mm", &BoxVessel::length, "inside, along y").in("mm").within(above(0)).must();
  s.key<Milli>("height_mm", &BoxVessel::height, "of the walls").in("mm").within(above(0)).otherwise("without end");
  return s.spec();
}

template <class Vessel>
KindSpec vessel_kind(SectionSpec section) {
  return {std::move(section),
          [](void* spec) -> void* { return &static_cast<ContainerSpec*>(spec)->options.vessel.emplace<Vessel>(); }};
}

}  // namespace

const SectionSpec& container_section() {
  using Hold = ContainerSpec::Hold;
  static const SectionSpec section = [] {
    const auto option = [](auto member) {
      return [member](ContainerSpec & x) -> auto& { return x.options.*member; };
    };
    using O = ContainerOptions;
    Section<ContainerSpec> s(
        "container",
        "A rigid vessel that the body stands in, of the `kind` given, with sensors for what its floor "
        "and its wall carry: the columns `bottom_z_N`, `side_z_N` and `side_radial_N` of forces.csv.");
    s.key(
         "floor_m", [](ContainerSpec & x) -> auto& { return x.options.pose.position; }, "middle of its floor")
        .in("m");
    s.choice<Hold>("hold", &ContainerSpec::hold,
                   {{"free", Hold::free, "slides, with `friction`, and lifts off"},
                    {"wet", Hold::wet, "slides, with `friction`, and does not come off"},
                    {"bonded", Hold::bonded, "stays where it touched"}},
                   "how tissue is held where it touches");
    s.key("friction", option(&O::friction), "Coulomb's μ").in("-").within(at_least(0));
    s.key<Milli>("push_out_speed_mm_s", option(&O::push_out_speed),
                 "of tissue that is outside the vessel at the start, at most")
        .in("mm/s")
        .within(above(0));
    s.spec().kinds = {vessel_kind<CylinderVessel>(cylinder_vessel()), vessel_kind<BoxVessel>(box_vessel())};
    s.finish([](ContainerSpec& x, const Node&, const Place& place) {
      x.origin = place.text();
      x.options.bonded = x.hold == Hold::bonded;
      x.options.holds_floor = x.options.holds_wall = x.hold == Hold::wet;
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& capsule_section() {
  static const SectionSpec section = [] {
    const auto option = [](auto member) {
      return [member](CapsuleSpec & x) -> auto& { return x.options.*member; };
    };
    using O = CapsuleOptions;
    Section<CapsuleSpec> s(
        "capsule",
        "The skin of an organ: a membrane on the surface that bears tension and tears (docs/capsule.md). "
        "A needle that pierces the surface tears it there.");
    s.key("name", option(&O::name), "name");
    s.key("set", &CapsuleSpec::set, "vertex set; it covers the triangles of the surface with all vertices in it")
        .otherwise("all of the surface");
    s.key<Milli>("thickness_mm", option(&O::thickness), "thickness").in("mm").within(above(0));
    s.key("youngs_modulus_Pa", option(&O::youngs_modulus), "Young's modulus E at small strain")
        .in("Pa")
        .within(above(0));
    s.key("poisson_ratio", option(&O::poisson_ratio), "Poisson's ratio ν").in("-").within(between(0, 0.5));
    s.key("prestretch", option(&O::prestretch), "of the surface at rest from where it bears nothing")
        .in("-")
        .within(between(1, 2));
    s.key("stiffening", option(&O::stiffening), "α: stress rises by exp(α Q), Q the square of strain")
        .in("-")
        .within(between(0, 1000));
    s.key("strength_N_m", option(&O::strength),
          "force across a line, for each length of it, at which it tears by itself")
        .in("N/m")
        .within(above(0))
        .otherwise("it does not");
    s.key<Milli>("averaging_length_mm", option(&O::averaging_length), "over which tension is averaged for that")
        .in("mm")
        .within(above(0));
    s.finish([](CapsuleSpec& x, const Node&, const Place& place) { x.origin = place.text(); });
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
