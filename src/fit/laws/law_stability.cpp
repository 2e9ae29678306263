#include "fit/laws/law_stability.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "base/text.h"
#include "glisson/material_point.h"

namespace glisson::fit {
namespace {

constexpr int kParts = 200;           // from rest to an end of a path
constexpr double kUnknown = 0.2;      // strain of tests that are not homogeneous
constexpr double kLeastRange = 0.05;  // data of less strain tell of a law at rest alone
constexpr double kHalf = 0.5, kTwice = 2.0;

struct Path {
  const char* name;
  MaterialTest test;
  double rest;
};
constexpr Path kPaths[] = {{"uniaxial", MaterialTest::uniaxial, 1.0},
                           {"equibiaxial", MaterialTest::equibiaxial, 1.0},
                           {"simple_shear", MaterialTest::simple_shear, 0.0}};

/// dσ : dε between two states, with the logarithmic strain, of tissue of small strain the engineering one; of simple shear
/// dε_xz = ½ dγ alone.
double work_of_change(const Path& path, bool small, const MaterialState& a, const MaterialState& b) {
  if (path.test == MaterialTest::simple_shear) {
    return (b.cauchy(0, 2) - a.cauchy(0, 2)) * (b.deformation(0, 2) - a.deformation(0, 2));
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double from = a.deformation(i, i), to = b.deformation(i, i);
    sum += (b.cauchy(i, i) - a.cauchy(i, i)) * (small ? to - from : std::log(to / from));
  }
  return sum;
}

/// What was found on the way from rest to an end.
struct Way {
  double reached;                 ///< where the law has answers up to
  std::optional<double> lost_at;  ///< where it is not stable any more
};

Way go(const Tissue& tissue, const Path& path, double end) {
  MaterialPoint point(tissue);
  MaterialState before = point.state();
  Way way{path.rest, {}};
  double last_work = 0.0;
  for (int k = 1; k <= kParts; ++k) {
    const double value = path.rest + (end - path.rest) * k / kParts;
    const MaterialState& now = point.advance(1.0, test_targets(path.test, MaterialControl::deformation, value));
    if (!now.converged) return way;  // as where the bulk gives way
    const double work = work_of_change(path, tissue.has_small_strain(), before, now), step = value - way.reached;
    if (!(work > 0.0)) {  // between the middles of the last two parts, on a straight line
      const double share = last_work > 0.0 ? last_work / (last_work - work) : 0.0;
      way.lost_at = way.reached + (share - 0.5) * step;
      if (k == 1) way.lost_at = path.rest;
      return way;
    }
    before = now, last_work = work, way.reached = value;
  }
  return way;
}

std::string shown(double x) { return detail::number_text(std::round(1e3 * x) * 1e-3); }

}  // namespace

DataRange data_range(std::span<const CurveResult> curves, std::optional<double> height, double radius) {
  DataRange range;
  const auto stretch = [&](double x) {
    range.least_stretch = std::min(range.least_stretch, x), range.largest_stretch = std::max(range.largest_stretch, x);
  };
  for (const CurveResult& c : curves) {
    const Measurement& m = c.curve.measurement;
    const bool homogeneous = m.deforming != Deforming::indentation && m.test != LabTest::oscillation && height;
    if (!homogeneous || c.curve.size() == 0) continue;
    const std::vector<double>& driven =
        m.loaded() ? c.curve.force : c.curve.displacement;  // a creep's strain is measured
    const double most = *std::max_element(driven.begin(), driven.end()) / *height;
    if (m.deforming == Deforming::simple_shear) {
      range.largest_shear = std::max(range.largest_shear, most);
    } else if (m.deforming == Deforming::torsion) {
      range.largest_shear = std::max(range.largest_shear, most * radius);
    } else {
      stretch(std::max(0.05, 1.0 + m.outward() * most));
    }
  }
  if (range.least_stretch == 1.0 && range.largest_stretch == 1.0) {
    const double g = range.largest_shear;  // simple shear stretches by λ − 1/λ = γ at most
    if (g > 0.0) stretch(0.5 * g + std::sqrt(1.0 + 0.25 * g * g)), stretch(1.0 / range.largest_stretch);
  }
  stretch(1.0 - kLeastRange), stretch(1.0 + kLeastRange);
  if (!height) stretch(1.0 - kUnknown), stretch(1.0 + kUnknown);
  if (range.largest_shear == 0.0) {
    const double most = std::max(range.largest_stretch, 1.0 / range.least_stretch);
    range.largest_shear = most - 1.0 / most;
  }
  return range;
}

std::vector<StabilityResult> law_stability(const Tissue& tissue, const DataRange& range) {
  Tissue at_once = tissue;
  at_once.viscosity = 0.0, at_once.maxwell.clear();
  std::vector<StabilityResult> all;
  try {
    for (const Path& path : kPaths) {
      const bool shear = path.test == MaterialTest::simple_shear;
      const Way up = go(at_once, path, kTwice * (shear ? range.largest_shear : range.largest_stretch));
      const Way down = shear ? Way{0.0, {}} : go(at_once, path, kHalf * range.least_stretch);
      all.push_back({path.name, down.reached, up.reached, down.lost_at, up.lost_at});
    }
  } catch (const std::invalid_argument&) {  // its measure depends on the mesh
    return {};
  }
  return all;
}

std::string stability_sentence(std::span<const StabilityResult> paths, const DataRange& range) {
  std::string lost;
  bool within = false;
  for (const StabilityResult& p : paths) {
    const bool shear = p.path == "simple_shear";
    const std::string of = p.path == "equibiaxial" ? "equibiaxial stretch"
                           : shear                 ? "simple shear"
                                                   : "uniaxial stretch";
    const auto tell = [&](const std::optional<double>& at, const char* side) {
      if (!at) return;
      lost += (lost.empty() ? "" : ", ") + of + " " + side + " " + shown(*at);
      within = within || (shear ? *at < range.largest_shear : *at > range.least_stretch && *at < range.largest_stretch);
    };
    tell(p.lost_below, "below"), tell(p.lost_above, "above");
  }
  if (lost.empty()) return {};
  return "The law is not stable (dσ : dε > 0, looked at from half to twice the stretches of the data) in " + lost +
         (within ? ", within the range of the data: bodies of it do not keep their shape there; take another law, or "
                   "bounds "
                   "that keep its terms positive."
                 : ", beyond the data: bodies that are deformed so far do not keep their shape.");
}

}  // namespace glisson::fit
