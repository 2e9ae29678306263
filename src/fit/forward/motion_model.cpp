#include "fit/forward/motion_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace glisson::fit {
namespace {

/// Instants of a curve and of what was before, and where the tool is at them.
struct Way {
  std::vector<double> time, displacement;
};

/// How long before its first instant a motion begins that is at `first` > 0 there [s].
double lead_time(const Way& way, double speed, double first) {
  for (std::size_t i = 1; i < way.time.size() && !(speed > 0.0); ++i)
    speed = (way.displacement[i] - way.displacement[0]) / (way.time[i] - way.time[0]);
  return speed > 0.0 ? first / speed : way.time.back() - way.time.front();
}

/// The same of a specimen that is gripped: at the speed with which it goes on, where that takes it there within the test's
/// duration; else at once, as a hold or a creep whose first row is loaded already.
double lead_of_grip(const Way& way, double first) {
  constexpr double kAtOnce = 1e-6;
  const double whole = way.time.back() - way.time.front();
  const double step = way.displacement[1] - way.displacement[0], width = way.time[1] - way.time[0];
  const double lead = first / step * width;
  return std::isfinite(lead) && lead > 0.0 && lead < whole ? lead : kAtOnce * whole;
}

MonotoneCubic<double> way_of(const Curve& curve, double contact, std::size_t& lead) {
  Way all{curve.past_time, curve.past_displacement};
  all.time.insert(all.time.end(), curve.time.begin(), curve.time.end());
  all.displacement.insert(all.displacement.end(), curve.displacement.begin(), curve.displacement.end());
  std::vector<double> times, way;
  const double first = all.displacement.front() - contact;
  // a press touches nothing before contact; a grip or a load goes either way
  const Measurement& m = curve.measurement;
  const bool grips = m.loaded() || (m.test != LabTest::compression && m.deforming != Deforming::indentation);
  if (first > 0.0 || (grips && first != 0.0)) {
    times.push_back(all.time.front() - (grips ? lead_of_grip(all, first) : lead_time(all, curve.velocity, first)));
    way.push_back(0.0);
  }
  lead = times.size() + curve.past_time.size();
  for (std::size_t i = 0; i < all.time.size(); ++i) {
    const double d = all.displacement[i] - contact;
    times.push_back(all.time[i]);
    way.push_back(grips ? d : std::max(0.0, d));
  }
  return {std::move(times), std::move(way)};
}

}  // namespace

History::History(const Curve& curve, double contact) : way_(way_of(curve, contact, lead_)) {}

void require_curves(std::span<const Curve> curves) {
  const auto refuse = [](const Curve& c, const std::string& what) {
    throw std::invalid_argument("curve \"" + c.name + "\": " + what);
  };
  for (const Curve& c : curves) {
    if (c.size() < 2) refuse(c, std::to_string(c.size()) + " points; allowed: 2 or more");
    if (c.displacement.size() != c.size() || c.force.size() != c.size() ||
        c.past_displacement.size() != c.past_time.size())
      refuse(c, "as many displacements and forces as instants are needed");
    for (std::size_t i = 0; i < c.past_time.size(); ++i) {
      const double next = i + 1 < c.past_time.size() ? c.past_time[i + 1] : c.time.front();
      if (!std::isfinite(c.past_time[i]) || !std::isfinite(c.past_displacement[i]) || !(c.past_time[i] < next))
        refuse(c, "point " + std::to_string(i) + " before its first is not finite, or not earlier than the next");
    }
    for (std::size_t i = 0; i < c.size(); ++i) {
      const bool finite = std::isfinite(c.time[i]) && std::isfinite(c.displacement[i]);
      if (!finite || (i > 0 && !(c.time[i] > c.time[i - 1])))
        refuse(c, "point " + std::to_string(i) + " is not finite, or not later than the one before");
    }
  }
}

}  // namespace glisson::fit
