#include "material/ice_network.h"

namespace glisson {

void set_amount(IceNetwork& ice, const Sym3<double>& E, const LameParameters& lame, double amount) {
  const double before = ice.amount;
  if (amount > before) {
    const double kept = before / amount;
    const Sym3<double> D = E - ice.relaxed;
    ice.locked +=
        0.5 * ice.volume_ratio * before * (1.0 - kept) * contract(isotropic_stress(D, lame.lambda, lame.mu), D);
    ice.relaxed = E - D * kept;
  } else if (before > 0.0) {
    ice.locked *= amount / before;
  }
  ice.amount = amount;
}

IceResponse::IceResponse(const IceNetwork& ice, const LameParameters& lame, const LameParameters& drag, const Mat3d& H,
                         const Mat3d& Hdot)
    : F_r(since_frozen(ice, H)), rate(Hdot * ice.inverse), strain(ice_strain(ice, H)),
      elastic(ice_stress(ice, strain, lame)),
      viscous(isotropic_stress(symmetric(transposed_product(F_r, rate)), drag.lambda, drag.mu)) {}

Mat3d ice_piola(const IceNetwork& ice, const Mat3d& F_r, const Sym3<double>& S) {
  return scaled(F_r * full(S) * transposed(ice.inverse), ice.volume_ratio);
}

std::array<double, 81> ice_tangent(const IceNetwork& ice, const LameParameters& lame, const LameParameters& drag,
                                   const IceResponse& at, double rate) {
  std::array<double, 81> slope{};
  const Mat3d S = full(at.elastic + at.viscous), back = transposed(ice.inverse);
  for (std::size_t column = 0; column < 9; ++column) {
    Mat3d dF_r{};  // e_k ⊗ e_l F_f⁻¹
    for (std::size_t j = 0; j < 3; ++j) dF_r(column / 3, j) = ice.inverse(column % 3, j);
    const Sym3<double> dE = symmetric(transposed_product(at.F_r, dF_r));
    Sym3<double> dS = isotropic_stress(dE, ice.amount * lame.lambda, ice.amount * lame.mu);
    if (drag.mu != 0.0 || drag.lambda != 0.0) {
      const Sym3<double> dRate = dE * rate + symmetric(transposed_product(dF_r, at.rate));
      dS += isotropic_stress(dRate, drag.lambda, drag.mu);
    }
    const Mat3d dP = sum(dF_r * S, at.F_r * full(dS)) * back;
    for (std::size_t row = 0; row < 9; ++row) slope[9 * row + column] = ice.volume_ratio * dP(row / 3, row % 3);
  }
  return slope;
}

}  // namespace glisson
