#include "instruments/contact/contact_books.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glisson {
namespace {

constexpr double kToolShare = 0.01;  // of the tool's work: errors of a moving contact may add so much energy

}  // namespace

void ContactBooks::begin(const InteractionStep& step) {
  before_.clear();
  for (const ActiveVertex& w : step.vertices) before_.push_back(w.velocity);
  corrected_ = false;
}

ContactBooks::Work ContactBooks::work_of(std::span<const ContactRow> rows, const InteractionStep& step) const {
  Work work;
  for (const ContactRow& row : rows) {
    if (row.pressing == 0.0 && row.rubbing == Vec3d{}) continue;
    Vec3d v;
    for (std::uint32_t i = 0; i < row.count; ++i) {
      v += (before_[row.places[i]] + step.vertices[row.places[i]].velocity) * row.weights[i];
    }
    const Vec3d carried = row.carried + row.carried_before;
    work.relative += 0.5 * dot(row.impulse(), v - carried);
    work.tool += 0.5 * std::abs(dot(row.impulse(), carried));
  }
  return work;
}

bool ContactBooks::creates(std::span<const ContactRow> rows, const InteractionStep& step) const {
  const Work work = work_of(rows, step);
  return work.relative > taken_ + kToolShare * work.tool;
}

int ContactBooks::solve(std::span<ContactRow> rows, const InteractionStep& step) {
  for (ContactRow& row : rows) row.most.reset();
  int sweeps = glisson::solve(rows, step);
  if (!creates(rows, step)) return sweeps;
  corrected_ = true;
  sweeps += solve_anew(rows, step);
  if (creates(rows, step)) shrink(rows, step);
  return sweeps;
}

void ContactBooks::close(std::span<const ContactRow> rows, const InteractionStep& step) {
  const Work work = work_of(rows, step);
  taken_ += kToolShare * work.tool - work.relative;
}

/// Takes all impulses back, and lets no point leave faster than it came, or come out where it was inside.
int ContactBooks::solve_anew(std::span<ContactRow> rows, const InteractionStep& step) const {
  for (ContactRow& row : rows) {
    push(row, step, -row.impulse());
    row.pressing = 0.0, row.rubbing = {};
    Vec3d v;
    for (std::uint32_t i = 0; i < row.count; ++i) v += before_[row.places[i]] * row.weights[i];
    row.most = std::max(0.0, -dot(row.normal, v - row.carried_before));
  }
  return glisson::solve(rows, step);
}

/// Makes all impulses smaller by one factor a, with which their work a (W − w) + a² w is none: w is that on the change of
/// velocity they make themselves.
void ContactBooks::shrink(std::span<ContactRow> rows, const InteractionStep& step) const {
  const double whole = work_of(rows, step).relative;
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

void FoundInside::mark(ContactRow& row, std::uint32_t vertex, std::uint32_t solid, const Vec3d& start, bool begun) {
  if (!begun && distance_to(*row.solid->shape, start).distance < -row.solid->tolerance())
    inside_.insert({vertex, solid});
  row.comes_out = !inside_.empty() && inside_.count({vertex, solid}) != 0;
}

void FoundInside::settle(const ContactRow& row, std::uint32_t vertex, std::uint32_t solid) {
  if (row.comes_out && row.inside == 0.0) inside_.erase({vertex, solid});
}

}  // namespace glisson
