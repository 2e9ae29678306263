// element_operator.cpp — the production element loop, in float or double.
//
// State comes in double; only differences of displacements enter the element, so that float arithmetic
// never meets a position (docs/theory.md §5). Per tissue block the law, the measure and the presence of
// viscosity are compile-time constants of the loop.
#include <algorithm>

#include "element/element_shape.h"
#include "element/force_operator.h"
#include "element/local_stiffness.h"

namespace glisson {
namespace {

template <class T>
struct KernelRest {
  T volume;
  std::array<Vec3<T>, 3> s;
};

/// Everything the loop over one block reads and writes.
template <class T>
struct BlockContext {
  const Tet* elements;
  const KernelRest<T>* rest;
  const EdgeMetric<T>* metric;  ///< only for the raw mean ratio
  const Vec3d* u;
  const Vec3d* v;
  Vec3d* elastic;
  Vec3d* viscous;
  const std::uint32_t* mesh_tet;
  ElementWatch* watch;
  double list_above;  ///< stiffening
};

template <class T>
std::array<Vec3<T>, 3> differences(const Tet& t, const Vec3d* value) {
  std::array<Vec3<T>, 3> d;
  const Vec3d& origin = value[t[0]];
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3d difference = value[t[a + 1]] - origin;
    d[a] = {T(difference.x), T(difference.y), T(difference.z)};
  }
  return d;
}

/// Adds f_a = −V σ s_a to the four vertices.
template <class T>
void scatter(const Tet& t, const KernelRest<T>& rest, const Sym3<T>& stress, Vec3d* force) {
  Vec3<T> sum{};
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3<T> f = (stress * rest.s[a]) * -rest.volume;
    force[t[a + 1]] += Vec3d{f.x, f.y, f.z};
    sum += f;
  }
  force[t[0]] -= Vec3d{sum.x, sum.y, sum.z};
}

/// The loop. `stiffness(H, e)` gives λ, μ and the tangent bound of element e.
template <bool kViscous, class T, class Stiffness>
T run_block(const BlockContext<T>& c, std::size_t begin, std::size_t end, LameParameters viscosity,
            const Stiffness& stiffness) {
  const T a = T(viscosity.lambda), b = T(viscosity.mu);
  T stiffening = T(0);
  for (std::size_t e = begin; e < end; ++e) {
    const Tet& t = c.elements[e];
    const KernelRest<T>& rest = c.rest[e];
    const Mat3<T> H = displacement_gradient(rest.s, differences<T>(t, c.u));
    if (!(jacobian(H) > T(0))) c.watch->inverted.push_back(c.mesh_tet[e]);
    const LocalStiffness<T> k = stiffness(H, e);
    stiffening = std::max(stiffening, k.stiffening);
    if (const auto r = static_cast<double>(k.stiffening); r > c.list_above) {
      c.watch->stiff.push_back({static_cast<std::uint32_t>(e), r, r});
    }
    scatter(t, rest, isotropic_stress(H, k.lambda, k.mu), c.elastic);  // [Schwartz2002, eq. 6]
    if constexpr (kViscous) {
      const Mat3<T> rate = displacement_gradient(rest.s, differences<T>(t, c.v));
      scatter(t, rest, isotropic_stress(rate, a, b), c.viscous);  // [Schwartz2002, eq. 7]
    }
  }
  return stiffening;
}

/// Chooses the loop for a law with a measure known at compile time.
template <DeformationMeasure M, bool kViscous, class T, class Moduli>
T run_with_measure(const BlockContext<T>& c, const TissueBlock& block, const Moduli& moduli) {
  return run_block<kViscous>(c, block.begin, block.end, block.viscous, [&](const Mat3<T>& H, std::size_t e) {
    constexpr bool kRaw = M == DeformationMeasure::regular_mean_ratio;
    return moduli(H, measure_value<M>(H, c.rest[e].volume, kRaw ? c.metric[e] : EdgeMetric<T>{}));
  });
}

template <bool kViscous, class T, class Moduli>
T run_with_law(const BlockContext<T>& c, const TissueBlock& block, const Moduli& moduli) {
  switch (block.tissue.measure) {
    case DeformationMeasure::intensity:
      return run_with_measure<DeformationMeasure::intensity, kViscous>(c, block, moduli);
    case DeformationMeasure::one_minus_q:
      return run_with_measure<DeformationMeasure::one_minus_q, kViscous>(c, block, moduli);
    case DeformationMeasure::regular_mean_ratio:
    case DeformationMeasure::radius_ratio:  // never a tensor mass
    case DeformationMeasure::solid_angle:
      break;
  }
  return run_with_measure<DeformationMeasure::regular_mean_ratio, kViscous>(c, block, moduli);
}

template <bool kViscous, class T>
T run_tissue(const BlockContext<T>& c, const TissueBlock& block) {
  const Tissue& tissue = block.tissue;
  if (tissue.lambda_law || tissue.mu_law) return run_with_law<kViscous>(c, block, LameStiffness<T>(block));
  return std::visit(
      [&]<class Law>(const Law& law) -> T {
        if constexpr (std::is_same_v<Law, ConstantLaw>) {
          const LocalStiffness<T> k{T(block.elastic.lambda), T(block.elastic.mu), T(1)};
          return run_block<kViscous>(c, block.begin, block.end, block.viscous,
                                     [&](const Mat3<T>&, std::size_t) { return k; });
        } else {
          return run_with_law<kViscous>(c, block, YoungStiffness<T, Law>(block, law));
        }
      },
      tissue.law);
}

template <class T>
class ElementOperator final : public ForceOperator {
 public:
  explicit ElementOperator(const Body& body) : body_(body) {
    for (const ElementRest& r : body.rest) rest_.push_back({T(r.volume), convert(r.s)});
    const bool raw = std::any_of(body.blocks.begin(), body.blocks.end(), [](const TissueBlock& b) {
      return b.tissue.measure == DeformationMeasure::regular_mean_ratio;
    });
    if (raw) build_metric();
  }

  void evaluate(std::span<const Vec3d> u, std::span<const Vec3d> v, std::span<Vec3d> elastic, std::span<Vec3d> viscous,
                ElementWatch& watch) const override {
    std::fill(elastic.begin(), elastic.end(), Vec3d{});
    std::fill(viscous.begin(), viscous.end(), Vec3d{});
    watch.reset(body_.blocks.size());
    BlockContext<T> c{body_.elements.data(), rest_.data(),   metric_.data(),        u.data(), v.data(),
                      elastic.data(),        viscous.data(), body_.mesh_tet.data(), &watch,   0.0};
    for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
      const TissueBlock& block = body_.blocks[b];
      c.list_above = watch.list_above.empty() ? std::numeric_limits<double>::infinity() : watch.list_above[b];
      const T r = block.tissue.viscosity > 0.0 ? run_tissue<true>(c, block) : run_tissue<false>(c, block);
      watch.stiffening[b] = static_cast<double>(r);
    }
  }

 private:
  static std::array<Vec3<T>, 3> convert(const std::array<Vec3d, 3>& s) {
    std::array<Vec3<T>, 3> out;
    for (std::size_t a = 0; a < 3; ++a) out[a] = {T(s[a].x), T(s[a].y), T(s[a].z)};
    return out;
  }

  void build_metric() {
    for (std::size_t e = 0; e < body_.elements.size(); ++e) {
      const EdgeMetric<double> g = edge_metric(body_, e);
      metric_.push_back({T(g.xx), T(g.yy), T(g.zz), T(g.xy), T(g.yz), T(g.zx)});
    }
  }

  const Body& body_;
  std::vector<KernelRest<T>> rest_;
  std::vector<EdgeMetric<T>> metric_;
};

}  // namespace

std::unique_ptr<ForceOperator> make_element_operator(const Body& body, Precision precision) {
  if (precision == Precision::double_precision) return std::make_unique<ElementOperator<double>>(body);
  return std::make_unique<ElementOperator<float>>(body);
}

void apply_linear(const Body& body, std::span<const LameParameters> lame, std::span<const Vec3d> x,
                  std::span<Vec3d> y) {
  std::fill(y.begin(), y.end(), Vec3d{});
  for (std::size_t b = 0; b < body.blocks.size(); ++b) {
    for (std::size_t e = body.blocks[b].begin; e < body.blocks[b].end; ++e) {
      const Sym3<double> stress = isotropic_stress(element_gradient(body, e, x), lame[b].lambda, lame[b].mu);
      scatter<double>(body.elements[e], {-body.rest[e].volume, body.rest[e].s}, stress, y.data());
    }
  }
}

}  // namespace glisson
