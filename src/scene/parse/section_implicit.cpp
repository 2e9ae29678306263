// section_implicit.cpp — [mesh] of kind "implicit": [[mesh.shape]] and [[mesh.region]].
#include "glisson/scene/scene.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

template <class S>
KindSpec shape_kind(std::string help) {
  return {described<S>(std::move(help)),
          [](void* shape) -> void* { return &static_cast<NamedShape*>(shape)->what.emplace<S>(); }};
}

/// The file itself is read once its path is known (scene.cpp).
KindSpec surface_kind() {
  Section<SurfaceShape> s("surface", "The body within a closed surface of triangles from a file: .stl, .obj or .ply.");
  s.key("path", &SurfaceShape::path, "the file, relative to the scene").must();
  s.key("scale", &SurfaceShape::scale, "factor on the coordinates; 0.001 for a file in millimetres")
      .in("-")
      .within(above(0));
  return {s.spec(),
          [](void* shape) -> void* { return &static_cast<NamedShape*>(shape)->what.emplace<SurfaceShape>(); }};
}

/// A fault between names, at the key of the shape, region or size that has it.
void complain_of_names(ImplicitBody& body, const Node& table, const Place& place) {
  for (const char* list : {"shape", "region"}) {
    if (!table.find(list) || table.find(list)->array()->empty()) {
      const std::string heading = std::string("[[mesh.") + list + "]]";
      return place.complain("has no " + heading + "; give one or more");
    }
  }
  const BodyFault fault = glisson::check_names(body);
  if (fault.what.empty()) return;
  const std::string list(fault.list);
  const Node& element = (*table.find(list)->array())[fault.index];
  const Node* given = element.find(fault.key);
  place.complain(given ? *given : element, list + "." + std::to_string(fault.index) + "." + fault.key, fault.what);
}

}  // namespace

const SectionSpec& tube_point_section() {
  static const SectionSpec section = described<TubePoint>(
      "mesh.shape.points", "A point of a tube: `points = [{ at_mm = [0, 0, 0], radius_mm = 3 }, ...]`.");
  return section;
}

const SectionSpec& path_point_section() {
  static const SectionSpec section =
      described<PathPoint>("mesh.size.path", "A point of a line: `path = [{ at_mm = [0, 0, 0] }, ...]`.");
  return section;
}

const SectionSpec& mesh_size_section() {
  static const SectionSpec section =
      described<MeshSize>("mesh.size",
                          "Where the edges of a mesh of kind implicit or liver are shorter: near one region, its "
                          "surface or a line. From there "
                          "on they grow by `growth`; of several sizes the shortest counts (docs/implicit.md).");
  return section;
}

const SectionSpec& shape_section() {
  static const SectionSpec section = [] {
    Section<NamedShape> s("mesh.shape",
                          "A shape, selected by `kind`. It may refer to those before it, and is part of the body only "
                          "through a region (docs/implicit.md).");
    s.key("name", &NamedShape::name, "name").must();
    s.spec().kinds = {
        shape_kind<BallShape>("A ball."),
        shape_kind<EllipsoidShape>("An ellipsoid along x, y and z, or with larger exponents a superellipsoid: rounder "
                                   "than a box or a cylinder."),
        shape_kind<BoxShape>("A box along x, y and z."),
        shape_kind<CylinderShape>("A cylinder between two points."),
        shape_kind<TubeShape>("A tube of varying radius along a smooth line through points, with round ends."),
        shape_kind<TorusShape>("A ring."),
        shape_kind<HalfSpaceShape>("All on one side of a plane; cuts other shapes."),
        surface_kind(),
        shape_kind<UnionShape>("Shapes joined."),
        shape_kind<DifferenceShape>("The first shape without the others."),
        shape_kind<IntersectionShape>("What shapes share."),
        shape_kind<PlacedShape>("A shape scaled, turned about the origin and moved, in this order.")};
    return s.spec();
  }();
  return section;
}

const SectionSpec& shape_region_section() {
  static const SectionSpec section = described<ShapeRegion>(
      "mesh.region",
      "A region of the mesh, in the order of precedence: the first takes what it covers from all others.");
  return section;
}

SectionSpec implicit_body_kind() {
  Section<ImplicitBody> s(
      "implicit",
      "A body of shapes with one or more regions, meshed conformingly: regions meet in common faces, "
      "and all dihedral angles lie between 10° and 165° (docs/implicit.md).");
  s.fields();
  s.finish(complain_of_names);
  return s.spec();
}

}  // namespace glisson::scene
