// needle_state.h — what a needle knows between steps.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "glisson/archive.h"
#include "glisson/instruments/needle.h"
#include "instruments/needle/crossing.h"
#include "instruments/needle/needle_path.h"

namespace glisson {

/// The part of a vector across a direction.
inline Vec3d across(const Vec3d& a, const Vec3d& direction) { return a - direction * dot(a, direction); }

inline double squared(const Vec3d& a) { return dot(a, a); }

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

/// What a needle keeps from step to step.
struct NeedleKept : NeedlePath {
  NeedleStage stage = NeedleStage::outside;
  bool look = true;                         ///< whether reach is to name some
  Vec3d named_around{};                     ///< rest position that vertices were last named for
  std::vector<std::size_t> near_triangles;  ///< of the surface, that the tip may meet next, or come out at
  double aside = 0.0;                       ///< how far across the needle the farthest of them is from its rest [m]
  double aside_named = 0.0;                 ///< the list holds while it is no farther [m]
  std::size_t entered = 0;  ///< so many tracks the needle is in or has passed; the others are holes ahead of the tip
  bool tip_out = false;     ///< it has passed the last of these
  shaft::Row tip;           ///< where the path ends
  double tip_along = 0.0;   ///< impulse of the tip along the needle in the last step [N s]
  bool tip_cuts = false;    ///< in the last step
  double wave_time = 0.0;   ///< that a shear wave needs across the zone there [s]
  int region = 0;           ///< that the tip is in
  std::optional<int> next_region;        ///< whose boundary holds the tip
  std::size_t broken = 0;                ///< of the membranes on this path
  bool at_membrane = false;              ///< the first that is not broken holds the tip
  std::optional<double> cutting_beyond;  ///< of the last broken one that has a cutting force [N]
  bool withdraws = false;
  PressingWork pressing;
  DropWatch drop;
  Vec3d bend_tip{};      ///< deflection of the tip [m]
  double bending = 0.0;  ///< energy of that; kept where energies are tracked [J]
  double step_h = 0.0;
};

struct Needle::State : NeedleKept {
  NeedleOptions options;

  // the body
  const TetMesh* mesh = nullptr;
  std::unique_ptr<TissueZones> zones;
  std::vector<Triangle> surface;
  std::vector<double> surface_edges;  ///< the longest of each triangle, at rest [m]
  Mat3d zone_axes = identity<double>();

  // active vertices
  std::vector<std::uint32_t> wanted;          ///< named by reach
  std::vector<std::uint32_t> entry_vertices;  ///< of the near triangles that it may meet, ascending
  void look_at(const BodyView& body);
  void take_entry_vertices();
  void name_surface(const Vec3d& direction);
  void name_around_tip();
  void name_path();

  // the path
  std::vector<int> breaks;  ///< per node: how often it came from sticking to slip while a long step was solved for
  std::vector<char> stuck;  ///< per node: in the last iteration of a long step
  /// By how much the needle passes a node in a long step, which the lengths of shaft follow, as iterations find it.
  struct Way {
    std::optional<double> next{};               ///< to go on with [m]; none: not found yet
    double used = 0.0, last_used = 0.0;         ///< in this iteration and the last …
    std::optional<double> found{}, last_found;  ///< … and what came of it
    void take(double way);
  };
  std::vector<Way> ways;  ///< per node
  bool tries = false;     ///< what comes after a long step is tried, and taken back
  shaft::MobilityMatrix mobility;
  Vec3d tip_velocity{};                  ///< of the tissue at the tip before the step [m/s]
  std::vector<InnerMembrane> membranes;  ///< given and drawn, by ascending depth

  std::unique_ptr<Solver> solver;  ///< of the step that is being made

  void forget_forces(double h);

  // needle_path.cpp
  shaft::Row& entry() { return nodes[tracks[entered - 1].begin]; }  ///< of the track that the tip is in or has passed
  shaft::Row& far_end() { return nodes[end_of(entered - 1) - 1]; }  ///< its last node
  bool is_through() const { return entered > 0 && tracks[entered - 1].through; }
  /// Whether the tip presses, or there is a path that ends somewhere.
  bool has_tip_row() const { return stage == NeedleStage::pressing || !tracks.empty(); }
  /// Whether the tip's row acts: on a surface, or at the end of the path.
  bool tip_acts() const { return stage == NeedleStage::pressing || (stage == NeedleStage::inside && !is_through()); }
  bool tip_is_in_air() const { return stage == NeedleStage::outside || (stage == NeedleStage::inside && tip_out); }
  void read_ends(const InteractionStep& step);
  std::vector<TissueInterval> crossing(const Vec3d& at, const Vec3d& direction) const;
  std::vector<SurfaceHit> hits_at_rest(const Vec3d& from, const Vec3d& to, std::span<const std::size_t> triangles,
                                       double beyond = 0.0) const;
  bool is_next_entry(const SurfaceHit& hit, const Vec3d& from, const Vec3d& direction) const;
  bool meets_hole(const Vec3d& rest) const;
  void enter_hole();
  void touch(shaft::Row met, const Vec3d& direction);
  void let_go();
  void begin_track();
  void come_out();
  void leave_track();
  bool tracks_fit(std::size_t points) const;
  std::optional<Vec3d> way_out(const Vec3d& to) const;
  std::vector<TissueInterval> intervals_left(std::span<const Vec3d> points, std::span<const double> along) const;
  bool keep_what_is_left(std::size_t track, NeedlePath& kept) const;
  void cross_anew(const BodyView& body, const Vec3d& at, const Vec3d& direction);
  double bending_stiffness() const;  ///< E I [N m²]; 0: rigid
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
