// section_tissue.cpp — [tissue] with its laws, and [[region]].
#include <cmath>
#include <type_traits>

#include "glisson/scene/scene.h"
#include "scene/parse/presets.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

template <class Law, class Laws>
KindSpec law_kind() {
  return {described<Law>(std::string(Law::kName), std::string(Law::kHelp) + "."),
          [](void* law) -> void* { return &static_cast<Laws*>(law)->template emplace<Law>(); }};
}

template <class... Laws>
std::vector<KindSpec> law_kinds(std::type_identity<std::variant<Laws...>>) {
  return {law_kind<Laws, std::variant<Laws...>>()...};
}

/// E and ν from `lambda_Pa` and `mu_Pa`, where those are given.
void convert_lame(Tissue& tissue, const Node& table, const Place& place) {
  const Node* lambda = table.find("lambda_Pa");
  const Node* mu = table.find("mu_Pa");
  if (!lambda && !mu) return;
  if (!lambda || !mu) {
    place.complain(lambda ? *lambda : *mu, lambda ? "lambda_Pa" : "mu_Pa",
                   std::string("needs `") + (lambda ? "mu_Pa" : "lambda_Pa") + "` with it");
    return;
  }
  const double l = number_of(*lambda), m = number_of(*mu);
  if (!(3.0 * l + 2.0 * m > 0.0)) {
    place.complain(*lambda, "lambda_Pa",
                   show(l) + " Pa is out of range; allowed: > -2/3 mu_Pa = " + show(-2.0 * m / 3.0) +
                       " Pa, so that the body resists compression");
    return;
  }
  tissue.youngs_modulus = m * (3.0 * l + 2.0 * m) / (l + m);
  tissue.poisson_ratio = l / (2.0 * (l + m));
  const bool valid = std::isfinite(tissue.youngs_modulus) && tissue.poisson_ratio > -1.0 && tissue.poisson_ratio < 0.5;
  if (!valid) {
    place.complain(*lambda, "lambda_Pa",
                   show(l) + " Pa with mu_Pa = " + show(m) + " gives E = " + show(tissue.youngs_modulus) +
                       " Pa and ν = " + show(tissue.poisson_ratio) +
                       "; allowed: E finite, ν > -1 and < 0.5; bring the two closer together");
  }
}

/// A hyperelastic law has no measure; times of branches have.
void refuse_idle_measure(const Tissue& tissue, const Node& table, const Place& place) {
  const Node* measure = table.find("measure");
  if (!measure || !table.find("hyperelastic") || tissue.relaxation_follows()) return;
  place.complain(
      *measure, "measure",
      "and `hyperelastic` exclude each other, where no branch of `maxwell` has a `time_law`; remove `measure`");
}

}  // namespace

const SectionSpec& law_section() {
  static const SectionSpec section = [] {
    SectionSpec s;
    s.name = "tissue.law";
    s.help =
        "Modulus M as a function of the local deformation x, selected by `kind`. M₀ is the "
        "tissue's own, M at x = 0: the modulus at rest, but not with `regular_mean_ratio`, which is not 0 at rest.";
    s.kinds = law_kinds(std::type_identity<StiffnessLaw>{});
    return s;
  }();
  return section;
}

const SectionSpec& fibres_section() {
  static const SectionSpec section =
      described<Fibres>("tissue.fibres", "Fibres along one direction a: W = ½ c (a·E a)².");
  return section;
}

const SectionSpec& time_law_section() {
  static const SectionSpec section = [] {
    SectionSpec s;
    s.name = "tissue.maxwell.time_law";
    s.help =
        "Time of a branch as a function of the local deformation x, the tissue's `measure`, selected by `kind`: the "
        "branch "
        "relaxes by q′ = (S − q)/τ(x), and its relaxation is no longer linear.";
    s.kinds = law_kinds(std::type_identity<TimeLaw>{});
    return s;
  }();
  return section;
}

const SectionSpec& maxwell_section() {
  static const SectionSpec section = described<MaxwellBranch>(
      "tissue.maxwell", "A branch of a generalised Maxwell body: μ(t) = μ₀ (1 − Σ g (1 − exp(−t/τ))).");
  return section;
}

const SectionSpec& hyperelastic_section() {
  static const SectionSpec section = [] {
    SectionSpec s;
    s.name = "tissue.hyperelastic";
    s.help =
        "A large-deformation law, selected by `kind`: the stress is ∂W/∂F. λ̄ = J^(−⅓) λ are the isochoric principal "
        "stretches, Ī₁ and Ī₂ their invariants.";
    s.kinds = law_kinds(std::type_identity<HyperelasticLaw>{});
    return s;
  }();
  return section;
}

const SectionSpec& tissue_section() {
  static const SectionSpec section = [] {
    Section<Tissue> s("tissue",
                      "The body's material: isotropic elasticity whose moduli may follow the local deformation, and "
                      "Kelvin–Voigt viscosity.");
    s.bare({.name = "preset",
            .help = "a preset to start from (docs/tissues.md); other keys of the table override it",
            .type = ValueType::text,
            .words = preset_words(),
            .default_text = "none"});
    s.bare({.name = "file",
            .help = "a file with a `[tissue]` to start from, such as `glisson fit` writes, relative to the scene; "
                    "other keys of the table override it",
            .type = ValueType::text,
            .default_text = "none"});
    s.spec().starts = {"preset", "file"};
    s.fields();
    s.bare_after("poisson_ratio",
                 {{.name = "lambda_Pa",
                   .help = "Lamé's first parameter λ at rest, with `mu_Pa` in place of E and ν",
                   .unit = "Pa"},
                  {.name = "mu_Pa", .help = "shear modulus μ at rest", .unit = "Pa", .range = above(0)}});
    s.spec().exclusions = {{{{"preset"}, {"file"}}, false},
                           {{{"youngs_modulus_Pa", "poisson_ratio"}, {"lambda_Pa", "mu_Pa"}, {"hyperelastic"}}, false},
                           {{{"law"}, {"lambda_law", "mu_law"}, {"hyperelastic"}}, false},
                           {{{"kinematics", "law_form"}, {"hyperelastic"}}, false}};
    s.finish([](Tissue& tissue, const Node& table, const Place& place) {
      convert_lame(tissue, table, place);
      refuse_idle_measure(tissue, table, place);
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& stiffness_section() {
  static const SectionSpec section = described<StiffnessImage>(
      "Young's modulus of each tet from an image of elastography, on a grid of its own: the mean over the voxels in "
      "the tet. Tets of like "
      "modulus become a region, \"liver 5.012 kPa\", with all else of the tissue of their region; where the image has "
      "no value above 0 the tissue "
      "keeps its own (docs/image.md).");
  return section;
}

const SectionSpec& region_section() {
  static const SectionSpec section = [] {
    Section<RegionSpec> s("region",
                          "A part of the body with its own tissue: the tets whose centroid lies in a box or a ball, or "
                          "the mesh's region of that name or number. Later regions override earlier ones.");
    s.key("name", &RegionSpec::name,
          "name; without `box_m` and `sphere_m`, that of a region of the mesh, or its number")
        .must();
    s.table(
        "box_m", box_section(), [](RegionSpec& r) -> Selection::Box& { return r.where.emplace<Selection::Box>(); },
        "tets in a box");
    s.table(
        "sphere_m", sphere_section(),
        [](RegionSpec& r) -> Selection::Sphere& { return r.where.emplace<Selection::Sphere>(); }, "tets in a ball");
    s.table("tissue", tissue_section(), &RegionSpec::tissue,
            "keys as in `[tissue]`; missing keys are taken from the body's tissue, or from the region's `preset`; "
            "`name` is the region's");
    s.spec().exclusions = {{{{"box_m"}, {"sphere_m"}}, false}};
    s.finish([](RegionSpec& r, const Node& table, const Place& place) {
      r.origin = place.text();
      if (!table.find("tissue")->find("name")) r.tissue.name = r.name;
      if (r.name.empty()) place.complain(*table.find("name"), "name", "is empty");
    });
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
