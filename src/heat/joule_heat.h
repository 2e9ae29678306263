// joule_heat.h — the potential between two electrodes at given temperatures, and the heat of its current.
#pragma once

#include <span>
#include <vector>

#include "glisson/heat/radio_frequency.h"
#include "glisson/heat/thermal_tissue.h"
#include "heat/blocks.h"

namespace glisson::heat {

class JouleHeat {
 public:
  /// @param tissue_of  of each tet; null: no current in it @throws std::invalid_argument where electrodes cannot be used
  JouleHeat(const TetMesh& mesh, std::vector<const ThermalTissue*> tissue_of, RadioFrequency radio);

  /// Solves for the potential. @param potential  in: where the search begins, or empty; out: for 1 V
  /// @return conductance between the electrodes [S]
  double solve(std::span<const double> temperature, Blocks& blocks, std::vector<double>& potential);
  /// Heat at each vertex at 1 V, of the last solve [W]; its sum is the conductance.
  const std::vector<double>& heat() const { return heat_; }

  /// Effective voltage [V] that gives what is asked for at a time. @throws std::invalid_argument
  double voltage_at(double time, double conductance) const;
  const RadioFrequency& radio() const { return radio_; }

 private:
  struct TetEdges {
    std::array<std::uint32_t, 6> edge{};
    std::array<double, 6> w{};  // −V ∇φ_i·∇φ_j [m]
  };
  void find_edges(const TetMesh& mesh);
  void assemble(std::span<const double> temperature);
  void multiply(Blocks& blocks, const std::vector<double>& x, std::vector<double>& y) const;
  void iterate(Blocks& blocks, std::vector<double>& x);
  double find_heat(const std::vector<double>& potential);

  std::vector<const ThermalTissue*> tissue_of_;
  RadioFrequency radio_;
  std::vector<Tet> tets_;
  std::vector<TetEdges> of_tet_;
  std::vector<double> conductivity_;              // of each tet [S/m]
  std::vector<std::uint32_t> begin_, to_, edge_;  // rows: neighbours, and the edge to each
  std::vector<double> conductance_, diagonal_;    // of each edge, of each vertex [S]
  std::vector<char> held_;
  std::vector<double> heat_, r_, p_, q_;
};

}  // namespace glisson::heat
