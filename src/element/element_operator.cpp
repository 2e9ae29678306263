// element_operator.cpp — the element loop in double, what the scene option runs and the engine is compared with.
//
// Only differences of displacements enter the element. Per tissue block the law, the measure and the presence of
// viscosity are compile-time constants of the loop.
#include <algorithm>

#include "element/element_shape.h"
#include "element/force_operator.h"
#include "element/local_stiffness.h"

namespace glisson {
namespace {

/// Everything the loop over one block reads and writes.
struct BlockContext {
  const Body& body;
  const EdgeMetric<double>* metric;  ///< only for the raw mean ratio
  const Vec3d* u;
  const Vec3d* v;
  Vec3d* elastic;
  Vec3d* viscous;
  ElementWatch& watch;
  double list_above;  ///< stiffening
};

std::array<Vec3d, 3> differences(const Tet& t, const Vec3d* value) {
  const Vec3d& origin = value[t[0]];
  return {value[t[1]] - origin, value[t[2]] - origin, value[t[3]] - origin};
}

/// Adds f_a = −V σ s_a to the four vertices.
void scatter(const Tet& t, const ElementRest& rest, const Sym3<double>& stress, Vec3d* force) {
  Vec3d sum;
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3d f = (stress * rest.s[a]) * -rest.volume;
    force[t[a + 1]] += f;
    sum += f;
  }
  force[t[0]] -= sum;
}

/// The loop. `stiffness(H, e)` gives λ, μ and the tangent bound of element e.
template <bool kViscous, class Stiffness>
double run_block(const BlockContext& c, const TissueBlock& block, const Stiffness& stiffness) {
  const LameParameters viscosity = block.viscous;
  double stiffening = 0.0;
  for (std::size_t e = block.begin; e < block.end; ++e) {
    const Tet& t = c.body.elements[e];
    const ElementRest& rest = c.body.rest[e];
    const Mat3d H = displacement_gradient(rest.s, differences(t, c.u));
    if (!(jacobian(H) > 0.0)) c.watch.inverted.push_back(c.body.mesh_tet[e]);
    const LocalStiffness k = stiffness(H, e);
    stiffening = std::max(stiffening, k.stiffening);
    if (k.stiffening > c.list_above) {
      c.watch.stiff.push_back({static_cast<std::uint32_t>(e), k.stiffening, k.stiffening});
    }
    scatter(t, rest, isotropic_stress(H, k.lambda, k.mu), c.elastic);  // [Schwartz2002, eq. 6]
    if constexpr (kViscous) {
      const Mat3d rate = displacement_gradient(rest.s, differences(t, c.v));
      scatter(t, rest, isotropic_stress(rate, viscosity.lambda, viscosity.mu), c.viscous);  // [Schwartz2002, eq. 7]
    }
  }
  return stiffening;
}

/// Chooses the loop for a law with a measure known at compile time.
template <DeformationMeasure M, bool kViscous, class Laws>
double run_with_measure(const BlockContext& c, const TissueBlock& block, const Laws& laws) {
  return run_block<kViscous>(c, block, [&](const Mat3d& H, std::size_t e) {
    constexpr bool kRaw = M == DeformationMeasure::regular_mean_ratio;
    return laws(H, measure_value<M>(H, c.body.rest[e].volume, kRaw ? c.metric[e] : EdgeMetric<double>{}));
  });
}

template <bool kViscous, class Laws>
double run_with_laws(const BlockContext& c, const TissueBlock& block, const Laws& laws) {
  switch (block.tissue.measure) {
    case DeformationMeasure::equivalent_shear_strain:
      return run_with_measure<DeformationMeasure::equivalent_shear_strain, kViscous>(c, block, laws);
    case DeformationMeasure::one_minus_q:
      return run_with_measure<DeformationMeasure::one_minus_q, kViscous>(c, block, laws);
    case DeformationMeasure::regular_mean_ratio:
    case DeformationMeasure::radius_ratio:  // never a tensor mass
    case DeformationMeasure::solid_angle:
      break;
  }
  return run_with_measure<DeformationMeasure::regular_mean_ratio, kViscous>(c, block, laws);
}

template <bool kViscous>
double run_tissue(const BlockContext& c, const TissueBlock& block) {
  const Tissue& tissue = block.tissue;
  if (tissue.lambda_law || tissue.mu_law) return run_with_laws<kViscous>(c, block, LameStiffness(block));
  return std::visit(
      [&]<class Law>(const Law& law) {
        if constexpr (std::is_same_v<Law, ConstantLaw>) {
          const LocalStiffness k{block.elastic.lambda, block.elastic.mu, 1.0};
          return run_block<kViscous>(c, block, [&](const Mat3d&, std::size_t) { return k; });
        } else {
          return run_with_laws<kViscous>(c, block, YoungStiffness<Law>(block, law));
        }
      },
      tissue.law);
}

class ElementOperator final : public ForceOperator {
 public:
  explicit ElementOperator(const Body& body) : body_(body) {
    const bool raw = std::any_of(body.blocks.begin(), body.blocks.end(), [](const TissueBlock& b) {
      return b.tissue.measure == DeformationMeasure::regular_mean_ratio;
    });
    for (std::size_t e = 0; raw && e < body.elements.size(); ++e) metric_.push_back(edge_metric(body, e));
  }

  void evaluate(std::span<const Vec3d> u, std::span<const Vec3d> v, std::span<Vec3d> elastic, std::span<Vec3d> viscous,
                ElementWatch& watch) const override {
    std::fill(elastic.begin(), elastic.end(), Vec3d{});
    std::fill(viscous.begin(), viscous.end(), Vec3d{});
    watch.reset(body_.blocks.size());
    BlockContext c{body_, metric_.data(), u.data(), v.data(), elastic.data(), viscous.data(), watch, 0.0};
    for (std::size_t b = 0; b < body_.blocks.size(); ++b) {
      const TissueBlock& block = body_.blocks[b];
      c.list_above = watch.list_above.empty() ? std::numeric_limits<double>::infinity() : watch.list_above[b];
      watch.stiffening[b] = block.tissue.viscosity > 0.0 ? run_tissue<true>(c, block) : run_tissue<false>(c, block);
    }
  }

 private:
  const Body& body_;
  std::vector<EdgeMetric<double>> metric_;
};

}  // namespace

std::unique_ptr<ForceOperator> make_element_operator(const Body& body) {
  return std::make_unique<ElementOperator>(body);
}

void apply_linear(const Body& body, std::span<const LameParameters> lame, std::span<const Vec3d> x,
                  std::span<Vec3d> y) {
  std::fill(y.begin(), y.end(), Vec3d{});
  for (std::size_t b = 0; b < body.blocks.size(); ++b) {
    for (std::size_t e = body.blocks[b].begin; e < body.blocks[b].end; ++e) {
      const Sym3<double> stress = isotropic_stress(element_gradient(body, e, x), lame[b].lambda, lame[b].mu);
      scatter(body.elements[e], {-body.rest[e].volume, body.rest[e].s}, stress, y.data());
    }
  }
}

}  // namespace glisson
