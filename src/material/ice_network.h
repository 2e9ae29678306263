// ice_network.h — what ice adds to the stress of tissue that froze in the shape it had.
//
// Ice that forms in an instant is a network of its own in parallel with the tissue, without stress in the shape of that instant, as in
// mixtures whose parts come and go [HumphreyRajagopal2002]. With F_f the deformation gradient when the first ice formed, J_f = det F_f,
//   E = ½ (F_rᵀ F_r − I),  F_r = F F_f⁻¹              strain since then
//   W = J_f ∫ ½ (E − E_s) : C : (E − E_s) dg(s)       per volume at rest; C isotropic in the shape of F_f, g the amount of ice
// Ice that melts goes from all networks alike. Since W is square in E, all networks together are one, with the mean E̅ of E_s:
//   W = ½ J_f g (E − E̅) : C : (E − E̅) + locked,       S = g C : (E − E̅),   P = J_f F_r S F_f⁻ᵀ
// More ice changes neither S nor W; less ice takes its share of both.
#pragma once

#include <array>

#include "glisson/material/tissue.h"
#include "material/strain.h"

namespace glisson {

struct IceNetwork {
  Mat3d inverse = identity<double>();  ///< F_f⁻¹
  double volume_ratio = 1.0;           ///< J_f
  Sym3<double> relaxed;                ///< E̅: the strain at which all ice together has no stress
  double amount = 0.0;                 ///< g: stiffness over that of the tissue at rest
  double locked = 0.0;                 ///< of networks that pull against one another, per volume at rest [J/m³]

  void archive(auto& ar) { ar(inverse, volume_ratio, relaxed, amount, locked); }
};

/// F_r = F F_f⁻¹ at a displacement gradient H.
inline Mat3d since_frozen(const IceNetwork& ice, const Mat3d& H) { return deformation_gradient(H) * ice.inverse; }

/// E.
inline Sym3<double> ice_strain(const IceNetwork& ice, const Mat3d& H) {
  Mat3d change = since_frozen(ice, H);
  for (std::size_t i = 0; i < 3; ++i) change(i, i) -= 1.0;
  return green_strain(change);
}

/// W [J/m³]. @param lame  C of one unit of ice
inline double ice_energy(const IceNetwork& ice, const Sym3<double>& E, const LameParameters& lame) {
  const Sym3<double> D = E - ice.relaxed, S = isotropic_stress(D, lame.lambda, lame.mu);
  return 0.5 * ice.volume_ratio * ice.amount * contract(S, D) + ice.locked;
}

/// S [Pa].
inline Sym3<double> ice_stress(const IceNetwork& ice, const Sym3<double>& E, const LameParameters& lame) {
  return isotropic_stress(E - ice.relaxed, ice.amount * lame.lambda, ice.amount * lame.mu);
}

/// Lets ice form or melt at a strain, up to an amount. @param amount  ≥ 0
void set_amount(IceNetwork& ice, const Sym3<double>& E, const LameParameters& lame, double amount);

/// Stress and what it is of: of a network at F and Ḟ, with ice that resists strain rates by σ = a tr(Ė) I + 2 b Ė.
struct IceResponse {
  Mat3d F_r, rate;                ///< since the first ice [-], [1/s]
  Sym3<double> strain;            ///< E
  Sym3<double> elastic, viscous;  ///< S [Pa]

  /// @param drag  a and b [Pa s] @param Hdot  velocity gradient in the shape at rest [1/s]
  IceResponse(const IceNetwork& ice, const LameParameters& lame, const LameParameters& drag, const Mat3d& H,
              const Mat3d& Hdot);
};

/// P = J_f F_r S F_f⁻ᵀ [Pa].
Mat3d ice_piola(const IceNetwork& ice, const Mat3d& F_r, const Sym3<double>& S);

/// ∂P/∂F, of the elastic and the viscous part, with Ḟ following F by a rate [1/s]; row 9 (3 i + j) + 3 k + l: of P_ij by F_kl [Pa].
std::array<double, 81> ice_tangent(const IceNetwork& ice, const LameParameters& lame, const LameParameters& drag,
                                   const IceResponse& at, double rate);

}  // namespace glisson
