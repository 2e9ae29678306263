// tissue_change.cpp — Scheme::set_tissues: exchanges the tissues of a body that moves, or leaves all as it was.
#include "dynamics/state/tissue_change.h"

#include <algorithm>
#include <stdexcept>

#include "dynamics/schemes/scheme.h"
#include "dynamics/step/mass_scaling.h"
#include "element/block_response.h"

namespace glisson {
namespace {

/// Which law an optional one is; 0 for none.
template <class Law>
std::size_t kind(const std::optional<Law>& law) {
  return law ? 1 + law->index() : 0;
}

/// What a change of tissues changes in a body.
struct Former {
  std::vector<TissueBlock> blocks;
  std::vector<double> masses, mass_factor;
  MassScaling scaling;
};

}  // namespace

std::vector<Sym3<double>> carried_stresses(std::span<const Sym3<double>> stresses, std::size_t elements,
                                           std::size_t before, std::size_t after) {
  std::vector<Sym3<double>> carried(elements * after);
  for (std::size_t e = 0; e < elements; ++e) {
    for (std::size_t k = 0; k < std::min(before, after); ++k) carried[e * after + k] = stresses[e * before + k];
  }
  return carried;
}

bool differ_by_values(const Tissue& a, const Tissue& b) {
  return a.law.index() == b.law.index() && kind(a.lambda_law) == kind(b.lambda_law) &&
         kind(a.mu_law) == kind(b.mu_law) && kind(a.hyperelastic) == kind(b.hyperelastic) && a.measure == b.measure &&
         a.kinematics == b.kinematics && a.law_form == b.law_form && a.fibres.has_value() == b.fibres.has_value() &&
         a.maxwell.size() == b.maxwell.size() && a.maxwell_part == b.maxwell_part &&
         a.volume_change == b.volume_change && a.viscous_tensor == b.viscous_tensor &&
         (a.viscosity > 0.0) == (b.viscosity > 0.0);
}

/// Kinetic energy and energy of the elastic forces of some blocks [J]. The ledger of an explicit scheme stands half a step
/// back: the work of the forces at u over that half is booked with those that come. For a quadratic energy
///   W(u) − ¼ [W(u + hv) − W(u − hv)] = W(u) − ½ h v·∂W(u)
/// is what makes its elastic energy that of the new tissue from there on, to rounding.
std::array<double, 2> Scheme::energy_of_blocks(std::span<const std::size_t> blocks) const {
  const std::span<const Vec3d> u = displacement(), v = velocity();
  const double h = booked_behind();
  std::vector<Vec3d> ahead(u.begin(), u.end()), back = ahead;
  for (std::size_t i = 0; i < ahead.size(); ++i) ahead[i] += v[i] * h, back[i] -= v[i] * h;
  std::array<double, 2> sum{};
  for (std::size_t i = 0; i < v.size(); ++i) sum[0] += 0.5 * body_.masses[i] * dot(v[i], v[i]);
  for (const std::size_t b : blocks) {
    const BlockResponse response(body_, body_.blocks[b]);
    sum[1] += response.energy(u);
    if (h > 0.0) sum[1] -= 0.25 * (response.energy(ahead) - response.energy(back));
  }
  return sum;
}

/// Gives blocks their tissues, and the vertices the masses that follow from them.
void Scheme::put_tissues(const BlockTissues& to) {
  bool heavier = options_.mass_scaling_step.has_value();
  for (const auto& [b, tissue] : to) {
    heavier = heavier || tissue.density != body_.blocks[b].tissue.density;
    body_.blocks[b] = make_block(tissue, body_.blocks[b].begin, body_.blocks[b].end);
  }
  if (!heavier) return;
  body_.mass_factor.clear();
  lump_masses(body_);
  mass_scaling_ = scaled_masses(body_, options_);
}

void Scheme::masses_changed() {
  for (std::size_t v = 0; v < gamma_.size(); ++v) {
    gamma_[v] = options_.damping_rate * body_.masses[v] + options_.nodal_damping;
  }
  if (changer_ != nullptr) changer_->masses_changed();
}

bool Scheme::set_tissues(const BlockTissues& to) {
  require_tissues(to);
  TissueChange change, back;
  const Former former{body_.blocks, body_.masses, body_.mass_factor, mass_scaling_};
  for (const auto& [b, tissue] : to) {
    const TissueBlock& block = body_.blocks[b];
    change.blocks.push_back(b), back.blocks.push_back(b);
    back.branch_stresses.push_back(branch_stresses(b));
    change.branch_stresses.push_back(carried_stresses(back.branch_stresses.back(), block.end - block.begin,
                                                      block.tissue.maxwell.size(), tissue.maxwell.size()));
  }
  if (options_.step) back.past = past();
  const bool booked = options_.track_energies;
  const std::array<double, 2> before = booked ? energy_of_blocks(change.blocks) : std::array<double, 2>{};
  put_tissues(to);
  masses_changed();
  const bool heavier = body_.masses != former.masses;
  const std::array<double, 2> after = booked ? energy_of_blocks(change.blocks) : std::array<double, 2>{};
  try {
    take_tissues(change);
  } catch (...) {
    body_.blocks = former.blocks, body_.masses = former.masses, body_.mass_factor = former.mass_factor;
    mass_scaling_ = former.scaling;
    masses_changed();
    take_back_tissues(back);
    throw;
  }
  if (booked) bring_in(heavier ? after[0] - before[0] : 0.0, after[1] - before[1]);
  return heavier;
}

}  // namespace glisson
