// step_solver.h — the one solver of a step: finds the impulses that meet the rows of all tools together.
//
//   declare, round 0 ─▶ islands ─▶ each: points ─▶ discs ─▶ shafts ─▶ holds ─┐ until none moves another ─▶ account ─▶ round 1 …
//                                    ▲_________________________________________│
//
// An island is tools whose rows share vertices: tools apart from each other are solved for apart. In an island rows are sorted by
// what they are of, never by the order in which tools were attached, and solved in turn (projected Gauss–Seidel), blocks at once. A
// row whose vertices have not moved since it was solved is not looked at. In a long step all tools are one island, and its rows are
// solved among themselves (coupled_rows.h).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "contact/island.h"
#include "contact/push_clock.h"
#include "contact/step_mobility.h"
#include "glisson/simulation/interaction.h"

namespace glisson {

class StepSolver {
 public:
  using Tools = std::span<const std::shared_ptr<Interaction>>;

  /// Begins a step, before the tissue's forces are applied: the velocities are v₋.
  void begin(const InteractionStep& step);
  /// Asks all tools for their rows, meets them, and hands the impulses back.
  void solve(Tools tools, const InteractionStep& step);
  /// The same in a long step, where all vertices move one another. @param most  sweeps over the rows @return sweeps that it took
  int solve_coupled(Tools tools, const InteractionStep& step, StepMobility& mobility, int most);
  /// Adds what the rows of this step hold.
  void list_held(const InteractionStep& step, HeldRows& held) const;
  /// Whether some rows of this step could not be met, as those of two walls that close on a vertex.
  bool is_unmet() const { return is_unmet_; }
  /// Whether a tool that a force moves ends elsewhere than its rows were declared for. @param share  as ToolYield::moves_on
  bool moves_on(double share) const;
  /// Whether the impulses of a long step no longer changed at the end.
  bool has_settled() const { return has_settled_; }
  /// Whether these meet all rows, or nearly, or no impulses do.
  bool is_found() const { return is_found_; }

 private:
  void fit(std::size_t tools);
  RowGroup& group(std::size_t tool) { return rows_[tool].group(); }
  bool declare(Tools tools, const InteractionStep& step, int round);
  void find_islands(const InteractionStep& step);
  std::uint32_t first_of(std::uint32_t tool) const;
  void mark(std::uint32_t tool, std::uint32_t place);
  void gather(Island& island, const InteractionStep& step);
  void join_holds(Island& island);
  void solve(Island& island, const InteractionStep& step);
  void begin_rows(Island& island, const InteractionStep& step);
  int settle(Island& island, const InteractionStep& step);
  int settle_together(Island& island, const InteractionStep& step, double enough);
  void go_further(Island& island, std::span<const Vec3d> before, double share, const InteractionStep& step);
  double sweep_others(Island& island, const InteractionStep& step);
  static double most_missed(const Island& island, const InteractionStep& step);
  void share_out(Island& island);
  void book(const RowGroup& rows, const InteractionStep& step) const;
  void book(const InteractionStep& step);

  std::vector<StepRows> rows_;      ///< per tool
  std::vector<std::size_t> known_;  ///< rows per tool before this round
  std::vector<Vec3d> before_;       ///< v₋ per place [m/s]
  std::vector<Island> islands_;
  std::size_t island_count_ = 0;
  std::vector<std::uint32_t> owner_;   ///< per place: a tool that acts there, or none
  std::vector<std::uint32_t> merged_;  ///< per tool: the first of its island, or one nearer to it
  PushClock clock_;
  std::vector<InterfaceBook> books_;  ///< of each tool that acts
  bool is_unmet_ = false, has_settled_ = true, is_found_ = true;
};

}  // namespace glisson
