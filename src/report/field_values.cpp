// field_values.cpp — see field_values.h.
#include "report/field_values.h"

#include <algorithm>
#include <cmath>

#include "element/tet_fields.h"
#include "report/base64.h"
#include "report/fractions.h"

namespace glisson {
namespace {

template <class Scalar>
std::vector<double> of_each(std::span<const double> stress, Scalar scalar) {
  std::vector<double> values;
  values.reserve(stress.size() / 6);
  for (std::size_t i = 0; i + 6 <= stress.size(); i += 6) values.push_back(scalar(stress.subspan(i).first<6>()));
  return values;
}

}  // namespace

std::vector<double> pressure_of(std::span<const double> stress) {
  return of_each(stress, [](std::span<const double, 6> s) { return -(s[0] + s[1] + s[2]) / 3.0; });
}

std::vector<double> von_mises_of(std::span<const double> stress) {
  return of_each(stress, [](std::span<const double, 6> s) { return von_mises(s); });
}

std::vector<double> vertex_means(const TetMesh& mesh, std::span<const double> values,
                                 const std::function<bool(std::uint32_t)>& removed) {
  std::vector<double> sum(mesh.vertices.size(), 0.0), count(mesh.vertices.size(), 0.0);
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    if (removed(t)) continue;
    for (const std::uint32_t v : mesh.tets[t]) {
      sum[v] += values[t];
      count[v] += 1.0;
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] /= std::max(1.0, count[v]);
  return sum;
}

nlohmann::json field_json(std::span<const double> values) {
  double low = 0.0, high = 0.0;
  for (const double x : values) {
    if (!std::isfinite(x)) continue;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size());
  for (const double x : values) bytes.push_back(fraction8(x - low, high - low));
  return {{"low", low}, {"high", high}, {"values", base64_of(std::span<const std::uint8_t>(bytes))}};
}

}  // namespace glisson
