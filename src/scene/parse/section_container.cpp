// section_container.cpp — [container]: a rigid vessel around the body; [[capsule]]: a membrane on its surface.
#include "glisson/scene/scene.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

template <class Vessel>
KindSpec vessel_kind(const std::string& help) {
  return {described<Vessel>(help),
          [](void* spec) -> void* { return &static_cast<ContainerSpec*>(spec)->options.vessel.emplace<Vessel>(); }};
}

}  // namespace

const SectionSpec& container_section() {
  using Hold = ContainerSpec::Hold;
  static const SectionSpec section = [] {
    Section<ContainerSpec> s("container",
                             "A rigid vessel around the body, selected by `kind`, with sensors for the load on its "
                             "floor and wall: the columns `bottom_z_N`, `side_z_N` and `side_radial_N` of forces.csv.");
    s.key(
         "floor_m", [](ContainerSpec & x) -> auto& { return x.options.pose.position; }, "centre of its floor")
        .in("m");
    s.key("hold", &ContainerSpec::hold, "how tissue is held in contact");
    s.fields(&ContainerSpec::options);
    s.spec().kinds = {vessel_kind<CylinderVessel>("A cylinder about the z axis, with a floor, open at the top."),
                      vessel_kind<BoxVessel>("A box, open at the top.")};
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
    Section<CapsuleSpec> s("capsule",
                           "The skin of an organ: a membrane on the surface that carries tension and tears "
                           "(docs/capsule.md). A needle that pierces the surface opens it there.");
    s.fields(&CapsuleSpec::options);
    s.key("set", &CapsuleSpec::set, "vertex set; the capsule covers the surface triangles whose vertices are all in it")
        .otherwise("the whole surface");
    s.finish([](CapsuleSpec& x, const Node&, const Place& place) { x.origin = place.text(); });
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
