// step_rows.h — what a tool wants of the body at the end of a step: rows, which one solver meets together with those of all other tools.
//
//   declare(step, rows)  ──▶  rows of all tools  ──▶  one solver  ──▶  solved(step, rows): the impulses found
//
// Where two tools act on the same vertices, neither undoes the other, and the order in which they were attached does not matter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "glisson/math.h"

namespace glisson {

struct RowGroup;

/// Where the part of a tool's work goes that the tissue does not receive.
enum class WorkSink {
  contact,   ///< impulses along the normal: an impact, tissue that is pushed out
  friction,  ///< slip
  fracture   ///< cutting
};

/// Velocity of a tool's material at a point, before and after the time of the forces [m/s].
struct ToolVelocity {
  Vec3d before{};  ///< V₋, of the last step; 0 in the first
  Vec3d after{};   ///< V₊, of this step
};

/// A rigid half-space that moves in a step: what is outside of it lies in the direction of its normal.
struct Wall {
  Vec3d point{};          ///< on it, at the start of the step [m]
  Vec3d normal{0, 0, 1};  ///< outward; any length
  Vec3d velocity{};       ///< [m/s]
  double friction = 0.0;  ///< Coulomb's μ [-]
};

class InteractionStep;

/// The rows of one tool in a step; the engine empties it before declare().
class StepRows {
 public:
  StepRows();
  ~StepRows();
  StepRows(StepRows&&) noexcept;
  StepRows& operator=(StepRows&&) noexcept;

  /// Holds a vertex: it ends the step with this velocity, whatever impulse that takes; components that a support holds stay.
  /// Where several tools hold a vertex, it gets the mean of what they want.
  /// @param place  among the active vertices @param velocity  [m/s]
  /// @param tool  velocity of the tool's material there, for the energy ledger; none: it moves with the tissue
  /// @return its number, for holding_impulse()
  std::size_t hold(std::uint32_t place, const Vec3d& velocity, const std::optional<ToolVelocity>& tool = {});
  /// Keeps a vertex outside a wall at the end of the step, with Coulomb's friction; a vertex that does not come near gets no impulse.
  /// @return its number, for pressing_impulse()
  std::size_t press(const InteractionStep& step, std::uint32_t place, const Wall& wall);
  /// Gives a vertex an impulse [N s], in the components that may move; for the energy ledger by a tool that moves with the tissue.
  void push(std::uint32_t place, const Vec3d& impulse);
  /// What a held vertex was given, in solved() [N s]. @throws std::out_of_range
  Vec3d holding_impulse(std::size_t row) const;
  std::size_t hold_count() const;
  /// What the wall gave a vertex, in solved() [N s]. @throws std::out_of_range
  Vec3d pressing_impulse(std::size_t row) const;
  std::size_t press_count() const;

  RowGroup& group() { return *group_; }  ///< for the engine's own tools
  const RowGroup& group() const { return *group_; }

 private:
  std::unique_ptr<RowGroup> group_;
};

}  // namespace glisson
