#include "compare/models/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "glisson/material_point.h"

namespace glisson::models {

Tissue at_once(const Tissue& tissue) {
  Tissue elastic = tissue;
  elastic.maxwell.clear();
  elastic.viscosity = 0.0;
  return elastic;
}

std::vector<TestPoint> constant_volume_test(const Tissue& tissue, double time) {
  constexpr int kPoints = 30;
  std::vector<TestPoint> points;
  for (const double end : {-kMostStrain, kMostStrain}) {
    MaterialPoint point(tissue);
    for (int i = 1; i <= kPoints; ++i) {
      const double stretch = 1.0 + end * i / kPoints;
      MaterialTargets targets;
      targets(0, 0).value = targets(1, 1).value = 1.0 / std::sqrt(stretch);
      targets(2, 2).value = stretch;
      const MaterialState& state = point.advance(time / kPoints, targets);
      points.push_back({stretch, end / time, state.nominal(2, 2) - std::pow(stretch, -1.5) * state.nominal(0, 0)});
    }
  }
  return points;
}

LinearFit fit_terms(const std::vector<TestPoint>& test, const Term& first, const Term& second) {
  double aa = 0.0, ab = 0.0, bb = 0.0, ap = 0.0, bp = 0.0, pp = 0.0;
  for (const TestPoint& point : test) {
    const double a = first(point), b = second(point);
    aa += a * a, ab += a * b, bb += b * b;
    ap += a * point.stress, bp += b * point.stress, pp += point.stress * point.stress;
  }
  const auto rest_of = [&](double x, double y) {
    return pp - 2.0 * (x * ap + y * bp) + x * x * aa + 2.0 * x * y * ab + y * y * bb;
  };
  LinearFit best{{}, pp};
  const auto take = [&](double x, double y) {
    if (!(x >= 0.0) || !(y >= 0.0) || !(rest_of(x, y) < best.rest)) return;
    best = {{x, y}, rest_of(x, y)};
  };
  if (aa > 0.0) take(ap / aa, 0.0);
  if (bb > 0.0) take(0.0, bp / bb);
  const double determinant = aa * bb - ab * ab;
  if (determinant > 1e-12 * aa * bb) take((ap * bb - bp * ab) / determinant, (bp * aa - ap * ab) / determinant);
  return best;
}

double least_over(double low, double high, const std::function<double(double)>& rest) {
  constexpr int kSteps = 24, kRounds = 6;
  double best = low;
  for (int round = 0; round < kRounds; ++round) {
    const double factor = std::pow(high / low, 1.0 / kSteps);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= kSteps; ++i) {
      const double x = low * std::pow(factor, i), left = rest(x);
      if (left < least) least = left, best = x;
    }
    low = std::max(low, best / factor);
    high = std::min(high, best * factor);
  }
  return best;
}

}  // namespace glisson::models
