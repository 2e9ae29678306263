#include "fit/forward/specimen_model.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "glisson/material_point.h"
#include "glisson/oscillation.h"
#include "glisson/torsion.h"
#include "material/uniaxial_path.h"

namespace glisson::fit {
namespace {

constexpr double kMostStretch = 0.01, kMostTime = 1.0 / 400.0;  ///< of a step, the latter of the whole history
constexpr double kLeastStretch = 0.02;

/// The history of one curve in stretches, of a shear in amounts.
struct Stretching {
  const History& way;
  double rest, per_displacement;

  double of(double displacement) const { return rest + per_displacement * displacement; }
  StretchRate at(double time) const { return {of(way.at(time)), per_displacement * way.rate(time)}; }
};

[[noreturn]] void fail_at(const Curve& curve, std::size_t i, double stretch, const std::string& what) {
  throw std::runtime_error("curve \"" + curve.name + "\", " + std::to_string(curve.time[i]) + " s, stretch " +
                           std::to_string(stretch) + ": " + what);
}

void require_stretch(const Curve& curve, std::size_t i, double stretch) {
  if (!(stretch > kLeastStretch)) fail_at(curve, i, stretch, "the specimen is pressed to nothing; check its height");
}

/// The stress along the axis in the curve's measure.
double axial_stress(const UniaxialState& state, const Curve& curve, std::size_t i, double stretch) {
  if (!state.converged || !std::isfinite(state.stress))
    fail_at(curve, i, stretch, "no width between 0.02 and 50 times that at rest leaves the sides free");
  if (curve.measurement.measured == Measured::cauchy)
    return state.stress / (state.lateral_stretch * state.lateral_stretch);
  if (curve.measurement.measured == Measured::second_piola) return state.stress / stretch;
  return state.stress;
}

/// The curve's own instant that one of the history is, for a message; the first where it was before.
std::size_t own_instant(std::size_t k, std::size_t lead) { return k < lead ? 0 : k - lead; }

/// How often the way between two instants is parted for a tissue with a past.
int parts_of(double change, double width, double whole) {
  return static_cast<int>(
      std::max(1.0, std::ceil(std::max(change / kMostStretch, width / (kMostTime * whole)) - 1e-9)));
}

/// Stress at each instant of the curve, for a tissue whose stress is that of the present stretch.
void elastic_stresses(UniaxialPath& path, const Stretching& way, const Curve& curve, std::vector<double>& out) {
  path.start(0.0);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double stretch = way.of(way.way.displacements()[i + way.way.lead()]);
    require_stretch(curve, i, stretch);
    out[i] = axial_stress(path.at(stretch), curve, i, stretch);
  }
}

/// The same for one with a past, by steps through the whole history.
void stresses_in_time(UniaxialPath& path, const Stretching& way, const Curve& curve, std::vector<double>& out) {
  const std::vector<double>& times = way.way.times();
  const std::size_t lead = way.way.lead();
  const double whole = way.way.end() - way.way.begin();
  UniaxialState state = path.start(way.at(times.front()).rate);
  if (lead == 0)
    out[0] = way.way.displacements().front() > 0.0 || way.at(times.front()).rate != 0.0 ? state.stress : 0.0;
  for (std::size_t k = 1; k < times.size(); ++k) {
    const double width = times[k] - times[k - 1];
    const double change =
        std::abs(way.way.displacements()[k] - way.way.displacements()[k - 1]) * std::abs(way.per_displacement);
    const int steps = parts_of(change, width, whole);
    const double h = width / steps;
    StretchRate end;
    for (int s = 0; s < steps; ++s) {
      const double t = times[k - 1] + s * h;
      end = way.at(s + 1 == steps ? times[k] : t + h);
      require_stretch(curve, own_instant(k, lead), end.stretch);
      state = path.advance(h, way.at(t + UniaxialPath::kMiddle * h), end);
      if (!state.converged) axial_stress(state, curve, own_instant(k, lead), end.stretch);
    }
    if (k >= lead) out[k - lead] = axial_stress(state, curve, k - lead, end.stretch);
  }
}

/// A path under given stresses along its axis: each step's stretch by secants from the slope of the one before.
class LoadedPath {
 public:
  explicit LoadedPath(const Tissue& tissue) : path_(tissue) { path_.start(0.0); }
  double stretch() const { return stretch_; }

  /// Goes on to a stress [Pa] in h [s]. @return false where secants do not get there
  bool advance(double h, double stress) {
    UniaxialPath there = path_;
    const auto miss = [&](double stretch) {
      there = path_;
      const UniaxialState s = there.advance(h, {stretch, 0.0}, {stretch, 0.0});
      return s.converged && stretch > kLeastStretch ? s.stress - stress : std::numeric_limits<double>::quiet_NaN();
    };
    double a = stretch_, b = stretch_ + growth_, slope = slope_;
    double at_b = miss(b);
    for (int i = 0; i < kMostSecants && std::isfinite(at_b); ++i) {
      if (slope > 0.0 && std::abs(at_b) <= kClose * slope) {
        growth_ = b - stretch_, stretch_ = b, slope_ = slope, path_ = there;
        return true;
      }
      const double at_a = at_b;
      a = b, b = a - (slope > 0.0 ? at_a / slope : std::copysign(kFirst, at_a));
      at_b = miss(b);
      if (std::abs(b - a) > kClose) slope = (at_b - at_a) / (b - a);
    }
    return false;
  }

 private:
  static constexpr int kMostSecants = 30;
  static constexpr double kClose = 1e-12, kFirst = 1e-4;  ///< stretches: where a search ends, and its first way
  UniaxialPath path_;
  double stretch_ = 1.0, growth_ = 0.0, slope_ = 0.0;  ///< the last step's way, and dP/dλ [Pa]; 0: not known yet
};

/// Strain at each instant of a creep along the axis, of a tissue with Maxwell branches. @return false where secants fail
bool strains_in_time(const Tissue& tissue, const Stretching& way, std::vector<double>& out) {
  LoadedPath path(tissue);
  const std::vector<double>& times = way.way.times();
  const std::size_t lead = way.way.lead();
  const double whole = way.way.end() - way.way.begin(), first = way.of(way.way.displacements().front());
  if (first != 0.0 && !path.advance(1e-9 * whole, first)) return false;
  if (lead == 0) out[0] = path.stretch() - 1.0;
  for (std::size_t k = 1; k < times.size(); ++k) {
    const double width = times[k] - times[k - 1];
    const int steps = parts_of(0.0, width, whole);
    for (int s = 1; s <= steps; ++s) {
      const double t = s == steps ? times[k] : times[k - 1] + s * width / steps;
      if (!path.advance(width / steps, way.of(s == steps ? way.way.displacements()[k] : way.way.at(t)))) return false;
    }
    if (k >= lead) out[k - lead] = path.stretch() - 1.0;
  }
  return true;
}

/// Rows are no seconds.
void require_times(const Measurement& m, const Tissue& tissue) {
  if (m.timed || m.test == LabTest::oscillation || !has_past(tissue)) return;
  throw std::runtime_error(
      "a tissue with viscosity or Maxwell branches needs the time of each row; give columns.time or speed_mm_s");
}

/// What is driven of a material point, and where its answer stands.
struct Component {
  MaterialTest test = MaterialTest::uniaxial;
  std::size_t i = 2, j = 2;
};

Component component_of(Deforming deforming) {
  if (deforming == Deforming::simple_shear) return {MaterialTest::simple_shear, 0, 2};
  if (deforming == Deforming::equibiaxial) return {MaterialTest::equibiaxial, 0, 0};
  if (deforming == Deforming::planar) return {MaterialTest::planar, 2, 2};
  return {MaterialTest::uniaxial, 2, 2};
}

/// The driven component of the stress in a measure, of a creep the strain.
double answer_of(const MaterialState& state, const Component& c, Measured measured) {
  const Mat3d& F = state.deformation;
  if (measured == Measured::strain) return F(c.i, c.j) - (c.i == c.j ? 1.0 : 0.0);
  if (measured == Measured::cauchy) return state.cauchy(c.i, c.j);
  if (measured == Measured::second_piola) return (inverse(F) * state.nominal)(c.i, c.j);
  return state.nominal(c.i, c.j);
}

/// A material point along the curve: driven by stretch or shear, of a creep by stress.
void by_point(const Tissue& tissue, const Stretching& way, const Curve& curve, std::vector<double>& out) {
  const Measured measured = curve.measurement.measured;
  const Component c = component_of(curve.measurement.deforming);
  const bool by_stress = measured == Measured::strain;
  const MaterialControl control = by_stress ? MaterialControl::nominal_stress : MaterialControl::deformation;
  const bool slow = has_past(tissue);
  const std::vector<double>& times = way.way.times();
  const std::size_t lead = way.way.lead();
  const double whole = way.way.end() - way.way.begin();
  const double first = way.of(way.way.displacements().front());
  double value = by_stress || c.i != c.j ? 0.0 : 1.0;
  MaterialPoint point(tissue);
  const auto go = [&](double h, double to, std::size_t k) {
    if (!by_stress && c.i == c.j) require_stretch(curve, k, to);
    if (const MaterialState& s = point.advance(h, test_targets(c.test, control, to)); !s.converged)
      fail_at(curve, k, to, s.message);
    value = to;
  };
  if (first != value) go(1e-9 * whole, first, 0);
  if (lead == 0) out[0] = answer_of(point.state(), c, measured);
  for (std::size_t k = 1; k < times.size(); ++k) {
    const double width = times[k] - times[k - 1], end = way.of(way.way.displacements()[k]);
    const int steps = slow ? parts_of(by_stress ? 0.0 : std::abs(end - value), width, whole) : 1;
    for (int s = 1; s <= steps; ++s)
      go(width / steps, s == steps ? end : way.of(way.way.at(times[k - 1] + s * width / steps)), own_instant(k, lead));
    if (k >= lead) out[k - lead] = answer_of(point.state(), c, measured);
  }
}

/// Storage or loss modulus at the curve's frequencies.
void moduli(const Tissue& tissue, const Curve& curve, std::vector<double>& out) {
  const std::vector<ComplexModulus> found = oscillation(tissue, curve.displacement, curve.measurement.stretch);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = curve.measurement.measured == Measured::loss ? found[i].loss : found[i].storage;
}

/// Torque or axial force at each instant of a cylinder of a radius and a height, twisted by the curve's angles.
void twisted(const Tissue& tissue, const History& history, const Specimen& size, const Curve& curve,
             std::vector<double>& out) {
  const std::size_t lead = history.lead();
  const double first = history.begin(), whole = history.end() - first;
  std::vector<double> times, twists;
  for (std::size_t k = 0; k < history.times().size(); ++k) {
    times.push_back(history.times()[k] - first);
    twists.push_back(history.displacements()[k] / size.height);
  }
  double widest = 0.0;
  for (std::size_t k = 1; k < times.size(); ++k) widest = std::max(widest, times[k] - times[k - 1]);
  const TorsionOptions options{.between =
                                   has_past(tissue) ? static_cast<std::size_t>(parts_of(0.0, widest, whole)) : 1};
  const std::vector<TorsionState> states = torsion(tissue, size.radius, times, twists, options);
  const bool axial = curve.measurement.measured == Measured::axial;
  for (std::size_t i = 0; i < curve.size(); ++i)
    out[i] = axial ? -states[i + lead].axial_force : states[i + lead].torque;
}

}  // namespace

bool has_past(const Tissue& tissue) { return tissue.viscosity > 0.0 || !tissue.maxwell.empty(); }

SpecimenModel::SpecimenModel(std::vector<Curve> curves, const Specimen& specimen, TissueAt tissue)
    : MotionModel(std::move(curves)), specimen_(specimen), tissue_(std::move(tissue)) {
  if (!(specimen.area > 0.0) || !(specimen.height > 0.0))
    throw std::invalid_argument("specimen: area = " + std::to_string(specimen.area) +
                                " m², height = " + std::to_string(specimen.height) + " m; allowed: both > 0");
  for (std::size_t i = 0; i < this->curves(); ++i) require_curves({&curve(i), 1});
}

Prediction SpecimenModel::predict_from(std::size_t index, std::span<const double> values, double contact) const {
  Prediction result;
  try {
    const Curve& measured = curve(index);
    const Measurement& m = measured.measurement;
    const bool loaded = m.loaded();
    const History history(measured, loaded ? 0.0 : contact);
    const Tissue tissue = tissue_(values);
    require_times(m, tissue);
    result.force.resize(measured.size());
    const bool along = m.deforming == Deforming::compression || m.deforming == Deforming::tension;
    if (m.test == LabTest::oscillation || m.deforming == Deforming::torsion) {
      if (m.test == LabTest::oscillation)
        moduli(tissue, measured, result.force);
      else
        twisted(tissue, history, specimen_, measured, result.force);
      return result;
    }
    const double outward = m.outward(), load = loaded ? specimen_.height : specimen_.area;
    if (along && !loaded && !tissue.fibres) {
      UniaxialPath path(tissue);
      const Stretching way{history, 1.0, outward / specimen_.height};
      if (path.has_past())
        stresses_in_time(path, way, measured, result.force);
      else
        elastic_stresses(path, way, measured, result.force);
    } else if (loaded) {
      const Stretching way{history, 0.0, outward / specimen_.area};
      const bool by_path = along && !tissue.fibres && !tissue.maxwell.empty() && tissue.viscosity == 0.0;
      if (!by_path || !strains_in_time(tissue, way, result.force)) by_point(tissue, way, measured, result.force);
    } else {
      const double rest = m.deforming == Deforming::simple_shear ? 0.0 : 1.0;
      by_point(tissue, {history, rest, outward / specimen_.height}, measured, result.force);
    }
    for (double& f : result.force) f = outward * load * f + (loaded ? contact : 0.0);
  } catch (const std::exception& error) {
    result.force.clear();
    result.failure = error.what();
  }
  return result;
}

}  // namespace glisson::fit
