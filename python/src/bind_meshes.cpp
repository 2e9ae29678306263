// bind_meshes.cpp — meshes from arrays and generators, and what is wrong with them.
#include <algorithm>

#include "bind.h"
#include "glisson/io.h"
#include "glisson/mesh.h"
#include "glisson/mesh_refinement.h"

namespace glisson::python {
namespace {

using Sets = std::map<std::string, nb::object>;

TetMesh mesh_of(const ArrayLike& vertices, const ArrayLike& tets, const nb::object& regions,
                const std::map<int, std::string>& region_names, const Sets& vertex_sets, const nb::object& fibres,
                bool orient) {
  TetMesh mesh;
  mesh.vertices = to_vectors(vertices, "vertices");
  const std::vector<std::uint32_t> corners = to_indices(tets, 4, "tets");
  for (std::size_t i = 0; i + 3 < corners.size(); i += 4) {
    mesh.tets.push_back({corners[i], corners[i + 1], corners[i + 2], corners[i + 3]});
  }
  if (!regions.is_none()) {
    for (const std::uint32_t r : to_indices(regions, 1, "regions")) mesh.regions.push_back(static_cast<int>(r));
  }
  mesh.region_names = region_names;
  if (!fibres.is_none()) mesh.fibres = to_vectors(nb::borrow<ArrayLike>(fibres), "fibres");
  for (const auto& [name, set] : vertex_sets) {
    std::vector<std::uint32_t> numbers = to_indices(set, 1, "vertex_sets");
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    mesh.vertex_sets[name] = std::move(numbers);
  }
  if (orient) orient_and_inspect(mesh);
  require_valid(mesh);
  return mesh;
}

/// What a mesh holds, as an array that must not be written to and keeps the mesh.
template <class Scalar, class Value>
nb::object view(nb::handle mesh, const std::vector<Value>& values, std::initializer_list<std::size_t> shape) {
  return nb::ndarray<nb::numpy, const Scalar, nb::c_contig>(reinterpret_cast<const Scalar*>(values.data()), shape, mesh)
      .cast(nb::rv_policy::reference);
}

nb::object vertices_view(nb::handle self) {
  const auto& mesh = nb::cast<const TetMesh&>(self);
  return view<double>(self, mesh.vertices, {mesh.vertices.size(), 3});
}
nb::object tets_view(nb::handle self) {
  const auto& mesh = nb::cast<const TetMesh&>(self);
  return view<std::uint32_t>(self, mesh.tets, {mesh.tets.size(), 4});
}
nb::object regions_view(nb::handle self) {
  const auto& mesh = nb::cast<const TetMesh&>(self);
  return view<int>(self, mesh.regions, {mesh.regions.size()});
}
nb::object fibres_view(nb::handle self) {
  const auto& mesh = nb::cast<const TetMesh&>(self);
  return view<double>(self, mesh.fibres, {mesh.fibres.size(), 3});
}

std::map<std::string, Numbers> sets_of(const TetMesh& mesh) {
  std::map<std::string, Numbers> sets;
  for (const auto& [name, vertices] : mesh.vertex_sets) sets.emplace(name, indices(vertices));
  return sets;
}

Numbers triangles_of(const TetMesh& mesh) {
  std::vector<Triangle> triangles = boundary_triangles(mesh);
  const std::size_t n = triangles.size();
  return owned<Numbers>(std::move(triangles), {n, 3});
}

TetMesh with_set(const TetMesh& mesh, const std::string& name, const ArrayLike& vertices) {
  TetMesh other = mesh;
  std::vector<std::uint32_t> numbers = to_indices(vertices, 1, "vertices");
  std::sort(numbers.begin(), numbers.end());
  other.vertex_sets[name] = std::move(numbers);
  require_valid(other);
  return other;
}

/// Copies of a mesh's arrays, as pickles and processes take them.
nb::tuple mesh_state(nb::handle self) {
  const auto& mesh = nb::cast<const TetMesh&>(self);
  const auto copy = [](const nb::object& array) { return array.attr("copy")(); };
  return nb::make_tuple(copy(vertices_view(self)), copy(tets_view(self)), copy(regions_view(self)),
                        copy(fibres_view(self)), mesh.region_names, sets_of(mesh));
}

void set_mesh_state(TetMesh& self, const nb::tuple& state) {
  set_pickled(self, state, "TetMesh", 6, [&] {
    const auto regions = nb::cast<nb::ndarray<const int, nb::ndim<1>, nb::c_contig, nb::device::cpu>>(state[2]);
    TetMesh mesh =
        mesh_of(nb::borrow<ArrayLike>(state[0]), nb::borrow<ArrayLike>(state[1]), nb::none(),
                nb::cast<std::map<int, std::string>>(state[4]), nb::cast<Sets>(state[5]), nb::borrow(state[3]), false);
    mesh.regions.assign(regions.data(), regions.data() + regions.size());
    require_valid(mesh);
    return mesh;
  });
}

void bind_report(nb::module_& m) {
  Results<MeshReport>(m, "MeshReport")
      .read("vertices", &MeshReport::vertices)
      .read("tets", &MeshReport::tets)
      .read("boundary_triangles", &MeshReport::boundary_triangles)
      .read("box_min", &MeshReport::box_min)
      .read("box_max", &MeshReport::box_max)
      .read("volume", &MeshReport::volume)
      .read("worst_mean_ratio", &MeshReport::worst_mean_ratio)
      .read("median_mean_ratio", &MeshReport::median_mean_ratio)
      .read("worst_tet", &MeshReport::worst_tet)
      .read("reoriented_tets", &MeshReport::reoriented_tets)
      .read("duplicate_tets", &MeshReport::duplicate_tets)
      .read("degenerate_tets", &MeshReport::degenerate_tets)
      .read("unused_vertices", &MeshReport::unused_vertices)
      .read("non_manifold_faces", &MeshReport::non_manifold_faces)
      .read("pieces", &MeshReport::pieces)
      .read("warnings", &MeshReport::warnings);
}

/// Keeps a copy of the options given by name: box_mesh(cells=…, size=…).
template <class T>
T options_from(const nb::kwargs& fields) {
  return nb::cast<T>(nb::type<T>()(**fields));
}

}  // namespace

void bind_meshes(nb::module_& m) {
  nb::exception<FileError>(m, "FileError", PyExc_RuntimeError);
  nb::class_<TetMesh>(m, "TetMesh", doc("TetMesh"))
      .def(
          "__init__",
          [](TetMesh* self, const ArrayLike& vertices, const ArrayLike& tets, const nb::object& regions,
             const std::map<int, std::string>& names, const Sets& sets, const nb::object& fibres,
             bool orient) { new (self) TetMesh(mesh_of(vertices, tets, regions, names, sets, fibres, orient)); },
          "vertices"_a, "tets"_a, nb::kw_only(), "regions"_a = nb::none(),
          "region_names"_a = std::map<int, std::string>{}, "vertex_sets"_a = Sets{}, "fibres"_a = nb::none(),
          "orient"_a = true, "Copies the arrays. `orient` reorients inverted tets; without it they are an error.")
      .def_prop_ro("vertices", vertices_view, doc("TetMesh::vertices"),
                   nb::sig("def vertices(self) -> numpy.typing.NDArray[numpy.float64]"))
      .def_prop_ro("tets", tets_view, doc("TetMesh::tets"),
                   nb::sig("def tets(self) -> numpy.typing.NDArray[numpy.uint32]"))
      .def_prop_ro("regions", regions_view, doc("TetMesh::regions"),
                   nb::sig("def regions(self) -> numpy.typing.NDArray[numpy.int32]"))
      .def_prop_ro("fibres", fibres_view, doc("TetMesh::fibres"),
                   nb::sig("def fibres(self) -> numpy.typing.NDArray[numpy.float64]"))
      .def_ro("region_names", &TetMesh::region_names, doc("TetMesh::region_names"))
      .def_prop_ro("vertex_sets", sets_of, doc("TetMesh::vertex_sets"))
      .def("with_set", with_set, "name"_a, "vertices"_a, "The mesh with one more vertex set: numbers or a mask.")
      .def_prop_ro(
          "volume", [](const TetMesh& mesh) { return volume(mesh); }, doc("volume"))
      .def(
          "refined", [](const TetMesh& mesh) { return refined(mesh); }, doc("refined"))
      .def("boundary_triangles", triangles_of, doc("boundary_triangles"))
      .def(
          "dihedral_histogram", [](const TetMesh& mesh, double bin_deg) { return dihedral_histogram(mesh, bin_deg); },
          "bin_deg"_a = 10.0, doc("dihedral_histogram"))
      .def(
          "inspect", [](const TetMesh& mesh) { return inspect(mesh); }, doc("inspect"))
      .def("__getstate__", mesh_state, nb::sig(kGetState))
      .def("__setstate__", set_mesh_state, nb::sig(kSetState))
      .def("__eq__", [](const TetMesh& a,
                        nb::handle b) { return nb::isinstance<TetMesh>(b) && a == nb::cast<const TetMesh&>(b); })
      .def("__repr__", [](const TetMesh& mesh) {
        return "<TetMesh of " + std::to_string(mesh.vertices.size()) + " vertices and " +
               std::to_string(mesh.tets.size()) + " tets>";
      });
  Options<BoxOptions>(m, "BoxOptions");
  Options<CylinderOptions>(m, "CylinderOptions");
  m.def(
      "box_mesh", [](const nb::kwargs& o) { return box_mesh(options_from<BoxOptions>(o)); }, doc("box_mesh"));
  m.def(
      "cylinder_mesh", [](const nb::kwargs& o) { return cylinder_mesh(options_from<CylinderOptions>(o)); },
      doc("cylinder_mesh"));
  bind_report(m);
}

}  // namespace glisson::python
