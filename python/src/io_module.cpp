// io_module.cpp — glisson._io: mesh files. A module of its own, so that VTK is only loaded where a file is read.
#include "bind.h"
#include "glisson/io.h"

NB_MODULE(_io, m) {
  namespace nb = nanobind;
  using namespace nb::literals;
  using namespace glisson;
  nb::module_::import_("glisson._core");
  m.def(
      "read_mesh",
      [](const std::filesystem::path& file, std::optional<double> scale) {
        ImportedMesh imported = read_mesh(file, scale);
        return std::pair(std::move(imported.mesh), std::move(imported.report));
      },
      "file"_a, "scale"_a.none() = 1.0, python::doc("read_mesh"));
  m.def(
      "format_report",
      [](const std::string& name, const MeshReport& report, const TetMesh& mesh) {
        return format_report(name, report, &mesh);
      },
      "name"_a, "report"_a, "mesh"_a, python::doc("format_report"));
  using Fields = std::map<std::string, python::ArrayLike>;
  m.def(
      "write_vtu",
      [](const std::filesystem::path& file, const TetMesh& mesh, const std::optional<python::ArrayLike>& positions,
         const Fields& on_vertices, const Fields& on_tets) {
        const auto fields = [](const Fields& given) {
          std::vector<Field> out;
          for (const auto& [name, array] : given) {
            const nb::object rows = nb::module_::import_("numpy").attr("ascontiguousarray")(array, "float64");
            const auto numbers = nb::cast<nb::ndarray<const double, nb::c_contig, nb::device::cpu>>(rows);
            const int components = numbers.ndim() == 2 ? static_cast<int>(numbers.shape(1)) : 1;
            out.push_back({name, components, {numbers.data(), numbers.data() + numbers.size()}});
          }
          return out;
        };
        const std::vector<Vec3d> places =
            positions ? python::to_vectors(*positions, "positions") : std::vector<Vec3d>{};
        write_vtu(file, mesh, places, fields(on_vertices), fields(on_tets));
      },
      "file"_a, "mesh"_a, "positions"_a = nb::none(), "vertex_fields"_a = Fields{}, "tet_fields"_a = Fields{},
      python::doc("write_vtu"));
}
