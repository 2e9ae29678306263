// probe.h — results at places of a moving body: at a point of the material, a vertex set, a region, a plane.
//
//   Probes probes(simulation, {{.name = "tip", .where = ProbePoint{{0.02, 0.02, 0.05}}}});
//   probes.columns()             tip_displacement_x_m, …, tip_stress_xx_Pa, …
//   probes.read(simulation)      their values at the present state
//
// Places are given at rest and stay with the material. Stress is that of the forces (TetFields); it is computed for the tets
// of the probes alone, and only when read() is called: between these calls a probe costs nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "glisson/field.h"
#include "glisson/math.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// A point of the material: displacement, velocity, and stress and strain of the tet around it.
struct ProbePoint {
  Vec3d position{};  ///< at rest [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("position", &ProbePoint::position, "m", "a point of the material: displacement, velocity, stress, strain")
            .keyed("point_m"));
  }
};
/// A vertex set: mean displacement and velocity, and the resultant of the stress on it,
///   F = Σ_a Σ_e V P s_a  over the vertices a of the set,
/// which in equilibrium is the force that a tool, a support or a load exerts there. The mean is over the faces of the surface
/// that the set spans, by their areas; of a set without such faces, over its vertices by the volumes around them.
struct ProbeSet {
  std::string set;

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("set", &ProbeSet::set, "a vertex set: mean displacement and velocity, resultant of the stress"));
  }
};
/// A region: means over the volume at rest, and the present volume.
struct ProbeRegion {
  std::string region;  ///< name or number; 0 is the whole body where the mesh has no regions

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("region", &ProbeRegion::region,
                      "a region by name or number, `\"0\"` for a body without regions: means over it, volume"));
  }
};
/// A section through the whole body: force and moment that the part in front of it, to which the normal points, exerts
/// on the part behind it, in tension along the normal.
///
///   F = Σ_a Σ_e V P s_a,  M = Σ_a Σ_e (x_a − point) × V P s_a    over the vertices a in front, of the tets that are cut
///
/// F and M are consistent with the discrete equations of motion: in equilibrium F equals the external force on the part in front,
/// to rounding, on any mesh; in motion the two differ by the inertia of that part. The mean traction is the stress over the section,
/// Σ P n A / Σ A; it is exact in uniform stress and otherwise has the error of the mesh. Vertices on the plane count as
/// behind it.
struct ProbePlane {
  Vec3d point{};                ///< at rest [m]; moments are about it, fixed in space
  Vec3d normal{0.0, 0.0, 1.0};  ///< of any length but 0

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("point", &ProbePlane::point, "m", "a point of it; moments are about this point, fixed in space")
            .keyed("point")
            .must(),
        field("normal", &ProbePlane::normal, "from the part behind to the part in front, of any length").direction());
  }
};

/// The tip of an instrument, or of anything else, at the present state.
struct ProbeTip {
  Vec3d position{};   ///< [m]
  Vec3d direction{};  ///< in which it is to arrive, a unit vector
};

struct ProbeOptions {
  std::string name = "probe";
  std::variant<ProbePoint, ProbeSet, ProbeRegion, ProbePlane> where;
  /// Where a tip is, asked with every reading; none: no distance is read. Of a point, set or region with present place x (of a
  /// region the mean over its volume, of a set that of its displacement) and a tip at p that points along d:
  ///   tip_distance_m = |x − p|,  tip_along_m = (x − p)·d, positive while the place lies ahead,  tip_across_m = |x − p − d (x − p)·d|
  std::function<ProbeTip()> tip{};

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("name", &ProbeOptions::name,
                      "name, with which its columns begin; no two probes of an experiment share one"),
                no_key("where", &ProbeOptions::where), no_key("tip", &ProbeOptions::tip));
  }
};

class ProbeReader;

/// Probes of one simulation.
///
/// They follow changes of the body: tets that were removed are left out, and a probe with no tet left reads nan. A point whose
/// tet was removed is lost unless it lies on the face of another.
class Probes {
 public:
  Probes();
  /// @throws std::invalid_argument for a point outside of the body (naming the nearest point of it), a plane that does not
  ///         cut it, a set or region that it does not have, or a tip with a plane
  Probes(const Simulation& simulation, std::vector<ProbeOptions> options);
  ~Probes();
  Probes(Probes&&) noexcept;
  Probes& operator=(Probes&&) noexcept;

  std::size_t size() const { return readers_.size(); }
  bool empty() const { return readers_.empty(); }
  const std::string& name(std::size_t probe) const { return options_[probe].name; }
  /// NAME_quantity_unit of each value, probe by probe.
  const std::vector<std::string>& columns() const { return columns_; }
  /// The values at the present state of the simulation that they were made for.
  /// Cost: of their tets, with averaged volume change of the neighbours too; and a look at every tet of the body.
  std::vector<double> read(const Simulation& simulation);
  /// Whether no tet of the probe is left; as of the last read().
  bool lost(std::size_t probe) const;

 private:
  std::vector<ProbeOptions> options_;
  std::vector<std::unique_ptr<ProbeReader>> readers_;
  std::vector<std::string> columns_;
  std::uint64_t changes_ = 0;  ///< of the body that the readers have followed
};

}  // namespace glisson
