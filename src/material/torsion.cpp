#include "glisson/torsion.h"

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "base/require_fields.h"
#include "base/symmetric_eigen.h"
#include "material/course.h"
#include "material/static_stretch.h"

namespace glisson {
namespace {

/// Gauss's rule for ∫₀¹, from the recurrence of Legendre's polynomials.
std::vector<RuleNode> legendre_rule(std::size_t points) {
  const auto n = static_cast<Eigen::Index>(points);
  Eigen::VectorXd beside(n - 1);
  for (Eigen::Index k = 1; k < n; ++k) {
    const auto i = static_cast<double>(k);
    beside[k - 1] = i / std::sqrt(4.0 * i * i - 1.0);
  }
  return gauss_rule(Eigen::VectorXd::Zero(n), beside);
}

void require_arguments(const Tissue& tissue, double radius, std::span<const double> twists,
                       const TorsionOptions& options) {
  const auto fail = [](const std::string& why) { throw std::invalid_argument("torsion: " + why); };
  if (!(radius > 0.0) || !std::isfinite(radius)) {
    fail("radius = " + detail::number_text(radius) + " m is outside the allowed range, > 0");
  }
  for (std::size_t k = 0; k < twists.size(); ++k) {
    if (!std::isfinite(twists[k])) fail("twist " + std::to_string(k + 1) + " is not finite");
  }
  detail::require_fields("torsion", options);
  if (!tissue.fibres) return;
  const Vec3d a = unit(tissue.fibres->direction);
  if (std::hypot(a.x, a.y) > 1e-9)
    fail("the fibres are not along z, the axis of the cylinder: it would not stay round");
}

/// The shell at a radius, in simple shear: x along the rim, y outward, z along the axis.
class Shell {
 public:
  Shell(const Tissue& tissue, double stretch) : point_(tissue) {
    stretch_for_long(point_, stretch, "torsion");
    for (std::size_t i = 0; i < 3; ++i) targets_(i, i).value = point_.state().deformation(i, i);
  }
  double side_stretch() const { return targets_(0, 0).value; }
  bool advance(double h, double shear) {
    targets_(0, 2).value = shear;
    return point_.advance(h, targets_).converged;
  }
  double tangential() const { return point_.state().cauchy(0, 2); }
  double normal() const {
    const Mat3d& s = point_.state().cauchy;
    return 2.0 * s(2, 2) - s(0, 0) - s(1, 1);
  }

 private:
  MaterialPoint point_;
  MaterialTargets targets_;
};

}  // namespace

std::vector<TorsionState> torsion(const Tissue& tissue, double radius, std::span<const double> times,
                                  std::span<const double> twists, const TorsionOptions& options) {
  const Course course{times, twists, options.between};
  course.require_valid("torsion");
  require_arguments(tissue, radius, twists, options);
  std::vector<TorsionState> states(times.size());
  for (std::size_t k = 0; k < times.size(); ++k) states[k].time = times[k], states[k].twist = twists[k];
  const bool small = tissue.has_small_strain();
  for (const RuleNode& node : legendre_rule(options.radii)) {
    Shell shell(tissue, options.stretch);
    const double present = (small ? 1.0 : shell.side_stretch()) * radius, r = node.at * present;
    const double ring = std::numbers::pi * r * node.weight * present;  // π r dr
    course.follow(
        0.0, [&](double h, double twist) { return shell.advance(h, twist * r); },
        [&](std::size_t k) {
          states[k].torque += 2.0 * ring * r * shell.tangential();
          states[k].axial_force += ring * shell.normal();
        });
  }
  return states;
}

}  // namespace glisson
