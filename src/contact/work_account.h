// work_account.h — what contact of a tool does to the energy of a body, and the rule that it creates none.
//
// The explicit scheme counts the work of an impulse J as J·(v₋ + v₊)/2. Against a solid at rest that is below zero for a
// vertex on a plane, whatever J is asked for. Along curved solids, on triangles between vertices and where impulses act on one
// another it can be above, by errors of the step. The account adds up what contact has taken from the body; where the impulses
// of a step would give more than that back, they are solved for anew so that each takes or gives nothing, and if that
// still gives, all are made smaller. So the sum is never above zero, against a solid at rest.
#pragma once

#include <span>
#include <vector>

#include "contact/point_rows.h"
#include "glisson/archive.h"

namespace glisson {

class WorkAccount {
 public:
  /// Whether the impulses of these rows give the body more than contact has taken from it. @param before  v₋ per place [m/s]
  bool is_overdrawn(std::span<const ContactRow> rows, std::span<const Vec3d> before, const InteractionStep& step) const;
  /// Books the impulses as they are now. Once a step.
  void close(std::span<const ContactRow> rows, std::span<const Vec3d> before, const InteractionStep& step);
  double taken() const { return taken_; }
  void set_taken(double taken) { taken_ = taken; }
  void archive(Archive& ar) { ar(taken_); }

 private:
  double taken_ = 0.0;  ///< [J]
};

/// Takes all impulses back, and lets no point leave faster than it came, or come out where it was inside.
void begin_anew(std::span<ContactRow> rows, std::span<const Vec3d> before, const InteractionStep& step);

/// Makes all impulses smaller by one factor, so that they do no work in sum.
void shrink(std::span<ContactRow> rows, std::span<const Vec3d> before, const InteractionStep& step);

}  // namespace glisson
