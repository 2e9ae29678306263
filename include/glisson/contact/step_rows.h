// step_rows.h — what a tool wants of the body at the end of a step: rows, which one solver meets together with those of all other tools.
//
//   declare(step, rows)  ──▶  rows of all tools  ──▶  one solver  ──▶  solved(step, rows): the impulses found
//
// Where two tools act on the same vertices, neither undoes the other, and the order in which they were attached does not matter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "glisson/math.h"

namespace glisson {

struct RowGroup;
struct ToolVelocity;
enum class WorkSink;

/// The rows of one tool in a step; the engine empties it before declare().
class StepRows {
 public:
  StepRows();
  ~StepRows();
  StepRows(StepRows&&) noexcept;
  StepRows& operator=(StepRows&&) noexcept;

  /// Holds a vertex: it ends the step with this velocity, whatever impulse that takes; components that a support holds stay.
  /// Where several tools hold a vertex, it gets the mean of what they want.
  /// @param place  among the active vertices @param velocity  [m/s] @param tool  of the tool's material there, for the energy ledger
  /// @return its number, for holding_impulse()
  std::size_t hold(std::uint32_t place, const Vec3d& velocity, const ToolVelocity& tool);
  /// Gives a vertex an impulse [N s], in the components that may move. @param sink  where work goes that the tissue does not receive
  void push(std::uint32_t place, const Vec3d& impulse, WorkSink sink, const ToolVelocity& tool);
  /// What a held vertex was given, in solved() [N s]. @throws std::out_of_range
  Vec3d holding_impulse(std::size_t row) const;
  std::size_t hold_count() const;

  RowGroup& group() { return *group_; }  ///< for the engine's own tools
  const RowGroup& group() const { return *group_; }

 private:
  std::unique_ptr<RowGroup> group_;
};

}  // namespace glisson
