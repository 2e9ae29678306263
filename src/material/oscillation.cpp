#include "glisson/oscillation.h"

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>

#include "base/require_fields.h"
#include "material/response.h"
#include "material/static_stretch.h"

namespace glisson {
namespace {

using Complex = std::complex<double>;

/// What P gains where F moves by 1 in one component, in parts that each frequency weighs for itself [Pa].
struct Tangent {
  Mat3d held{};      ///< of the elastic stress, while the q of all branches stay as they are
  Mat3d relaxing{};  ///< F dS: what a branch of share 1 takes of it, given the time
  Mat3d viscous{};   ///< where it moves by 1 a second [Pa·s]
};

/// The tissue about a state of rest.
class Linearised {
 public:
  Linearised(const Tissue& tissue, const Mat3d& deformation)
      : response_(tissue), H_(sum(deformation, scaled(identity<double>(), -1.0))) {
    if (tissue.fibres) shape_.fibre = unit(tissue.fibres->direction);
    const Sym3<double> S = response_.relaxing(H_, response_.elastic(H_, shape_));
    relaxed_ = S * response_.relaxing_share();
    const double x = response_.paces().follows() ? response_.measure(H_, shape_) : 0.0;
    for (std::size_t k = 0; k < tissue.maxwell.size(); ++k)
      times_.push_back(tissue.maxwell[k].time_law ? 1.0 / response_.paces().at(k, x) : tissue.maxwell[k].time);
  }

  Tangent along(std::size_t i, std::size_t j) const {
    Mat3<Dual> H = with_scalar<Dual>(H_);
    H(i, j).d = 1.0;
    Mat3d rate{};
    rate(i, j) = 1.0;
    const Mat3<Dual> P = response_.elastic(H, shape_);
    const Sym3<Dual> S = response_.relaxing(H, P);
    const Mat3<Dual> carried = response_.carry(H, with_scalar<Dual>(relaxed_));
    Tangent t;
    t.relaxing = response_.carry(H_, {S.xx.d, S.yy.d, S.zz.d, S.xy.d, S.yz.d, S.zx.d});
    t.viscous = response_.viscous(H_, rate);
    for (std::size_t k = 0; k < 9; ++k) t.held(k / 3, k % 3) = P(k / 3, k % 3).d - carried(k / 3, k % 3).d;
    return t;
  }

  /// A component of dP at an angular frequency [1/s].
  Complex at(const Tangent& t, std::size_t i, std::size_t j, double omega) const {
    Complex stress{t.held(i, j), omega * t.viscous(i, j)};
    for (std::size_t k = 0; k < times_.size(); ++k) {
      stress -= response_.tissue().maxwell[k].share * t.relaxing(i, j) / Complex{1.0, omega * times_[k]};
    }
    return stress;
  }

  /// Length over area of the specimen, of those at rest.
  double slenderness(const Mat3d& F) const { return response_.small() ? 1.0 : F(2, 2) / (F(0, 0) * F(1, 1)); }

 private:
  Response response_;
  ElementShape shape_;
  Mat3d H_;
  std::vector<double> times_;  ///< τ of each branch there: where all has relaxed, its slope moves nothing [s]
  Sym3<double> relaxed_{};     ///< Σ g q
};

/// dP_zz/dF_zz with sides that carry no stress.
Complex with_free_sides(const Linearised& about, const std::array<Tangent, 3>& along, double omega) {
  Eigen::Matrix3cd K;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      K(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = about.at(along[j], i, i, omega);
    }
  }
  const Eigen::Matrix2cd sides = K.topLeftCorner<2, 2>();
  const Eigen::Vector2cd moved = sides.fullPivLu().solve(Eigen::Vector2cd(-K.topRightCorner<2, 1>()));
  return K(2, 2) + K(2, 0) * moved[0] + K(2, 1) * moved[1];
}

void require_frequencies(std::span<const double> frequencies) {
  for (std::size_t k = 0; k < frequencies.size(); ++k) {
    if (frequencies[k] >= 0.0 && std::isfinite(frequencies[k])) continue;
    throw std::invalid_argument("oscillation: frequency " + std::to_string(k + 1) + " = " +
                                detail::number_text(frequencies[k]) + " Hz is outside the allowed range, ≥ 0");
  }
}

}  // namespace

double ComplexModulus::magnitude() const { return std::hypot(storage, loss); }
double ComplexModulus::loss_tangent() const { return loss / storage; }

std::vector<ComplexModulus> oscillation(const Tissue& tissue, std::span<const double> frequencies, double stretch,
                                        OscillationMode mode) {
  detail::Requirement{"oscillation"}.value("mode", {}, mode);
  require_frequencies(frequencies);
  MaterialPoint point(tissue);
  stretch_for_long(point, stretch, "oscillation");
  const Mat3d& F = point.state().deformation;
  const Linearised about(tissue, F);
  const double slenderness = about.slenderness(F);
  const Tangent shear = about.along(0, 2);
  const std::array<Tangent, 3> axes{about.along(0, 0), about.along(1, 1), about.along(2, 2)};
  std::vector<ComplexModulus> moduli;
  moduli.reserve(frequencies.size());
  for (const double f : frequencies) {
    const double omega = 2.0 * std::numbers::pi * f;
    const Complex m = slenderness * (mode == OscillationMode::simple_shear ? about.at(shear, 0, 2, omega)
                                                                           : with_free_sides(about, axes, omega));
    moduli.push_back({m.real(), m.imag()});
  }
  return moduli;
}

}  // namespace glisson
