// tangent_system.h — the linear system of a Newton iteration, on the components that are free to move.
//
//   A = k (K(u, rate) + T(u) − L(u)) + diag(d)   K of element/tissue_operator.h and of what interactions add to the stress of tets, applied
//                                                without being assembled; T of triangles of the surface that interactions stiffen; L of
//                                                loads that follow
//
// Only the preconditioner is assembled: a sparse Cholesky factor of A's symmetric part at some earlier state, kept
// over iterations and steps until the iterations say that it has become bad; or the 3 × 3 blocks of A's diagonal.
//
// Tissue that shares its volume changes couples each vertex with its neighbours' neighbours. Its factor has the pressure q of each
// vertex a as an unknown instead, which couples neighbours alone: with b_a = Σ ¼ V ∂ϑ/∂u, W_a = Σ V over its tets,
//
//   [ k K_own + diag(d)    k bᵀ       ] [ u ]   [ f ]
//   [ k b               −k W/(4 κ)    ] [ q ] = [ 0 ]
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "dynamics/solvers/factor_panels.h"
#include "dynamics/solvers/krylov.h"
#include "dynamics/solvers/step_factor.h"
#include "dynamics/state/loads.h"
#include "element/tissue_operator.h"
#include "glisson/archive.h"
#include "glisson/simulation/interaction.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// A field of vectors as one of numbers.
inline Eigen::Map<Eigen::VectorXd> flat(std::span<Vec3d> field) {
  static_assert(sizeof(Vec3d) == 3 * sizeof(double));
  return {&field.front().x, static_cast<Eigen::Index>(3 * field.size())};
}
inline Eigen::Map<const Eigen::VectorXd> flat(std::span<const Vec3d> field) {
  return {&field.front().x, static_cast<Eigen::Index>(3 * field.size())};
}

class TangentSystem final : public StepFactor {
 public:
  /// What A is made of.
  struct Terms {
    double rate = 0.0;                               ///< dv/du in K [1/s]
    double weight = 1.0;                             ///< k
    std::span<const Vec3d> diagonal;                 ///< d of each component [kg/s²]
    std::span<const FaceStiffness> loads{};          ///< L: not in the preconditioner
    std::span<const TriangleStiffness> triangles{};  ///< T
    std::span<const TetStiffness> tets{};            ///< in K
  };

  /// Both must outlive this. @param interrupt  asked within solves, whose answers are then of no use
  TangentSystem(const TissueOperator& tissue, Preconditioner preconditioner, StepInterrupt& interrupt);

  /// Components that are free (3 i + axis: 1). Also after the body has changed.
  void set_free(std::vector<char> free);
  /// The tissues have changed; set_free comes next.
  void tissues_changed();
  bool is_free(std::size_t component) const override { return free_[component] != 0; }

  /// Takes A at a state.
  /// @param semidefinite  as TissueOperator::linearise
  /// @param anew  false: the tissue's part may stay that of an earlier state of the step
  void linearise(const TissueState& state, const Terms& terms, bool semidefinite, bool anew = true);
  /// Read after set_free, with the same components as when it was written.
  void archive(Archive& ar);
  /// The factor, shared, and goes back to one after archive() of a copy in memory; none: there was no factor.
  std::shared_ptr<const void> save_factor() const;
  void load_factor(const std::shared_ptr<const void>& factor);
  /// Whether A may be kept while its terms do not change: every tissue is linear.
  bool is_linear() const { return linear_ && triangles_.empty() && tets_.empty(); }

  /// y = A x on all components, held ones included.
  void apply(std::span<const Vec3d> x, std::span<Vec3d> y) const;
  /// Factorises from now on, however large the body is: for factor_solve().
  void need_factor() { factorises_ = true; }
  /// The next solve() makes the factor anew.
  void renew() override { has_factor_ = current_ = false; }
  std::uint64_t factor_number() const override { return has_factor_ ? factor_number_ : 0; }
  std::shared_ptr<void>& solved() override { return f_->solved; }
  /// P is A at some earlier state.
  void factor_solve(Eigen::MatrixXd& x) const override;
  /// x ≈ A⁻¹ b on the free components, 0 on the others.
  KrylovResult solve(const Eigen::VectorXd& b, double tolerance, Eigen::VectorXd& x);

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  /// What is factorised.
  struct Factored {
    std::vector<int> number;  ///< per component: its row among the free ones, −1
    std::vector<std::array<int, 4>>
        pressure;                     ///< per element: rows of its vertices' pressures; empty: no tissue shares
    int unknowns = 0, pressures = 0;  ///< rows of displacements, and of pressures after them
    Matrix matrix;                    ///< lower triangle
    std::vector<std::array<int, 144>> position;          ///< per element: where its entries are in the matrix, −1
    std::vector<std::array<int, 48>> pressure_position;  ///< those of pressures; empty where `pressure` is
    std::vector<int> diagonal_position;                  ///< per row
    FactorPanels factor;
    bool knows_entries = false;  ///< the factor has been made for this pattern
    std::shared_ptr<void> solved{};
  };
  void add_tets(TissueTangent& tangent, bool semidefinite);
  void find_pattern();
  int place_in(int row, int column) const;
  void find_pressures();
  void assemble(const TissueTangent& tangent);
  void assemble_pressures(const TissueTangent& tangent);
  void assemble_triangles();
  bool factorise(const TissueTangent& tangent);
  bool take_factor();
  void refresh();
  void find_blocks();
  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;

  const TissueOperator& tissue_;
  StepInterrupt& interrupt_;
  bool factorises_, linear_ = true, symmetric_ = true;
  std::vector<char> free_;
  Terms terms_;
  std::vector<Vec3d> diagonal_;
  std::vector<FaceStiffness> loads_;
  std::vector<TriangleStiffness> triangles_;
  std::vector<TetStiffness> tets_;
  std::vector<std::uint32_t> element_of_;  ///< of each tet of the mesh, while tets_ has some
  TissueState state_;
  TissueTangent tangent_;
  mutable std::vector<Vec3d> x_, y_;

  std::shared_ptr<Factored> f_ = std::make_shared<Factored>();  ///< shared with saved states: a copy is changed then
  std::shared_ptr<Factored> spare_;  ///< memory for such a copy, which takes longer to give back and to ask for anew
  mutable Eigen::MatrixXd packed_, moved_;
  bool known_ = false;  ///< tangent_ is that of this body
  bool has_pattern_ = false, has_factor_ = false;
  bool current_ = false;  ///< the factor is that of A
  std::uint64_t factor_number_ = 0;

  std::vector<Eigen::Matrix3d> inverse_blocks_;  ///< per vertex
};

}  // namespace glisson
