// bind_implicit.cpp — bodies of shapes or of any function of a point, their mesher, and the liver.
#include <nanobind/stl/tuple.h>

#include <sstream>
#include <typeinfo>

#include "bind.h"
#include "glisson/implicit.h"
#include "glisson/liver.h"
#include "glisson/scene/surface_file.h"
#include "glisson/simulation/mesh_step.h"
#include "glisson/surface_region.h"
#include "glisson/surface_repair.h"
#include "rooms.h"

namespace glisson::python {
namespace {

using Shapes = std::vector<Solid>;
using OfPoint = std::function<double(const Vec3d&)>;

/// The function, with a message where it gives something else than a number. @param name  as the caller knows it
OfPoint with_message(OfPoint f, const char* name) {
  if (!f) return f;
  return [f = std::move(f), name](const Vec3d& point) {
    try {
      return f(point);
    } catch (const std::bad_cast&) {
      std::ostringstream text;
      text << name << ": gave no number at (" << point.x << ", " << point.y << ", " << point.z
           << ") m; return a float in metres";
      throw nb::type_error(text.str().c_str());
    }
  };
}

void bind_shapes(nb::module_& m) {
  Options<BallShape>(m, "BallShape");
  Options<EllipsoidShape>(m, "EllipsoidShape");
  Options<BoxShape>(m, "BoxShape");
  Options<CylinderShape>(m, "CylinderShape");
  Options<TubePoint>(m, "TubePoint");
  Options<TubeShape>(m, "TubeShape");
  Options<TorusShape>(m, "TorusShape");
  Options<HalfSpaceShape>(m, "HalfSpaceShape");
}

void bind_solid(nb::module_& m) {
  nb::class_<Solid>(m, "Solid", doc("Solid"))
      .def(nb::init_implicit<BallShape>(), "shape"_a)
      .def(nb::init_implicit<EllipsoidShape>(), "shape"_a)
      .def(nb::init_implicit<BoxShape>(), "shape"_a)
      .def(nb::init_implicit<CylinderShape>(), "shape"_a)
      .def(nb::init_implicit<TubeShape>(), "shape"_a)
      .def(nb::init_implicit<TorusShape>(), "shape"_a)
      .def(nb::init_implicit<HalfSpaceShape>(), "shape"_a)
      .def_static(
          "from_function",
          [](OfPoint distance, const Vec3d& min, const Vec3d& max) {
            return Solid(with_message(std::move(distance), "distance"), {min, max});
          },
          "distance"_a, "min"_a, "max"_a,
          "Any function of a point [m]: negative inside, outside at most the distance, of its size near the surface; "
          "the box "
          "from `min` to `max` holds all of it.")
      .def("distance", &Solid::distance, "point"_a, doc("Solid::distance"))
      .def_prop_ro(
          "bounds", [](const Solid& s) { return std::pair(s.bounds().min, s.bounds().max); }, doc("Solid::bounds"))
      .def(
          "placed",
          [](const Solid& s, double scale, const Vec3d& axis, double angle_deg, const Vec3d& move) {
            return s.placed({"", scale, axis, angle_deg, move});
          },
          nb::kw_only(), "scale"_a = 1.0, "axis"_a = Vec3d{0, 0, 1}, "angle_deg"_a = 0.0, "move"_a = Vec3d{},
          "Scaled about the origin, turned about an axis through it and moved [m], in this order.")
      .def("__or__",
           [](const Solid& a, const Solid& b) {
             return unite({a, b});
           })
      .def("__and__",
           [](const Solid& a, const Solid& b) {
             return intersect({a, b});
           })
      .def("__sub__", [](const Solid& a, const Solid& b) { return subtract(a, {b}); });
  m.def("unite", unite, "shapes"_a, "blend"_a = 0.0, doc("unite"));
  m.def("intersect", intersect, "shapes"_a, "blend"_a = 0.0, doc("intersect"));
  m.def("subtract", subtract, "shape"_a, "others"_a, "blend"_a = 0.0, doc("subtract"));
}

std::vector<Triangle> to_triangles(const ArrayLike& array) {
  const std::vector<std::uint32_t> corners = to_indices(array, 3, "triangles");
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < corners.size(); i += 3) triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  return triangles;
}

void bind_surfaces(nb::module_& m) {
  m.def(
      "surface_solid",
      [](const ArrayLike& points, const ArrayLike& triangles) {
        return surface_solid(to_vectors(points, "points"), to_triangles(triangles));
      },
      "points"_a, "triangles"_a, doc("surface_solid"));
  m.def(
      "repair_surface",
      [](const ArrayLike& points, const ArrayLike& triangles) {
        SurfaceRepair closed = repair_surface(to_vectors(points, "points"), to_triangles(triangles));
        std::string text = closed.text();
        std::vector<std::uint32_t> corners;
        for (const Triangle& t : closed.triangles) corners.insert(corners.end(), t.begin(), t.end());
        const std::size_t count = closed.triangles.size();
        return std::tuple(vectors(std::move(closed.points)), owned<Numbers>(std::move(corners), {count, 3}),
                          std::move(text));
      },
      "points"_a, "triangles"_a, doc("repair_surface"));
  m.def(
      "read_surface",
      [](const std::filesystem::path& file, double scale) {
        TriangleSurface surface = read_surface(file, scale);
        std::vector<std::uint32_t> corners;
        for (const Triangle& t : surface.triangles) corners.insert(corners.end(), t.begin(), t.end());
        const std::size_t count = surface.triangles.size();
        return std::pair(vectors(std::move(surface.points)), owned<Numbers>(std::move(corners), {count, 3}));
      },
      "file"_a, "scale"_a = 1.0, doc("read_surface"));
}

using Made = std::pair<TetMesh, RegionMeshReport>;

Made made(RegionMesh mesh) { return {std::move(mesh.mesh), std::move(mesh.report)}; }

void bind_mesher(nb::module_& m) {
  Options<PathPoint>(m, "PathPoint");
  Options<MeshSize>(m, "MeshSize");
  nb::class_<BodyRegion>(m, "BodyRegion", doc("BodyRegion"))
      .def(
          "__init__",
          [](BodyRegion* self, const std::string& name, const Solid& solid, bool hole) {
            new (self) BodyRegion(region_of(name, solid, hole));
          },
          "name"_a, "solid"_a, "hole"_a = false)
      .def_ro("name", &BodyRegion::name)
      .def_ro("hole", &BodyRegion::hole, doc("BodyRegion::hole"));
  Results<RegionVolume>(m, "RegionVolume")
      .read("name", &RegionVolume::name)
      .read("number", &RegionVolume::number)
      .read("tets", &RegionVolume::tets)
      .read("volume", &RegionVolume::volume);
  Results<RegionMeshReport>(m, "RegionMeshReport")
      .read("min_dihedral_deg", &RegionMeshReport::min_dihedral_deg)
      .read("max_dihedral_deg", &RegionMeshReport::max_dihedral_deg)
      .read("seconds", &RegionMeshReport::seconds)
      .read("regions", &RegionMeshReport::regions)
      .read("poor_tets", &RegionMeshReport::poor_tets)
      .read("warnings", &RegionMeshReport::warnings);
  m.def(
      "mesh_regions",
      [](const std::vector<BodyRegion>& regions, double edge, std::size_t max_tets, const std::vector<MeshSize>& sizes,
         double growth, OfPoint size_at) {
        const auto go_on = [](double) { return PyErr_CheckSignals() == 0; };
        return made(
            mesh_regions(regions, {edge, max_tets, go_on, sizes, growth, with_message(std::move(size_at), "size_at")}));
      },
      "regions"_a, "edge"_a, "max_tets"_a = RegionMeshOptions{}.max_tets, "sizes"_a = std::vector<MeshSize>{},
      "growth"_a = kGrowth, "size_at"_a = nb::none(), doc("mesh_regions"));
  m.def(
      "edges_asked",
      [](const TetMesh& mesh, const std::vector<BodyRegion>& regions, double edge, const std::vector<MeshSize>& sizes,
         double growth, OfPoint size_at) {
        return scalars(edges_asked(
            mesh, regions,
            {.edge = edge, .sizes = sizes, .growth = growth, .size_at = with_message(std::move(size_at), "size_at")}));
      },
      "mesh"_a, "regions"_a, "edge"_a, "sizes"_a = std::vector<MeshSize>{}, "growth"_a = kGrowth,
      "size_at"_a = nb::none(), doc("edges_asked"));
  m.def("relative_stable_step", nb::overload_cast<const TetMesh&, double>(relative_stable_step), "mesh"_a, "edge"_a,
        doc("relative_stable_step"));
  m.def(
      "relative_stable_step",
      [](const TetMesh& mesh, const std::vector<double>& edges) { return relative_stable_step(mesh, edges); }, "mesh"_a,
      "edges"_a, "The same where another edge was asked for in each tet [m] (`edges_asked`).");
  Options<LiverOptions>(m, "LiverOptions");
  m.def(
      "liver_mesh",
      [](const nb::kwargs& options) {
        return made(liver_mesh(nb::cast<LiverOptions>(nb::type<LiverOptions>()(**options))));
      },
      doc("liver_mesh"));
}

}  // namespace

void bind_implicit(nb::module_& m) {
  bind_shapes(m);
  bind_solid(m);
  bind_surfaces(m);
  bind_mesher(m);
}

}  // namespace glisson::python
