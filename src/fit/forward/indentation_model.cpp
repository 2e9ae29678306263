#include "fit/forward/indentation_model.h"

#include <algorithm>
#include <array>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "material/branch_weights.h"
#include "material/viscosity.h"

namespace glisson::fit {
namespace {

constexpr double kTableError = 5e-3;                          ///< of a force, along the lines through the start
constexpr double kMostDepth = 0.01, kMostWait = 1.0 / 400.0;  ///< of a step: of the deepest, and of the whole history
constexpr double kBeyondMeasured = 1.1;  ///< of a creep: how far beyond what it has measured laws are solved
constexpr double kFewest = 4.0;          ///< steps between two rows of a creep

/// Depths at which a law is solved, of the deepest. Below the first a mesh for the deepest is too coarse.
std::vector<double> depths_of(const Indenter& indenter) {
  if (indenter.sharp()) return {0.02, 0.1, 0.2, 0.3, 0.4, 0.5, 0.625, 0.75, 0.875, 1.0};
  if (indenter.shape == IndenterShape::cone) return {0.15, 0.22, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
  return {0.06, 0.12, 0.2, 0.3, 0.4, 0.5, 0.625, 0.75, 0.875, 1.0};
}

/// E/(1 − ν²).
double plane_modulus(const HyperelasticLaw& law) {
  const double mu = shear_modulus(law), kappa = bulk_modulus(law);
  return 4.0 * mu * (3.0 * kappa + mu) / (3.0 * kappa + 4.0 * mu);
}

const HyperelasticLaw& law_of(const Tissue& tissue) {
  if (tissue.hyperelastic && !tissue.fibres) return *tissue.hyperelastic;
  throw std::invalid_argument("tissue \"" + tissue.name +
                              "\" is not hyperelastic and isotropic; indentation needs "
                              "tissue.hyperelastic, without fibres");
}

/// F₀ over the depth.
class ElasticForce {
 public:
  ElasticForce(const Indenter& indenter, double deepest, const HyperelasticLaw& law, const std::vector<double>& factors)
      : indenter_(indenter), deepest_(deepest), modulus_(plane_modulus(law)),
        factor_(places(indenter, deepest), values(indenter, factors)) {}

  double at(double depth) const {
    return depth > 0.0 ? modulus_ * lab::thick_layer_force(indenter_, depth) * std::exp(factor_.at(depth)) : 0.0;
  }
  double slope(double depth) const {
    return depth > 0.0 ? at(depth) * (lab::depth_power(indenter_.shape) / depth + factor_.slope(depth)) : 0.0;
  }
  /// The depth of a force; beyond the deepest by the power of the closed form, as at() is.
  double depth_at(double force) const {
    const double most = at(deepest_);
    if (!(force > 0.0)) return 0.0;
    if (force >= most) return deepest_ * std::pow(force / most, 1.0 / lab::depth_power(indenter_.shape));
    const auto miss = [&](double d) { return std::pair(at(d) - force, slope(d)); };
    const double guess = deepest_ * std::pow(force / most, 1.0 / lab::depth_power(indenter_.shape));
    constexpr int kDigits = std::numeric_limits<double>::digits - 4;
    return boost::math::tools::newton_raphson_iterate(miss, guess, 0.0, deepest_, kDigits);
  }

 private:
  static std::vector<double> places(const Indenter& indenter, double deepest) {
    std::vector<double> list{0.0};
    for (const double part : depths_of(indenter)) list.push_back(part * deepest);
    return list;
  }
  /// A sphere of little depth meets a thick layer of little strain: Hertz's.
  static std::vector<double> values(const Indenter& indenter, const std::vector<double>& factors) {
    std::vector<double> list{indenter.shape == IndenterShape::sphere ? 0.0 : factors.front()};
    list.insert(list.end(), factors.begin(), factors.end());
    return list;
  }

  Indenter indenter_;
  double deepest_, modulus_;
  MonotoneCubic<double> factor_;
};

double lag_of(const Tissue& tissue) { return viscous_coefficients(tissue).mu / shear_modulus(*tissue.hyperelastic); }

/// Depth at the curve's instants under the forces of a history. The same equation, solved for F₀ step by step: with F₀ and what
/// drives it, S = F + Σ g_i q_i, linear in a step, lag F₀′ = S − F₀ and the branches are exact in it.
std::vector<double> depths_in_time(const ElasticForce& elastic, const Tissue& tissue, const History& way) {
  const double lag = lag_of(tissue), whole = way.end() - way.begin();
  const std::vector<double>& times = way.times();
  std::array<double, kMostBranches> q{};
  double before = 0.0, drive = 0.0;  // F₀ and S
  const auto go = [&](double h, double force) {
    std::array<BranchWeights<>, kMostBranches> w{};
    double held = 0.0, more = 0.0;  // Σ g_i q_i at the end of the step is held + more F₀
    for (std::size_t b = 0; b < tissue.maxwell.size(); ++b) {
      w[b] = branch_weights(h, tissue.maxwell[b].time);
      held += tissue.maxwell[b].share * (w[b].decay * q[b] + w[b].from * before);
      more += tissue.maxwell[b].share * w[b].to;
    }
    const BranchWeights own = branch_weights(h, lag);
    const double now = (own.decay * before + own.from * drive + own.to * (force + held)) / (1.0 - own.to * more);
    for (std::size_t b = 0; b < tissue.maxwell.size(); ++b)
      q[b] = w[b].decay * q[b] + w[b].from * before + w[b].to * now;
    before = now, drive = force + held + more * now;
  };
  std::vector<double> out;
  if (way.lead() == 0) out.push_back(0.0);  // it begins without a load
  for (std::size_t k = 1; k < times.size(); ++k) {
    const double width = times[k] - times[k - 1];
    const int steps = static_cast<int>(std::max(kFewest, std::ceil(width / (kMostWait * whole) - 1e-9)));
    for (int s = 1; s <= steps; ++s)
      go(width / steps, way.at(s == steps ? times[k] : times[k - 1] + s * width / steps));
    if (k >= way.lead()) out.push_back(elastic.depth_at(before));
  }
  return out;
}

/// Force at the curve's instants of a tissue that relaxes or is viscous.
std::vector<double> forces_in_time(const ElasticForce& elastic, const Tissue& tissue, const History& way,
                                   double deepest) {
  const double lag = lag_of(tissue);
  std::array<double, kMostBranches> q{};
  const std::vector<double>& times = way.times();
  const double whole = way.end() - way.begin();
  double before = elastic.at(way.displacements().front());
  const auto force = [&](double t, double now) {
    double f = now + lag * elastic.slope(way.at(t)) * way.rate(t);
    for (std::size_t b = 0; b < tissue.maxwell.size(); ++b) f -= tissue.maxwell[b].share * q[b];
    return std::max(0.0, f);
  };
  std::vector<double> out;
  if (way.lead() == 0) out.push_back(force(times.front(), before));
  for (std::size_t k = 1; k < times.size(); ++k) {
    const double width = times[k] - times[k - 1], change = way.displacements()[k] - way.displacements()[k - 1];
    const double parts = std::max(std::abs(change) / (kMostDepth * deepest), width / (kMostWait * whole));
    const int steps = static_cast<int>(std::max(1.0, std::ceil(parts - 1e-9)));
    for (int s = 1; s <= steps; ++s) {
      const double now = elastic.at(way.at(s == steps ? times[k] : times[k - 1] + s * width / steps));
      for (std::size_t b = 0; b < tissue.maxwell.size(); ++b) {
        const BranchWeights w = branch_weights(width / steps, tissue.maxwell[b].time);
        q[b] = w.decay * q[b] + w.from * before + w.to * now;
      }
      before = now;
    }
    if (k >= way.lead()) out.push_back(force(times[k], before));
  }
  return out;
}

/// Depth at the curve's instants.
std::vector<double> depths_of_loads(const ElasticForce& elastic, const Tissue& tissue, const History& way) {
  if (has_past(tissue)) return depths_in_time(elastic, tissue, way);
  std::vector<double> out;
  for (std::size_t k = way.lead(); k < way.times().size(); ++k) out.push_back(elastic.depth_at(way.displacements()[k]));
  return out;
}

void require_past(const Tissue& tissue, const Measurement& m) {
  if (tissue.viscosity > 0.0 && tissue.viscous_tensor == ViscousTensor::pioletti)
    throw std::runtime_error("indentation does not follow viscous_tensor = \"pioletti\"; give \"shear\"");
  if (m.timed || !has_past(tissue)) return;
  throw std::runtime_error(
      "a tissue with viscosity or Maxwell branches needs the time of each row; give columns.time or speed_mm_s");
}

}  // namespace

IndentationModel::IndentationModel(std::vector<Curve> curves, const Layer& layer, TissueAt tissue,
                                   std::vector<Parameter> parameters, const IndentationOptions& options)
    : MotionModel(std::move(curves)), layer_(layer), tissue_(std::move(tissue)), options_(options) {
  for (std::size_t c = 0; c < this->curves(); ++c) {
    require_curves({&curve(c), 1});
    const std::optional<Indenter>& indenter = curve(c).measurement.indenter;
    if (!indenter) throw std::invalid_argument("curve \"" + curve(c).name + "\": no indenter; give `indenter`");
    const auto same =
        std::find_if(indenting_.begin(), indenting_.end(), [&](const auto& own) { return own->indenter == *indenter; });
    of_.push_back(static_cast<std::size_t>(same - indenting_.begin()));
    if (same == indenting_.end()) indenting_.push_back(std::make_unique<Indenting>(Indenting{*indenter, 0.0, {}}));
    double& deepest = indenting_[of_.back()]->deepest;
    if (curve(c).measurement.loaded()) {
      for (const double d : curve(c).force)
        deepest = std::max(deepest, std::min(kBeyondMeasured * d, 0.5 * (d + layer_.thickness)));
    } else {
      for (const double d : curve(c).displacement) deepest = std::max(deepest, d + options_.margin);
    }
  }
  const std::vector<std::size_t> active = of_law(parameters);
  for (const auto& own : indenting_) {
    if (!(own->deepest > 0.0))
      throw std::invalid_argument("the curves under " + lab::words_of(own->indenter) +
                                  " never press; check their depth");
    own->table = std::make_unique<LawTable>(
        parameters, active, [this, o = own.get()](std::span<const double> values) { return factors(*o, values); },
        options_.table ? kTableError : 0.0);
  }
}

/// The parameters on which the law depends.
std::vector<std::size_t> IndentationModel::of_law(const std::vector<Parameter>& parameters) const {
  std::vector<double> start;
  for (const Parameter& p : parameters) start.push_back(p.start);
  const HyperelasticLaw own = law_of(tissue_(start));
  std::vector<std::size_t> active;
  for (std::size_t p = 0; p < start.size(); ++p) {
    std::vector<double> other = start;
    for (const double end : {parameters[p].low, parameters[p].high}) {
      if (end != start[p]) other[p] = end;
    }
    if (law_of(tissue_(other)) != own) active.push_back(p);
  }
  return active;
}

/// ln φ at the depths of depths_of().
std::vector<double> IndentationModel::factors(const Indenting& own, std::span<const double> values) const {
  const Tissue tissue = tissue_(values);
  const HyperelasticLaw& law = law_of(tissue);
  lab::IndentedLayer layer(layer_, own.indenter, law, own.deepest, options_.fineness);
  std::vector<double> list;
  for (const double part : depths_of(own.indenter)) {
    const double depth = part * own.deepest;
    list.push_back(std::log(layer.press(depth) / (plane_modulus(law) * lab::thick_layer_force(own.indenter, depth))));
  }
  return list;
}

std::size_t IndentationModel::solved() const {
  std::size_t sum = 0;
  for (const auto& own : indenting_) sum += own->table->runs();
  return sum;
}

Prediction IndentationModel::predict_from(std::size_t index, std::span<const double> values, double contact) const {
  Prediction result;
  try {
    const Indenting& own = indenting(index);
    const Tissue tissue = tissue_(values);
    require_past(tissue, curve(index).measurement);
    const ElasticForce elastic(own.indenter, own.deepest, law_of(tissue), own.table->at(values));
    const bool loaded = curve(index).measurement.loaded();
    const History history(curve(index), loaded ? 0.0 : contact);
    if (loaded) {
      result.force = depths_of_loads(elastic, tissue, history);
      for (double& d : result.force) d += contact;
    } else if (has_past(tissue)) {
      result.force = forces_in_time(elastic, tissue, history, own.deepest);
    } else {
      for (std::size_t i = 0; i < curve(index).size(); ++i)
        result.force.push_back(elastic.at(history.displacements()[i + history.lead()]));
    }
  } catch (const std::exception& error) {
    result = {{}, error.what()};
  }
  return result;
}

}  // namespace glisson::fit
