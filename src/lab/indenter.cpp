#include "lab/indenter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/text.h"

namespace glisson {

Fault fit::Indenter::check() const {
  if (shape != IndenterShape::flat || edge_radius <= radius) return {};
  return {detail::number_text(1e3 * edge_radius) + " mm is above " + detail::number_text(1e3 * radius) +
              " mm, the radius of its face; give a smaller one",
          "edge_radius"};
}

namespace lab {

double contact_radius(const Indenter& indenter, double depth) {
  switch (indenter.shape) {
    case IndenterShape::flat:
      return indenter.radius;
    case IndenterShape::cone:
      return 2.0 / std::numbers::pi * depth * std::tan(indenter.half_angle);
    case IndenterShape::sphere:
      break;
  }
  return std::min(indenter.radius, std::sqrt(indenter.radius * depth));
}

double thick_layer_force(const Indenter& indenter, double depth) {
  switch (indenter.shape) {
    case IndenterShape::flat:
      return 2.0 * indenter.radius * depth;
    case IndenterShape::cone:
      return 2.0 / std::numbers::pi * depth * depth * std::tan(indenter.half_angle);
    case IndenterShape::sphere:
      break;
  }
  return 4.0 / 3.0 * std::sqrt(indenter.radius * depth) * depth;
}

double depth_power(IndenterShape shape) {
  if (shape == IndenterShape::flat) return 1.0;
  return shape == IndenterShape::cone ? 2.0 : 1.5;
}

double thick_layer_modulus(const Indenter& indenter, double depth, double force) {
  return 0.75 * force / thick_layer_force(indenter, depth);
}

Entry entry_of(const Indenter& indenter, double tip, double r, double z) {
  if (indenter.shape == IndenterShape::cone) {
    const double c = std::cos(indenter.half_angle), s = std::sin(indenter.half_angle);
    return {.depth = (z - tip) * s - r * c, .by_r = -c, .by_z = s};
  }
  // a ball is a rounded edge without a face
  const double rounding = indenter.shape == IndenterShape::flat ? indenter.edge_radius : indenter.radius;
  const double out = r - (indenter.radius - rounding), up = z - tip - rounding;
  if (up >= 0.0) return {.depth = indenter.radius - r, .by_r = -1.0};  // on the shaft
  if (out <= 0.0 && indenter.shape == IndenterShape::flat) return {.depth = z - tip, .by_z = 1.0};
  const double distance = std::hypot(out, up), nr = out / distance, nz = up / distance;
  return {.depth = rounding - distance,
          .by_r = -nr,
          .by_z = -nz,
          .rr = -nz * nz / distance,
          .rz = nr * nz / distance,
          .zz = -nr * nr / distance};
}

std::string words_of(const Indenter& indenter) {
  if (indenter.shape == IndenterShape::cone)
    return "a cone of " + detail::number_text(indenter.half_angle / Indenter::kDegree) + "° half angle";
  return (indenter.shape == IndenterShape::flat ? "a flat punch of " : "a sphere of ") +
         detail::number_text(1e3 * indenter.radius) + " mm radius";
}

}  // namespace lab
}  // namespace glisson
