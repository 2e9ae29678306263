// element_step_bound.h — a lower bound of the stable step of a body that changes, kept up to date where it changes.
//
// Each element's stiffness is held against a share of the masses of its vertices. Any shares that add up to the masses give
// a bound: with W_a the share of vertex a,
//   xᵀK_e x ≤ V m ‖Σ x_a ⊗ s_a‖² ≤ V m λ_max(Σ s_a s_aᵀ/W_a) Σ W_a |x_a|²,        m ≥ the modulus,
// so that the largest of V m λ_max over the elements bounds that of M⁻¹K. Shares as an element's own mass, V ρ/4, need
// nothing of its neighbours, so that the bound holds for any part of the body; but a flat tet then counts as if it were
// alone. Here vertices divide their masses by what each element asks for, V m |s_a|²: flat tets among good ones borrow from
// them. The better of the two is taken.
// Where the body changes, only the elements around are looked at again. Their bound depends on the others through Σ asked/mass
// of each vertex alone, and is made for a twentieth more of that than there is: a vertex that loses one tet of many asks for no
// look at all.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "element/body_change.h"
#include "glisson/archive.h"

namespace glisson {

class ElementStepBound {
 public:
  /// @param viscosity  per tissue block: factor on C, negative ones count as 0 [-]
  ElementStepBound(const Body& body, const detail::VertexStars& stars, std::vector<double> viscosity);

  /// After a change of the body. Cost: 0.1 µs an element around the vertices touched, after removals only around those
  /// where asked/mass has left what was allowed for.
  void change(const BodyChange& change);

  /// What its changes have left. @throws std::runtime_error where it is that of another body
  void archive(Archive& ar);

  /// h* of the body at rest stiffness, from below, nodal damping left out [s].
  double step() const;

 private:
  /// h* that an element allows [s].
  struct Steps {
    double shared = kNever, own = kNever;  ///< by shares as asked for, by its own mass
  };
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  void bound_all();
  void ask(std::uint32_t element);
  void weigh(std::uint32_t vertex);
  void look_around(std::uint32_t vertex, std::vector<std::uint32_t>& around);
  void take_out(const BodyChange& change, std::vector<std::uint32_t>& around);
  void bound(std::uint32_t element);
  static Steps least(std::span<const Steps> of);
  void find_least(std::span<const std::uint32_t> elements);

  const Body& body_;
  const detail::VertexStars& stars_;
  std::vector<double> elastic_, viscous_;   ///< per tissue block: bounds of the moduli [Pa], [Pa s]
  std::vector<std::array<float, 4>> asks_;  ///< per element and corner: V m |s_a|²
  std::vector<double> asked_;               ///< per vertex: Σ of it over the elements around
  std::vector<double> allowed_;             ///< per vertex: asked over mass that bounds around it are made for
  std::vector<Steps> steps_, least_;        ///< per element; the least per run of elements
};

}  // namespace glisson
