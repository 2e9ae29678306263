// section_tissue.cpp — [tissue] with its laws, and [[region]].
#include <cmath>
#include <type_traits>

#include "glisson/scene/scene.h"
#include "scene/build/presets.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

/// The keys of a law, from the law's own description.
template <class Law, class Laws>
KindSpec law_kind() {
  Section<Law> s{std::string(Law::kName), std::string(Law::kHelp) + "."};
  for (const LawField<Law>& field : Law::kFields) {
    std::visit(
        [&](auto member) {
          KeySpec& key = s.key(std::string(field.key), member, std::string(field.help));
          key.in(std::string(field.unit)).within(between(field.min, field.max));
          if (field.required) key.must();
        },
        field.member);
  }
  s.finish([](Law& law, const Node&, const Place& place) {
    if (const std::string wrong = law.check(); !wrong.empty()) place.complain(wrong);
  });
  return {s.spec(), [](void* law) -> void* { return &static_cast<Laws*>(law)->template emplace<Law>(); }};
}

template <class... Laws>
std::vector<KindSpec> law_kinds(std::type_identity<std::variant<Laws...>>) {
  return {law_kind<Laws, std::variant<Laws...>>()...};
}

/// What require_valid would refuse, said at the key that is wrong.
void check_together(const Tissue& t, const Node& table, const Place& place) {
  double sum = 0.0;
  for (const MaxwellBranch& b : t.maxwell) sum += b.share;
  if (!(sum < 1.0)) {
    place.complain(
        *table.find("maxwell"), "maxwell",
        "the shares sum up to " + show(sum) + "; allowed: below 1, the rest is the modulus after long times");
  }
  if (t.hyperelastic || t.kinematics != Kinematics::small || t.viscous_tensor != ViscousTensor::pioletti) return;
  place.complain(*table.find("viscous_tensor"), "viscous_tensor",
                 "\"pioletti\" is a law of large strain; set `kinematics` to \"green\" or \"corotational\" or give a "
                 "`hyperelastic` law");
}

/// E and ν from `lambda_Pa` and `mu_Pa`, where those are given.
void convert_lame(Tissue& tissue, const Node& table, const Place& place) {
  const Node* lambda = table.find("lambda_Pa");
  const Node* mu = table.find("mu_Pa");
  if (!lambda && !mu) return;
  if (!lambda || !mu) {
    place.complain(lambda ? *lambda : *mu, lambda ? "lambda_Pa" : "mu_Pa",
                   std::string("needs `") + (lambda ? "mu_Pa" : "lambda_Pa") + "` beside it");
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

}  // namespace

const SectionSpec& law_section() {
  static const SectionSpec section = [] {
    SectionSpec s;
    s.name = "tissue.law";
    s.help = "Modulus M as a function of the local deformation x, selected by `kind`. M₀ is the modulus at rest.";
    s.kinds = law_kinds(std::type_identity<StiffnessLaw>{});
    return s;
  }();
  return section;
}

const SectionSpec& fibres_section() {
  static const SectionSpec section = [] {
    Section<Fibres> s("tissue.fibres", "Fibres along one direction a: W = ½ c (a·E a)².");
    s.key("direction", &Fibres::direction, "a at rest, any length; fibre directions in the mesh override it");
    s.key("stiffness_Pa", &Fibres::stiffness, "c = λ_L − λ_T + 2 (μ_L − μ_T), along L and across T the fibres")
        .in("Pa")
        .within(at_least(0))
        .must();
    s.finish([](Fibres& f, const Node& table, const Place& place) {
      if (!(norm(f.direction) > 0.0)) place.complain(*table.find("direction"), "direction", "has no length");
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& maxwell_section() {
  static const SectionSpec section = [] {
    Section<MaxwellBranch> s("tissue.maxwell",
                             "A branch of a generalised Maxwell body: μ(t) = μ₀ (1 − Σ g (1 − exp(−t/τ))).");
    s.key("share", &MaxwellBranch::share, "g, share of the instantaneous modulus that relaxes; sum below 1")
        .in("-")
        .within(strictly_between(0.0, 1.0))
        .must();
    s.key("time_s", &MaxwellBranch::time, "τ, time constant").in("s").within(above(0)).must();
    return s.spec();
  }();
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
    s.key("name", &Tissue::name, "name for the report; default for a preset: its name");
    s.key("youngs_modulus_Pa", &Tissue::youngs_modulus, "Young's modulus E at rest").in("Pa").within(above(0));
    s.key("poisson_ratio", &Tissue::poisson_ratio, "Poisson's ratio ν")
        .in("-")
        .within(strictly_between(-1.0, 0.5))
        .advise("0.45 to 0.49 is nearly incompressible");
    s.bare({.name = "lambda_Pa",
            .help = "Lamé's first parameter λ at rest, with `mu_Pa` in place of E and ν",
            .unit = "Pa"});
    s.bare({.name = "mu_Pa", .help = "shear modulus μ at rest", .unit = "Pa", .range = above(0)});
    s.key("density_kg_m3", &Tissue::density, "density ρ").in("kg/m³").within(above(0));
    s.key("viscosity_Pa_s", &Tissue::viscosity, "viscosity η").in("Pa·s").within(at_least(0));
    s.key("viscous_tensor", &Tissue::viscous_tensor, "tensor that carries η");
    s.key("measure", &Tissue::measure, "measure of deformation x of the laws");
    s.table("law", law_section(), &Tissue::law, "law of E, ν constant").otherwise("{ kind = \"constant\" }");
    s.table(
         "lambda_law", law_section(), [](Tissue& t) -> StiffnessLaw& { return t.lambda_law.emplace(); },
         "law of λ, in place of a law of E")
        .otherwise("λ constant");
    s.table(
         "mu_law", law_section(), [](Tissue& t) -> StiffnessLaw& { return t.mu_law.emplace(); },
         "law of μ, in place of a law of E")
        .otherwise("μ constant");
    s.key("kinematics", &Tissue::kinematics, "strain that E and ν act on");
    s.key("law_form", &Tissue::law_form, "force of a stiffness law");
    s.table(
         "hyperelastic", hyperelastic_section(), [](Tissue& t) -> HyperelasticLaw& { return t.hyperelastic.emplace(); },
         "large-deformation law, in place of E, ν and their laws")
        .otherwise("none");
    s.table(
         "fibres", fibres_section(), [](Tissue& t) -> Fibres& { return t.fibres.emplace(); },
         "fibres that stiffen the tissue along one direction")
        .otherwise("none");
    s.tables("maxwell", maxwell_section(), &Tissue::maxwell,
             "branches that relax, each with its time constant; the given moduli are then the instantaneous ones");
    s.key("maxwell_part", &Tissue::maxwell_part, "stress that the branches relax");
    s.key("volume_change", &Tissue::volume_change, "volume change that the bulk resists");
    s.spec().exclusions = {{{{"preset"}, {"file"}}, false},
                           {{{"youngs_modulus_Pa", "poisson_ratio"}, {"lambda_Pa", "mu_Pa"}, {"hyperelastic"}}, false},
                           {{{"law"}, {"lambda_law", "mu_law"}, {"hyperelastic"}}, false},
                           {{{"kinematics", "law_form", "measure"}, {"hyperelastic"}}, false}};
    s.finish([](Tissue& tissue, const Node& table, const Place& place) {
      convert_lame(tissue, table, place);
      check_together(tissue, table, place);
    });
    return s.spec();
  }();
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
