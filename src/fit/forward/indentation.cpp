#include "glisson/indentation.h"

#include <numbers>
#include <stdexcept>

#include "base/text.h"
#include "fit/forward/indentation_model.h"

namespace glisson::fit {
namespace {

void require_above_zero(const char* name, double value, const char* unit) {
  if (value > 0.0) return;
  throw std::invalid_argument(std::string("indentation: ") + name + " = " + detail::number_text(value) + unit +
                              " is outside the allowed range, > 0");
}

void require_shape(const Indenter& indenter) {
  if (indenter.shape != IndenterShape::cone) return require_above_zero("radius", indenter.radius, " m");
  if (indenter.half_angle > 0.0 && indenter.half_angle < 0.5 * std::numbers::pi) return;
  throw std::invalid_argument("indentation: half_angle = " + detail::number_text(indenter.half_angle) +
                              " rad is outside the allowed range, 0 to π/2");
}

}  // namespace

std::vector<double> indentation(const Tissue& tissue, const Indenter& indenter, const Layer& layer,
                                std::span<const double> times, std::span<const double> depths) {
  require_shape(indenter);
  require_above_zero("thickness", layer.thickness, " m");
  require_above_zero("radius of the layer", layer.radius, " m");
  if (times.size() != depths.size() || times.empty() || !(times.front() > 0.0))
    throw std::invalid_argument("indentation: as many depths as times are needed, and times above 0");
  Curve curve;
  curve.name = "indentation", curve.time = {0.0}, curve.displacement = {0.0};
  curve.time.insert(curve.time.end(), times.begin(), times.end());
  curve.displacement.insert(curve.displacement.end(), depths.begin(), depths.end());
  curve.force.assign(curve.size(), 0.0);
  curve.measurement.test = LabTest::indentation, curve.measurement.deforming = Deforming::indentation;
  curve.measurement.indenter = indenter;
  const IndentationModel model({std::move(curve)}, layer, [&](std::span<const double>) { return tissue; }, {},
                               {.table = false});
  Prediction p = model.predict(0, {});
  if (p.force.empty()) throw std::runtime_error("indentation: " + p.failure);
  return {p.force.begin() + 1, p.force.end()};
}

}  // namespace glisson::fit
