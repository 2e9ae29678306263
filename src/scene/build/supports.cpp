#include "scene/build/supports.h"

#include <algorithm>

#include "dynamics/simulation_parts.h"
#include "glisson/instruments/tool_motion.h"

namespace glisson::scene {
namespace {

double along(const Vec3d& v, std::size_t axis) { return v[axis]; }

/// Whether a recorded component stays where it begins.
bool rests(const RecordedMotion& motion, std::size_t axis) {
  return std::all_of(motion.positions.begin(), motion.positions.end(),
                     [&](const Vec3d& x) { return along(x, axis) == along(motion.positions.front(), axis); });
}

/// Whether two records move a component alike: at the same times by the same way. Between their points both are followed by the
/// same curve then.
bool moves_alike(const RecordSpec& a, const RecordSpec& b, std::size_t axis) {
  if (a.start != b.start || a.motion.times != b.motion.times) return false;
  for (std::size_t i = 0; i < a.motion.positions.size(); ++i) {
    const double of_a = along(a.motion.positions[i], axis) - along(a.motion.positions[0], axis);
    const double of_b = along(b.motion.positions[i], axis) - along(b.motion.positions[0], axis);
    if (of_a != of_b) return false;
  }
  return true;
}

/// A component's course: at rest, or that of the first set whose record moves it alike.
Course course_of(const Variant& variant, std::size_t fixed, std::size_t axis) {
  const std::optional<RecordSpec>& own = variant.fixed[fixed].record;
  if (!own || rests(own->motion, axis)) return kAtRest;
  std::size_t first = 0;
  while (!variant.fixed[first].record || !moves_alike(*variant.fixed[first].record, *own, axis)) ++first;
  return kAtRest + 1 + first;
}

}  // namespace

ConstraintId add_support(const Variant& variant, std::size_t fixed, std::span<const std::uint32_t> set,
                         Simulation& simulation) {
  const FixedSpec& spec = variant.fixed[fixed];
  Constraint constraint{{set.begin(), set.end()}, spec.axes, {}, 0.0, {}};
  if (spec.record) constraint.motion = support_path(spec).displacement;
  for (std::size_t axis = 0; axis < 3; ++axis) constraint.courses[axis] = course_of(variant, fixed, axis);
  return SimulationParts::add_constraint(simulation, std::move(constraint));
}

std::string support_text(const FixedSpec& fixed) {
  return "[[fixed]] \"" + fixed.set + "\", " +
         (fixed.record ? "moved by " + fixed.record->path.filename().string() : "at rest");
}

std::string contradiction_text(const Variant& variant, const Contradiction& found, const std::string& asked) {
  const std::size_t tool = found.holder - std::min(found.holder, variant.fixed.size());
  std::string holder;
  if (found.holder < variant.fixed.size())
    holder = support_text(variant.fixed[found.holder]);
  else if (tool < variant.tools.size())
    holder = "[[tool]] \"" + variant.tools[tool].name + "\"";
  const std::string what = "component " + std::string(1, "xyz"[found.axis]) + " of vertex " +
                           std::to_string(found.vertex) + " belongs to " + asked;
  if (holder.empty() || holder == asked) return what + " twice; name each vertex of its set once";
  return what + " and to " + holder +
         "; they contradict each other. Take the vertices that both have out of one of the sets, leave the component "
         "out of `axes`, or let both move alike";
}

}  // namespace glisson::scene
