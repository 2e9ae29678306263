// tissue_operator.h — forces, tangents and energy of a body of any tissue, in double, one element at a time.
//
//   f_a = −V P s_a                       P of material/response.h, at H and Ḣ of the element
//   K = Σ V s_a ∂(P·s_b)/∂u, C likewise  exact: of small strain in closed form, else by numbers that carry their derivative
//
// What the implicit schemes and statics run on, what runs in double precision, and what the submesh engine is compared
// with. Tissues whose volume change is shared (VolumeChange::average_nodal) take a pass over the elements before.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/task_pool.h"
#include "element/body.h"
#include "element/branch_memory.h"
#include "element/force_operator.h"
#include "material/response.h"

namespace glisson {

/// What a tissue remembers of its past: of each element and Maxwell branch the relaxed stress, the stress then, and how fast
/// the branch relaxed.
struct TissueMemory {
  std::vector<Sym3<double>> relaxed;  ///< q of branch k of element e at first_branch(e) + k [Pa]
  std::vector<Sym3<double>> stress;   ///< S of each element of a tissue with branches, else empty [Pa]
  std::vector<double> pace;  ///< 1/τ at the place of q; empty where the times of all branches are constant [1/s]
  bool operator==(const TissueMemory&) const = default;
  void archive(auto& ar) {
    ar.same_size(relaxed), ar.same_size(stress);
    if (!pace.empty()) ar.same_size(pace);
  }
};

/// Of stresses over a body, √Σ V |σ|² [Pa m^(3/2)].
struct MemoryChange {
  double overstress = 0.0;  ///< Σ g Δq/(1 − e^(−h/τ)): what adds up while a branch forgets
  double stress = 0.0;      ///< S, of which the branches relax their shares
};

/// The state a body is asked about.
struct TissueState {
  std::span<const Vec3d> u;  ///< displacement [m]
  std::span<const Vec3d> v;  ///< velocity [m/s]
  double since = 0.0;        ///< time since the memory was last brought up to date [s], ≥ 0
};

/// ∂P/∂F of every element, row-major 9 × 9: row 3 i + j of P_ij, column 3 k + l of F_kl [Pa].
using ElementTangent = Eigen::Matrix<double, 9, 9, Eigen::RowMajor>;

/// Goes to the nearest matrix whose symmetric part has no negative eigenvalue.
void make_semidefinite(ElementTangent& C);

/// The linearised forces at one state.
struct TissueTangent {
  std::vector<ElementTangent> local;  ///< of each element; with shared volume change, at constant mean
  std::vector<Mat3d> volume;          ///< ∂ϑ/∂F of each element with shared volume change, else empty
  std::vector<Mat3d> pressure;        ///< ∂P/∂ϑ̄ of those by the shared mean, Maxwell branches included [Pa]
  std::vector<double> modulus;        ///< ∂²W/∂ϑ² of those without branches [Pa]
};

class TissueOperator {
 public:
  /// @param body  must outlive this
  /// @param step  what the branches whose times follow the deformation go by
  /// @param threads  that elements are shared out to; the same bytes with any number
  explicit TissueOperator(const Body& body, StepKind step = StepKind::implicit, int threads = 1);
  int threads() const { return pool_->threads(); }

  /// Overwrites `elastic` and `viscous` [N]. Elastic is what is left after long times; viscous is the rest: Kelvin–Voigt
  /// and what the Maxwell branches have not relaxed yet.
  void forces(const TissueState& state, std::span<Vec3d> elastic, std::span<Vec3d> viscous, ElementWatch& watch) const;
  /// Energy of the elastic forces [J], Response::relaxed_energy over the body.
  double energy(std::span<const Vec3d> u) const;

  /// ∂(−f)/∂u + rate ∂(−f)/∂v at a state, for schemes in which dv = rate du [1/s].
  /// @param semidefinite  whether negative eigenvalues of each element's symmetric part are set to 0
  void linearise(const TissueState& state, double rate, bool semidefinite, TissueTangent& out) const;
  /// y = K x.
  void apply(const TissueTangent& tangent, std::span<const Vec3d> x, std::span<Vec3d> y) const;

  /// Takes the state in as the past: relaxed stresses go on by `state.since`, exactly for stress linear in time, or in the
  /// branch's own time where that follows the deformation.
  void advance_memory(const TissueState& state);
  const TissueMemory& memory() const { return memory_; }
  /// What the branches would hold otherwise, had one step of `since` led from an earlier memory to the present one.
  /// @param u  that the present memory is of [m]
  MemoryChange change_by_one_step(const TissueMemory& earlier, double since, std::span<const Vec3d> u) const;
  /// Whether some tissue has branches.
  bool has_memory() const { return has_memory_; }
  void set_memory(TissueMemory memory) { memory_ = std::move(memory); }
  void archive(auto& ar) { ar(memory_); }

  /// Follows elements and vertices that have changed in the body; memory of an element stays.
  void body_changed();

  /// What the branches of a block hold. @param since  time since the memory was last brought up to date [s], ≥ 0
  /// @param u  displacement now [m]
  BranchMemory branch_memory(std::size_t block, double since, std::span<const Vec3d> u) const;
  /// Stress g (S − q) of each element and branch of a block, with the memory up to date [Pa].
  std::vector<Sym3<double>> branch_stresses(std::size_t block, std::span<const Vec3d> u) const;
  /// Follows tissues that have changed in the body. Branches of those blocks carry no stress then; the others keep theirs.
  /// @param blocks  that have changed; the memory is up to date
  void tissues_changed(std::span<const std::size_t> blocks, std::span<const Vec3d> u);
  /// Sets what branch_stresses reads, in a memory that is up to date.
  void set_branch_stresses(std::size_t block, std::span<const Sym3<double>> stresses, std::span<const Vec3d> u);

  const Body& body() const { return body_; }

 private:
  /// What an element exerts.
  struct Exerted {
    Mat3d elastic{}, dashpot{}, branches{};  ///< [Pa]
    double ratio = 0.0, norm = 0.0;          ///< of its stiffening
    bool inverted = false;
  };
  Exerted exerted_by(std::size_t block, std::size_t e, const TissueState& state, const double* mean) const;
  void for_elements(std::size_t begin, std::size_t end, const std::function<void(std::size_t)>& act) const;
  std::vector<double> mean_volume_change(std::span<const Vec3d> u) const;
  bool is_closed(std::size_t block) const;
  void linearise_closed(std::size_t block, const TissueState& state, double rate, std::span<const double> mean,
                        TissueTangent& out) const;
  void linearise_by_duals(std::size_t block, std::size_t e, const TissueState& state, double rate,
                          std::span<const double> mean, TissueTangent& out) const;
  template <class T>
  Sym3<T> overstress(std::size_t block, std::size_t e, double since, const Mat3<T>& H, const Sym3<T>& S) const;
  template <class T>
  BranchWeights<T> weights(const TissueMemory& past, std::size_t block, std::size_t e, std::size_t k, double since,
                           T x) const;
  template <class T>
  T measure_of_times(std::size_t block, std::size_t e, const Mat3<T>& H) const;
  void set_paces(std::size_t block, std::size_t e, const Mat3d& H);
  /// Where branch 0 of an element is in memory.
  std::size_t place_of(std::size_t block, std::size_t e) const {
    const TissueBlock& b = body_.blocks[block];
    return first_branch_[block] + (e - b.begin) * b.tissue.maxwell.size();
  }

  const Body& body_;
  StepKind step_;
  std::unique_ptr<detail::TaskPool> pool_;
  std::vector<Response> responses_;        ///< per tissue block
  std::vector<ElementShape> shapes_;       ///< per element
  std::vector<std::size_t> first_branch_;  ///< per block: place of its first element's branches in memory
  std::vector<std::size_t> first_stress_;  ///< per block: place of its first element's stress
  TissueMemory memory_;
  bool has_memory_ = false, shares_volume_ = false;
};

}  // namespace glisson
