// capsule_state.h — what a capsule keeps between steps: the sheet, where its vertices are, what is open.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "instruments/capsule/capsule_surface.h"
#include "instruments/capsule/membrane.h"

namespace glisson {

/// Share of its stiffness that a sheet keeps with the share φ of it taken by round holes, (1 − φ)/(1 + 2φ): 1 − 3φ for
/// few, 0 for φ = 1 [MoriTanaka1973].
inline double kept_share(double open) { return (1.0 - open) / (1.0 + 2.0 * open); }

struct Capsule::State {
  explicit State(const CapsuleOptions& o) : options(o) {}

  CapsuleOptions options;
  std::vector<TetFace> faces;            ///< per triangle
  std::vector<Triangle> triangles;       ///< in vertices of the mesh
  std::vector<char> is_gone, counts;     ///< per triangle: went with its tet; bears something
  std::vector<double> open;              ///< per triangle: share of it that is open [-]
  std::vector<std::uint32_t> vertices;   ///< of the mesh that it lies on, ascending
  std::vector<Triangle> local;           ///< per triangle, in places of `vertices`
  std::vector<Vec3d> rest, now, forces;  ///< per place [m], [m], [N]
  Membrane membrane;
  std::vector<double> tension;  ///< per triangle [N/m]; read through tensions()
  bool tension_is_current = false;
  Neighbours near;                                 ///< within half the averaging length; made when first needed
  std::size_t nearest = 0;                         ///< triangle that was nearest to the last place someone asked about
  bool is_long = false;                            ///< acts in long steps
  bool is_named = false;                           ///< whether reach() has named the vertices
  double frequency = 0.0, frequency_before = 0.0;  ///< squared, of the last two steps [1/s²]
  double released = 0.0;                           ///< without work [J]
  double time = 0.0;                               ///< of the last forces [s]
  std::vector<CapsuleEvent> events;

  /// @param sharply  finds the frequency of the sheet at rest, which takes some ms; else a bound from single triangles
  void lay_out(const BodyView& body, bool sharply);
  void show_openings();
  void evaluate();
  const std::vector<double>& tensions();
  PointOnTriangle nearest_to(const Vec3d& place);
  void open_to(std::size_t triangle, double share);
  std::size_t due_to_tear();
  void tear_where_due();
  double mean_tension(std::size_t triangle);
  Vec3d centre(std::size_t triangle) const;
};

}  // namespace glisson
