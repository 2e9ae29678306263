// active_kick.h — the kick of the vertices that supports, tools and loads act on: v₋ → v₊, and the forces and work of it.
//
//   as if free:  v₊ = (m v₋ + h F)/(m + γ h)  ─▶  motions replace what they hold  ─▶  interactions correct it  ─▶  books
//
// The body moves all other vertices (engine/moving_body.h).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "dynamics/state/body_state.h"
#include "engine/moving_body.h"

namespace glisson {

/// Brings a list, one a vertex that was active, to those that are now; 0 for one that was not. @param before, active  ascending
template <class T>
void follow_active(std::span<const std::uint32_t> before, std::span<const ActiveVertex> active, std::vector<T>& list,
                   std::vector<T>& memory) {
  memory.clear();
  std::size_t k = 0;
  for (const ActiveVertex& w : active) {
    while (k < before.size() && before[k] < w.vertex) ++k;
    const bool known = k < std::min(before.size(), list.size()) && before[k] == w.vertex;
    known ? memory.push_back(list[k]) : memory.push_back({});
  }
  std::swap(list, memory);
}

class ActiveKick {
 public:
  /// What an active vertex had at the last kick; all 0 for one that was not active then.
  struct Kicked {
    double mass = 0.0, damping = 0.0;
    Vec3d weight{};
    Vec3d velocity_before, load, contact;  ///< contact: force of the interactions
    Vec3d dashpot{};                       ///< to the ground, along x, y, z [kg/s]
    Vec3d mobility{};                      ///< 1/(m + γ h), 0 without mass [1/kg]
    void archive(Archive& ar) { ar(mass, damping, weight, velocity_before, load, contact, dashpot); }
    /// All that drags it [N].
    Vec3d drag(const Vec3d& v) const { return v * damping + component_product(dashpot, v); }
  };

  /// @param state  must outlive this
  explicit ActiveKick(BodyState& state) : state_(state) {}

  /// The active vertices have become others. @param before  those it knew; both lists are ascending
  void follow(std::span<const std::uint32_t> before, std::span<const ActiveVertex> active);
  /// Begins a kick of h at the present time.
  void begin(double h);
  /// Forces of loads at present [N], one per vertex of the mesh.
  std::span<const Vec3d> loads(std::span<const ActiveVertex> active);
  /// v₊ as if they were free; massless ones (in no tet) stay.
  void kick(std::span<ActiveVertex> active);
  /// Keeps what they had before. @return force of loads on the k-th [N]
  Vec3d keep(std::size_t k, const ActiveVertex& active, std::span<const Vec3d> loads);
  /// Replaces v₊ of held and driven components by what their motion asks for.
  void impose_motions(std::span<ActiveVertex> active) const;
  /// 1/(m + γ h) of what is not held [1/kg].
  std::span<const Vec3d> mobility();
  /// What interactions exerted [N s].
  void push(std::span<const Vec3d> impulses);

  /// The last kick, to go back to; with the same active vertices.
  struct Kept {
    std::vector<Kicked> kicked;
    Vec3d gravity;
    double step = 0.0, time = 0.0;
  };
  void keep_last(Kept& kept) const {
    kept.kicked = kicked_, kept.gravity = gravity_, kept.step = step_, kept.time = time_;
  }
  void go_back(const Kept& kept) {
    kicked_ = kept.kicked, gravity_ = kept.gravity, step_ = kept.step, time_ = kept.time;
  }

  /// What a constraint exerted at the last kick.
  ForceParts force(std::span<const ActiveVertex> active, std::size_t constraint) const;
  /// Its torque about a place, with where the vertices were.
  Vec3d torque(std::span<const ActiveVertex> active, std::size_t constraint, const Vec3d& about) const;
  /// Work of the forces, that of the constraints included.
  KickWork work(std::span<const ActiveVertex> active) const;
  /// Adds what of the work of tools the tissue did not take.
  void add_interface(std::span<const ActiveVertex> active, const InterfaceBook& book, KickWork& work) const;

  /// What supports, tools and loads did at the last kick.
  struct Outer {
    double force = 0.0;  ///< Σ |F| [N]
    double power = 0.0;  ///< Σ F·v₊ [W]
  };
  Outer outer_action(std::span<const ActiveVertex> active) const;

  double time() const { return time_; }  ///< of the last kick [s]
  const Vec3d& gravity() const { return gravity_; }
  std::span<const Kicked> all() const { return kicked_; }
  void archive(Archive& ar);

 private:
  ForceParts force_at(const ActiveVertex& active, std::size_t place, const Axes& axes) const;
  /// @param k  which of the constraint's vertices
  ForceParts force_on(std::span<const ActiveVertex> active, std::size_t constraint, std::size_t k) const;

  BodyState& state_;
  std::vector<Kicked> kicked_;                      ///< per active vertex
  std::vector<Kicked> kicked_before_;               ///< memory for follow()
  std::vector<std::vector<std::uint32_t>> places_;  ///< per constraint: where its vertices are among those active
  std::vector<Vec3d> mobility_;
  std::vector<Vec3d> displacement_;  ///< of active vertices, by vertex, for loads that ask for it [m]
  Vec3d gravity_{};
  double step_ = 0.0, time_ = 0.0;
};

/// Adds the second to the first.
inline void add(KickPower& sum, const KickPower& p) {
  sum.elastic += p.elastic, sum.viscous += p.viscous, sum.damping += p.damping;
  sum.tools += p.tools, sum.loads += p.loads;
  sum.contact += p.contact, sum.friction += p.friction, sum.fracture += p.fracture;
}

}  // namespace glisson
