#include "fit/forward/uniaxial.h"

#include <cmath>
#include <stdexcept>

#include "material/uniaxial_path.h"

namespace glisson::fit {
namespace {

constexpr double kMostStretch = 0.01, kMostTime = 1.0 / 400.0;  ///< of a step, the latter of the whole history
constexpr double kLeastStretch = 0.02;

/// The history of one curve in stretches.
struct Stretching {
  const History& way;
  double height;

  StretchRate at(double time) const { return {1.0 - way.at(time) / height, -way.rate(time) / height}; }
};

[[noreturn]] void fail_at(const Curve& curve, std::size_t i, double stretch, const std::string& what) {
  throw std::runtime_error("curve \"" + curve.name + "\", " + std::to_string(curve.time[i]) + " s, stretch " +
                           std::to_string(stretch) + ": " + what);
}

double stress_of(const UniaxialState& state, const Curve& curve, std::size_t i, double stretch) {
  if (!state.converged || !std::isfinite(state.stress))
    fail_at(curve, i, stretch, "no width between 0.02 and 50 times that at rest leaves the sides free");
  return state.stress;
}

/// Nominal stress at each instant of the curve, for a tissue whose stress is that of the present stretch.
void elastic_stresses(UniaxialPath& path, const Stretching& way, const Curve& curve, std::vector<double>& out) {
  path.start(0.0);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double stretch = 1.0 - way.way.displacements()[i + way.way.lead()] / way.height;
    if (!(stretch > kLeastStretch)) fail_at(curve, i, stretch, "the specimen is pressed to nothing; check its height");
    out[i] = stress_of(path.at(stretch), curve, i, stretch);
  }
}

/// The same for one with a past, by steps through the whole history.
void stresses_in_time(UniaxialPath& path, const Stretching& way, const Curve& curve, std::vector<double>& out) {
  const std::vector<double>& times = way.way.times();
  const std::size_t lead = way.way.lead();
  const double longest = kMostTime * (way.way.end() - way.way.begin());
  UniaxialState state = path.start(way.at(times.front()).rate);
  if (lead == 0)
    out[0] = way.way.displacements().front() > 0.0 || way.at(times.front()).rate != 0.0 ? state.stress : 0.0;
  for (std::size_t k = 1; k < times.size(); ++k) {
    const double width = times[k] - times[k - 1];
    const double change = std::abs(way.way.displacements()[k] - way.way.displacements()[k - 1]) / way.height;
    const double parts = std::ceil(std::max(change / kMostStretch, width / longest) - 1e-9);
    const auto steps = static_cast<int>(std::max(1.0, parts));
    const double h = width / steps;
    for (int s = 0; s < steps; ++s) {
      const double t = times[k - 1] + s * h;
      const StretchRate end = way.at(s + 1 == steps ? times[k] : t + h);
      if (!(end.stretch > kLeastStretch))
        fail_at(curve, k - lead, end.stretch, "the specimen is pressed to nothing; check its height");
      state = path.advance(h, way.at(t + UniaxialPath::kMiddle * h), end);
      stress_of(state, curve, k - lead, end.stretch);
    }
    out[k - lead] = state.stress;
  }
}

}  // namespace

UniaxialModel::UniaxialModel(std::vector<Curve> curves, const Specimen& specimen, TissueAt tissue)
    : MotionModel(std::move(curves)), specimen_(specimen), tissue_(std::move(tissue)) {
  if (!(specimen.area > 0.0) || !(specimen.height > 0.0))
    throw std::invalid_argument("specimen: area = " + std::to_string(specimen.area) +
                                " m², height = " + std::to_string(specimen.height) + " m; allowed: both > 0");
  for (std::size_t i = 0; i < this->curves(); ++i) require_curves({&curve(i), 1});
}

Prediction UniaxialModel::predict_from(std::size_t index, std::span<const double> values, double contact) const {
  Prediction result;
  try {
    const Curve& measured = curve(index);
    const History history(measured, contact);
    UniaxialPath path(tissue_(values));
    result.force.resize(measured.size());
    if (path.has_past())
      stresses_in_time(path, {history, specimen_.height}, measured, result.force);
    else
      elastic_stresses(path, {history, specimen_.height}, measured, result.force);
    for (double& f : result.force) f *= -specimen_.area;
  } catch (const std::exception& error) {
    result.force.clear();
    result.failure = error.what();
  }
  return result;
}

}  // namespace glisson::fit
