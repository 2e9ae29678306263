#include "contact/work_account.h"

#include <algorithm>
#include <cmath>

namespace glisson {
namespace {

constexpr double kToolShare = 0.01;  // of the tool's work: errors of a moving contact may add so much energy

/// Of the impulses of a step [J].
struct Work {
  double relative = 0.0;  ///< with velocities against the solid: what contact itself adds to the body
  double tool = 0.0;      ///< by the motion of the solid, each row's in size
};

Work work_of(std::span<const ContactRow> rows, std::span<const Vec3d> before, const InteractionStep& step) {
  Work work;
  for (const ContactRow& row : rows) {
    if (row.pressing == 0.0 && row.rubbing == Vec3d{}) continue;
    Vec3d v;
    for (std::uint32_t i = 0; i < row.count; ++i) {
      v += (before[row.places[i]] + step.vertices[row.places[i]].velocity) * row.weights[i];
    }
    const Vec3d carried = row.carried + row.carried_before;
    work.relative += 0.5 * dot(row.impulse(), v - carried);
    work.tool += 0.5 * std::abs(dot(row.impulse(), carried));
  }
  return work;
}

}  // namespace

bool WorkAccount::is_overdrawn(std::span<const ContactRow> rows, std::span<const Vec3d> before,
                               const InteractionStep& step) const {
  const Work work = work_of(rows, before, step);
  return work.relative > taken_ + kToolShare * work.tool;
}

void WorkAccount::close(std::span<const ContactRow> rows, std::span<const Vec3d> before, const InteractionStep& step) {
  const Work work = work_of(rows, before, step);
  taken_ += kToolShare * work.tool - work.relative;
}

void begin_anew(std::span<ContactRow> rows, std::span<const Vec3d> before, const InteractionStep& step) {
  for (ContactRow& row : rows) {
    push(row, step, -row.impulse());
    row.pressing = 0.0, row.rubbing = {}, row.solved_at = 0;
    Vec3d v;
    for (std::uint32_t i = 0; i < row.count; ++i) v += before[row.places[i]] * row.weights[i];
    row.most = std::max(0.0, -dot(row.normal, v - row.carried_before));
  }
}

/// The factor is a, with which their work a (W − w) + a² w is none: w is that on the change of velocity they make themselves.
void shrink(std::span<ContactRow> rows, std::span<const Vec3d> before, const InteractionStep& step) {
  const double whole = work_of(rows, before, step).relative;
  std::vector<Vec3d> sums(step.vertices.size());
  for (const ContactRow& row : rows) {
    for (std::uint32_t i = 0; i < row.count; ++i) sums[row.places[i]] += row.impulse() * row.weights[i];
  }
  double own = 0.0;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const Vec3d &J = sums[k], &a = step.mobility[k];
    own += 0.5 * (a.x * J.x * J.x + a.y * J.y * J.y + a.z * J.z * J.z);
  }
  const double factor = own > 0.0 ? std::clamp((own - whole) / own, 0.0, 1.0) : 0.0;
  for (ContactRow& row : rows) {
    push(row, step, row.impulse() * (factor - 1.0));
    row.pressing *= factor, row.rubbing *= factor;
  }
}

}  // namespace glisson
