// material_point.cpp — mixed control of a homogeneous deformation, step by step.
//
// Unknown are the F_ij whose P_ij is prescribed. At each stage of a step they solve, by Newton with exact tangents (Dual),
//
//   P_elastic(H)_ij + P_viscous(H, Ḣ)_ij − carry( Σ g_k q_k )_ij = P_ij,      q_k′ = (S − q_k)/τ_k(x)
//
// with Ḣ = (H − from)/weight at the stages t + γh and t + h of [Alexander1977], γ = 1 − 1/√2, and q_k by the weights of
// branch_weights.h and branch_pace.h, as in uniaxial_path.h. A step works on a copy of the history, which is taken over where it succeeds; nothing
// in it allocates.
#include "glisson/material_point.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "base/require_fields.h"
#include "base/text.h"
#include "material/branch_weights.h"
#include "material/course.h"
#include "material/response.h"

namespace glisson {
namespace {

constexpr double kMiddle = 0.29289321881345254;  // γ
constexpr double kWithin = 1e-12;                // of the stress, up to which a prescribed one is met
constexpr int kIterations = 60, kHalvings = 30;
constexpr int kMostParts = 256;  // into which a step is parted where Newton's method does not find the way

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

}  // namespace

struct MaterialPoint::Parts {
  /// What the point has come through.
  struct History {
    Mat3d deformation = identity<double>();       ///< F
    Mat3d nominal{};                              ///< P [Pa]
    Sym3<double> relaxing{};                      ///< S there [Pa]
    std::array<Sym3<double>, kMostBranches> q{};  ///< as many as the tissue has branches [Pa]
    std::array<double, kMostBranches> pace{};     ///< 1/τ there of branches whose times follow the deformation [1/s]
  };

  /// What a stage knows beside the deformation.
  struct Stage {
    MaterialTargets targets;
    Mat3d from{};         ///< H − weight Ḣ of the stage
    double weight = 0.0;  ///< γh [s]; 0: no viscosity
    double length = 0.0;  ///< time from the past's end to the stage [s]
    const History* past = nullptr;
    Sym3<double> kept{};  ///< Σ g (decay q + from S(t)) of branches whose weights do not depend on the deformation
    double share = 0.0;   ///< Σ g to, likewise
  };
  /// P of a deformation with the S that its branches relax.
  template <class T>
  struct Answer {
    Mat3<T> P;
    Sym3<T> S{};
  };

  explicit Parts(const Tissue& tissue) : response(tissue) {
    if (tissue.fibres) shape.fibre = unit(tissue.fibres->direction);
    set_paces(history);
  }

  Response response;
  ElementShape shape;
  History history;
  MaterialState state;

  const std::vector<MaxwellBranch>& branches() const { return response.tissue().maxwell; }
  bool viscous() const { return response.tissue().viscosity > 0.0; }

  /// The stress of a stage, all parts.
  template <class T>
  Answer<T> answer(const Stage& stage, const Mat3<T>& H) const {
    const Mat3<T> elastic = response.elastic(H, shape);
    Answer<T> a{.P = elastic};
    if (stage.weight > 0.0) {
      const Mat3<T> moved = sum(H, scaled(with_scalar<T>(stage.from), T(-1.0)));
      a.P = sum(a.P, response.viscous(H, scaled(moved, T(1.0 / stage.weight))));
    }
    if (branches().empty()) return a;
    a.S = response.relaxing(H, elastic);
    Sym3<T> held = with_scalar<T>(stage.kept) + a.S * T(stage.share);
    if (response.paces().follows()) held += following(stage, response.measure(H, shape), a.S);
    a.P = sum(a.P, response.carry(H, held * T(-1.0)));
    return a;
  }

  /// Σ g q at a stage of branches whose times follow the measure x.
  template <class T>
  Sym3<T> following(const Stage& stage, T x, const Sym3<T>& S) const {
    Sym3<T> sum{};
    const History& past = *stage.past;
    for (std::size_t k = 0; k < branches().size(); ++k) {
      if (!branches()[k].time_law) continue;
      const BranchWeights<T> w = response.paces().weights(k, stage.length, past.pace[k], x);
      sum += (with_scalar<T>(past.q[k]) * w.decay + with_scalar<T>(past.relaxing) * w.from + S * w.to) *
             T(branches()[k].share);
    }
    return sum;
  }

  void set_paces(History& now) const {
    if (!response.paces().follows()) return;
    const double x = response.measure(sum(now.deformation, scaled(identity<double>(), -1.0)), shape);
    for (std::size_t k = 0; k < branches().size(); ++k) now.pace[k] = response.paces().at(k, x);
  }

  /// What the branches keep of the past at the end of h, and what they take of the stress there.
  void weigh(double h, const History& past, Stage& stage) const {
    stage.length = h, stage.past = &past;
    for (std::size_t k = 0; k < branches().size(); ++k) {
      const MaxwellBranch& branch = branches()[k];
      if (branch.time_law) continue;
      const BranchWeights<> w = branch_weights(h, branch.time);
      stage.kept += (past.q[k] * w.decay + past.relaxing * w.from) * branch.share;
      stage.share += branch.share * w.to;
    }
  }

  std::optional<Answer<double>> solve(const Stage& stage, Mat3d& H) const;
  bool step(double h, const MaterialTargets& from, const MaterialTargets& to, History& now) const;
  void show(double time);
};

namespace {

using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 9, 9>;
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 9, 1>;

/// Components whose stress is prescribed.
class Unknowns {
 public:
  explicit Unknowns(const MaterialTargets& targets) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        if (targets(i, j).control == MaterialControl::nominal_stress) at_[count_++] = {i, j};
      }
    }
  }
  Eigen::Index size() const { return static_cast<Eigen::Index>(count_); }
  /// The k-th of them in a matrix.
  template <class Matrix>
  auto& of(Matrix& m, Eigen::Index k) const {
    const auto [i, j] = at_[static_cast<std::size_t>(k)];
    return m(i, j);
  }

 private:
  std::array<std::array<std::size_t, 2>, 9> at_{};
  std::size_t count_ = 0;
};

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

/// Newton's method for the free components, from H on; a step is halved until it brings the stress nearer. None: no way is found.
auto MaterialPoint::Parts::solve(const Stage& stage, Mat3d& H) const -> std::optional<Answer<double>> {
  hold(stage.targets, H);
  if (!response.small() && !(determinant_of(H) > 0.0)) return std::nullopt;
  const Unknowns free(stage.targets);
  const Eigen::Index n = free.size();
  Answer<double> there = answer(stage, H);
  if (n == 0) return there;
  const auto residual = [&] {
    Column r(n);
    for (Eigen::Index k = 0; k < n; ++k) r[k] = free.of(there.P, k) - free.of(stage.targets, k).value;
    return r;
  };
  Column r = residual();
  if (!r.allFinite()) return std::nullopt;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Square K(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      Mat3<Dual> moved = with_scalar<Dual>(H);
      free.of(moved, k).d = 1.0;
      const Mat3<Dual> P = answer(stage, moved).P;
      for (Eigen::Index l = 0; l < n; ++l) K(l, k) = free.of(P, l).d;
    }
    const Column step = K.fullPivLu().solve(-r);
    if (!step.allFinite()) return std::nullopt;
    // Rounding of P is that of its largest slope times F's last digit.
    const double met = kWithin * std::sqrt(squared_norm(there.P)) + 4e-16 * K.cwiseAbs().maxCoeff();
    const double before = r.norm();
    double share = 1.0;
    for (int halving = 0; halving < kHalvings; ++halving, share *= 0.5) {
      Mat3d next = H;
      for (Eigen::Index k = 0; k < n; ++k) free.of(next, k) += share * step[k];
      if (!response.small() && !(determinant_of(next) > 0.0)) continue;
      there = answer(stage, next);
      r = residual();
      if (!r.allFinite() || (r.norm() >= before && r.norm() > met)) continue;
      H = next;
      break;
    }
    if (r.allFinite() && r.norm() <= met) return there;
    if (!r.allFinite() || r.norm() >= before) return std::nullopt;
  }
  return std::nullopt;
}

/// One step of a history; false leaves it undefined.
bool MaterialPoint::Parts::step(double h, const MaterialTargets& from, const MaterialTargets& to, History& now) const {
  Mat3d H = sum(now.deformation, scaled(identity<double>(), -1.0));
  Stage last{.targets = to, .kept = {}};
  if (viscous()) {
    Stage first{.targets = between(from, to, kMiddle), .from = H, .weight = kMiddle * h, .kept = {}};
    weigh(kMiddle * h, now, first);
    Mat3d middle = H;
    if (!solve(first, middle)) return false;
    const Mat3d stage_rate = scaled(sum(middle, scaled(H, -1.0)), 1.0 / first.weight);
    last.from = sum(H, scaled(stage_rate, (1.0 - kMiddle) * h));
    last.weight = first.weight;
    H = sum(last.from, scaled(stage_rate, last.weight));
  }
  weigh(h, now, last);
  const std::optional<Answer<double>> found = solve(last, H);
  if (!found) return false;
  const double x = response.paces().follows() ? response.measure(H, shape) : 0.0;
  for (std::size_t k = 0; k < branches().size(); ++k) {
    const BranchWeights<> w =
        branches()[k].time_law ? response.paces().weights(k, h, now.pace[k], x) : branch_weights(h, branches()[k].time);
    now.q[k] = now.q[k] * w.decay + now.relaxing * w.from + found->S * w.to;
  }
  now.deformation = deformation_gradient(H), now.nominal = found->P, now.relaxing = found->S;
  set_paces(now);
  return true;
}

void MaterialPoint::Parts::show(double time) {
  const Mat3d &F = history.deformation, &P = history.nominal;
  state.time = time, state.deformation = F, state.nominal = P;
  state.cauchy = response.small() ? P : scaled(P * transposed(F), 1.0 / determinant(F));
  state.converged = true, state.message.clear();
}

MaterialPoint::MaterialPoint(const Tissue& tissue) {
  require_valid(tissue);
  const bool by_shear = tissue.measure == DeformationMeasure::equivalent_shear_strain ||
                        tissue.measure == DeformationMeasure::one_minus_q;
  if (((!tissue.hyperelastic && !tissue.has_constant_moduli()) || tissue.relaxation_follows()) && !by_shear) {
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
  const double time = parts_->state.time + h;
  for (int parts = 1; parts <= kMostParts; parts *= 4) {
    Parts::History now = parts_->history;
    bool made = true;
    for (int k = 0; k < parts && made; ++k) {
      made = parts_->step(h / parts, between(from, targets, double(k) / parts),
                          between(from, targets, double(k + 1) / parts), now);
    }
    if (!made) continue;
    parts_->history = now;
    parts_->show(time);
    return parts_->state;
  }
  parts_->state.converged = false;
  parts_->state.message = "no deformation carries the prescribed stress at " + detail::number_text(time) +
                          " s: it is beyond what the tissue can carry, or the step is too long; prescribe less, take "
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
  detail::Requirement{"material test"}.value("test", {}, test);
  if (control != MaterialControl::deformation && control != MaterialControl::nominal_stress) {
    detail::refuse_enumerator("material test", "control", static_cast<long long>(control),
                              {"deformation", "nominal_stress"});
  }
  const Course course{times, values, between};
  course.require_valid("material test");
  const double rest = control == MaterialControl::deformation && test != MaterialTest::simple_shear ? 1.0 : 0.0;
  MaterialPoint point(tissue);
  std::vector<MaterialState> states;
  course.follow(
      rest, [&](double h, double value) { return point.advance(h, test_targets(test, control, value)).converged; },
      [&](std::size_t k) {
        states.push_back(point.state());
        if (states.back().converged) states.back().time = times[k];
      });
  return states;
}

}  // namespace glisson
