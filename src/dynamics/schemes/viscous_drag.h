// viscous_drag.h — the viscous force within an explicit step: at v₋, or in stages from there on (element/drag_stages.h).
//
// The body knows how to take the force. In stages it is told what supports, motions and interactions hold, and what tools and loads pushed
// in the last step: tissue within a step moves by that, too.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/state/active_kick.h"
#include "dynamics/state/body_state.h"
#include "dynamics/state/interactions.h"
#include "engine/moving_body.h"
#include "engine/stage_holds.h"
#include "glisson/archive.h"

namespace glisson {

/// Taken at v₋, with nothing to tell.
class ViscousDrag {
 public:
  virtual ~ViscousDrag() = default;
  /// The body is about to move; who is active is known.
  virtual void begin(MovingBody& /*moving*/) {}
  /// Active vertices have the forces of the tissue, and no others yet.
  virtual void tissue_pushed(std::span<const ActiveVertex> /*active*/) {}
  /// They have been kicked.
  virtual void end(std::span<const ActiveVertex> /*active*/, const ActiveKick& /*kick*/,
                   const Interactions& /*interactions*/) {}
  /// Other vertices are active. @param before, active  ascending
  virtual void follow(std::span<const std::uint32_t> /*before*/, std::span<const ActiveVertex> /*active*/) {}
  /// The body is another one.
  virtual void body_changed() {}
  /// A state was set from outside: what acted on the last one is forgotten.
  virtual void state_set() {}
  virtual void archive(Archive& /*ar*/, std::size_t /*active_count*/) {}
};

class StagedDrag final : public ViscousDrag {
 public:
  /// @param state  must outlive this
  explicit StagedDrag(const BodyState& state) : state_(state) {}

  void begin(MovingBody& moving) override;
  void tissue_pushed(std::span<const ActiveVertex> active) override;
  void end(std::span<const ActiveVertex> active, const ActiveKick& kick, const Interactions& interactions) override;
  void follow(std::span<const std::uint32_t> before, std::span<const ActiveVertex> active) override;
  void body_changed() override { told_.reset(); }
  void state_set() override;
  void archive(Archive& ar, std::size_t active_count) override;

 private:
  void tell_held(MovingBody& moving);
  void tell_rows(MovingBody& moving);

  const BodyState& state_;
  std::optional<std::vector<char>> told_;  ///< per constraint: whether the body knows that it holds; none: tell it anew
  std::vector<char> held_components_;      ///< 3 a vertex: as it knows them
  HeldRows rows_;                          ///< what interactions held in the last step
  std::vector<Vec3d> outer_;               ///< per active vertex, of tools and loads then; empty: none yet [N]
  std::vector<Vec3d> tissue_;              ///< the tissue's own forces [N]
  std::vector<Vec3d> outer_before_, inverse_mass_;  ///< memory of follow(), and of tell_rows() [N], [1/kg]
  engine::StageHolds holds_;
};

/// What the options ask for. @param state  must outlive it
inline std::unique_ptr<ViscousDrag> make_viscous_drag(const BodyState& state) {
  if (state.options.drag_stages > 1) return std::make_unique<StagedDrag>(state);
  return std::make_unique<ViscousDrag>();
}

}  // namespace glisson
