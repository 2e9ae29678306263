// needle_past.cpp — a needle's checkpoint.
#include "base/past.h"
#include "instruments/needle/needle_state.h"

namespace glisson {

std::vector<double> Needle::past() const {
  const State& s = *state_;
  std::vector<double> past;
  save_motion(past);
  PastWriter put(past);
  put(static_cast<double>(s.stage));
  put(s.named_around);
  put(s.look ? 1.0 : 0.0);
  put(s.tip.rest), put(s.tip_along), put(s.bend_tip);
  for (const bool flag : {s.tip_cuts, s.tip_out, s.withdraws, s.next_region.has_value()}) put(flag ? 1.0 : 0.0);
  put(s.region), put(s.next_region.value_or(0)), put(s.step_h);
  for (const double a :
       {s.pressing.work, s.pressing.depth, s.pressing.force, s.pressing.work_at_cutting, s.pressing.depth_at_cutting}) {
    put(a);
  }
  put(s.drop.armed ? 1.0 : 0.0);
  for (const double a : {s.drop.puncture_force, s.drop.force, s.drop.least, s.drop.time, s.drop.depth}) put(a);
  put(static_cast<double>(s.nodes.size()));
  for (std::size_t j = 0; j < s.nodes.size(); ++j) {
    put(s.nodes[j].rest), put(s.slips[j] != 0 ? 1.0 : 0.0), put(s.along[j]);
    put(j < s.bend.size() ? s.bend[j] : Vec3d{});
  }
  put(static_cast<double>(s.entry_triangles.size()));
  for (const std::size_t t : s.entry_triangles) put(static_cast<double>(t));
  return past;
}

bool Needle::restore(std::span<const double> past) {
  State& s = *state_;
  if (!restore_motion(past)) return false;
  PastReader get(past);
  s.stage = static_cast<NeedleStage>(get.index(3));
  s.named_around = get.vector();
  s.look = get.flag();
  const Vec3d tip = get.vector();
  s.tip_along = get.number(), s.bend_tip = get.vector();
  s.tip_cuts = get.flag(), s.tip_out = get.flag(), s.withdraws = get.flag();
  const bool has_next = get.flag();
  s.region = get.whole();
  const int next = get.whole();
  s.next_region = has_next ? std::optional<int>(next) : std::nullopt;
  s.step_h = get.number();
  for (double* a : {&s.pressing.work, &s.pressing.depth, &s.pressing.force, &s.pressing.work_at_cutting,
                    &s.pressing.depth_at_cutting}) {
    *a = get.number();
  }
  s.drop.armed = get.flag();
  for (double* a : {&s.drop.puncture_force, &s.drop.force, &s.drop.least, &s.drop.time, &s.drop.depth})
    *a = get.number();
  const std::size_t nodes = get.count();
  s.nodes.assign(nodes, {});
  s.mobility.forget();
  s.slips.assign(nodes, 0), s.along.assign(nodes, 0.0), s.bend.assign(nodes, Vec3d{});
  for (std::size_t j = 0; j < nodes && get.ok(); ++j) {
    const Vec3d rest = get.vector();
    if (!s.place(s.nodes[j], rest)) s.nodes[j].rest = rest;
    s.slips[j] = get.flag() ? 1 : 0, s.along[j] = get.number();
    s.bend[j] = get.vector();
  }
  s.entry_triangles.assign(get.count(), 0);
  for (std::size_t& t : s.entry_triangles) t = get.index(s.surface.size());
  if (s.stage != NeedleStage::outside && !s.place(s.tip, tip)) s.tip.rest = tip;
  return get.done();
}

}  // namespace glisson
