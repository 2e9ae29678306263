// viscous_system.h — (M + hγ + hC) x = b: the constant matrix of the semi-implicit scheme.
//
// C is the viscous matrix at rest. Small bodies are factorised once (factor_panels.h); for large ones, whose factor is
// no longer read at the speed of a cache, conjugate gradients start from the last answer. Interactions need a factor.
#pragma once

#include <Eigen/SparseCore>
#include <algorithm>
#include <span>
#include <vector>

#include "dynamics/solvers/factor_panels.h"
#include "dynamics/solvers/step_factor.h"
#include "element/body.h"

namespace glisson {

class ViscousSystem final : public StepFactor {
 public:
  /// Tets up to which a factor pays (docs/integrators.md).
  static constexpr std::size_t kMostTets = 20000;

  /// Whether the body has any viscosity: without it the matrix is diagonal and this is not needed.
  static bool needed(const Body& body);

  /// @param nodal_damping  γ_i per vertex [kg/s]
  /// @param h  step [s]
  /// @param held  per component: 1 where x is given
  /// @param dashpots  damping beside γ_i, per component [kg/s]; empty: none
  /// @param most_tets  for a factor; a body of more iterates
  /// @return false where the matrix is not positive
  bool build(const Body& body, std::span<const double> nodal_damping, double h, std::vector<char> held,
             std::span<const Vec3d> dashpots = {}, std::size_t most_tets = kMostTets);

  /// Fills the free components of x.
  /// @param b  [kg m/s], @param x  [m/s]; its held components are given
  void solve(std::span<const Vec3d> b, std::span<Vec3d> x);
  /// P = (M + hγ + hC)/h².
  void factor_solve(Eigen::MatrixXd& x) const override;
  std::uint64_t factor_number() const override { return factorised_ ? factor_number_ : 0; }
  std::shared_ptr<void>& solved() override { return solved_; }
  void renew() override {}  // build() does

  /// C x of the held components [N]; 0 for the others.
  void held_drag(std::span<const Vec3d> x, std::span<Vec3d> drag) const;

  /// The last answer, which the next one starts from.
  std::vector<double> last() const { return {last_.begin(), last_.end()}; }
  /// @return false where it has another size
  bool set_last(std::span<const double> last);
  bool is_free(std::size_t component) const override { return held_[component] == 0; }
  bool is_factorised() const { return factorised_; }
  /// Whether it was built with these held.
  bool is_for(std::span<const char> held) const { return std::ranges::equal(held, held_); }

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  void number();
  void iterate(Eigen::MatrixXd& x);

  double h_ = 0.0;
  std::vector<char> held_;
  std::vector<Eigen::Index> row_;                       ///< per component: among the free or among the held
  std::vector<std::size_t> free_of_row_, held_of_row_;  ///< components
  Matrix matrix_;                                       ///< free × free
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows_;   ///< free × free, for conjugate gradients
  Matrix coupling_;                                     ///< C, held × free
  Matrix held_block_;                                   ///< C, held × held
  bool factorised_ = false;
  FactorPanels factor_;
  std::uint64_t factor_number_ = 0;
  std::shared_ptr<void> solved_;
  Eigen::MatrixXd packed_;  ///< one column
  Eigen::VectorXd last_, inverse_diagonal_;
};

}  // namespace glisson
