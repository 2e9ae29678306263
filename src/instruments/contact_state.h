// contact_state.h — what a ContactTool keeps: its part of the surface, the rows of a step, what is bonded.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "instruments/contact_rows.h"
#include "instruments/contact_surface.h"

namespace glisson {

/// The part of the surface that a solid may touch: patches come in as it draws near and stay.
class ContactReach {
 public:
  void attach(const BodyView& body);
  /// Vertices to bring to hand, the sentinels of all patches at first. @param solid  its way in the coming step
  std::span<const std::uint32_t> ask(const ContactSolid& solid, double h);
  /// Where the sentinels are after a step.
  void look(const InteractionStep& step);

  const ContactSurface& surface() const { return surface_; }
  std::span<const std::uint32_t> vertices() const { return mine_; }
  /// Triangles with all corners among vertices(), and these as places there.
  std::span<const Triangle> triangles() const { return my_triangles_; }

  void save(std::vector<double>& past) const;
  bool restore(std::span<const double>& past);

 private:
  /// Of a patch.
  struct Sentinel {
    Vec3d position, velocity;
    bool asked = false;
  };

  bool may_reach(const ContactSolid& solid, const SurfacePatch& patch, const Sentinel& s, double h) const;
  void gather();

  ContactSurface surface_;
  std::vector<Sentinel> sentinels_;
  std::vector<std::uint32_t> mine_, asking_;
  std::vector<Triangle> my_triangles_;
  bool sentinels_asked_ = false;
};

struct ContactTool::State {
  ContactOptions options;
  ContactSolid solid;
  ContactReach reach;
  double last_h = 0.0;
  bool lost = false;  ///< its pose made no sense: it has left

  std::vector<ContactRow> rows;
  std::vector<Vec3d> starts, ends;          ///< per vertex of the reach, in the frame of the tool
  std::vector<double> at_ends;              ///< φ there
  std::map<std::uint32_t, Vec3d> bonds;     ///< vertex → place in the frame of the tool
  std::map<std::uint32_t, double> bearing;  ///< vertex → impulse along its normal in this step [N s]
  std::vector<std::uint32_t> bearing_vertices;
  std::vector<double> pressures;
  double area = 0.0;
  Effort effort{};

  std::vector<Vec3d> speeds;  ///< v₋ per place
  double taken = 0.0;         ///< energy that contact has taken from the body so far, the tool's own motion apart [J]
  bool begun = false;         ///< a step has been made since the tool was attached
  std::set<std::uint32_t> found_inside;  ///< vertices that were inside then, and have not come out yet
  bool in_contact = false;
  double last_touch = 0.0, last_depth = 0.0;

  void add_vertices(const InteractionStep& step);
  void measure(const InteractionStep& step);
  void add_triangles(const InteractionStep& step);
  void add_triangle(std::uint32_t triangle, const Triangle& corners, const InteractionStep& step);
  void solve_rows(const InteractionStep& step);
  void keep_account(const InteractionStep& step);
  void bond(const InteractionStep& step, ToolForces& forces);
  void collect(const InteractionStep& step, ToolForces& forces);
  void weigh(const InteractionStep& step);
};

}  // namespace glisson
