#include "fit/uncertainty/combination.h"

#include <cmath>
#include <utility>

#include "fit/data/units.h"

namespace glisson::fit {
namespace {

/// du/dz of u = value, or ln value on a logarithmic scale.
double stretch(const Parameter& x) { return x.scale == Scale::linear ? x.high - x.low : std::log(x.high / x.low); }

std::string factor(const std::string& name, double exponent) {
  if (std::abs(exponent - 1.0) < 0.02) return " · " + name;
  if (std::abs(exponent + 1.0) < 0.02) return " / " + name;
  return (exponent > 0.0 ? " · " : " / ") + name + "^" + number(std::abs(exponent), "", 3);
}

std::string term(const std::string& name, double coefficient) {
  const double size = std::abs(coefficient);
  return (coefficient > 0.0 ? " + " : " − ") + (std::abs(size - 1.0) < 0.005 ? name : number(size, "", 3) + " " + name);
}

/// One logarithmic scale, one linear: no formula of both, but how the one makes up for the other.
std::string trade(const Parameter& logarithmic, const Parameter& linear, double slope) {
  return "1 % more of " + logarithmic.name + " is compensated by " + number(0.01 * std::abs(slope), linear.unit, 2) +
         (slope > 0.0 ? " more of " : " less of ") + linear.name;
}

}  // namespace

std::string number(double value, const std::string& unit, int digits) {
  return unit.empty() ? brief(value, digits) : brief(value, digits) + " " + unit;
}

std::string fixed_combination(const Problem& problem, const Covariance& covariance, std::size_t p, std::size_t q,
                              const std::vector<double>& direction) {
  // the one that moves less leads, so that the other's exponent is below 1
  if (std::abs(direction[p] * stretch(problem.parameters()[p])) >
      std::abs(direction[q] * stretch(problem.parameters()[q])))
    std::swap(p, q);
  const Parameter &a = problem.parameters()[p], &b = problem.parameters()[q];
  const double du_a = direction[p] * stretch(a), du_b = direction[q] * stretch(b);
  if (a.scale != b.scale) return a.scale == Scale::logarithmic ? trade(a, b, du_b / du_a) : trade(b, a, du_a / du_b);
  const double beta = -du_a / du_b;  // u_a + β u_b does not move
  std::vector<double> weights(covariance.parameters(), 0.0);
  weights[p] = stretch(a);
  weights[q] = beta * stretch(b);
  const double half = covariance.quantile * std::sqrt(covariance.variance_of(weights));
  const std::vector<double> values = problem.to_values(covariance.scaled);
  if (a.scale == Scale::logarithmic)
    return a.name + factor(b.name, beta) + " = " + number(values[p] * std::pow(values[q], beta)) + " ± " +
           number(100.0 * half, "", 2) + " %";
  return a.name + term(b.name, beta) + " = " + number(values[p] + beta * values[q]) + " ± " + number(half, "", 2);
}

}  // namespace glisson::fit
