#include "glisson/indentation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/require_fields.h"
#include "base/text.h"
#include "fit/forward/indentation_model.h"
#include "lab/indenter.h"

namespace glisson::fit {
namespace {

void require_indenter(const Indenter& indenter) {
  const std::string where = "indentation: indenter";
  each_field<Indenter>([&](const auto& f) {
    if (Indenter::has(indenter.shape, f.name))
      detail::Requirement{where}.value(std::string(f.name), f, indenter.*f.member);
  });
  const Fault fault = indenter.check();
  if (!fault.what.empty()) detail::refuse(where, std::string(fault.field), fault.what);
}

void require_arguments(const Indenter& indenter, const Layer& layer, std::span<const double> times,
                       std::span<const double> driven, const char* what) {
  require_indenter(indenter);
  detail::require_fields("indentation: layer", layer);
  if (times.size() != driven.size() || times.empty() || !(times.front() > 0.0))
    throw std::invalid_argument(std::string("indentation: as many ") + what +
                                " as times are needed, and times above 0");
}

/// From rest at time 0 on.
Curve curve_of(const Indenter& indenter, std::span<const double> times, std::span<const double> driven) {
  Curve curve;
  curve.name = "indentation", curve.time = {0.0}, curve.displacement = {0.0};
  curve.time.insert(curve.time.end(), times.begin(), times.end());
  curve.displacement.insert(curve.displacement.end(), driven.begin(), driven.end());
  curve.force.assign(curve.size(), 0.0);
  curve.measurement.test = LabTest::indentation, curve.measurement.deforming = Deforming::indentation;
  curve.measurement.indenter = indenter;
  return curve;
}

std::vector<double> answers(const Curve& curve, const Tissue& tissue, const Layer& layer) {
  const IndentationModel model({curve}, layer, [&](std::span<const double>) { return tissue; }, {}, {.table = false});
  Prediction p = model.predict(0, {});
  if (p.force.empty()) throw std::runtime_error("indentation: " + p.failure);
  return {p.force.begin() + 1, p.force.end()};
}

/// The depth of a force on a thick layer of little strain, without branches [m].
double thick_layer_depth(const Tissue& tissue, const Indenter& indenter, double force) {
  if (!tissue.hyperelastic) return 1e-4;  // the model says what is wrong
  const double unit = lab::thick_layer_force(indenter, 1.0) * 4.0 * shear_modulus(*tissue.hyperelastic);
  return std::pow(force / unit, 1.0 / lab::depth_power(indenter.shape));
}

}  // namespace

std::vector<double> indentation(const Tissue& tissue, const Indenter& indenter, const Layer& layer,
                                std::span<const double> times, std::span<const double> depths) {
  require_arguments(indenter, layer, times, depths, "depths");
  return answers(curve_of(indenter, times, depths), tissue, layer);
}

std::vector<double> indentation_depths(const Tissue& tissue, const Indenter& indenter, const Layer& layer,
                                       std::span<const double> times, std::span<const double> forces) {
  constexpr int kMostRounds = 12;
  constexpr double kNear = 0.5, kMostShare = 0.9;  // of the depth the mesh is made for; of the layer
  require_arguments(indenter, layer, times, forces, "forces");
  Curve curve = curve_of(indenter, times, forces);
  curve.measurement.test = LabTest::creep, curve.measurement.measured = Measured::strain;
  const double most = *std::max_element(forces.begin(), forces.end());
  if (!(most > 0.0)) return std::vector<double>(times.size(), 0.0);
  double deepest = std::min(thick_layer_depth(tissue, indenter, most), 0.3 * layer.thickness);
  for (int round = 0; round < kMostRounds; ++round) {
    std::fill(curve.force.begin(), curve.force.end(), deepest);
    std::vector<double> depths = answers(curve, tissue, layer);
    const double found = *std::max_element(depths.begin(), depths.end());
    if (found <= deepest && found > kNear * deepest) return depths;
    const double next = std::min(1.02 * found, 0.5 * (deepest + kMostShare * layer.thickness));
    deepest = layer.thick() ? std::min(1.02 * found, 3.0 * deepest) : next;
  }
  throw std::runtime_error("indentation: no depth within 0.9 of the layer balances a force of " +
                           detail::number_text(most) + " N");
}

}  // namespace glisson::fit
