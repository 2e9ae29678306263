// ice_state.h — what ice keeps: the frozen tets, which change between steps alone and are shared by copies, and what a step finds.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "glisson/instruments/ice.h"
#include "glisson/tet_gradient.h"
#include "material/ice_network.h"

namespace glisson {

struct IceTet {
  std::uint32_t number = 0;  ///< of the mesh
  Tet corners{};
  ElementRest rest;
  LameParameters elastic, drag;  ///< λ and μ of the tissue at rest [Pa]; a and b of its viscosity [Pa s]
  double share = 0.0;            ///< frozen [-]
  IceNetwork ice;

  double energy(const Mat3d& H) const { return rest.volume * ice_energy(ice, ice_strain(ice, H), elastic); }
  /// d with xᵀ K x ≤ d Σ |x_a|² of its stiffness K in the shape in which it froze [N/m].
  double stiffness_bound() const;
  void archive(Archive& ar);
};

/// All frozen tets and what follows from them.
struct FrozenTets {
  std::vector<IceTet> tets;
  std::vector<std::uint32_t> place_of;  ///< per tet of the mesh: 1 + its place in `tets`, 0: it is not frozen
  std::vector<std::uint32_t> vertices;  ///< ascending
  std::vector<double> bounds;           ///< per place in `vertices`: Σ of stiffness_bound() [N/m]
  double squared_frequency = 0.0;       ///< bound of it, in the shape in which they froze [1/s²]

  /// Finds all but the tets. @param masses  per vertex of the mesh [kg]
  void lay_out(std::size_t tets_of_mesh, const std::vector<double>& masses);
};

struct Ice::State {
  explicit State(const IceOptions& o) : options(o) {}

  IceOptions options;
  bool is_long = false;
  std::size_t tet_count = 0;
  std::shared_ptr<const std::vector<double>> masses;  ///< per vertex of the mesh [kg]
  std::shared_ptr<const FrozenTets> frozen = std::make_shared<const FrozenTets>();
  bool is_renamed = false;     ///< the vertices are others than those that reach() has named
  std::vector<Mat3d> H, Hdot;  ///< per frozen tet: where it was evaluated last [-], [1/s]
  double energy = 0.0;         ///< there [J]
  double rise = 1.0;           ///< bound of the stiffness there over that in the shape in which tets froze [-]
  double changed = 0.0;        ///< [J]

  double drag_factor(const IceTet& t) const { return t.share * (options.viscosity_factor - 1.0); }
  LameParameters drag(const IceTet& t) const { return {drag_factor(t) * t.drag.lambda, drag_factor(t) * t.drag.mu}; }
  void replace(FrozenTets next);
  void set_share(IceTet& tet, const Mat3d& H, double share);
  /// Evaluates all tets. @param at  vertex → displacement [m] @param push  (vertex, force [N])
  template <class At, class Push>
  void evaluate(const At& at, const Push& push);
};

/// H of a frozen tet. @param at  vertex → displacement [m], or velocity [m/s]
template <class At>
Mat3d gradient_of(const IceTet& t, const At& at) {
  const Vec3d first = at(t.corners[0]);
  return displacement_gradient(
      t.rest.s, std::array{at(t.corners[1]) - first, at(t.corners[2]) - first, at(t.corners[3]) - first});
}

/// Forces −V P s_a on the corners. @param push  (vertex, force [N])
template <class Push>
void push_corners(const IceTet& t, const Mat3d& P, const Push& push) {
  Vec3d sum{};
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3d f = (P * t.rest.s[a]) * -t.rest.volume;
    push(t.corners[a + 1], f);
    sum += f;
  }
  push(t.corners[0], -sum);
}

/// Evaluates all tets by `at`, and remembers it for the tangent.
template <class At, class Push>
void Ice::State::evaluate(const At& at, const Push& push) {
  const std::vector<IceTet>& tets = frozen->tets;
  energy = 0.0, rise = 1.0;
  for (std::size_t k = 0; k < tets.size(); ++k) {
    const IceTet& t = tets[k];
    H[k] = gradient_of(t, at);
    const Sym3<double> E = ice_strain(t.ice, H[k]), S = ice_stress(t.ice, E, t.elastic);
    push_corners(t, ice_piola(t.ice, since_frozen(t.ice, H[k]), S), push);
    energy += t.rest.volume * ice_energy(t.ice, E, t.elastic);
    if (!(t.ice.amount > 0.0)) continue;
    const double strain = std::sqrt(contract(E, E)), stress = std::sqrt(contract(S, S));
    rise = std::max(rise, 1.0 + 2.0 * strain + stress / (2.0 * t.ice.amount * t.elastic.mu));
  }
}

}  // namespace glisson
