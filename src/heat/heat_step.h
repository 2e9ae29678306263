// heat_step.h — one step of backward Euler: Newton's method on the heat of the vertices.
//
// Unknown of a linear solve is what the vertices' conducted heat Θ changes by, in which the matrix of one tissue is symmetric:
//   (C/k + h g/k + h L) δΘ = heat before + h flows − heat,    C = dH/dT · V, g what blood and surface lose per kelvin
// A vertex then takes the heat C δT, and the temperature that has this heat: it stops at the corners of H(T) by itself.
// Linear solves are as exact as the iteration is near its end [EisenstatWalker1996].
#pragma once

#include <span>
#include <vector>

#include "glisson/heat/heat_simulation.h"
#include "heat/heat_flows.h"
#include "heat/heat_solve.h"

namespace glisson::heat {

class HeatStepper {
 public:
  /// @param threads  1 or more
  HeatStepper(const HeatBody& body, int threads);

  struct Input {
    double h = 0.0;                      ///< [s]
    std::span<const double> heat;        ///< of the vertices before [J]
    std::span<const double> sources;     ///< [W], by vertex
    std::span<const char> held;          ///< 1: its temperature is given
    std::span<const std::uint8_t> dead;  ///< 1: without blood and metabolism
    std::span<const SurfaceHeat> surfaces;
  };
  /// @param temperature  where the search begins, of held vertices what they are held at [°C]; the result
  /// @param flows  the result
  /// @return iterations, or −1 where it did not converge
  int step(const Input& in, std::vector<double>& temperature, Flows& flows);

  Blocks& blocks() { return blocks_; }
  const HeatWork& work() const { return work_; }
  /// Goes on counting from what another one has cost.
  void set_work(const HeatWork& work, bool counts_time);
  bool counts_time() const { return solver_.counts_time; }
  void count_time() { solver_.counts_time = true; }

 private:
  /// How far the temperatures are from those of the step [K].
  struct Distance {
    double beside = 0.0;  ///< beside their neighbours'
    double alone = 0.0;   ///< by what flows in beside the heat that is there; more than `beside` in long steps
  };
  Distance find_residual(const Input& in, Flows& flows);
  /// What else than conduction flows into each vertex, less what it takes; infinite where its temperature is given.
  void find_else(const Input& in, const Flows& flows);
  void set_diagonal(const Input& in, const Flows& flows);
  void change_temperature(double share, std::vector<double>& temperature);

  const HeatBody* body_;
  Blocks blocks_;
  FlowFinder finder_;
  HeatSolver solver_;
  HeatWork work_;
  std::vector<char> fixed_;    // held, or in no tet
  std::vector<double> links_;  // Σ |w| at a vertex [m]
  std::vector<double> residual_, diagonal_, change_, else_in_;
};

}  // namespace glisson::heat
