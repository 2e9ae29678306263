#include "instruments/ice/ice_state.h"

#include <algorithm>
#include <cmath>

#include "glisson/archive.h"

namespace glisson {

// With G = ∇x and M = Σ s_a s_aᵀ: tr(G)² ≤ tr M Σ |x|² and |sym G|² ≤ λ_max(M) Σ |x|².
double IceTet::stiffness_bound() const {
  Sym3<double> M{};
  for (const Vec3d& s : shape_gradients(rest))
    M += symmetric(outer(transposed(ice.inverse) * s, transposed(ice.inverse) * s));
  return rest.volume * ice.volume_ratio * ice.amount *
         (std::max(0.0, elastic.lambda) * trace(M) + 2.0 * elastic.mu * largest_eigenvalue(M));
}

void IceTet::archive(Archive& ar) {
  ar(number, corners, rest.volume, rest.s, elastic.lambda, elastic.mu, drag.lambda, drag.mu, share, ice);
}

void FrozenTets::lay_out(std::size_t tets_of_mesh, const std::vector<double>& masses) {
  place_of.assign(tets_of_mesh, 0);
  std::vector<double> bound(masses.size(), 0.0);
  std::vector<char> has(masses.size(), 0);
  for (std::uint32_t k = 0; k < tets.size(); ++k) {
    const IceTet& t = tets[k];
    place_of[t.number] = k + 1;
    const double d = t.stiffness_bound();
    for (const std::uint32_t v : t.corners) bound[v] += d, has[v] = 1;
  }
  vertices.clear(), bounds.clear();
  squared_frequency = 0.0;
  for (std::uint32_t v = 0; v < masses.size(); ++v) {
    if (has[v] == 0) continue;
    vertices.push_back(v), bounds.push_back(bound[v]);
    if (masses[v] > 0.0) squared_frequency = std::max(squared_frequency, bound[v] / masses[v]);
  }
}

/// Goes on with other tets; displacements of the last evaluation come next.
void Ice::State::replace(FrozenTets next) {
  next.lay_out(tet_count, *masses);
  is_renamed = is_renamed || next.vertices != frozen->vertices;
  frozen = std::make_shared<const FrozenTets>(std::move(next));
  H.assign(frozen->tets.size(), Mat3d{}), Hdot.assign(frozen->tets.size(), Mat3d{});
}

/// Freezes or thaws a tet, and books what that changes of its energy.
void Ice::State::set_share(IceTet& tet, const Mat3d& H_now, double share) {
  const Sym3<double> strain = ice_strain(tet.ice, H_now);
  const double before = ice_energy(tet.ice, strain, tet.elastic);
  set_amount(tet.ice, strain, tet.elastic, share * (options.factor - 1.0));
  const double grown = 0.5 * (std::pow(1.0 + options.expansion, 2.0 / 3.0) - 1.0) * (share - tet.share);
  tet.ice.relaxed += Sym3<double>{grown, grown, grown, 0.0, 0.0, 0.0};
  tet.share = share;
  changed += tet.rest.volume * (ice_energy(tet.ice, strain, tet.elastic) - before);
}

}  // namespace glisson
