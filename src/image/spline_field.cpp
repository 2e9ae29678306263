// spline_field.cpp — coefficients by the recursive filter of pole √3 − 2 with mirrored ends, values by 4 × 4 × 4 of them.
#include "image/spline_field.h"

#include <algorithm>
#include <cmath>

namespace glisson::image {
namespace {

constexpr double kPole = -0.26794919243112270647;  ///< √3 − 2
constexpr std::size_t kHorizon = 16;               ///< kPole^16 is below a float's grain

/// Values to coefficients along a line whose ends are mirrored.
void filter(double* line, std::size_t count) {
  if (count < 2) return;  // a constant is its own coefficient
  const auto mirrored = [&](std::size_t k) {
    const std::size_t period = 2 * (count - 1), m = k % period;
    return line[m < count ? m : period - m];
  };
  double sum = 0.0, power = 1.0;
  for (std::size_t k = 0; k < kHorizon; ++k, power *= kPole) sum += power * mirrored(k);
  line[0] = sum;
  for (std::size_t k = 1; k < count; ++k) line[k] += kPole * line[k - 1];
  line[count - 1] = kPole / (kPole * kPole - 1.0) * (line[count - 1] + kPole * line[count - 2]);
  for (std::size_t k = count - 1; k-- > 0;) line[k] = kPole * (line[k + 1] - line[k]);
  for (std::size_t k = 0; k < count; ++k) line[k] *= 6.0;
}

/// The four weights at the fraction t between the second and the third.
std::array<float, 4> weights(double t) {
  const double u = 1.0 - t;
  return {static_cast<float>(u * u * u / 6.0), static_cast<float>(2.0 / 3.0 - t * t * (2.0 - t) / 2.0),
          static_cast<float>(2.0 / 3.0 - u * u * (2.0 - u) / 2.0), static_cast<float>(t * t * t / 6.0)};
}

}  // namespace

SplineField::SplineField(const ImageGrid& grid, std::vector<float> values)
    : grid_(grid), to_index_(inverse(grid.axes)), origin_(grid.origin) {
  const std::array<std::size_t, 3>& n = grid.size;
  const std::array<std::size_t, 3> step{1, n[0], n[0] * n[1]};
  std::vector<double> line(std::max({n[0], n[1], n[2]}));
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    for (std::size_t k = 0; k < n[c]; ++k) {
      for (std::size_t j = 0; j < n[b]; ++j) {
        float* from = values.data() + j * step[b] + k * step[c];
        for (std::size_t i = 0; i < n[a]; ++i) line[i] = from[i * step[a]];
        filter(line.data(), n[a]);
        for (std::size_t i = 0; i < n[a]; ++i) from[i * step[a]] = static_cast<float>(line[i]);
      }
    }
  }
  for (std::size_t a = 0; a < 3; ++a) size_[a] = n[a] + 3;  // mirrored by one below, by two above
  coefficients_.resize(size_[0] * size_[1] * size_[2]);
  const auto mirrored = [&](std::size_t padded, std::size_t count) {
    if (count == 1) return std::size_t{0};
    const std::size_t period = 2 * (count - 1), m = (padded + period - 1) % period;
    return m < count ? m : period - m;
  };
  std::size_t at = 0;
  for (std::size_t k = 0; k < size_[2]; ++k) {
    for (std::size_t j = 0; j < size_[1]; ++j) {
      const float* row = values.data() + mirrored(j, n[1]) * step[1] + mirrored(k, n[2]) * step[2];
      for (std::size_t i = 0; i < size_[0]; ++i) coefficients_[at++] = row[mirrored(i, n[0])];
    }
  }
}

double SplineField::at_index(const Vec3d& index) const {
  std::array<std::size_t, 3> cell{};
  std::array<std::array<float, 4>, 3> w{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double last = static_cast<double>(grid_.size[a] - 1);
    const double x = std::clamp(index[a], 0.0, last);
    cell[a] = static_cast<std::size_t>(x);
    w[a] = weights(x - static_cast<double>(cell[a]));
  }
  const float* corner = coefficients_.data() + cell[0] + size_[0] * (cell[1] + size_[1] * cell[2]);
  std::array<float, 4> sum{};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t j = 0; j < 4; ++j) {
      const float* row = corner + size_[0] * (j + size_[1] * k);
      const float weight = w[1][j] * w[2][k];
      for (std::size_t i = 0; i < 4; ++i) sum[i] += weight * row[i];
    }
  }
  return (sum[0] * w[0][0] + sum[1] * w[0][1]) + (sum[2] * w[0][2] + sum[3] * w[0][3]);
}

}  // namespace glisson::image
