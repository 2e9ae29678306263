#include "contact/contact_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glisson {
namespace {

constexpr double kStretch = 2.5;  // of a patch's radius: how far its vertices may be from its sentinel
constexpr double kFarAway = 5.0;  // of a patch's radius: so far from all solids, its vertices are let go
constexpr double kHurry = 4.0;    // times the sentinel's way in a step: how far they may go
constexpr std::uint32_t kAbsent = std::numeric_limits<std::uint32_t>::max();

}  // namespace

void ContactReach::attach(const BodyView& body) {
  surface_.build(body);
  seen_.sentinels.clear();
  for (const SurfacePatch& p : surface_.patches()) {
    seen_.sentinels.push_back({body.mesh.vertices[p.sentinel] + body.displacement[p.sentinel], {}, false});
  }
  seen_.sentinels_asked = false;
  gather();
}

/// φ is never less along the way than half of what its ends have beyond that way.
/// @param margin  how far the patch's vertices may be from its sentinel [m]
bool ContactReach::may_reach(const ContactSolid& solid, double margin, const Sentinel& s, double h) const {
  const Vec3d before = solid.before.to_own(s.position), after = solid.after.to_own(s.position);
  const double apart = 0.5 * (distance_to(*solid.shape, before).distance + distance_to(*solid.shape, after).distance -
                              norm(after - before));
  return !(apart > margin + kHurry * h * norm(s.velocity));
}

std::span<const std::uint32_t> ContactReach::ask(std::span<const ContactSolid> solids, double h) {
  asking_.clear();
  gone_ = false;
  for (std::size_t k = 0; k < seen_.sentinels.size(); ++k) {
    const SurfacePatch& patch = surface_.patches()[k];
    if (!seen_.sentinels_asked) asking_.push_back(patch.sentinel);
    const double margin = (seen_.sentinels[k].asked ? kFarAway : kStretch) * patch.radius;
    const auto near = [&](const ContactSolid& s) { return may_reach(s, margin, seen_.sentinels[k], h); };
    if (seen_.sentinels[k].asked == std::any_of(solids.begin(), solids.end(), near)) continue;
    seen_.sentinels[k].asked = !seen_.sentinels[k].asked;
    if (seen_.sentinels[k].asked) {
      asking_.insert(asking_.end(), patch.vertices.begin(), patch.vertices.end());
    } else {
      gone_ = true;
    }
  }
  const bool grown = asking_.size() > (seen_.sentinels_asked ? 0 : seen_.sentinels.size());
  seen_.sentinels_asked = true;
  if (grown || gone_) gather();
  return asking_;
}

std::span<const std::uint32_t> ContactReach::kept() {
  kept_ = mine_;
  for (const SurfacePatch& p : surface_.patches()) kept_.push_back(p.sentinel);
  return kept_;
}

std::optional<std::span<const std::uint32_t>> ContactReach::keeps() {
  if (!gone_) return {};
  return kept();
}

void ContactReach::look(const InteractionStep& step) {
  for (std::size_t k = 0; k < seen_.sentinels.size(); ++k) {
    const std::uint32_t place = step.place_of[surface_.patches()[k].sentinel];
    if (place == InteractionStep::kNowhere) continue;
    seen_.sentinels[k].position = step.position(place), seen_.sentinels[k].velocity = step.vertices[place].velocity;
  }
}

/// Lists what has been asked for.
void ContactReach::gather() {
  mine_.clear();
  for (std::size_t k = 0; k < seen_.sentinels.size(); ++k) {
    const std::vector<std::uint32_t>& v = surface_.patches()[k].vertices;
    if (seen_.sentinels[k].asked) mine_.insert(mine_.end(), v.begin(), v.end());
  }
  std::sort(mine_.begin(), mine_.end());
  mine_.erase(std::unique(mine_.begin(), mine_.end()), mine_.end());
  std::vector<std::uint32_t> place(surface_.body_vertices(), kAbsent);
  for (std::uint32_t i = 0; i < mine_.size(); ++i) place[mine_[i]] = i;
  my_triangles_.clear();
  for (const Triangle& t : surface_.triangles()) {
    const Triangle local{place[t[0]], place[t[1]], place[t[2]]};
    if (std::find(local.begin(), local.end(), kAbsent) == local.end()) my_triangles_.push_back(local);
  }
}

void ContactReach::set_seen(const Seen& seen) {
  seen_ = seen;
  gather();
}

void ContactReach::archive(Archive& ar) {
  ar(seen_.sentinels_asked);
  ar.same_size(seen_.sentinels);
  if (ar.reads()) gather();
}

}  // namespace glisson
