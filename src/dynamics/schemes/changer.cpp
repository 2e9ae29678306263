#include "dynamics/schemes/changer.h"

#include <algorithm>

#include "dynamics/step/mass_scaling.h"
#include "element/block_response.h"
#include "element/tet_fields.h"

namespace glisson {
namespace {

/// What a change of tissues changes in a body.
struct Former {
  std::vector<TissueBlock> blocks;
  std::vector<double> masses, mass_factor;
  MassScaling scaling;
};

/// Stresses of branches that go on, by their place in the list; 0 for those that are new.
/// @param before, @param after  number of branches
std::vector<Sym3<double>> carried_stresses(std::span<const Sym3<double>> stresses, std::size_t elements,
                                           std::size_t before, std::size_t after) {
  std::vector<Sym3<double>> carried(elements * after);
  for (std::size_t e = 0; e < elements; ++e) {
    for (std::size_t k = 0; k < std::min(before, after); ++k) carried[e * after + k] = stresses[e * before + k];
  }
  return carried;
}

}  // namespace

/// Kinetic and elastic energy of elements with their shares of mass [J].
std::array<double, 2> Changer::energy_of(std::span<const std::uint32_t> elements) const {
  const Body& body = state_.body;
  std::array<double, 2> sum{};
  for (const std::uint32_t e : elements) {
    const TissueBlock& block = body.block_of(e);
    const double quarter = body.quarter_mass(block, e);
    std::array<Vec3d, 4> u;
    for (std::size_t a = 0; a < 4; ++a) {
      const std::uint32_t vertex = body.elements[e][a];
      const Vec3d v = scheme_.velocity_of(vertex);
      u[a] = scheme_.displacement_of(vertex);
      sum[0] += 0.5 * quarter * dot(v, v);
    }
    sum[1] += element_energy(body, block, e, u);
  }
  return sum;
}

/// Mass, momentum and energy of elements that are about to go.
void Changer::weigh(std::span<const std::uint32_t> elements, RemovalReport& report) {
  for (const std::uint32_t e : elements) {
    const double quarter = state_.body.quarter_mass(state_.body.block_of(e), e);
    for (const std::uint32_t vertex : state_.body.elements[e]) {
      report.mass += quarter;
      report.momentum += scheme_.velocity_of(vertex) * quarter;
    }
  }
  const auto [kinetic, elastic] = energy_of(elements);
  report.tets += elements.size();
  report.energy = kinetic + elastic;
  if (state_.options.track_energies) ledger_.take_out(kinetic, elastic);
}

void Changer::carry(const BodyChange& change) {
  if (change.touched.empty()) return;
  state_.damp(change.touched);
  scheme_.take_over(change);
}

/// Lets loads act on the body as it is now.
void Changer::follow_with_loads() {
  if (state_.loads.empty()) return;
  state_.loads.body_changed(state_.body);
  scheme_.loads_changed(false);
}

RemovalReport Changer::remove(std::span<const std::uint32_t> tets) {
  RemovalReport report;
  const std::vector<std::uint32_t> elements = state_.changer().living_elements(tets);
  weigh(elements, report);
  const BodyChange removal = state_.changer().remove(elements);
  carry(removal);
  follow_with_loads();
  for (const std::uint32_t v : removal.touched) {
    if (scheme_.stars().tets_at(v).empty()) report.loose_vertices.push_back(v);
  }
  state_.note_change();
  return report;
}

/// Lets motions that hold moved vertices count from where these are now.
void Changer::move_bases(std::span<const MovedVertex> moved) {
  for (const MovedVertex& m : moved) {
    for (std::size_t c = 0; c < state_.base.size(); ++c) {
      if (!state_.holds(c)) continue;
      const std::vector<std::uint32_t>& held = state_.constraints.all()[c].vertices;
      const auto at = std::find(held.begin(), held.end(), m.vertex) - held.begin();
      if (at == std::ssize(held)) continue;
      Vec3d& base = state_.base[c][static_cast<std::size_t>(at)];
      const Constraint& constraint = state_.constraints.all()[c];
      if (constraint.rigid) {
        base = Target(constraint, state_.time).base_of(state_.body.rest_positions[m.vertex], m.displacement);
      } else {
        base += m.displacement - scheme_.displacement_of(m.vertex);
      }
    }
  }
}

/// Lets copies be held, driven and loaded as their origins are.
void Changer::hold_copies(std::span<const std::uint32_t> origins) {
  state_.copies.insert(state_.copies.end(), origins.begin(), origins.end());
  const std::vector<std::vector<std::size_t>> copied = state_.constraints.add_copies(origins);
  state_.loads.add_copies(origins);
  for (std::size_t c = 0; c < copied.size(); ++c) {
    for (const std::size_t k : copied[c]) {
      if (state_.holds(c)) state_.base[c].push_back(Vec3d(state_.base[c][k]));
    }
  }
}

Changer::Split Changer::split(std::span<const Triangle> faces, std::span<const VertexMove> moves) {
  Split split;
  split.report.first_new = static_cast<std::uint32_t>(state_.body.vertex_count);
  const StateOf state = [this](std::uint32_t v) {
    return std::pair{scheme_.displacement_of(v), scheme_.velocity_of(v)};
  };
  const bool booked = state_.options.track_energies && !moves.empty();
  const auto around = booked ? state_.changer().elements_around(moves) : std::vector<std::uint32_t>{};
  const std::array<double, 2> before = energy_of(around);
  BodyChange opening = state_.changer().cut(faces, moves, state);
  move_bases(opening.moved);
  carry(opening);
  const std::array<double, 2> after = energy_of(around);
  if (booked) ledger_.take_out(before[0] - after[0], before[1] - after[1]);
  hold_copies(opening.origins);
  follow_with_loads();
  if (!opening.origins.empty()) scheme_.follow(opening.origins, split.report.first_new);
  for (const detail::CornerChange& c : opening.corners) split.changed.push_back(c.tet);
  split.report.closed_faces = state_.changer().closed_faces();
  split.report.origins = std::move(opening.origins);
  state_.note_change();
  return split;
}

/// Kinetic energy and energy of the elastic forces of some blocks [J]. The ledger of an explicit scheme stands half a step
/// back: the work of the forces at u over that half is booked with those that come. For a quadratic energy
///   W(u) − ¼ [W(u + hv) − W(u − hv)] = W(u) − ½ h v·∂W(u)
/// is what makes its elastic energy that of the new tissue from there on, to rounding.
/// @param memory  of the blocks, of which the linear law has its share; empty: it has none
std::array<double, 2> Changer::energy_of_blocks(std::span<const std::size_t> blocks,
                                                std::span<const BranchMemory> memory) const {
  const std::span<const Vec3d> u = scheme_.displacement(), v = scheme_.velocity();
  const double h = ledger_.pending_step();
  std::vector<Vec3d> ahead(u.begin(), u.end()), back = ahead;
  for (std::size_t i = 0; i < ahead.size(); ++i) ahead[i] += v[i] * h, back[i] -= v[i] * h;
  std::array<double, 2> sum{};
  for (std::size_t i = 0; i < v.size(); ++i) sum[0] += 0.5 * state_.body.masses[i] * dot(v[i], v[i]);
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const BlockResponse response(state_.body, state_.body.blocks[blocks[k]]);
    const BranchMemory* of = memory.empty() ? nullptr : &memory[k];
    sum[1] += response.energy(u, of);
    if (h > 0.0) sum[1] -= 0.25 * (response.energy(ahead, of) - response.energy(back, of));
  }
  return sum;
}

/// Gives blocks their tissues, and the vertices the masses that follow from them.
void Changer::put_tissues(const BlockTissues& to) {
  Body& body = state_.body;
  bool heavier = state_.options.mass_scaling_step.has_value();
  for (const auto& [b, tissue] : to) {
    heavier = heavier || tissue.density != body.blocks[b].tissue.density;
    body.blocks[b] = make_block(tissue, body.blocks[b].begin, body.blocks[b].end);
  }
  if (!heavier) return;
  body.mass_factor.clear();
  lump_masses(body);
  state_.mass_scaling = scaled_masses(body, state_.options);
}

bool Changer::set_tissues(const BlockTissues& to) {
  scheme_.require_tissues(to);
  TissueChange change, back;
  Body& body = state_.body;
  const Former former{body.blocks, body.masses, body.mass_factor, state_.mass_scaling};
  for (const auto& [b, tissue] : to) {
    const TissueBlock& block = body.blocks[b];
    change.blocks.push_back(b), back.blocks.push_back(b);
    back.branch_stresses.push_back(scheme_.branch_stresses(b));
    change.branch_stresses.push_back(carried_stresses(back.branch_stresses.back(), block.end - block.begin,
                                                      block.tissue.maxwell.size(), tissue.maxwell.size()));
  }
  if (state_.options.step) back.past = scheme_.past();
  const bool booked = state_.options.track_energies;
  std::vector<BranchMemory> memory;
  for (const std::size_t b : change.blocks) memory.push_back(scheme_.branch_memory(b));
  const std::array<double, 2> before = booked ? energy_of_blocks(change.blocks, memory) : std::array<double, 2>{};
  put_tissues(to);
  state_.masses_changed();
  const bool heavier = body.masses != former.masses;
  const std::array<double, 2> after = booked ? energy_of_blocks(change.blocks, {}) : std::array<double, 2>{};
  try {
    scheme_.take_tissues(change);
  } catch (...) {
    body.blocks = former.blocks, body.masses = former.masses, body.mass_factor = former.mass_factor;
    state_.mass_scaling = former.scaling;
    state_.masses_changed();
    scheme_.take_back_tissues(back);
    throw;
  }
  if (booked) ledger_.bring_in(heavier ? after[0] - before[0] : 0.0, after[1] - before[1]);
  if (heavier) follow_with_loads();
  state_.note_change();
  return heavier;
}

}  // namespace glisson
