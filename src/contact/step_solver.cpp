#include "contact/step_solver.h"

#include "contact/coupled_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>

namespace glisson {
namespace {

constexpr int kMostRounds = 12;        ///< of declaring rows in a step
constexpr int kMostLongSweeps = 1000;  ///< of a round in a long step
constexpr int kMostTurns = 400;        ///< of the laws of an island
constexpr int kLook = 20;              ///< after so many of several tools it is looked at …
constexpr double kStalls = 1e-5;       ///< … whether rows move as far as a turn before, but for this share …
constexpr double kStallsSince = 1e-3;  ///< … and as far as when it was looked at last
constexpr double kFarOff =
    20.0;  ///< tolerances: rows that miss their places by more after the last turn have not been met
constexpr double kHelps = 0.7;         ///< a jump that leaves more of it than that has not helped
constexpr double kFarthest = 1000.0;   ///< of what a turn has changed: so far impulses are taken at once
constexpr double kHeldWithin = 1e-13;  ///< of where it is to end: such a vertex is held [m]
constexpr std::uint32_t kNoTool = std::numeric_limits<std::uint32_t>::max();

/// What a row of points is known by, whoever declared it.
auto key_of(const ContactRow& row) {
  const auto numbers = [](const Vec3d& x) { return std::array{x.x, x.y, x.z}; };
  return std::tuple(row.count, row.places, row.weights, numbers(row.normal), numbers(row.carried), row.level,
                    row.allowance, row.solid->friction);
}

auto key_of(const DiscRow& row) {
  return std::tuple(row.places, row.weights, row.velocity.x, row.velocity.y, row.velocity.z);
}

auto key_of(const GivenRow& row) { return std::tuple(row.place, row.impulse.x, row.impulse.y, row.impulse.z); }

auto key_of(const shaft::Block& block) {
  const shaft::Row& row = *block.rows.front();
  return std::tuple(row.rest.x, row.rest.y, row.rest.z, block.direction.x, block.direction.y, block.direction.z);
}

/// Of the tool's material where a row acts.
ToolVelocity tool_velocity(const ContactRow& row, const InteractionStep& step) {
  const ContactSolid& solid = *row.solid;
  if (solid.still) return {};
  if (!step.is_long) return solid.velocity_at(row.origin, step.h);
  Pose after = solid.after;
  if (solid.yields != nullptr) after.position += solid.yields->shift;
  Vec3d x = row.origin;
  for (std::uint32_t i = 0; i < row.count; ++i) {
    x += step.vertices[row.places[i]].velocity * (row.weights[i] * step.h);
  }
  const Vec3d velocity = (x - solid.before.to_space(after.to_own(x))) * (1.0 / step.h);
  return {velocity, velocity};
}

/// The same of a tool without rows of points. @param yields  as in its rows
ToolVelocity with_shift(ToolVelocity tool, const ToolYield* yields, double h) {
  if (yields == nullptr) return tool;
  const Vec3d more = yields->shift * (1.0 / h);
  return {tool.before + more, tool.after + more};
}

template <class Row>
void sort_rows(std::vector<Row*>& rows) {
  std::stable_sort(rows.begin(), rows.end(), [](const Row* a, const Row* b) { return key_of(*a) < key_of(*b); });
}

/// Rows of points by their places, and there by tools; those of one tool at one place stay in its order, as of a vertex in the corner of a
/// container, where it decides what each wall bears.
void sort_points(std::vector<ContactRow*>& rows) {
  const auto place_of = [](const ContactRow* row) { return std::tie(row->count, row->places, row->weights); };
  std::stable_sort(rows.begin(), rows.end(), [&](const auto* a, const auto* b) { return place_of(a) < place_of(b); });
  for (auto first = rows.begin(), end = first; first != rows.end(); first = end) {
    end = std::find_if(first, rows.end(), [&](const auto* row) { return place_of(row) != place_of(*first); });
    if (end - first == 1) continue;
    const auto least = [&](const ContactRow* row) {  // of its tool here
      auto least_key = key_of(*row);
      for (auto other = first; other != end; ++other) {
        if ((*other)->tool == row->tool) least_key = std::min(least_key, key_of(**other));
      }
      return least_key;
    };
    std::stable_sort(first, end, [&](const auto* a, const auto* b) { return least(a) < least(b); });
  }
}

template <class Do>
void for_places(const RowGroup& group, const InteractionStep& step, const Do& act) {
  for (const ContactRow& row : group.points) {
    for (const std::uint32_t place : places_of(row)) act(place);
  }
  for (const HoldRow& row : group.holds) act(row.place);
  for (const GivenRow& row : group.pushes) act(row.place);
  for (const DiscRow& row : group.discs) {
    for (const std::uint32_t place : row.places) act(place);
  }
  if (!group.shaft) return;
  for (const shaft::Row* row : group.shaft->rows) {
    for (const VertexWeight& w : row->weights) act(step.place_of[w.vertex]);
  }
}

}  // namespace

void StepSolver::begin(const InteractionStep& step) {
  before_.clear();
  for (const ActiveVertex& w : step.vertices) before_.push_back(w.velocity);
}

void StepSolver::fit(std::size_t tools) {
  while (rows_.size() < tools) rows_.emplace_back();
  known_.assign(tools, 0);
}

/// @return whether some tool has more rows than before
bool StepSolver::declare(Tools tools, const InteractionStep& step, int round) {
  bool more = false, solids_act = false;
  for (std::size_t k = 0; k < tools.size(); ++k) {
    RowGroup& rows = group(k);
    if (round == 0) rows.clear();
    known_[k] = rows.size();
    solids_act = solids_act || !rows.points.empty() || !rows.holds.empty();
  }
  for (std::size_t k = 0; k < tools.size(); ++k) group(k).others_act = solids_act && known_[k] == 0;
  for (std::size_t i = 0; i < island_count_ && round > 0; ++i) {
    for (const std::size_t k : islands_[i].tools) group(k).others_act = islands_[i].tools.size() > 1;
  }
  for (std::size_t k = 0; k < tools.size(); ++k) {
    tools[k]->declare(step, rows_[k], round);
    more = more || group(k).size() > known_[k];
  }
  return more;
}

std::uint32_t StepSolver::first_of(std::uint32_t tool) const {
  while (merged_[tool] != tool) tool = merged_[tool];
  return tool;
}

/// A tool acts at a place: it is of the island of those that act there, too.
void StepSolver::mark(std::uint32_t tool, std::uint32_t place) {
  if (owner_[place] == kNoTool) {
    owner_[place] = tool;
    return;
  }
  const std::uint32_t a = first_of(owner_[place]), b = first_of(tool);
  merged_[std::max(a, b)] = std::min(a, b);
}

/// Tools that share vertices, directly or by others.
void StepSolver::find_islands(const InteractionStep& step) {
  merged_.resize(known_.size());
  std::vector<std::uint32_t> acting;
  for (std::uint32_t k = 0; k < merged_.size(); ++k) {
    merged_[k] = k;
    if (group(k).size() > 0) acting.push_back(k);
  }
  if (acting.size() > 1) {
    owner_.assign(step.vertices.size(), kNoTool);
    for (const std::uint32_t k : acting) for_places(group(k), step, [&](std::uint32_t place) { mark(k, place); });
  }
  island_count_ = 0;
  std::vector<std::uint32_t> of_tool(merged_.size(), kNoTool);
  for (const std::uint32_t k : acting) {
    std::uint32_t& number = of_tool[first_of(k)];
    if (number == kNoTool) {
      number = static_cast<std::uint32_t>(island_count_++);
      if (islands_.size() < island_count_) islands_.emplace_back();
      islands_[number].tools.clear();
    }
    islands_[number].tools.push_back(k);
  }
}

/// Lists the rows of an island; those of several tools in an order of their own.
void StepSolver::gather(Island& island, const InteractionStep& step) {
  island.points.clear(), island.discs.clear(), island.shafts.clear(), island.holds.clear(), island.pushes.clear();
  for (const std::size_t k : island.tools) {
    RowGroup& rows = group(k);
    for (ContactRow& row : rows.points) row.tool = k, island.points.push_back(&row);
    for (DiscRow& row : rows.discs) island.discs.push_back(&row);
    for (HoldRow& row : rows.holds) island.holds.push_back(&row);
    for (GivenRow& row : rows.pushes) island.pushes.push_back(&row);
    if (rows.shaft && !rows.shaft->rows.empty()) island.shafts.push_back(&*rows.shaft);
  }
  if (island.tools.size() == 1) return;
  sort_points(island.points);
  sort_rows(island.discs), sort_rows(island.shafts), sort_rows(island.pushes);
  for (shaft::Block* block : island.shafts) block->find_places(step);
  join_holds(island);
}

/// A vertex that several tools hold gets the mean of what they want.
void StepSolver::join_holds(Island& island) {
  island.joint.clear(), island.given_by.clear();
  std::stable_sort(island.holds.begin(), island.holds.end(), [](const HoldRow* a, const HoldRow* b) {
    return std::tuple(a->place, a->velocity.x, a->velocity.y, a->velocity.z) <
           std::tuple(b->place, b->velocity.x, b->velocity.y, b->velocity.z);
  });
  for (std::size_t first = 0, end = 0; first < island.holds.size(); first = end) {
    HoldRow joint;
    joint.place = island.holds[first]->place;
    for (end = first; end < island.holds.size() && island.holds[end]->place == joint.place; ++end) {
      joint.velocity += island.holds[end]->velocity, joint.impulse += island.holds[end]->impulse;
      island.given_by.emplace_back(island.holds[end], static_cast<std::uint32_t>(island.joint.size()));
    }
    joint.velocity *= 1.0 / static_cast<double>(end - first);
    island.joint.push_back(joint);
  }
  island.holds.clear();
  for (HoldRow& row : island.joint) island.holds.push_back(&row);
}

/// Each tool that holds a vertex bears the same part of what holds it.
void StepSolver::share_out(Island& island) {
  std::vector<int> parts(island.joint.size(), 0);
  for (const auto& [row, number] : island.given_by) ++parts[number];
  for (const auto& [row, number] : island.given_by) row->impulse = island.joint[number].impulse * (1.0 / parts[number]);
}

/// Impulses that rows begin with.
void StepSolver::begin_rows(Island& island, const InteractionStep& step) {
  for (GivenRow* row : island.pushes) {
    if (std::exchange(row->is_new, false)) step.push(row->place, row->impulse);
  }
  for (ContactRow* row : island.points) {
    row->solved_at = 0;
    if (std::exchange(row->is_new, false) && row->impulse() != Vec3d{}) push(*row, step, row->impulse());
  }
}

/// Discs, shafts and holds whose places have been pushed since they were solved. @return by how much one was moved at most [m]
double StepSolver::sweep_others(Island& island, const InteractionStep& step) {
  double most = 0.0;
  const auto meet = [&](auto& row, std::span<const std::uint32_t> places, const auto& solve_it) {
    if (row.solved_at != 0 && clock_.latest(places) <= row.solved_at) return;
    const double change = solve_it(row);
    if (change > 0.0) clock_.push(places);
    row.solved_at = clock_.now();
    most = std::max(most, change);
  };
  for (DiscRow* row : island.discs) meet(*row, row->places, [&](DiscRow& x) { return glisson::solve(x, step); });
  for (shaft::Block* block : island.shafts) meet(*block, block->places, [&](shaft::Block& x) { return x.solve(step); });
  for (HoldRow* row : island.holds) {
    meet(*row, {&row->place, 1}, [&](HoldRow& x) { return glisson::solve(x, step); });
  }
  return most;
}

/// Meets all rows of an island, as far as their impulses are not bounded otherwise. @return sweeps over the points
int StepSolver::settle(Island& island, const InteractionStep& step) {
  const double enough = island.enough();
  if (island.tools.size() > 1) return settle_together(island, step, enough);
  const int most = most_sweeps(island.points);
  const auto is_due = [&](const ContactRow* row) { return clock_.latest(places_of(*row)) > row->solved_at; };
  int sweeps = 0;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    if (std::any_of(island.points.begin(), island.points.end(), is_due)) {
      sweeps += sweep(island.points, step, clock_, most).sweeps;
    }
    if (sweep_others(island, step) <= enough) break;
  }
  return sweeps;
}

/// Rows of several tools in turn. Where they move each other as far in every turn, not all can be met: all yield then, each by the same
/// part of what its impulse moves its own point, and what is missed is shared among them. Where it becomes less by a little in
/// every turn, impulses are taken at once to where that leads [Aitken1926].
int StepSolver::settle_together(Island& island, const InteractionStep& step, double enough) {
  double last = 0.0, at_last_look = 0.0;
  bool is_soft = false;
  const bool can_yield = !island.points.empty() || !island.holds.empty();
  std::vector<Vec3d> before;
  for (int turn = 1; turn <= kMostTurns; ++turn) {
    const bool looks = turn % kLook == 0;
    before.clear();
    for (const ContactRow* row : island.points) {
      if (looks) before.push_back(row->impulse());
    }
    const double points = sweep(island.points, step, clock_, 1).change;
    const double change = std::max(points, sweep_others(island, step));
    if (change <= enough) return turn;
    const double ratio = change / last;
    last = change;
    if (!looks) continue;
    const bool stalls = std::abs(1.0 - ratio) < kStalls && std::abs(1.0 - at_last_look / change) < kStallsSince;
    const bool may_jump =
        at_last_look == 0.0 || change < kHelps * at_last_look;  // the last jump has led nowhere: on in turns
    at_last_look = change;
    if (!is_soft && stalls && can_yield) {
      island.soften();
      is_soft = is_unmet_ = true;
    } else if (may_jump && ratio < 1.0) {
      go_further(island, before, std::min(ratio / (1.0 - ratio), kFarthest), step);
    }
  }
  is_unmet_ = is_unmet_ || most_missed(island, step) > island.may_miss();
  return kMostTurns;
}

/// By how much a row ends elsewhere than it wants to [m].
double StepSolver::most_missed(const Island& island, const InteractionStep& step) {
  double most = glisson::most_missed(island.points, step);
  for (const HoldRow* row : island.holds) {
    const Vec3d off = row->velocity - step.vertices[row->place].velocity, &a = step.mobility[row->place];
    for (std::size_t i = 0; i < 3; ++i) most = std::max(most, a[i] > 0.0 ? std::abs(off[i]) * step.h : 0.0);
  }
  return most;
}

/// Takes impulses of the points further by so much of what the last turn has changed, as far as their laws go.
void StepSolver::go_further(Island& island, std::span<const Vec3d> before, double share, const InteractionStep& step) {
  for (std::size_t k = 0; k < island.points.size(); ++k) {
    ContactRow& row = *island.points[k];
    const Vec3d now = row.impulse();
    if (row.pressing == 0.0 || now == before[k]) continue;
    row.take(now + (now - before[k]) * share);
    if (!row.solid->holds) row.pressing = std::max(0.0, row.pressing);
    const double most = row.solid->friction > 0.0 ? row.solid->friction * std::max(0.0, row.pressing) : 0.0;
    if (const double size = norm(row.rubbing); size > most) row.rubbing *= most / size;
    push(row, step, row.impulse() - now);
    clock_.push(places_of(row));
    row.solved_at = 0;
  }
}

/// Rows that give the body more than their tool's contact has taken from it are solved for anew, and then made smaller.
void StepSolver::solve(Island& island, const InteractionStep& step) {
  gather(island, step);
  begin_rows(island, step);
  for (ContactRow* row : island.points) row->most.reset();
  int sweeps = settle(island, step);
  const auto is_overdrawn = [&](std::size_t tool) {
    const RowGroup& rows = group(tool);
    return rows.account != nullptr && !rows.points.empty() && rows.account->is_overdrawn(rows.points, before_, step);
  };
  std::vector<std::size_t> overdrawn;
  std::copy_if(island.tools.begin(), island.tools.end(), std::back_inserter(overdrawn), is_overdrawn);
  if (!overdrawn.empty()) {
    for (ContactRow* row : island.points) row->solved_at = 0;
    for (const std::size_t k : overdrawn) {
      begin_anew(group(k).points, before_, step);
      for (const ContactRow& row : group(k).points) clock_.push(places_of(row));
      group(k).corrected = true;
    }
    sweeps += settle(island, step);
    for (const std::size_t k : overdrawn) {
      if (is_overdrawn(k)) shrink(group(k).points, before_, step);
    }
  }
  if (!island.joint.empty() && island.tools.size() > 1) share_out(island);
  for (const std::size_t k : island.tools) group(k).last_sweeps = sweeps, group(k).sweeps += sweeps;
}

void StepSolver::solve(Tools tools, const InteractionStep& step) {
  fit(tools.size());
  clock_.fit(step.vertices.size());
  is_unmet_ = false;
  for (int round = 0; round < kMostRounds && declare(tools, step, round); ++round) {
    find_islands(step);
    for (Island& island : std::span(islands_).first(island_count_)) {
      const auto has_new = [&](std::size_t k) { return group(k).size() > known_[k]; };
      if (std::any_of(island.tools.begin(), island.tools.end(), has_new)) solve(island, step);
    }
  }
  for (std::size_t k = 0; k < tools.size(); ++k) {
    RowGroup& rows = group(k);
    if (rows.account != nullptr) rows.account->close(rows.points, before_, step);
  }
  book(step);
  for (std::size_t k = 0; k < tools.size(); ++k) tools[k]->solved(step, rows_[k]);
}

int StepSolver::solve_coupled(Tools tools, const InteractionStep& step, StepMobility& mobility, int most) {
  fit(tools.size());
  is_unmet_ = false, has_settled_ = is_found_ = true;
  if (islands_.empty()) islands_.emplace_back();
  Island& all = islands_.front();
  all.tools.clear(), island_count_ = 1;
  std::vector<Vec3d> free;
  for (const ActiveVertex& w : step.vertices) free.push_back(w.velocity);
  const auto for_yields = [&](const auto& act) {
    for (std::size_t k = 0; k < tools.size(); ++k) {
      if (group(k).yields != nullptr) act(*group(k).yields);
    }
  };
  int sweeps = 0;
  for (int round = 0; round < kMostRounds && declare(tools, step, round) && sweeps < most; ++round) {
    all.tools.clear();
    for (std::size_t k = 0; k < tools.size(); ++k) {
      if (group(k).size() > 0) all.tools.push_back(k);
    }
    gather(all, step);
    CoupledRows rows(all, step, mobility, free);
    const CoupledRows::Outcome outcome = rows.solve(std::min(most - sweeps, kMostLongSweeps));
    sweeps += outcome.sweeps;
    is_unmet_ = outcome.unmet, has_settled_ = outcome.settled, is_found_ = outcome.found;
    for_yields([](ToolYield& tool) { tool.begin(); });
    rows.finish(step.impulses);
    for_yields([](ToolYield& tool) { tool.end(); });
    mobility.set_velocities(step.impulses, step.vertices);
    if (!all.joint.empty()) share_out(all);
    for (const std::size_t k : all.tools) group(k).last_sweeps = outcome.sweeps, group(k).sweeps += outcome.sweeps;
    if (mobility.stops()) break;
  }
  if (all.tools.empty()) for_yields([](ToolYield& tool) { tool.begin(), tool.end(); });
  book(step);
  for (std::size_t k = 0; k < tools.size(); ++k) tools[k]->solved(step, rows_[k]);
  return sweeps;
}

bool StepSolver::moves_on(double share) const {
  return std::any_of(rows_.begin(), rows_.end(), [share](const StepRows& rows) {
    const ToolYield* tool = rows.group().yields;
    return tool != nullptr && tool->moves_on(share);
  });
}

/// Records the impulses of a tool in the energy ledger.
void StepSolver::book(const RowGroup& rows, const InteractionStep& step) const {
  for (const ContactRow& row : rows.points) {
    if (row.pressing == 0.0 && row.rubbing == Vec3d{}) continue;
    const ToolVelocity tool = tool_velocity(row, step);
    for (std::uint32_t i = 0; i < row.count; ++i) {
      step.book(WorkSink::contact, row.places[i], row.normal * (row.pressing * row.weights[i]), tool);
      step.book(WorkSink::friction, row.places[i], row.rubbing * row.weights[i], tool);
    }
  }
  for (const DiscRow& row : rows.discs) {
    for (std::size_t c = 0; c < 4; ++c) {
      step.book(WorkSink::fracture, row.places[c], row.impulse * row.weights[c],
                with_shift(row.tool[c], row.yields, step.h));
    }
  }
  if (rows.shaft) rows.shaft->book(step, with_shift(rows.shaft->tool, rows.shaft->yields, step.h));
  for (const HoldRow& row : rows.holds) {
    if (row.tool) step.book(WorkSink::contact, row.place, row.impulse, *row.tool);
  }
}

/// Several tools each in a book of its own first, which are then summed in an order of their own: sums do not depend on that of the tools.
void StepSolver::book(const InteractionStep& step) {
  if (step.interface_book == nullptr) return;
  std::vector<std::size_t> acting;
  for (std::size_t k = 0; k < known_.size(); ++k) {
    if (group(k).size() > 0) acting.push_back(k);
  }
  if (acting.size() == 1) return book(group(acting.front()), step);
  books_.resize(acting.size());
  for (std::size_t k = 0; k < acting.size(); ++k) {
    InteractionStep own = step;
    own.interface_book = &books_[k];
    books_[k].begin(step.vertices.size());
    book(group(acting[k]), own);
  }
  const auto key_of = [](const InterfaceBook& book) {
    std::array<double, 6> key{};
    for (std::size_t i = 0; i < 3; ++i)
      key[2 * i] = book.pages[i].tools_before, key[2 * i + 1] = book.pages[i].tools_after;
    return key;
  };
  std::stable_sort(books_.begin(), books_.end(), [&](const auto& a, const auto& b) { return key_of(a) < key_of(b); });
  for (const InterfaceBook& own : books_) step.interface_book->add(own);
}

void StepSolver::list_held(const InteractionStep& step, HeldRows& held) const {
  for (const StepRows& of_tool : rows_) {
    const RowGroup& rows = of_tool.group();
    for (const ContactRow& row : rows.points) glisson::list_held(row, step, held);
    for (const HoldRow& row : rows.holds) {
      const ActiveVertex& w = step.vertices[row.place];
      if (norm(w.velocity - row.velocity) * step.h <= kHeldWithin) held.add_vertex(w.vertex);
    }
    if (rows.shaft && !rows.shaft->rows.empty()) rows.shaft->list_held(step, held);
  }
}

}  // namespace glisson
