// reference_ice.h — the executable specification of ice in tissue: every network that has formed is kept, and all are summed.
//
//   W = J_f Σ_s ½ g_s (E − E_s) : C : (E − E_s),   E = ½ (F_rᵀ F_r − I),  F_r = F F_f⁻¹,   C of λ and μ of the tissue at rest
//   P = ∂W/∂F
//
// F_f is F when the first network formed. Ice that melts takes the same share of each. It shares no code with material/ice_network.h.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "glisson/material/tissue.h"

namespace glisson::reference {

class Ice {
 public:
  explicit Ice(LameParameters lame) : lame_(lame) {}

  /// A network of an amount g > 0 forms without stress at F.
  void form(double amount, const Eigen::Matrix3d& F);
  /// @param kept  share of each network that stays
  void melt(double kept);
  double amount() const;                                  ///< Σ g_s
  double energy(const Eigen::Matrix3d& F) const;          ///< W [J/m³]
  Eigen::Matrix3d piola(const Eigen::Matrix3d& F) const;  ///< P [Pa]

 private:
  struct Network {
    double amount;
    Eigen::Matrix3d strain;  ///< E_s
  };
  Eigen::Matrix3d strain(const Eigen::Matrix3d& F) const;

  LameParameters lame_;
  Eigen::Matrix3d first_ = Eigen::Matrix3d::Identity();  ///< F_f
  std::vector<Network> networks_;
};

}  // namespace glisson::reference
