// heat_step.h — one step of backward Euler: Newton's method on the heat of the vertices.
//
// Unknown of a linear solve is what the vertices' conducted heat Θ changes by, in which the matrix of one tissue is symmetric:
//   (C/k + h g/k + h L) δΘ = heat before + h flows − heat,    C = dH/dT · V, g what blood and surface lose per kelvin
// A vertex then takes the heat C δT, and the temperature that has this heat: it stops at the corners of H(T) by itself.
#pragma once

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "heat/heat_flows.h"

namespace glisson::heat {

class HeatStepper {
 public:
  explicit HeatStepper(const HeatBody& body);

  struct Input {
    double h = 0.0;                   ///< [s]
    std::span<const double> heat;     ///< of the vertices before [J]
    std::span<const double> sources;  ///< [W], by vertex
    std::span<const char> held;       ///< 1: its temperature is given
    std::span<const SurfaceHeat> surfaces;
  };
  /// @param temperature  where the search begins, of held vertices what they are held at [°C]; the result
  /// @param flows  the result
  /// @return iterations, or −1 where it did not converge
  int step(const Input& in, std::vector<double>& temperature, Flows& flows);

 private:
  Eigen::VectorXd solve(const Eigen::VectorXd& residual);
  void set_matrix(const Input& in, std::span<const double> temperature, const Flows& flows);

  const HeatBody* body_;
  FlowFinder finder_;
  Eigen::SparseMatrix<double> matrix_;
  std::vector<std::array<int, 2>> places_;  // of each conductance in the matrix: ij, ji
  std::vector<int> diagonal_;
  std::vector<double> links_;  // Σ |w| of the conductances at a vertex [m]
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> symmetric_;
  Eigen::BiCGSTAB<Eigen::SparseMatrix<double>> general_;  // where a vertex is of several tissues
  std::vector<VertexState> states_;
};

}  // namespace glisson::heat
