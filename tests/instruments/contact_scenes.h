// contact_scenes.h — tools on given paths, and bodies for them, that the tests of contact share.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "glisson/instruments/contact.h"
#include "glisson/simulation/simulation.h"
#include "support/bodies.h"

namespace glisson::test {

/// A tool whose pose is a function of time.
struct GivenPath final : ToolDriver {
  std::function<Pose(double)> pose;
  std::vector<Wrench> felt{};
  explicit GivenPath(std::function<Pose(double)> p) : pose(std::move(p)) {}
  Pose start() const override { return pose(0.0); }
  Pose advance(double time, double h, const Wrench& on_tool) override {
    felt.push_back(on_tool);
    return pose(time + h);
  }
};

/// A driver that yields to the force, in short steps only.
struct YieldsInShortSteps final : ToolDriver {
  Pose at;
  explicit YieldsInShortSteps(const Pose& start) : at(start) {}
  Pose start() const override { return at; }
  Pose advance(double, double, const Wrench&) override { return at; }
  bool yields() const override { return true; }
};

inline std::shared_ptr<GivenPath> standing(const Pose& pose) {
  return std::make_shared<GivenPath>([pose](double) { return pose; });
}

/// Rotation by an angle about a unit vector.
inline Mat3d rotation(const Vec3d& k, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), d = 1.0 - c;
  return {{{{c + d * k.x * k.x, d * k.x * k.y - s * k.z, d * k.x * k.z + s * k.y},
            {d * k.y * k.x + s * k.z, c + d * k.y * k.y, d * k.y * k.z - s * k.x},
            {d * k.z * k.x - s * k.y, d * k.z * k.y + s * k.x, c + d * k.z * k.z}}}};
}

/// Turned over: what is drawn above the tissue lies below it.
inline Mat3d upside_down() { return rotation({1.0, 0.0, 0.0}, std::acos(-1.0)); }

/// A step of the explicit scheme that is short enough to compare with: in its own, up to twelve times as long on coarse cells, the force of contact
/// is up to 0.4 % off [s].
inline constexpr double kShortStep = 1e-4;

/// An integrator in steps of h; the explicit one, to compare with, in double and in steps of its own, or in short ones.
inline SimulationOptions in_steps_of(Integrator integrator, double h) {
  SimulationOptions o;
  o.integrator = integrator;
  const bool any = capabilities(integrator).any_step_is_stable;
  if (any || h == kShortStep) o.step = h;
  if (!any) o.precision = Precision::double_precision;
  return o;
}

inline void advance_to(Simulation& s, double time) {
  while (s.time() < time) ASSERT_EQ(s.step().status, StepStatus::ok);
}

/// Mean of what is asked in the steps up to a time: in short steps tissue at rest trembles under triangles that bear in turn.
template <class Asked>
auto mean_up_to(double time, Simulation& s, const Asked& asked) {
  auto sum = asked();
  int count = 1;
  for (; s.time() < time; ++count) {
    advance_to(s, std::nextafter(s.time(), time));
    sum = sum + asked();
  }
  return sum * (1.0 / count);
}

inline Vec3d momentum(const Simulation& s) {
  Vec3d p;
  for (std::size_t i = 0; i < s.masses().size(); ++i) p += s.velocity()[i] * s.masses()[i];
  return p;
}

/// About the origin [N m s].
inline Vec3d angular_momentum(const Simulation& s) {
  Vec3d L;
  const std::vector<Vec3d> x = s.positions();
  for (std::size_t i = 0; i < x.size(); ++i) L += cross(x[i], s.velocity()[i] * s.masses()[i]);
  return L;
}

inline double mass(const Simulation& s) {
  double m = 0.0;
  for (const double mi : s.masses()) m += mi;
  return m;
}

}  // namespace glisson::test
