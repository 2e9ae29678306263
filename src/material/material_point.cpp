// material_point.cpp — mixed control of a homogeneous deformation, step by step.
//
// Unknown are the F_ij whose P_ij is prescribed. At each stage of a step they solve, by Newton with exact tangents (Dual),
//
//   P_elastic(H)_ij + P_viscous(H, Ḣ)_ij − carry( Σ g_k q_k )_ij = P_ij,      q_k′ = (S − q_k)/τ_k
//
// with Ḣ = (H − from)/weight at the stages t + γh and t + h of [Alexander1977], γ = 1 − 1/√2, and q_k by the weights of
// branch_weights.h, as in uniaxial_path.h.
#include "glisson/material_point.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/text.h"
#include "material/branch_weights.h"
#include "material/response.h"

namespace glisson {
namespace {

constexpr double kMiddle = 0.29289321881345254;  // γ
constexpr double kWithin = 1e-12;                // of the stress, up to which a prescribed one is met
constexpr int kIterations = 60, kHalvings = 30;
constexpr int kMostParts = 256;   // into which a step is parted where Newton's method does not find the way
constexpr double kAtOnce = 1e-9;  // of the second time, within which a first value at time 0 is applied

constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};

double determinant_of(const Mat3d& H) { return determinant(deformation_gradient(H)); }

std::string component(const char* what, std::size_t i, std::size_t j) {
  return std::string(what) + "_" + kAxes[i] + kAxes[j];
}

void require_targets(double h, const MaterialTargets& targets) {
  const auto fail = [](const std::string& why) { throw std::invalid_argument("material point: " + why); };
  if (!(h > 0.0) || !std::isfinite(h)) fail("h = " + detail::number_text(h) + " s is outside the allowed range, > 0");
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const MaterialTarget& t = targets(i, j);
      const bool stress = t.control == MaterialControl::nominal_stress;
      if (!std::isfinite(t.value)) fail(component(stress ? "P" : "F", i, j) + " is not finite");
      if (!stress && i == j && !(t.value > 0.0)) {
        fail(component("F", i, j) + " = " + detail::number_text(t.value) + " is outside the allowed range, > 0");
      }
      if (stress && i < j && targets(j, i).control == MaterialControl::nominal_stress) {
        fail(component("P", i, j) + " and " + component("P", j, i) +
             " are both prescribed, which leaves the rotation free; prescribe one, and F of the other");
      }
    }
  }
}

/// What a stage knows beside the deformation.
struct Stage {
  MaterialTargets targets;
  Mat3d from{};         ///< H − weight Ḣ of the stage
  double weight = 0.0;  ///< γh [s]; 0: no viscosity
  Sym3<double> kept{};  ///< Σ g (decay q + from S(t))
  double share = 0.0;   ///< Σ g to
};

}  // namespace

struct MaterialPoint::Parts {
  explicit Parts(const Tissue& tissue) : response(tissue), q(tissue.maxwell.size()) {
    if (tissue.fibres) shape.fibre = unit(tissue.fibres->direction);
  }

  Response response;
  ElementShape shape;
  MaterialState state;
  Sym3<double> relaxing{};  ///< S there [Pa]
  std::vector<Sym3<double>> q;

  bool viscous() const { return response.tissue().viscosity > 0.0; }
  Mat3d gradient() const { return sum(state.deformation, scaled(identity<double>(), -1.0)); }

  /// P of a stage, all parts.
  template <class T>
  Mat3<T> stress(const Stage& stage, const Mat3<T>& H) const {
    const Mat3<T> elastic = response.elastic(H, shape);
    Mat3<T> P = elastic;
    if (stage.weight > 0.0) {
      const Mat3<T> moved = sum(H, scaled(with_scalar<T>(stage.from), T(-1.0)));
      P = sum(P, response.viscous(H, scaled(moved, T(1.0 / stage.weight))));
    }
    if (q.empty()) return P;
    const Sym3<T> held = with_scalar<T>(stage.kept) + response.relaxing(H, elastic) * T(stage.share);
    return sum(P, response.carry(H, held * T(-1.0)));
  }

  /// What the branches keep of the past at the end of h, and what they take of the stress there.
  void weigh(double h, Stage& stage) const {
    for (std::size_t k = 0; k < q.size(); ++k) {
      const MaxwellBranch& branch = response.tissue().maxwell[k];
      const BranchWeights w = branch_weights(h, branch.time);
      stage.kept += (q[k] * w.decay + relaxing * w.from) * branch.share;
      stage.share += branch.share * w.to;
    }
  }

  bool solve(const Stage& stage, Mat3d& H) const;
  bool step(double h, const MaterialTargets& from, const MaterialTargets& to);
};

namespace {

/// Components whose stress is prescribed.
std::vector<std::array<std::size_t, 2>> unknowns(const MaterialTargets& targets) {
  std::vector<std::array<std::size_t, 2>> free;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (targets(i, j).control == MaterialControl::nominal_stress) free.push_back({i, j});
    }
  }
  return free;
}

/// The targets at a share of the way between two.
MaterialTargets between(const MaterialTargets& a, const MaterialTargets& b, double share) {
  MaterialTargets t = b;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) t(i, j).value = a(i, j).value + share * (b(i, j).value - a(i, j).value);
  }
  return t;
}

void hold(const MaterialTargets& targets, Mat3d& H) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const MaterialTarget& t = targets(i, j);
      if (t.control == MaterialControl::deformation) H(i, j) = t.value - (i == j ? 1.0 : 0.0);
    }
  }
}

}  // namespace

/// Newton's method for the free components, from H on; a step is halved until it brings the stress nearer.
bool MaterialPoint::Parts::solve(const Stage& stage, Mat3d& H) const {
  hold(stage.targets, H);
  if (!response.small() && !(determinant_of(H) > 0.0)) return false;
  const auto free = unknowns(stage.targets);
  const auto n = static_cast<Eigen::Index>(free.size());
  double size = 0.0;
  const auto residual = [&](const Mat3d& at) {
    const Mat3d P = stress(stage, at);
    Eigen::VectorXd r(n);
    size = std::sqrt(squared_norm(P));
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto [i, j] = free[static_cast<std::size_t>(k)];
      r[k] = P(i, j) - stage.targets(i, j).value;
    }
    return r;
  };
  Eigen::VectorXd r = residual(H);
  if (!r.allFinite()) return false;
  for (int iteration = 0; iteration < kIterations && n > 0; ++iteration) {
    Eigen::MatrixXd K(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      Mat3<Dual> moved = with_scalar<Dual>(H);
      moved(free[static_cast<std::size_t>(k)][0], free[static_cast<std::size_t>(k)][1]).d = 1.0;
      const Mat3<Dual> P = stress(stage, moved);
      for (Eigen::Index l = 0; l < n; ++l) {
        K(l, k) = P(free[static_cast<std::size_t>(l)][0], free[static_cast<std::size_t>(l)][1]).d;
      }
    }
    const Eigen::VectorXd step = K.fullPivLu().solve(-r);
    if (!step.allFinite()) return false;
    // Rounding of P is that of its largest slope times F's last digit.
    const double met = kWithin * size + 4e-16 * K.cwiseAbs().maxCoeff();
    const double before = r.norm();
    double share = 1.0;
    for (int halving = 0; halving < kHalvings; ++halving, share *= 0.5) {
      Mat3d next = H;
      for (Eigen::Index k = 0; k < n; ++k) {
        next(free[static_cast<std::size_t>(k)][0], free[static_cast<std::size_t>(k)][1]) += share * step[k];
      }
      if (!response.small() && !(determinant_of(next) > 0.0)) continue;
      r = residual(next);
      if (!r.allFinite() || (r.norm() >= before && r.norm() > met)) continue;
      H = next;
      break;
    }
    if (r.allFinite() && r.norm() <= met) return true;
    if (!r.allFinite() || r.norm() >= before) return false;
  }
  return n == 0;
}

bool MaterialPoint::Parts::step(double h, const MaterialTargets& from, const MaterialTargets& to) {
  Mat3d H = gradient();
  Stage last{.targets = to, .kept = {}};
  if (viscous()) {
    Stage first{.targets = between(from, to, kMiddle), .from = H, .weight = kMiddle * h, .kept = {}};
    weigh(kMiddle * h, first);
    Mat3d middle = H;
    if (!solve(first, middle)) return false;
    const Mat3d stage_rate = scaled(sum(middle, scaled(H, -1.0)), 1.0 / first.weight);
    last.from = sum(H, scaled(stage_rate, (1.0 - kMiddle) * h));
    last.weight = first.weight;
    H = sum(last.from, scaled(stage_rate, last.weight));
  }
  weigh(h, last);
  if (!solve(last, H)) return false;
  const Mat3d P = stress(last, H);
  const Sym3<double> S = q.empty() ? Sym3<double>{} : response.relaxing(H, response.elastic(H, shape));
  for (std::size_t k = 0; k < q.size(); ++k) {
    const BranchWeights w = branch_weights(h, response.tissue().maxwell[k].time);
    q[k] = q[k] * w.decay + relaxing * w.from + S * w.to;
  }
  relaxing = S;
  const Mat3d F = deformation_gradient(H);
  state.time += h, state.deformation = F, state.nominal = P;
  state.cauchy = response.small() ? P : scaled(P * transposed(F), 1.0 / determinant(F));
  return true;
}

MaterialPoint::MaterialPoint(const Tissue& tissue) {
  require_valid(tissue);
  const bool constant = std::holds_alternative<ConstantLaw>(tissue.law) && !tissue.lambda_law && !tissue.mu_law;
  const bool by_shear = tissue.measure == DeformationMeasure::equivalent_shear_strain ||
                        tissue.measure == DeformationMeasure::one_minus_q;
  if (!tissue.hyperelastic && !constant && !by_shear) {
    throw std::invalid_argument("material point: measure = \"" + std::string(word_of(tissue.measure)) +
                                "\" depends on the shape of a tet, and a point has none; take " +
                                "\"equivalent_shear_strain\" or \"one_minus_q\"");
  }
  parts_ = std::make_unique<Parts>(tissue);
}

MaterialPoint::~MaterialPoint() = default;
MaterialPoint::MaterialPoint(MaterialPoint&&) noexcept = default;
MaterialPoint& MaterialPoint::operator=(MaterialPoint&&) noexcept = default;

const MaterialState& MaterialPoint::state() const { return parts_->state; }

const MaterialState& MaterialPoint::advance(double h, const MaterialTargets& targets) {
  require_targets(h, targets);
  MaterialTargets from = targets;  // where the way of each component begins
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const bool stress = targets(i, j).control == MaterialControl::nominal_stress;
      from(i, j).value = stress ? parts_->state.nominal(i, j) : parts_->state.deformation(i, j);
    }
  }
  const Parts before = *parts_;
  for (int parts = 1; parts <= kMostParts; parts *= 4) {
    bool made = true;
    for (int k = 0; k < parts && made; ++k) {
      made = parts_->step(h / parts, between(from, targets, double(k) / parts),
                          between(from, targets, double(k + 1) / parts));
    }
    if (made) {
      parts_->state.converged = true, parts_->state.message.clear();
      return parts_->state;
    }
    *parts_ = before;
  }
  parts_->state.converged = false;
  parts_->state.message = "no deformation carries the prescribed stress at " +
                          detail::number_text(before.state.time + h) +
                          " s: it is beyond what the tissue bears, or the step is too long; prescribe less, take "
                          "shorter steps, or prescribe the stretch";
  return parts_->state;
}

MaterialTargets test_targets(MaterialTest test, MaterialControl control, double value) {
  MaterialTargets t;
  const MaterialTarget driven{control, value}, free{MaterialControl::nominal_stress, 0.0};
  switch (test) {
    case MaterialTest::uniaxial:
      t(0, 0) = t(1, 1) = free, t(2, 2) = driven;
      break;
    case MaterialTest::equibiaxial:
      t(0, 0) = t(1, 1) = driven, t(2, 2) = free;
      break;
    case MaterialTest::planar:
      t(0, 0) = free, t(2, 2) = driven;
      break;
    case MaterialTest::simple_shear:
      t(0, 2) = driven;
      break;
    case MaterialTest::volumetric:
      t(0, 0) = t(1, 1) = t(2, 2) = driven;
      break;
  }
  return t;
}

std::vector<MaterialState> material_test(const Tissue& tissue, MaterialTest test, MaterialControl control,
                                         std::span<const double> times, std::span<const double> values,
                                         std::size_t between) {
  const auto fail = [](const std::string& why) { throw std::invalid_argument("material test: " + why); };
  if (times.empty() || times.size() != values.size()) {
    fail(std::to_string(times.size()) + " times and " + std::to_string(values.size()) +
         " values; give as many of both, one or more");
  }
  if (between < 1) fail("between = 0 is outside the allowed range, ≥ 1");
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (std::isfinite(times[k]) && (k == 0 ? times[k] >= 0.0 : times[k] > times[k - 1])) continue;
    fail("time " + std::to_string(k + 1) + " = " + detail::number_text(times[k]) +
         (k == 0 ? " s is outside the allowed range, ≥ 0" : " s is not later than the one before it"));
  }
  const bool shear = test == MaterialTest::simple_shear;
  double value = control == MaterialControl::deformation && !shear ? 1.0 : 0.0, time = 0.0;
  MaterialPoint point(tissue);
  std::vector<MaterialState> states;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const bool at_once = times[k] == 0.0;
    const double way = at_once ? kAtOnce * (times.size() > 1 ? times[1] : 1.0) : times[k] - time;
    if (at_once && values[k] == value) {
      states.push_back(point.state());
      continue;
    }
    for (std::size_t i = 1; i <= between; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(between);
      const MaterialTargets targets = test_targets(test, control, value + share * (values[k] - value));
      if (!point.advance(way / static_cast<double>(between), targets).converged) break;
    }
    states.push_back(point.state());
    if (!point.state().converged) break;
    states.back().time = times[k];
    value = values[k], time = at_once ? way : times[k];
  }
  return states;
}

}  // namespace glisson
