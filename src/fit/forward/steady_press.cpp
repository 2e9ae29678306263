#include "fit/forward/steady_press.h"

#include <algorithm>
#include <cmath>

#include "fit/forward/motion_model.h"

namespace glisson::fit {
namespace {

constexpr double kStraight = 1e-9;  // of the length
constexpr double kLonger = 1.5;

/// Speed of a motion that is linear from rest on; 0: it is not.
double steady_speed(const History& way) {
  const double depth = way.displacements().back(), speed = depth / (way.end() - way.begin());
  if (!(speed > 0.0)) return 0.0;
  for (std::size_t i = 0; i < way.times().size(); ++i) {
    if (std::abs(way.displacements()[i] - speed * (way.times()[i] - way.begin())) > kStraight * depth) return 0.0;
  }
  return speed;
}

std::optional<SteadyPress> press_of(const Curve& c, const ContactRange& contact) {
  if (c.measurement.loaded() || !c.past_time.empty() || c.displacement.front() < contact.high) return {};
  const double low = steady_speed(History(c, contact.low)), high = steady_speed(History(c, contact.high));
  if (!(low > 0.0) || std::abs(low - high) > kStraight * low) return {};
  const double own = c.displacement.back() - std::clamp(0.0, contact.low, contact.high);
  const double depth = c.displacement.back() - contact.low;
  if (depth > kLonger * own) return {};
  return SteadyPress{low, depth, own / low, c.size()};
}

bool serve_together(const SteadyPress& a, const SteadyPress& b) {
  return std::abs(a.speed - b.speed) <= kStraight * a.speed &&
         std::max(a.duration, b.duration) <= kLonger * std::min(a.duration, b.duration);
}

}  // namespace

SteadyPresses steady_presses(std::span<const Curve> curves, std::span<const ContactRange> contacts) {
  SteadyPresses found;
  std::vector<SteadyPress> first;  // of the curve that made each press: what others are held against
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const auto own = press_of(curves[c], contacts.empty() ? ContactRange{} : contacts[c]);
    found.of.emplace_back();
    if (!own) continue;
    const auto same =
        std::find_if(first.begin(), first.end(), [&](const SteadyPress& p) { return serve_together(p, *own); });
    found.of.back() = static_cast<std::size_t>(same - first.begin());
    if (same == first.end()) {
      first.push_back(*own);
      found.presses.push_back(*own);
      continue;
    }
    SteadyPress& p = found.presses[*found.of.back()];
    p.depth = std::max(p.depth, own->depth);
    p.duration = std::max(p.duration, own->duration);
    p.points = std::max(p.points, own->points);
  }
  return found;
}

}  // namespace glisson::fit
