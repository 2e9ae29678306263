#include "scene/converge/grid_convergence.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/text.h"

namespace glisson {
namespace {

constexpr double kIndependent = 1e-6;                  // of the value
constexpr double kLeastOrder = 0.5, kMostOrder = 2.5;  // √h at the edge of a stiff punch; h² of smooth fields
constexpr double kSeenFactor = 1.25, kAssumedFactor = 3.0;

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

void extrapolate(GridConvergence& g, const MeshResult& fine, const MeshResult& coarse, double factor) {
  const double step = (fine.value - coarse.value) / (std::pow(coarse.h / fine.h, g.order) - 1.0);
  g.extrapolated = fine.value + step;
  g.low = fine.value - factor * std::abs(step);
  g.high = fine.value + factor * std::abs(step);
}

/// All that can be said is how far the values lie apart.
void hold_to(GridConvergence& g, GridConvergence::Verdict verdict, const MeshResult& fine, double apart) {
  g.verdict = verdict;
  g.extrapolated = fine.value;
  g.low = fine.value - kAssumedFactor * apart;
  g.high = fine.value + kAssumedFactor * apart;
}

void require_falling(std::span<const MeshResult> results) {
  if (results.size() < 2) throw std::invalid_argument("grid_convergence: two meshes or more are needed");
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].h > 0.0 && (i == 0 || results[i].h < results[i - 1].h)) continue;
    throw std::invalid_argument("grid_convergence: size " + detail::show(results[i].h) + " of mesh " +
                                std::to_string(i + 1) + " is not below that of the mesh before it");
  }
}

}  // namespace

double GridConvergence::error_of(double value) const {
  return extrapolated != 0.0 ? (value - extrapolated) / std::abs(extrapolated) : 0.0;
}

GridConvergence grid_convergence(std::span<const MeshResult> results) {
  using Verdict = GridConvergence::Verdict;
  require_falling(results);
  const std::size_t n = results.size();
  const MeshResult &f1 = results[n - 1], &f2 = results[n - 2], &f3 = results[n > 2 ? n - 3 : 0];
  const double e21 = f1.value - f2.value, e32 = n > 2 ? f2.value - f3.value : 0.0;
  const double apart = std::max(std::abs(e21), std::abs(e32));
  GridConvergence g;
  if (apart <= kIndependent * std::max(std::abs(f1.value), std::abs(f2.value))) {
    hold_to(g, Verdict::independent, f1, apart);
    return g;
  }
  if (n == 2) {
    g.verdict = Verdict::two_meshes;
    extrapolate(g, f1, f2, kAssumedFactor);
    return g;
  }
  if (e21 * e32 <= 0.0 || std::abs(e21) >= std::abs(e32)) {
    hold_to(g, Verdict::not_monotone, f1, apart);
    return g;
  }
  g.seen_order = observed_order(e21, e32, f2.h / f1.h, f3.h / f2.h);
  if (g.seen_order < kLeastOrder || g.seen_order > kMostOrder) {
    hold_to(g, Verdict::unusual_order, f1, apart);
    return g;
  }
  g.order = g.seen_order;
  extrapolate(g, f1, f2, kSeenFactor);
  return g;
}

std::string verdict_text(const GridConvergence& found) {
  constexpr const char* kWhy =
      "the meshes are too coarse, or what is compared changes with them, such as the area of a set chosen by a ball, "
      "or a "
      "peak that vibrates. Choose sets along the edges of cells, add damping or another level.";
  switch (found.verdict) {
    case GridConvergence::Verdict::converging:
      return {};
    case GridConvergence::Verdict::independent:
      return "The value does not depend on the mesh.";
    case GridConvergence::Verdict::two_meshes:
      return "Two meshes do not show the order of convergence; order 1 is assumed. Three would show it: --levels 3.";
    case GridConvergence::Verdict::unusual_order:
      return "The observed order " + detail::number_text(found.seen_order, 3) +
             " is none that linear tetrahedra have on fine meshes (0.5 to 2.5), so that nothing is extrapolated: " +
             kWhy;
    case GridConvergence::Verdict::not_monotone:
      return std::string("The values do not approach a limit from one side, so that nothing is extrapolated: ") + kWhy;
  }
  return {};
}

}  // namespace glisson
