// response_plan.cpp — what the stages need of a tissue and its laws, worked out once: in double, and rounded to float.
#include <cmath>

#include "element/element_shape.h"
#include "engine/kernels/response_kernels.h"
#include "material/stiffness_bound.h"

namespace glisson::engine {
namespace {

/// Divides the moduli of a law; its fields say which they are.
template <class Law>
void divide_moduli(Law& law, double unit) {
  const auto divide = [unit]<class T>(T& value) {
    if constexpr (std::is_same_v<T, double>) {
      value /= unit;
    } else {
      for (double& x : value) x /= unit;
    }
  };
  each_field<Law>([&](const auto& field) {
    if (field.unit == "Pa") divide(law.*field.member);
  });
}

std::vector<LanePace> lane_paces(const std::vector<MaxwellBranch>& branches) {
  std::vector<LanePace> all;
  for (const MaxwellBranch& b : branches) {
    LanePace pace{float(1.0 / b.time), b.time_law ? b.time_law->index() : kNoTimeLaw, {}};
    if (b.time_law) {
      std::visit(
          [&](const auto& law) {
            for (const double x : law.numbers()) pace.numbers.push_back(float(x));
          },
          *b.time_law);
    }
    all.push_back(std::move(pace));
  }
  return all;
}

}  // namespace

LaneLaw lane_law(StiffnessLaw law, double base, double unit) {
  LaneLaw lanes{law.index(), {}};
  std::visit(
      [&](auto& l) {
        divide_moduli(l, unit);
        const auto numbers = l.numbers(base / unit);
        for (const double x : numbers) lanes.numbers.push_back(static_cast<float>(x));
      },
      law);
  return lanes;
}

bool has_lanes(const Tissue& t) {
  if (t.is_tensor_mass()) return true;
  const bool known_measure =
      static_cast<std::size_t>(t.measure) <= static_cast<std::size_t>(DeformationMeasure::regular_mean_ratio);
  const bool raw_energy = t.law_form == LawForm::energy && t.measure == DeformationMeasure::regular_mean_ratio;
  return known_measure && !raw_energy;
}

bool in_one_pass(const Tissue& t) {
  const bool small = t.has_small_strain() && t.law_form == LawForm::secant;
  return small && !t.maxwell.empty() && !t.fibres && t.viscous_tensor != ViscousTensor::pioletti &&
         t.volume_change == VolumeChange::element && !t.relaxation_follows();
}

LaneResponse lane_response(const Tissue& tissue, const LaneTissue& moduli, std::size_t mu_law) {
  LaneResponse r;
  r.moduli = moduli;
  r.mu_law = mu_law;
  r.small = tissue.has_small_strain();
  r.constant = tissue.hyperelastic.has_value() || tissue.has_constant_moduli();
  r.energy = !r.constant && tissue.law_form == LawForm::energy;
  r.measure = tissue.measure;
  r.volume = tissue.hyperelastic ? VolumeKind::hyperelastic
                                 : (tissue.kinematics == Kinematics::corotational ? VolumeKind::corotational
                                    : tissue.kinematics == Kinematics::green      ? VolumeKind::green
                                                                                  : VolumeKind::small);
  r.viscous = tissue.viscosity > 0.0;
  r.pioletti = tissue.viscous_tensor == ViscousTensor::pioletti;
  r.deviator = tissue.maxwell_part == MaxwellPart::deviator;
  r.branches = tissue.maxwell.size();
  for (std::size_t k = 0; k < r.branches; ++k) r.share[k] = float(tissue.maxwell[k].share), r.relaxing += r.share[k];
  if (tissue.relaxation_follows()) r.pace = lane_paces(tissue.maxwell);
  if (tissue.fibres) r.fibre = float(tissue.fibres->stiffness);
  const LameParameters lame = tissue.lame();
  r.rest_bound = float(1.0 / std::max(3.0 * lame.lambda + 2.0 * lame.mu, 2.0 * lame.mu));
  if (!tissue.hyperelastic) return r;
  r.bulk = float(bulk_modulus(*tissue.hyperelastic));
  const HyperelasticBound rest = hyperelastic_bound(*tissue.hyperelastic, Mat3d{});
  r.rest_isochoric = float(1.0 / rest.isochoric), r.rest_volume = float(1.0 / rest.volume);
  r.law = tissue.hyperelastic;
  if (const Ogden* ogden = std::get_if<Ogden>(&*tissue.hyperelastic)) r.series = stretch_series(*ogden).rounded();
  return r;
}

RespondStage respond_stage(const ResponseKernels& kernels, const Tissue& tissue) {
  if (tissue.hyperelastic) return kernels.hyperelastic[tissue.hyperelastic->index()];
  return kernels.tensor_mass[tissue.has_constant_moduli() ? 0 : 1][static_cast<std::size_t>(tissue.kinematics)];
}

LaneWeights lane_weights(double step, double time) {
  const BranchWeights<> w = branch_weights(step, time);
  return {float(w.decay), float(w.from), float(w.to)};
}

Stiffening rescue(const Rescue& to, std::uint32_t element, const float* H, float* P, std::size_t stride,
                  const float* mean) {
  Mat3d gradient;
  for (std::size_t k = 0; k < 9; ++k) gradient(k / 3, k % 3) = static_cast<double>(H[k * stride]);
  ElementShape shape = element_shape(*to.body, to.response->tissue(), element);
  shape.fibre = {};  // the fibres' own stage adds them
  const double shared = mean != nullptr ? static_cast<double>(*mean) : 0.0;
  const Mat3d answer = to.response->elastic(gradient, shape, mean != nullptr ? &shared : nullptr);
  for (std::size_t k = 0; k < 9; ++k) P[k * stride] = static_cast<float>(answer(k / 3, k % 3));
  return to.response->elastic_stiffening(gradient, shape);
}

float rescue_stretch_sum(const float* H, std::size_t stride) {
  Mat3d gradient;
  for (std::size_t k = 0; k < 9; ++k) gradient(k / 3, k % 3) = static_cast<double>(H[k * stride]);
  const std::array<double, 3> b = principal_frame(gradient).b;
  return static_cast<float>(b[0] + b[1] + b[2]);
}

}  // namespace glisson::engine
