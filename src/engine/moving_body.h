// moving_body.h — the seam between motion and tissue: a body that holds its state and advances it by a step.
//
//   advance(h):  forces at u, v₋ ─▶ v₊ = (m v₋ + h F)/(m + γh) ─▶ u + h v₊        [Schwartz2002, eq. 4]
//
// All vertices move as if they were free. Those that something else moves too (supports, tools, loads) are
// *active*: the body leaves them where they are and hands out their forces; whoever drives them decides
// their motion and places them. So the many vertices stay inside, in whatever layout and precision is fast,
// and the few that others care for are told in double. Vertices at *rest* stay where they are, and all that is told of them is
// the force that they stand against.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "element/body_change.h"
#include "element/branch_memory.h"
#include "element/stiff_element.h"
#include "glisson/archive.h"
#include "glisson/math.h"
#include "glisson/simulation/active_vertex.h"
#include "material/strain.h"

namespace glisson {

namespace engine {
class StageHolds;
}

/// Energies per unit time at a kick, with v₋ (before) and v₊ (after) [W]; kinetic is ½ Σ m v₋·v₊ [J].
struct KickPower {
  double elastic = 0.0, viscous = 0.0, damping = 0.0, tools = 0.0, loads = 0.0;  ///< on the tissue
  double contact = 0.0, friction = 0.0, fracture = 0.0;  ///< of tools, what the tissue does not take
  void archive(auto& ar) { ar(elastic, viscous, damping, tools, loads, contact, friction, fracture); }
};
struct KickWork {
  KickPower before, after;
  double kinetic = 0.0;
};

/// What an advance was like.
struct Advance {
  bool finite = true;                   ///< false: a force was not finite; its vertices were not moved
  std::vector<double> stiffening;       ///< per tissue block: bound of tangent over rest stiffness [-]
  std::vector<StiffElement> stiff;      ///< elements above what list_above() was told, in no order but always the same
  std::vector<std::uint32_t> inverted;  ///< tets of the mesh with J ≤ 0, ascending
  KickWork work;                        ///< of the vertices that are not active; only where accounted
  double brought_in = 0.0;              ///< energy of the elastic forces that a change of law has brought in [J]
};

class MovingBody {
 public:
  virtual ~MovingBody() = default;

  virtual void set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) = 0;
  virtual void read_state(std::span<Vec3d> displacement, std::span<Vec3d> velocity) const = 0;

  virtual Vec3d displacement_of(std::uint32_t vertex) const = 0;
  virtual Vec3d velocity_of(std::uint32_t vertex) const = 0;
  /// The same of several. @param velocities  as many as vertices
  virtual void read_velocities(std::span<const std::uint32_t> vertices, std::span<Vec3d> velocities) const = 0;

  /// What the body knows of its past beside the state.
  virtual void archive_past(Archive& ar) = 0;
  /// How it lies in memory where that has come from changes, and room for the vertices that its Body has. Read after the
  /// Body has changed; archive_state comes next. @throws std::runtime_error with the body as it was
  /// @param nodal_damping  γ_i of every vertex [kg/s]
  virtual void archive_layout(Archive& ar, std::span<const double> nodal_damping) = 0;
  /// A copy of how it lies in memory, and goes back to one, for which its Body is already: all vertices are free then, none at
  /// rest, and archive_state comes next.
  virtual std::shared_ptr<const void> save_layout() const = 0;
  virtual void load_layout(const std::shared_ptr<const void>& layout, std::span<const double> nodal_damping) = 0;
  /// Displacement and velocity, and the past.
  void archive_state(Archive& ar, std::size_t vertices);

  /// Takes over what has changed in the body (BodyChanger has changed it already). New vertices begin in the
  /// state of those they are copies of, and are not active.
  /// @param nodal_damping  γ_i of every vertex, new ones included [kg/s]
  virtual void apply(const BodyChange& change, const detail::VertexStars& stars,
                     std::span<const double> nodal_damping) = 0;

  /// Whether the body can go on with the tissues that its Body has; where not it is to be built anew.
  virtual bool supports_tissues() const = 0;
  /// Takes over tissues, and masses, that have changed in its Body. State and active vertices stay; Maxwell branches of
  /// the blocks that have changed carry no stress. Before the Body changes, branch_stresses has to be asked for them.
  /// @param blocks  that have changed
  /// @param nodal_damping  γ_i of every vertex [kg/s]
  virtual void tissues_changed(std::span<const std::size_t> blocks, std::span<const double> nodal_damping) = 0;
  /// What the Maxwell branches of a block hold for the forces of the present state.
  virtual BranchMemory branch_memory(std::size_t block) const = 0;
  /// Share of the tets that go by the linear law of adaptive precision; where that has a share, so much of a tet [-].
  virtual double linear_share() const { return 0.0; }
  /// Stress of each element and Maxwell branch of a block at the present state: what is not relaxed yet [Pa].
  virtual std::vector<Sym3<double>> branch_stresses(std::size_t block) = 0;
  virtual void set_branch_stresses(std::size_t block, std::span<const Sym3<double>> stresses) = 0;

  /// Adds vertices to those active; one that is active already stays so.
  /// @param apart  whose elastic and viscous forces are asked for one by one, ascending; of others, unless a step is
  ///               accounted, `elastic` may be both
  virtual void watch(std::span<const std::uint32_t> vertices, std::span<const std::uint32_t> apart) = 0;
  /// Takes all others from those active; they go on from where active() last placed them.
  /// @param vertices  ascending, all of them active
  virtual void watch_only(std::span<const std::uint32_t> vertices) = 0;
  /// In ascending order of vertex.
  virtual std::span<ActiveVertex> active() = 0;
  /// Brings vertices to rest where they are, and lets all others go that rested; in force until the next call.
  /// @param vertices  ascending
  virtual void rest(std::span<const std::uint32_t> vertices) = 0;
  /// Those at rest, ascending, with the force of the tissue at the last advance; who adds to it may do so in place.
  virtual std::span<RestingVertex> resting() = 0;
  /// Takes displacement and velocity of every active vertex over from active().
  virtual void place_active() = 0;

  /// Velocities that stages of drag leave as they are, in force until the next call.
  /// @param components  3 i + axis per vertex: 1 where a support or motion holds it
  virtual void hold_in_stages(std::span<const char> components) = 0;
  /// Forces from outside in the last step, which stages of drag go by, too. @param outer  per active vertex [N]
  virtual void push_in_stages(std::span<const Vec3d> outer) = 0;
  /// What instruments hold, for the next advance(); null: nothing.
  virtual void project_stages(engine::StageHolds* holds) = 0;

  /// @param vertex  whose copy among active(), where it has one, is to be given the same
  virtual void set_velocity(std::uint32_t vertex, const Vec3d& velocity) = 0;
  /// Follows Body::stiff_mass where that has changed. @param vertices  where
  virtual void inertia_changed(std::span<const std::uint32_t> vertices) = 0;

  /// Lets advance() list elements that are stiffer than this.
  /// @param stiffening  per tissue block [-]
  /// @param single  per element, which are above that; empty: none is. Must outlive the next advance()
  virtual void list_above(std::span<const double> stiffening, std::span<const StiffLimit> single) = 0;

  /// One step of h [s] under `gravity` [m/s²]; h = 0 evaluates the forces and moves nothing.
  /// @param accounted  whether to fill `work`
  /// The result is valid until the next call.
  virtual const Advance& advance(double h, const Vec3d& gravity, bool accounted) = 0;
};

}  // namespace glisson
