// stage_holds.h — what instruments hold, as stages of drag see it (element/drag_stages.h).
//
// Instruments act once a step, by impulses on the lumped mass. A stage that did not know of them would move what they hold by the
// whole step's forces, and the impulses that put it right would move the lightest vertices alone. So the change δ of the velocities in a
// stage loses what would move the rows B that are held:
//
//   δ ← δ − M⁻¹ Bᵀ (B M⁻¹ Bᵀ + c)⁻¹ B δ
//
// With c = 0 the rows keep their velocity, as supports do. With c, a needle's bending over h² say, this is the inverse of
// M + Bᵀ c⁻¹ B in the place of M⁻¹: the rows have the inertia that an implicit spring has in a step. It has no less mass than M in any
// motion, so that the step is as stable as without.
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <span>
#include <vector>

#include "glisson/simulation/interaction.h"

namespace glisson::engine {

class StageHolds {
 public:
  /// Rows of vertices that are not active are left out. Costs next to nothing where all is as it was.
  /// @param active  ascending @param inverse_mass  of each, in components that may move [1/kg]
  void set(std::span<const HeldRows> held, std::span<const ActiveVertex> active, std::span<const Vec3d> inverse_mass);
  bool empty() const { return places_.empty(); }
  /// Places among the active vertices that some row has, ascending; project() is told of them in this order.
  std::span<const std::uint32_t> places() const { return places_; }
  /// Takes what moves the rows from changes of the velocities.
  void project(std::span<Vec3d> changes);

 private:
  struct Entry {
    std::uint32_t at = 0;  ///< in places_
    Vec3d weight{};        ///< along x, y, z
  };
  void add_row(const HeldRows::Row& row, std::span<const ActiveVertex> active);
  void add_own(std::vector<Eigen::Triplet<double>>& W) const;
  void factorise(std::span<const HeldRows> held, std::span<const std::size_t> source);

  std::vector<HeldRows> held_;         ///< that it was set to
  std::vector<std::uint32_t> active_;  ///< vertices, then
  std::vector<Vec3d> inverse_mass_;    ///< of each [1/kg]
  std::vector<Entry> entries_;
  std::vector<std::size_t> begin_{0};  ///< of each row among the entries, and the end
  std::vector<std::uint32_t> places_;
  std::vector<Vec3d> mobility_;  ///< per place
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::VectorXd moved_, taken_;
};

}  // namespace glisson::engine
