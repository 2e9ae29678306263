// probe_reader.cpp — what probes have in common.
#include "dynamics/probe/probe_reader.h"

#include "dynamics/simulation_parts.h"
#include "element/tet_fields.h"

namespace glisson {
namespace {

constexpr std::array<const char*, 6> kSymmetric{"xx", "yy", "zz", "xy", "yz", "zx"};

Sym3<double> strain_of(const Simulation& simulation, std::uint32_t tet) {
  const Tet& t = simulation.mesh().tets[tet];
  const std::span<const Vec3d> u = simulation.displacement();
  const ElementRest rest = rest_of(simulation.mesh(), tet);
  return green_strain(displacement_gradient<double>(rest.s, {u[t[1]] - u[t[0]], u[t[2]] - u[t[0]], u[t[3]] - u[t[0]]}));
}

}  // namespace

TetFields fields_of(const Simulation& simulation, std::span<const std::uint32_t> tets) {
  const Scheme& scheme = SimulationParts::scheme(simulation);
  std::vector<BranchMemory> memory;
  for (std::size_t b = 0; b < scheme.body().blocks.size(); ++b) memory.push_back(scheme.branch_memory(b));
  return tet_fields(scheme.body(), tets, simulation.displacement(), simulation.velocity(), memory);
}

std::weak_ptr<const Scheme> scheme_of(const Simulation& simulation) { return SimulationParts::weak_scheme(simulation); }

std::uint64_t changes_of(const Simulation& simulation) { return SimulationParts::scheme(simulation).state().editions; }

ElementRest rest_of(const TetMesh& mesh, std::uint32_t tet) {
  const Tet& t = mesh.tets[tet];
  return element_rest({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], mesh.vertices[t[3]]});
}

Vec3d corner_force(const TetMesh& mesh, const TetFields& fields, std::size_t field, Corner corner) {
  const ElementRest rest = rest_of(mesh, corner.tet);
  const Vec3d s = shape_gradients(rest)[corner.at] * rest.volume;
  const double* P = &fields.piola[9 * field];
  return {P[0] * s.x + P[1] * s.y + P[2] * s.z, P[3] * s.x + P[4] * s.y + P[5] * s.z,
          P[6] * s.x + P[7] * s.y + P[8] * s.z};
}

std::vector<double> mean_state(const Simulation& simulation, const TetFields& fields, std::size_t first,
                               std::span<const std::uint32_t> tets, std::span<const double> volumes) {
  std::vector<double> row(12, 0.0);
  double whole = 0.0;
  for (const double v : volumes) whole += v;
  for (std::size_t k = 0; k < tets.size(); ++k) {
    const double share = volumes[k] / whole;
    const Sym3<double> e = strain_of(simulation, tets[k]);
    const std::array<double, 6> strain{e.xx, e.yy, e.zz, e.xy, e.yz, e.zx};
    for (std::size_t i = 0; i < 6; ++i) {
      row[i] += share * fields.stress[6 * (first + k) + i];
      row[6 + i] += share * strain[i];
    }
  }
  row.push_back(-(row[0] + row[1] + row[2]) / 3.0);
  row.push_back(von_mises(std::span<const double, 6>(row.data(), 6)));
  return row;
}

std::vector<std::string> material_columns() {
  std::vector<std::string> columns;
  add_vector_columns(columns, "displacement", "m");
  add_vector_columns(columns, "velocity", "m_s");
  for (const char* ij : kSymmetric) columns.push_back(std::string("stress_") + ij + "_Pa");
  for (const char* ij : kSymmetric) columns.push_back(std::string("strain_") + ij);
  columns.insert(columns.end(), {"pressure_Pa", "von_mises_Pa"});
  return columns;
}

void add_vector_columns(std::vector<std::string>& columns, const std::string& what, const std::string& unit) {
  for (const char* axis : {"_x_", "_y_", "_z_"}) columns.push_back(std::string(what).append(axis).append(unit));
}

void add_vector(std::vector<double>& row, const Vec3d& v) { row.insert(row.end(), {v.x, v.y, v.z}); }

}  // namespace glisson
