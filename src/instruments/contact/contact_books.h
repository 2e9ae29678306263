// contact_books.h — what contact does to the energy of a body, and the rule that it creates none.
//
// The explicit scheme counts the work of an impulse J as J·(v₋ + v₊)/2. Against a solid at rest that is below zero for a
// vertex on a plane, whatever J is asked for. Along curved solids, on triangles between vertices and where impulses act on one
// another it can be above, by errors of the step. The books add up what contact has taken from the body; where the impulses
// of a step would give more than that back, they are solved for anew so that each takes or gives nothing, and if that
// still gives, all are made smaller. So the sum is never above zero, against a solid at rest.
#pragma once

#include <set>
#include <utility>
#include <vector>

#include "glisson/archive.h"
#include "instruments/contact/contact_rows.h"

namespace glisson {

class ContactBooks {
 public:
  /// Keeps v₋ of all vertices at hand: to be called in add_forces.
  void begin(const InteractionStep& step);
  /// Solves for all impulses. @return sweeps
  int solve(std::span<ContactRow> rows, const InteractionStep& step);
  /// Books the impulses as they are now. Once a step.
  void close(std::span<const ContactRow> rows, const InteractionStep& step);

  /// Whether solve() had to solve anew in this step.
  bool corrected() const { return corrected_; }
  double taken() const { return taken_; }
  void set_taken(double taken) { taken_ = taken; }
  void archive(Archive& ar) { ar(taken_); }

 private:
  /// Of the impulses of a step [J].
  struct Work {
    double relative = 0.0;  ///< with velocities against the solid: what contact itself adds to the body
    double tool = 0.0;      ///< by the motion of the solid, each row's in size
  };
  Work work_of(std::span<const ContactRow> rows, const InteractionStep& step) const;
  bool creates(std::span<const ContactRow> rows, const InteractionStep& step) const;
  int solve_anew(std::span<ContactRow> rows, const InteractionStep& step) const;
  void shrink(std::span<ContactRow> rows, const InteractionStep& step) const;

  std::vector<Vec3d> before_;  ///< v₋ per place
  double taken_ = 0.0;
  bool corrected_ = false;
};

/// Vertices that were inside a solid when it was attached: there it is taken to grow to its size, so that they come out.
class FoundInside {
 public:
  /// Marks a row that has its solid, start pose and vertex, before prepare(); `begun`: this is not the first step.
  void mark(ContactRow& row, std::uint32_t vertex, std::uint32_t solid, const Vec3d& start, bool begun);
  /// After prepare().
  void settle(const ContactRow& row, std::uint32_t vertex, std::uint32_t solid);
  void archive(Archive& ar) { ar(inside_); }

 private:
  std::set<std::pair<std::uint32_t, std::uint32_t>> inside_;
};

}  // namespace glisson
