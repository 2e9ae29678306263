#include "glisson/scene/convergence.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/text.h"

namespace glisson {
namespace {

using Verdict = GridConvergence::Verdict;

constexpr double kIndependent = 1e-6;       // of the value
constexpr double kSmoothOrder = 2.0;        // of the energy of linear tets
constexpr double kLeastOrder = 0.5;         // less: no power describes the values yet
constexpr double kFasterThanPowers = 2.5;   // an observed order beyond which errors of two signs may cancel
constexpr double kFactor = 1.5;             // F of the head
constexpr double kAssumedFactor = 3.0;      // of two meshes [Roache1994]
constexpr double kAlternatingFactor = 1.5;  // of the last change
// Where errors a h² and −b h^P of two signs cancel in the last change, what is left is 0.2 to ⅓ of the change before (P = 1.4 to 1).
constexpr double kCancelling = 1.0 / 3.0;

/// p of three results whose differences have one sign, by fixed-point iteration where the sizes do not fall by one factor.
///   p = |ln(e₃₂/e₂₁) + q(p)| / ln r₂₁,  q = ln((r₂₁^p − 1)/(r₃₂^p − 1))                              [Celik2008]
double observed_order(double e21, double e32, double r21, double r32) {
  double p = std::log(e32 / e21) / std::log(r21);
  for (int i = 0; i < 100 && std::abs(r21 / r32 - 1.0) > 1e-12; ++i) {
    const double q = std::log((std::pow(r21, p) - 1.0) / (std::pow(r32, p) - 1.0));
    const double next = (std::log(e32 / e21) + q) / std::log(r21);
    if (!std::isfinite(next)) break;
    p = next;
  }
  return p;
}

/// The finest result, its change from the one before, and the factor of their sizes.
struct LastChange {
  double value, change, ratio;

  /// (f₁ − f₂)/(r^p − 1), the step to the limit by the order p.
  double step(double p) const { return change / (std::pow(ratio, p) - 1.0); }
};

void expect_between(GridConvergence& g, double value, double one_step, double other_step) {
  g.low = value + std::min(one_step, other_step);
  g.high = value + std::max(one_step, other_step);
}

/// The finest value stands for the limit, within this of it.
void hold_to(GridConvergence& g, Verdict verdict, const LastChange& last, double within) {
  g.verdict = verdict;
  g.order = 0.0;
  g.extrapolated = last.value;
  expect_between(g, last.value, -within, within);
}

/// @param before  the change before the last
void extrapolate(GridConvergence& g, const LastChange& last, double before) {
  g.order = std::min(g.seen_order, g.largest);
  const double far = last.step(g.order), near = last.step(std::max(std::min(g.seen_order, kSmoothOrder), g.largest));
  g.extrapolated = last.value + far;
  expect_between(g, last.value, kFactor * far,
                 g.seen_order > kFasterThanPowers ? -kCancelling * before : near / kFactor);
}

/// Of locked tets the changes grow at first and fall later. In the cases of docs/convergence.md what is left after the last change is
/// this share of it: 0.7 to 1.4 at p = 0.3, 1.7 to 2 at −0.4, 2.6 at −1.
void follow_slow_values(GridConvergence& g, const LastChange& last) {
  const double growth = std::pow(last.ratio, -g.seen_order), most = (1.0 + 1.5 * growth) * last.change;
  g.order = 0.0;
  if (g.seen_order < 0.0) {  // nothing shows yet that they will fall
    g.verdict = Verdict::not_monotone;
    g.extrapolated = last.value;
    expect_between(g, last.value, -last.change, most);
    return;
  }
  g.verdict = Verdict::slow;
  g.extrapolated = last.value + 1.5 * std::pow(growth, 0.6) * last.change;
  expect_between(g, last.value, 0.5 * last.change, most);
}

void require_valid(std::span<const MeshResult> results, double largest_order) {
  if (results.size() < 2) throw std::invalid_argument("grid_convergence: two meshes or more are needed");
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].h > 0.0 && (i == 0 || results[i].h < results[i - 1].h)) continue;
    throw std::invalid_argument("grid_convergence: size " + detail::show(results[i].h) + " of mesh " +
                                std::to_string(i + 1) + " is not below that of the mesh before it");
  }
  if (largest_order >= 1.0 && largest_order <= kSmoothOrder) return;
  throw std::invalid_argument("grid_convergence: the largest order " + detail::show(largest_order) +
                              " is not within 1 and 2");
}

}  // namespace

double GridConvergence::error_of(double value) const {
  return extrapolated != 0.0 ? (value - extrapolated) / std::abs(extrapolated) : 0.0;
}

GridConvergence grid_convergence(std::span<const MeshResult> results, double largest_order) {
  require_valid(results, largest_order);
  const std::size_t n = results.size();
  const MeshResult &f1 = results[n - 1], &f2 = results[n - 2], &f3 = results[n > 2 ? n - 3 : 0];
  const double e21 = f1.value - f2.value, e32 = n > 2 ? f2.value - f3.value : 0.0;
  const double apart = std::max(std::abs(e21), std::abs(e32));
  const LastChange last{f1.value, e21, f2.h / f1.h};
  GridConvergence g;
  g.largest = largest_order;
  if (apart <= kIndependent * std::max(std::abs(f1.value), std::abs(f2.value))) {
    hold_to(g, Verdict::independent, last, kAssumedFactor * apart);
  } else if (n == 2) {
    g.verdict = Verdict::two_meshes;
    g.extrapolated = last.value + last.step(g.order);
    expect_between(g, last.value, -kAssumedFactor * last.step(g.order), kAssumedFactor * last.step(g.order));
  } else if (e21 * e32 <= 0.0 && 2.0 * std::abs(e21) > std::abs(e32)) {
    hold_to(g, Verdict::not_monotone, last, kAssumedFactor * apart);
  } else if (e21 * e32 <= 0.0) {
    hold_to(g, Verdict::alternating, last, kAlternatingFactor * std::abs(e21) + kCancelling * std::abs(e32));
  } else {
    g.seen_order = observed_order(e21, e32, last.ratio, f3.h / f2.h);
    g.seen_order < kLeastOrder ? follow_slow_values(g, last) : extrapolate(g, last, e32);
  }
  return g;
}

std::string verdict_text(const GridConvergence& found) {
  constexpr const char* kLocking =
      "the meshes are too coarse, or their tets lock as the tissue is nearly incompressible (tissue.volume_change = "
      "\"average_nodal\" helps). Add a level.";
  switch (found.verdict) {
    case Verdict::converging:
      if (found.seen_order <= found.largest + 0.05) return {};
      return "The observed order is " + detail::number_text(found.seen_order, 3) + "; on fine meshes it is at most " +
             detail::number_text(found.largest, 3) +
             (found.largest < kSmoothOrder ? ", from the singular stress at edges of supports, tools or the body."
                                           : ", that of linear tetrahedra.");
    case Verdict::independent:
      return "The value does not depend on the mesh.";
    case Verdict::two_meshes:
      return "Two meshes do not show the order of convergence; order 1 is assumed. Three would show it: --levels 3.";
    case Verdict::alternating:
      return "The values go up and down around a limit, by less with each mesh; the finest one is taken for it.";
    case Verdict::slow:
      return std::string("The changes hardly fall from mesh to mesh, so that the extrapolation is rough: ") + kLocking;
    case Verdict::not_monotone:
      if (found.seen_order < 0.0) {
        return std::string("The value changes more with every refinement, so that nothing is extrapolated: ") +
               kLocking;
      }
      return "The values do not approach a limit from one side, so that nothing is extrapolated: the meshes are too "
             "coarse, or what is compared changes with them, such as the area of a set chosen by a ball, or a peak "
             "that "
             "vibrates. Choose sets along the edges of cells, add damping or another level.";
  }
  return {};
}

}  // namespace glisson
