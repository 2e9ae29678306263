// section_container.cpp — [container]: a rigid vessel around the body; [[capsule]]: a membrane on its surface.
#include "glisson/scene/scene.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

SectionSpec cylinder_vessel() {
  Section<CylinderVessel> s("cylinder", "A cylinder about the z axis, with a floor, open at the top.");
  s.key<Milli>("radius_mm", &CylinderVessel::radius, "inner radius").in("mm").within(above(0)).must();
  s.key<Milli>("height_mm", &CylinderVessel::height, "height of the wall")
      .in("mm")
      .within(above(0))
      .otherwise("unlimited");
  return s.spec();
}

SectionSpec box_vessel() {
  Section<BoxVessel> s("box", "A box, open at the top.");
  s.key<Milli>("width_mm", &BoxVessel::width, "inner width, along x").in("mm").within(above(0)).must();
  s.key<Milli>("length_mm", &BoxVessel::length, "inner length, along y").in("mm").within(above(0)).must();
  s.key<Milli>("height_mm", &BoxVessel::height, "height of the walls").in("mm").within(above(0)).otherwise("unlimited");
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
    Section<ContainerSpec> s("container",
                             "A rigid vessel around the body, selected by `kind`, with sensors for the load on its "
                             "floor and wall: the columns `bottom_z_N`, `side_z_N` and `side_radial_N` of forces.csv.");
    s.key(
         "floor_m", [](ContainerSpec & x) -> auto& { return x.options.pose.position; }, "centre of its floor")
        .in("m");
    s.key("hold", &ContainerSpec::hold, "how tissue is held in contact");
    s.key("friction", option(&O::friction), "Coulomb's μ").in("-").within(at_least(0));
    s.key<Milli>("push_out_speed_mm_s", option(&O::push_out_speed),
                 "largest speed of tissue that starts outside the vessel")
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
    Section<CapsuleSpec> s("capsule",
                           "The skin of an organ: a membrane on the surface that carries tension and tears "
                           "(docs/capsule.md). A needle that pierces the surface opens it there.");
    s.key("name", option(&O::name), "name");
    s.key("set", &CapsuleSpec::set, "vertex set; the capsule covers the surface triangles whose vertices are all in it")
        .otherwise("the whole surface");
    s.key<Milli>("thickness_mm", option(&O::thickness), "thickness").in("mm").within(above(0));
    s.key("youngs_modulus_Pa", option(&O::youngs_modulus), "Young's modulus E at small strain")
        .in("Pa")
        .within(above(0));
    s.key("poisson_ratio", option(&O::poisson_ratio), "Poisson's ratio ν").in("-").within(between(0, 0.5));
    s.key("prestretch", option(&O::prestretch), "stretch of the surface at rest relative to its stress-free shape")
        .in("-")
        .within(between(1, 2));
    s.key("stiffening", option(&O::stiffening), "α: stress rises by exp(α Q), Q the square of strain")
        .in("-")
        .within(between(0, 1000));
    s.key("strength_N_m", option(&O::strength), "force per length of a line across which it tears")
        .in("N/m")
        .within(above(0))
        .otherwise("never tears");
    s.key<Milli>("averaging_length_mm", option(&O::averaging_length),
                 "length over which tension is averaged for tearing")
        .in("mm")
        .within(above(0));
    s.finish([](CapsuleSpec& x, const Node&, const Place& place) { x.origin = place.text(); });
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
