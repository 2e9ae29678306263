// needle_state.h — what a needle knows between steps.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "glisson/archive.h"
#include "glisson/instruments/needle.h"
#include "instruments/needle/shaft.h"

namespace glisson {

/// The part of a vector across a direction.
inline Vec3d across(const Vec3d& a, const Vec3d& direction) { return a - direction * dot(a, direction); }

/// Where a ray meets a triangle.
struct Hit {
  double way = 0.0;  ///< along the ray [m]
  Vec3d rest{};      ///< of the point met [m]
};

/// Where a ray from `from` meets a triangle from either side. Ray and triangle at present, the answer at rest.
std::optional<Hit> meet(const Vec3d& from, const Vec3d& direction, const std::array<Vec3d, 3>& present,
                        const std::array<Vec3d, 3>& rest);

/// The way of the force while the tip presses, for what springing back would set free.
struct PressingWork {
  double work = 0.0;                                     ///< ∫ f dδ so far [J]
  double depth = 0.0;                                    ///< of the tip since contact, at the last step [m]
  double force = 0.0;                                    ///< at the last step [N]
  double work_at_cutting = 0.0, depth_at_cutting = 0.0;  ///< where the force rose through that of cutting

  void add(double new_depth, double new_force, double cutting);
  void archive(Archive& ar) { ar(work, depth, force, work_at_cutting, depth_at_cutting); }
  /// Energy that is free when the tissue springs back until the tip only cuts [J].
  double free_energy(double cutting) const;
};

/// After a puncture the force falls to a least value and rises again: the end of the drop. Looked for in the force smoothed
/// over some ms, since in the first step the tip has let go and the shaft has not yet taken hold.
struct DropWatch {
  bool armed = false;
  double puncture_force = 0.0, force = 0.0, least = 0.0, time = 0.0, depth = 0.0;
  void archive(Archive& ar) { ar(armed, puncture_force, force, least, time, depth); }
};

struct Needle::State {
  NeedleOptions options;
  NeedleStage stage = NeedleStage::outside;

  // the body
  const TetMesh* mesh = nullptr;
  std::unique_ptr<TissueZones> zones;
  std::vector<Triangle> surface;
  std::vector<double> surface_edges;  ///< the longest of each triangle, at rest [m]
  Mat3d zone_axes = identity<double>();

  // active vertices
  std::vector<std::uint32_t> wanted;          ///< named by reach
  bool look = true;                           ///< whether reach is to name some
  Vec3d named_around{};                       ///< rest position that vertices were last named for
  std::vector<std::size_t> entry_triangles;   ///< of the surface, that the needle may meet first
  std::vector<std::uint32_t> entry_vertices;  ///< theirs, ascending
  double aside = 0.0;                         ///< how far across the needle the farthest of them is from its rest [m]
  double aside_named = 0.0;                   ///< the list holds while it is no farther [m]
  void take_entry_vertices();
  void name_surface(const Vec3d& direction);
  void name_around_path();

  // the path
  std::vector<shaft::Row> nodes;  ///< from the surface on
  shaft::Row tip;                 ///< where the path ends
  std::vector<char> slips;        ///< per node
  std::vector<int> breaks;  ///< per node: how often it came from sticking to slip while a long step was solved for
  std::vector<char> stuck;  ///< per node: in the last iteration of a long step
  std::vector<double>
      ways;            ///< per node: by how much the needle passes it in a long step, as found last [m]; NaN: not found
  bool tries = false;  ///< what comes after a long step is tried, and taken back
  std::vector<double> along;  ///< per node: impulse along the needle in the last step [N s]
  shaft::MobilityMatrix mobility;
  double tip_along = 0.0;                ///< the same of the tip
  Vec3d tip_velocity{};                  ///< of the tissue at the tip before the step [m/s]
  double wave_time = 0.0;                ///< that a shear wave needs across the zone there [s]
  bool tip_cuts = false;                 ///< in the last step
  bool tip_out = false;                  ///< on the far side of the body
  int region = 0;                        ///< that the tip is in
  std::optional<int> next_region;        ///< whose boundary holds the tip
  std::vector<InnerMembrane> membranes;  ///< given and drawn, by ascending depth
  std::size_t broken = 0;                ///< of them on this path
  bool at_membrane = false;              ///< the first that is not broken holds the tip
  std::optional<double> cutting_beyond;  ///< of the last broken one that has a cutting force [N]
  bool withdraws = false;
  PressingWork pressing;
  DropWatch drop;

  // the last step
  Vec3d bend_tip{};         ///< deflection of the tip [m]
  std::vector<Vec3d> bend;  ///< of the needle at each node [m]
  double bending = 0.0;     ///< energy of that; kept where energies are tracked [J]
  double step_h = 0.0;
  double slack = 0.0;               ///< compliance of rows across beside that of the needle [1/kg]
  std::vector<std::size_t> acting;  ///< nodes that the needle acted on
  std::vector<double> lengths;      ///< of shaft that each of them stands for [m]
  std::vector<double> from_hand;    ///< of each, then of the tip if it acted: distance from the hand [m]

  void forget_forces(double h);
  const shaft::Row& acting_row(std::size_t j) const { return j < acting.size() ? nodes[acting[j]] : tip; }
  std::vector<double> compliance_across(double h) const;  ///< of the acting rows that are held, row by row [1/kg]
  double bending_stiffness() const;                       ///< E I [N m²]; 0: rigid
  TipResistance resistance(int region_number) const;
  double cutting() const;    ///< where the tip is [N]
  double tip_limit() const;  ///< [N]
  double rest_depth(const Vec3d& direction) const { return dot(tip.rest - nodes.front().rest, direction); }
  void enter(int region_number);
  void pass_membrane();
  /// Sets a row to a rest position. @return false where no tissue is around it; the row is as it was then
  bool place(shaft::Row& row, const Vec3d& rest) const;
  void cut_to(const InteractionStep& step, const Vec3d& at, const Vec3d& direction);
  Vec3d last_before(const Vec3d& next, int there) const;
  bool stop_at_membrane(Vec3d& next, const Vec3d& direction) const;
};

}  // namespace glisson
