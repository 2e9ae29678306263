// probe_reader.h — one probe: which tets it reads, and what it makes of their fields.
//
//   follow ─▶ tets ─▶ Simulation::tet_fields of all probes at once ─▶ read
//
// What a probe belongs to is kept as tets and their corners: these stay the same where faces are split, so that copies of a
// vertex follow by themselves.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "element/body.h"
#include "glisson/simulation/probe.h"

namespace glisson {

class Scheme;

/// A vertex as a corner of a tet.
struct Corner {
  std::uint32_t tet = 0;
  std::uint8_t at = 0;
};

class ProbeReader {
 public:
  virtual ~ProbeReader() = default;
  /// Names of the values, without that of the probe.
  virtual std::vector<std::string> columns() const = 0;
  /// Finds the tets anew, at the start and after a change of the body.
  virtual void follow(const Simulation& simulation) = 0;
  /// Those that are read, none of them removed; empty: the probe is lost.
  const std::vector<std::uint32_t>& tets() const { return tets_; }
  /// Values in the order of the columns. @param first  where the fields of its tets start
  virtual std::vector<double> read(const Simulation& simulation, const TetFields& fields, std::size_t first) const = 0;
  /// Where the place is in space at present [m]; none of a plane. Only where the probe has tets.
  virtual std::optional<Vec3d> place(const Simulation&) const { return {}; }

  std::weak_ptr<const Scheme> scheme;  ///< of the simulation that it was made for

 protected:
  std::vector<std::uint32_t> tets_;
};

/// @throws std::invalid_argument as Probes
std::unique_ptr<ProbeReader> make_reader(const Simulation& simulation, const ProbePoint& point);
std::unique_ptr<ProbeReader> make_reader(const Simulation& simulation, const ProbeSet& set);
std::unique_ptr<ProbeReader> make_reader(const Simulation& simulation, const ProbeRegion& region);
std::unique_ptr<ProbeReader> make_reader(const Simulation& simulation, const ProbePlane& plane);

/// Simulation::tet_fields of some tets, in their order. @param tets  numbers of the mesh
TetFields fields_of(const Simulation& simulation, std::span<const std::uint32_t> tets);
/// The same for all states of a simulation, and wherever it is moved to.
std::weak_ptr<const Scheme> scheme_of(const Simulation& simulation);
/// How often the mesh or the tissues of the body were changed so far.
std::uint64_t changes_of(const Simulation& simulation);

/// Rest data of a tet as the mesh has it now.
ElementRest rest_of(const TetMesh& mesh, std::uint32_t tet);
/// Present position of a vertex [m].
inline Vec3d present_position(const Simulation& simulation, std::uint32_t vertex) {
  return simulation.mesh().vertices[vertex] + simulation.displacement()[vertex];
}
/// F_a = V P s_a of a corner: what must act on it from outside to balance the tet's stress [N].
Vec3d corner_force(const TetMesh& mesh, const TetFields& fields, std::size_t field, Corner corner);
/// Mean over volume of Cauchy's stress (6, as in TetFields), Green's strain (6) and Cauchy's pressure and von Mises' stress
/// of the mean. @param volumes  weights of the tets, not all 0
std::vector<double> mean_state(const Simulation& simulation, const TetFields& fields, std::size_t first,
                               std::span<const std::uint32_t> tets, std::span<const double> volumes);
/// Displacement, velocity, and stress_xx_Pa … von_mises_Pa as mean_state has them.
std::vector<std::string> material_columns();
/// `what_x_unit`, `what_y_unit`, `what_z_unit`.
void add_vector_columns(std::vector<std::string>& columns, const std::string& what, const std::string& unit);
void add_vector(std::vector<double>& row, const Vec3d& v);

}  // namespace glisson
