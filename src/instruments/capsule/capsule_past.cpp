// capsule_past.cpp — a capsule in numbers, for checkpoints.
//
//   triangles, vertices, events | open share and whether gone, a triangle | position, a vertex | sums | events
#include <cmath>

#include "instruments/capsule/capsule_state.h"

namespace glisson {
namespace {

constexpr std::size_t kSums = 4, kEvent = 6;

}  // namespace

std::vector<double> Capsule::past() const {
  const State& s = *state_;
  std::vector<double> past{static_cast<double>(s.triangles.size()), static_cast<double>(s.vertices.size()),
                           static_cast<double>(s.events.size())};
  past.insert(past.end(), s.open.begin(), s.open.end());
  past.insert(past.end(), s.is_gone.begin(), s.is_gone.end());
  for (const Vec3d& x : s.now) past.insert(past.end(), {x.x, x.y, x.z});
  past.insert(past.end(), {s.frequency, s.frequency_before, s.released, s.time});
  for (const CapsuleEvent& e : s.events) {
    past.insert(past.end(), {e.time, static_cast<double>(e.what), e.place.x, e.place.y, e.place.z, e.area});
  }
  return past;
}

bool Capsule::restore(std::span<const double> past) {
  State& s = *state_;
  const std::size_t n = s.triangles.size(), m = s.vertices.size();
  if (past.size() < 3 || past[0] != static_cast<double>(n) || past[1] != static_cast<double>(m)) return false;
  if (!(past[2] >= 0.0 && past[2] <= static_cast<double>(past.size()))) return false;
  const auto events = static_cast<std::size_t>(past[2]);
  if (past.size() != 3 + 2 * n + 3 * m + kSums + kEvent * events) return false;
  const double* at = past.data() + 3;
  for (std::size_t t = 0; t < n; ++t) {
    const double open = at[t];
    if (!(open >= 0.0 && open <= 1.0) || at[n + t] != static_cast<double>(s.is_gone[t])) return false;
    s.open[t] = open;
    s.membrane.keep(t, kept_share(open));
    s.counts[t] = s.is_gone[t] == 0 && open < 1.0 && s.membrane.rest_area(t) > 0.0;
  }
  at += 2 * n;
  for (Vec3d& x : s.now) x = {at[0], at[1], at[2]}, at += 3;
  s.evaluate();
  s.frequency = at[0], s.frequency_before = at[1], s.released = at[2], s.time = at[3];
  at += kSums;
  s.events.clear();
  for (std::size_t e = 0; e < events; ++e, at += kEvent) {
    const auto what = at[1] == 0.0 ? CapsuleEvent::What::tear : CapsuleEvent::What::opening;
    s.events.push_back({at[0], what, {at[2], at[3], at[4]}, at[5]});
  }
  return true;
}

}  // namespace glisson
