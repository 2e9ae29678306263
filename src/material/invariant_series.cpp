#include "material/invariant_series.h"

#include <cmath>
#include <numbers>

namespace glisson {
namespace {

template <class Visit>
void visit_terms(Visit visit) {
  for (std::size_t j = 0; j < kSeriesPowers.size(); ++j) {
    for (std::size_t i = 0; i < kSeriesPowers[j]; ++i) visit(j, i);
  }
}
InvariantSeries<> constant(double value) {
  InvariantSeries<> s{};
  s[0][0] = value;
  return s;
}
InvariantSeries<> second_invariant() {
  InvariantSeries<> s{};
  s[0][1] = 1.0;
  return s;
}
InvariantSeries<> third_invariant() {
  InvariantSeries<> s{};
  s[1][0] = 1.0;
  return s;
}

}  // namespace

InvariantSeries<> sum_of(const InvariantSeries<>& a, const InvariantSeries<>& b, double factor) {
  InvariantSeries<> out = a;
  visit_terms([&](std::size_t j, std::size_t i) { out[j][i] += factor * b[j][i]; });
  return out;
}

InvariantSeries<> product_of(const InvariantSeries<>& a, const InvariantSeries<>& b) {
  InvariantSeries<> out{};
  visit_terms([&](std::size_t j, std::size_t i) {
    visit_terms([&](std::size_t l, std::size_t k) {
      if (j + l < kSeriesPowers.size() && i + k < kSeriesPowers[j + l]) out[j + l][i + k] += a[j][i] * b[l][k];
    });
  });
  return out;
}

InvariantSeries<float> rounded(const InvariantSeries<>& series) {
  InvariantSeries<float> out{};
  visit_terms([&](std::size_t j, std::size_t i) { out[j][i] = float(series[j][i]); });
  return out;
}

TensorPower tensor_power(double a) {
  const InvariantSeries<> J2 = second_invariant(), J3 = third_invariant();
  TensorPower out{.first = constant(a)};
  InvariantSeries<> two_back{}, one_back{}, at = constant(1.0);  // α_(n−2), α_(n−1), α_n of n = 2
  double binomial = a;
  for (std::size_t n = 2; n <= kSeriesOrder + 2; ++n) {
    binomial *= (a - double(n - 1)) / double(n);
    out.second = sum_of(out.second, at, binomial);
    out.whole = sum_of(out.whole, product_of(J3, one_back), binomial);
    const InvariantSeries<> next = sum_of(product_of(J2, one_back), product_of(J3, two_back));  // α_(n+1)
    out.first = sum_of(out.first, next, binomial);
    two_back = one_back, one_back = at, at = next;
  }
  return out;
}

/// det(I + X) = 1 − J₂ + J₃.
InvariantSeries<> determinant_power(double a) {
  const InvariantSeries<> y = sum_of(third_invariant(), second_invariant(), -1.0);
  InvariantSeries<> sum = constant(1.0), power = sum;
  double binomial = 1.0;
  for (std::size_t n = 1; 2 * n <= kSeriesOrder; ++n) {
    power = product_of(power, y), binomial *= (a - double(n - 1)) / double(n);
    sum = sum_of(sum, power, binomial);
  }
  return sum;
}

std::array<std::array<double, 3>, 25> shapes_of(double delta) {
  std::array<std::array<double, 3>, 25> shapes{};
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const double angle = std::numbers::pi / 3.0 * double(k) / double(shapes.size() - 1);
    const double turn = 2.0 * std::numbers::pi / 3.0;
    shapes[k] = {delta * std::cos(angle), delta * std::cos(angle + turn), delta * std::cos(angle - turn)};
  }
  return shapes;
}

}  // namespace glisson
