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

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "glisson/simulation/active_vertex.h"
#include "glisson/simulation/held_rows.h"

namespace glisson::engine {

class StageHolds {
 public:
  /// Means and vertices that are not all active are left out. What is as it was is kept.
  /// @param active  ascending @param inverse_mass  of each, in components that may move [1/kg]
  void set(const HeldRows& held, std::span<const ActiveVertex> active, std::span<const Vec3d> inverse_mass);
  bool empty() const { return places_.empty(); }
  /// Places among the active vertices that are held or in a mean, ascending; project() is told of them in this order.
  std::span<const std::uint32_t> places() const { return places_; }
  /// Takes what moves the rows from changes of the velocities.
  void project(std::span<Vec3d> changes);

 private:
  struct Entry {
    std::uint32_t at = 0;  ///< in places_
    double weight = 0.0;
  };
  struct Pair {
    std::uint32_t a = 0, b = 0;  ///< means, a ≥ b
    Vec3d coupling{};            ///< Σ w_a w_b / m of the vertices they share, along x, y, z [1/kg]
  };
  std::uint32_t place_of(std::uint32_t vertex) const;
  void take_active(std::span<const ActiveVertex> active);
  void take_means(std::span<const Vec3d> inverse_mass);
  void couple_means();
  void take_rows();
  void factorise();
  template <class Add>
  void add_own(const Add& add) const;
  template <class Add>
  void add_compliance(const Add& add) const;

  HeldRows held_;                               ///< that it was set to
  std::vector<std::uint32_t> active_;           ///< vertices, then
  std::vector<std::uint32_t> place_of_vertex_;  ///< of these, others are anything
  std::vector<Vec3d> inverse_mass_;             ///< of each [1/kg]
  std::vector<std::uint32_t> places_;
  std::vector<std::uint32_t> still_;  ///< those in places_ that are held as a whole
  std::vector<Vec3d> mobility_;       ///< per place [1/kg]
  std::vector<Entry> entries_;        ///< of the means
  std::vector<std::size_t> begin_;    ///< of each mean among the entries, and the end; empty: left out
  std::vector<Pair> pairs_;
  std::vector<HeldRows::Row> rows_;      ///< of means that are not left out
  std::vector<std::uint32_t> number_;    ///< of each row that was told among rows_, or kLeftOut
  std::vector<std::uint32_t> of_mean_;   ///< rows, mean by mean
  std::vector<std::size_t> rows_begin_;  ///< of each mean among them, and the end
  bool sparse_ = false;
  Eigen::MatrixXd W_;
  Eigen::LLT<Eigen::MatrixXd> dense_factor_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> sparse_factor_;
  Eigen::VectorXd moved_;
  std::vector<Vec3d> of_means_;  ///< their changes, then what is taken from them

  /// Arrays that take_means() and couple_means() would else make anew in every step.
  struct Scratch {
    std::vector<std::uint32_t> local;                   ///< per active vertex: its place in places_
    std::vector<std::size_t> begin, filled;             ///< per place: its means below the present one, in `here`
    std::vector<std::pair<std::uint32_t, Vec3d>> here;  ///< mean b, w_b / m
    std::vector<Vec3d> sum;                             ///< per mean
    std::vector<char> shares;
    std::vector<std::uint32_t> partners;
  } scratch_;
};

}  // namespace glisson::engine
