// membrane_lanes.cpp — forces of a sheet, compiled once for each instruction set; formulas as in membrane.h.
//
//   gather edges of eight triangles ─▶ strain, tension, K = A G S Gᵀ in lanes ─▶ add forces, one triangle after the other
#include "instruments/capsule/membrane_lanes.h"
#include "engine/kernels/targets.h"
#include "glisson/simulation/instruction_set.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "instruments/capsule/membrane_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace glisson::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, MembraneBlock::kSize>;
using V = hn::Vec<Tag>;
using Lanes = MembraneBlock::Lanes;

/// Edges of eight triangles from their first corners, by component.
struct Edges {
  alignas(64) Lanes x1, y1, z1, x2, y2, z2;
};

HWY_INLINE void gather(const MembraneBlock& b, const Vec3d* positions, Edges& e) {
  for (std::size_t k = 0; k < MembraneBlock::kSize; ++k) {
    const Vec3d &p = positions[b.corner[0][k]], &q = positions[b.corner[1][k]], &r = positions[b.corner[2][k]];
    e.x1[k] = q.x - p.x, e.y1[k] = q.y - p.y, e.z1[k] = q.z - p.z;
    e.x2[k] = r.x - p.x, e.y2[k] = r.y - p.y, e.z2[k] = r.z - p.z;
  }
}

HWY_INLINE void scatter(const MembraneBlock& b, const Edges& f, Vec3d* forces) {
  for (std::size_t k = 0; k < MembraneBlock::kSize; ++k) {
    const Vec3d f1{f.x1[k], f.y1[k], f.z1[k]}, f2{f.x2[k], f.y2[k], f.z2[k]};
    forces[b.corner[0][k]] += f1 + f2;
    forces[b.corner[1][k]] -= f1;
    forces[b.corner[2][k]] -= f2;
  }
}

struct Largest {
  V frequency, modulus, squared_tension;
};

/// What the triangles from lane `i` on pull their second and third corners back with, in place of their edges.
template <bool kStiffens>
HWY_INLINE void pull(const MembraneFactors& c, MembraneBlock& b, std::size_t i, Edges& e, Largest& largest) {
  const Tag d;
  const auto set = [d](double a) HWY_ATTR { return hn::Set(d, a); };
  const auto mul = [](auto p, auto q) HWY_ATTR { return hn::Mul(p, q); };
  const auto add = [](auto p, auto q) HWY_ATTR { return hn::Add(p, q); };
  const V half = set(0.5), one = set(1.0), two = set(2.0), zero = hn::Zero(d);
  const V x1 = hn::Load(d, &e.x1[i]), y1 = hn::Load(d, &e.y1[i]), z1 = hn::Load(d, &e.z1[i]);
  const V x2 = hn::Load(d, &e.x2[i]), y2 = hn::Load(d, &e.y2[i]), z2 = hn::Load(d, &e.z2[i]);
  const V g00 = hn::Load(d, &b.g00[i]), g01 = hn::Load(d, &b.g01[i]), g11 = hn::Load(d, &b.g11[i]);
  const V area = hn::Load(d, &b.area[i]);

  // E = ½ (Gᵀ (edges · edges) G − 1), its mean and radius on Mohr's circle
  const V p = add(add(mul(x1, x1), mul(y1, y1)), mul(z1, z1));
  const V q = add(add(mul(x1, x2), mul(y1, y2)), mul(z1, z2));
  const V r = add(add(mul(x2, x2), mul(y2, y2)), mul(z2, z2));
  const V along = add(mul(g01, p), mul(g11, q)), across = add(mul(g01, q), mul(g11, r));
  const V e11 = mul(half, hn::Sub(mul(mul(g00, g00), p), one));
  const V e12 = mul(half, mul(g00, along));
  const V e22 = mul(half, hn::Sub(add(mul(g01, along), mul(g11, across)), one));
  const V mean = mul(half, add(e11, e22)), side = mul(half, hn::Sub(e11, e22));
  const V radius = hn::Sqrt(add(mul(side, side), mul(e12, e12)));
  const V e1 = add(mean, radius), e2 = hn::Sub(mean, radius);

  // S / (E_Y t e^{αQ}) = a E + b 1
  const auto taut = hn::Gt(add(e2, mul(set(c.nu), e1)), zero);
  const auto pulled = hn::Gt(e1, zero);
  const V fold = hn::Div(mul(half, e1), hn::Max(radius, set(1e-300)));
  const V s_e = hn::IfThenElseZero(pulled, hn::IfThenElse(taut, set(c.shear), fold));
  const V folded = hn::Sub(mul(half, e1), mul(fold, mean));
  const V s_1 = hn::IfThenElseZero(pulled, hn::IfThenElse(taut, mul(set(c.bulk), mean), folded));
  const V s1 = add(mul(s_e, e1), s_1);
  V factor = set(c.stiffness), modulus = set(c.modulus);
  if constexpr (kStiffens) {
    const V s2 = add(mul(s_e, e2), s_1), square = add(mul(s1, e1), mul(s2, e2));
    factor = mul(factor, hn::Exp(d, hn::Min(mul(set(c.alpha), square), set(c.most_exponent))));
    modulus = add(modulus, mul(set(2.0 * c.alpha), add(mul(s1, s1), mul(s2, s2))));
  }

  const V stretch = add(one, mul(two, hn::Max(e1, zero))), tension = mul(factor, s1);
  const auto bears = hn::Gt(area, zero);
  const V squared = hn::IfThenElseZero(bears, mul(stretch, mul(tension, tension)));
  // |F D Fᵀ| + 2 |S|: across the sheet S acts alone, on modes that are up to 1 + ν times as fast for their modulus
  modulus = hn::IfThenElseZero(bears, mul(factor, add(mul(modulus, stretch), mul(two, s1))));
  hn::Store(squared, d, &b.squared_tension[i]);
  hn::Store(modulus, d, &b.modulus[i]);
  largest.squared_tension = hn::Max(largest.squared_tension, squared);
  largest.modulus = hn::Max(largest.modulus, modulus);
  largest.frequency = hn::Max(largest.frequency, mul(modulus, hn::Load(d, &b.rate[i])));

  // ∂(A W)/∂edges = edges K, K = A G S Gᵀ
  const V scale = mul(area, factor);
  const V s11 = add(mul(s_e, e11), s_1), s12 = mul(s_e, e12), s22 = add(mul(s_e, e22), s_1);
  const V gs1 = add(mul(g00, s11), mul(g01, s12)), gs2 = add(mul(g00, s12), mul(g01, s22));
  const V k11 = mul(scale, add(mul(gs1, g00), mul(gs2, g01)));
  const V k12 = mul(scale, mul(gs2, g11));
  const V k22 = mul(scale, mul(s22, mul(g11, g11)));
  hn::Store(add(mul(x1, k11), mul(x2, k12)), d, &e.x1[i]);
  hn::Store(add(mul(y1, k11), mul(y2, k12)), d, &e.y1[i]);
  hn::Store(add(mul(z1, k11), mul(z2, k12)), d, &e.z1[i]);
  hn::Store(add(mul(x1, k12), mul(x2, k22)), d, &e.x2[i]);
  hn::Store(add(mul(y1, k12), mul(y2, k22)), d, &e.y2[i]);
  hn::Store(add(mul(z1, k12), mul(z2, k22)), d, &e.z2[i]);
}

template <bool kStiffens>
MembraneSums forces(const MembraneFactors& factors, MembraneBlock* blocks, std::size_t count, const Vec3d* positions,
                    Vec3d* sums) {
  const Tag d;
  Largest largest{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  Edges edges;
  for (std::size_t n = 0; n < count; ++n) {
    gather(blocks[n], positions, edges);
    for (std::size_t i = 0; i < MembraneBlock::kSize; i += hn::Lanes(d)) {
      pull<kStiffens>(factors, blocks[n], i, edges, largest);
    }
    scatter(blocks[n], edges, sums);
  }
  const auto most = [d](V v) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(d, v)); };
  return {most(largest.frequency), most(largest.modulus), most(largest.squared_tension)};
}

MembraneSums linear_forces(const MembraneFactors& f, MembraneBlock* b, std::size_t n, const Vec3d* x, Vec3d* sums) {
  return forces<false>(f, b, n, x, sums);
}
MembraneSums stiffening_forces(const MembraneFactors& f, MembraneBlock* b, std::size_t n, const Vec3d* x, Vec3d* sums) {
  return forces<true>(f, b, n, x, sums);
}

}  // namespace

MembraneForces kernel_for(bool stiffens) { return stiffens ? stiffening_forces : linear_forces; }

}  // namespace glisson::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace glisson {

HWY_EXPORT(kernel_for);

MembraneForces membrane_forces(bool stiffens) {
  cpu::use_instruction_set_of_environment();
  return HWY_DYNAMIC_DISPATCH(kernel_for)(stiffens);
}

}  // namespace glisson
#endif
