// section_mesh.cpp — [mesh]: where the tetrahedra come from, and [sets]: vertices picked by place.
#include "glisson/scene/scene.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

SectionSpec box_kind() {
  return described<BoxOptions>("box",
                               "A box of cubes, six tetrahedra each, with the vertex sets `x_min`, `x_max`, `y_min`, "
                               "`y_max`, `z_min`, `z_max`.");
}

SectionSpec cylinder_kind() {
  return described<CylinderOptions>("cylinder",
                                    "A cylinder about the z axis from z = 0, its rings graded toward the axis, with "
                                    "the vertex sets `bottom`, `top`, `wall`, `axis`.");
}

SectionSpec liver_kind() {
  return described<LiverOptions>(
      "A liver of shapes with the regions `parenchyma`, `portal_veins`, `hepatic_veins`, `tumour` and, where it is "
      "asked for, "
      "`gallbladder`, and the vertex sets `bare_area`, `dome`, `visceral_face`, `vena_cava`, `coronary_ligament`, "
      "`right_triangular_ligament`, `left_triangular_ligament` and `falciform_ligament` (docs/liver.md).");
}

SectionSpec image_kind() {
  return described<ImageBody>(
      "The labels of an image (NIfTI, NRRD, MetaImage) as regions with the labels' names and numbers, in metres and "
      "RAS axes: x to the "
      "patient's right, y to the front, z to the head (docs/image.md). Its vertex sets: `NAME_surface`, what of a "
      "region lies on the surface of "
      "the body, `image_border`, where the image cuts the body, and those of `beside`.");
}

SectionSpec file_kind() {
  Section<MeshFile> s("file",
                      "A mesh of tetrahedra from a file: .vtu, .vtk, .msh (Gmsh 2.2 or 4.1), .inp (Abaqus). Its named "
                      "groups become vertex sets and regions.");
  s.key("path", &MeshFile::path, "the file, relative to the scene").must();
  KeySpec& scale =
      s.key("scale", &MeshFile::scale,
            "factor on the coordinates; 0.001 for a file in millimetres; \"auto\" takes that where the body "
            "would be more than 2 m across, and says so");
  scale.in("-").within(above(0));
  scale.accepts_auto = true;
  s.finish([](MeshFile& file, const Node& table, const Place& place) {
    if (file.path.empty())
      place.complain(*table.find("path"), "path", "is empty; name a .vtu, .vtk, .msh or .inp file");
  });
  return s.spec();
}

template <class Kind>
KindSpec mesh_kind(SectionSpec section) {
  return {std::move(section), [](void* source) -> void* { return &static_cast<MeshSource*>(source)->emplace<Kind>(); }};
}

SectionSpec box_selection() {
  Section<Selection::Box> s(
      "box_m", "An axis-aligned box, its faces included: to 1e-9 of the body's diagonal, beyond any rounding.");
  s.key("min", &Selection::Box::min, "lowest corner").in("m").must();
  s.key("max", &Selection::Box::max, "highest corner").in("m").must();
  s.finish([](Selection::Box& box, const Node& table, const Place& place) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (box.min[i] <= box.max[i]) continue;
      place.complain(*table.find("max"), "max",
                     std::string(1, "xyz"[i]) + " of `max` (" + show(box.max[i]) + " m) is below that of `min` (" +
                         show(box.min[i]) + " m); exchange them");
    }
  });
  return s.spec();
}

SectionSpec sphere_selection() {
  Section<Selection::Sphere> s("sphere_m", "A ball, its surface included, as that of a box.");
  s.key("center", &Selection::Sphere::center, "centre").in("m").must();
  s.key("radius", &Selection::Sphere::radius, "radius").in("m").within(above(0)).must();
  return s.spec();
}

SectionSpec nearest_selection() {
  Section<Selection::Nearest> s("nearest_m",
                                "The vertices of tets nearest to a point; of equally near ones those of lower number.");
  s.key("point", &Selection::Nearest::point, "the point").in("m").must();
  s.key("count", &Selection::Nearest::count, "how many").within(between(1, Codec<int>::kLargest));
  return s.spec();
}

SectionSpec side_selection() {
  Section<Selection::Side> s("side", "One side of the body.");
  s.choice<int>("axis", &Selection::Side::axis, {{"x", 0, ""}, {"y", 1, ""}, {"z", 2, ""}}, "axis across the side")
      .must();
  s.choice<bool>("end", &Selection::Side::upper,
                 {{"lower", false, "the side with the smallest coordinate"}, {"upper", true, "the largest"}},
                 "which end of the axis")
      .must();
  s.key("depth_m", &Selection::Side::depth,
        "vertices at most this far from the outermost one of a tet, up to rounding as in a box")
      .in("m")
      .within(at_least(0))
      .otherwise("");
  s.key("share", &Selection::Side::share, "the same as a share of the body's extent along the axis")
      .in("-")
      .within(Range{.min = 0.0, .max = 1.0, .min_open = true})
      .otherwise("");
  s.spec().exclusions = {{{{"depth_m"}, {"share"}}, true}};
  return s.spec();
}

SectionSpec facing_selection() {
  Section<Selection::Facing> s("facing",
                               "The vertices of the surface nearest to where a line through a point of the body first "
                               "meets it: a place that any "
                               "body has.");
  s.key("direction", &Selection::Facing::direction, "direction of the line, into the body, of any length")
      .in("-")
      .direction()
      .must();
  s.key("count", &Selection::Facing::count, "how many").within(between(1, Codec<int>::kLargest));
  s.fields(&Selection::Facing::at);
  s.spec().exclusions = {{{{"region"}, {"point_m"}}, false}};
  return s.spec();
}

template <class Place>
auto where_of(auto owner) {
  return [owner](auto& o) -> Place& { return (o.*owner).template emplace<Place>(); };
}

}  // namespace

const SectionSpec& mesh_section() {
  static const SectionSpec section = [] {
    SectionSpec s;
    s.name = "mesh";
    s.help = "The body: a generated mesh or one from a file, selected by `kind`.";
    s.kinds = {mesh_kind<BoxOptions>(box_kind()),
               mesh_kind<CylinderOptions>(cylinder_kind()),
               mesh_kind<ImplicitBody>(implicit_body_kind()),
               mesh_kind<LiverOptions>(liver_kind()),
               mesh_kind<ImageBody>(image_kind()),
               mesh_kind<MeshFile>(file_kind())};
    return s;
  }();
  return section;
}

const SectionSpec& box_section() {
  static const SectionSpec section = box_selection();
  return section;
}

const SectionSpec& sphere_section() {
  static const SectionSpec section = sphere_selection();
  return section;
}

const SectionSpec& selection_section() {
  static const SectionSpec nearest = nearest_selection(), side = side_selection(), facing = facing_selection();
  static const SectionSpec section = [] {
    Section<Selection> s("sets.NAME",
                         "A vertex set, selected by rest positions. It replaces a set of the mesh with the same name.");
    const auto where = &Selection::where;
    s.table("box_m", box_section(), where_of<Selection::Box>(where), "vertices in a box");
    s.table("sphere_m", sphere_section(), where_of<Selection::Sphere>(where), "vertices in a ball");
    s.table("nearest_m", nearest, where_of<Selection::Nearest>(where), "the vertices nearest to a point");
    s.table("side", side, where_of<Selection::Side>(where), "vertices of one side");
    s.table("facing", facing, where_of<Selection::Facing>(where), "the vertices about a point that a line finds");
    s.key(
         "vertices",
         [](Selection& x) -> std::vector<std::uint32_t>& { return x.where.emplace<Selection::Ids>().vertices; },
         "vertex numbers, from 0")
        .within(between(0, 4294967295.0))
        .otherwise("");
    s.key("surface_only", &Selection::surface_only, "only vertices of the surface");
    s.spec().exclusions = {{{{"box_m"}, {"sphere_m"}, {"nearest_m"}, {"side"}, {"facing"}, {"vertices"}}, true}};
    s.finish([](Selection& x, const Node& table, const Place& place) {
      x.origin = place.text();
      const auto* ids = std::get_if<Selection::Ids>(&x.where);
      if (ids && ids->vertices.empty())
        place.complain(*table.find("vertices"), "vertices", "is empty; name at least one vertex");
    });
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
