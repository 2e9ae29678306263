#include "fit/forward/motion_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace glisson::fit {
namespace {

/// How long before its first instant a motion begins that is at `first` > 0 there [s].
double lead_time(const Curve& curve, double first) {
  double speed = curve.velocity;
  for (std::size_t i = 1; i < curve.size() && !(speed > 0.0); ++i)
    speed = (curve.displacement[i] - curve.displacement[0]) / (curve.time[i] - curve.time[0]);
  return speed > 0.0 ? first / speed : curve.time.back() - curve.time.front();
}

/// The same of a specimen that is gripped: at the speed with which it goes on, where that takes it there within the test's
/// duration; else at once, as a hold or a creep whose first row is loaded already.
double lead_of_grip(const Curve& curve, double first) {
  constexpr double kAtOnce = 1e-6;
  const double whole = curve.time.back() - curve.time.front();
  const double way = curve.displacement[1] - curve.displacement[0], width = curve.time[1] - curve.time[0];
  const double lead = first / way * width;
  return std::isfinite(lead) && lead > 0.0 && lead < whole ? lead : kAtOnce * whole;
}

MonotoneCubic<double> way_of(const Curve& curve, double contact, std::size_t& lead) {
  std::vector<double> times, way;
  const double first = curve.displacement.front() - contact;
  // a press touches nothing before contact; a grip or a load goes either way
  const Measurement& m = curve.measurement;
  const bool grips = m.loaded() || (m.test != LabTest::compression && m.deforming != Deforming::indentation);
  lead = first > 0.0 || (grips && first != 0.0) ? 1 : 0;
  if (lead > 0)
    times.push_back(curve.time.front() - (grips ? lead_of_grip(curve, first) : lead_time(curve, first))),
        way.push_back(0.0);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double d = curve.displacement[i] - contact;
    times.push_back(curve.time[i]);
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
    if (c.displacement.size() != c.size() || c.force.size() != c.size())
      refuse(c, "as many displacements and forces as instants are needed");
    for (std::size_t i = 0; i < c.size(); ++i) {
      const bool finite = std::isfinite(c.time[i]) && std::isfinite(c.displacement[i]);
      if (!finite || (i > 0 && !(c.time[i] > c.time[i - 1])))
        refuse(c, "point " + std::to_string(i) + " is not finite, or not later than the one before");
    }
  }
}

}  // namespace glisson::fit
