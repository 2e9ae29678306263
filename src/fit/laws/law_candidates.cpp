#include "fit/laws/law_candidates.h"

#include <functional>
#include <stdexcept>

#include "base/nearest.h"
#include "scene/parse/document.h"

namespace glisson::fit {
namespace {

// κ/E of the hyperelastic candidates
constexpr double kBulkOfSpecimens = 1000.0;  // ν = 0.4998: a homogeneous state cannot lock
constexpr double kBulkOfBodies = 30.0;       // ν = 0.494: tets can

/// The tissue's size of moduli [Pa].
struct Stiffness {
  double modulus = 0.0, bulk = 0.0;
};

/// Collects what a candidate sets and frees; moduli in units of the tissue's.
class LawDraft {
 public:
  LawDraft(std::string name, Stiffness of) : modulus_(of.modulus), bulk_(of.bulk) { law_.name = std::move(name); }

  LawDraft& set(const std::string& key, const std::string& value) {
    law_.set.push_back({key, value});
    return *this;
  }
  /// A hyperelastic law; κ is held where it hardly acts.
  LawDraft& hyperelastic(const std::string& keys) {
    return set("tissue.hyperelastic", "{ " + keys + ", bulk_modulus_Pa = " + scene::show(bulk_) + " }");
  }
  LawDraft& modulus(const std::string& key, double least, double most) {
    return free(key, least * modulus_, most * modulus_, Scale::logarithmic);
  }
  /// A modulus of either sign.
  LawDraft& any_modulus(const std::string& key, double most) {
    return free(key, -most * modulus_, most * modulus_, Scale::linear, 0.0);
  }
  LawDraft& free(const std::string& key, double low, double high, Scale scale, std::optional<double> start = {}) {
    ParameterSpec p;
    p.key = p.name = key;
    p.low = low;
    p.high = high;
    p.scale = scale;
    p.start = start;
    law_.parameters.push_back(std::move(p));
    return *this;
  }
  operator LawSpec() const { return law_; }

 private:
  double modulus_, bulk_;
  LawSpec law_;
};

struct Known {
  LawName name;
  std::function<LawSpec(const std::string&, Stiffness)> make;
};

/// A law of stiffness on top of E.
LawDraft of_stiffness(const std::string& name, Stiffness m) {
  return LawDraft(name, m).modulus("tissue.youngs_modulus_Pa", 0.01, 30.0);
}

/// Laws of stiffness, on top of E.
std::vector<Known> stiffness_laws() {
  return {
      {{"constant", "linear elasticity, E alone"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return of_stiffness(n, m).set("tissue.law", "{ kind = \"constant\" }");
       }},
      {{"step", "E below a threshold of deformation, another modulus above (tissue 1 of the paper)"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return of_stiffness(n, m)
             .set("tissue.law", "{ kind = \"step\", threshold = 0.2, above_Pa = 1, width = 0.1 }")
             .free("tissue.law.threshold", 0.02, 1.0, Scale::linear)
             .modulus("tissue.law.above_Pa", 0.01, 1000.0);
       }},
      {{"linear", "E that grows in proportion to the deformation (tissue 2 of the paper)"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return of_stiffness(n, m)
             .set("tissue.law", "{ kind = \"linear\", slope_Pa = 0 }")
             .any_modulus("tissue.law.slope_Pa", 100.0);
       }},
      {{"polynomial", "E and two powers of the deformation"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return of_stiffness(n, m)
             .set("tissue.law", "{ kind = \"polynomial\", coefficients_Pa = [0, 0] }")
             .any_modulus("tissue.law.coefficients_Pa[0]", 100.0)
             .any_modulus("tissue.law.coefficients_Pa[1]", 500.0);
       }},
      {{"exponential", "E that grows exponentially with the deformation"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return of_stiffness(n, m)
             .set("tissue.law", "{ kind = \"exponential\", amplitude_Pa = 1, rate = 1 }")
             .modulus("tissue.law.amplitude_Pa", 1e-5, 100.0)
             .free("tissue.law.rate", 0.1, 50.0, Scale::logarithmic);
       }},
  };
}

std::vector<Known> hyperelastic_laws() {
  return {
      {{"neo_hookean", "neo-Hooke, μ alone"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return LawDraft(n, m)
             .hyperelastic("kind = \"neo_hookean\", mu_Pa = 1")
             .modulus("tissue.hyperelastic.mu_Pa", 0.003, 10.0);
       }},
      {{"mooney_rivlin", "Mooney and Rivlin, two moduli"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return LawDraft(n, m)
             .hyperelastic("kind = \"mooney_rivlin\", c10_Pa = 1, c01_Pa = 0")
             .modulus("tissue.hyperelastic.c10_Pa", 1e-4, 10.0)
             .any_modulus("tissue.hyperelastic.c01_Pa", 3.0);
       }},
      {{"yeoh", "Yeoh, three terms of I₁"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return LawDraft(n, m)
             .hyperelastic("kind = \"yeoh\", c1_Pa = 1, c2_Pa = 0, c3_Pa = 0")
             .modulus("tissue.hyperelastic.c1_Pa", 0.001, 10.0)
             .any_modulus("tissue.hyperelastic.c2_Pa", 3.0)
             .any_modulus("tissue.hyperelastic.c3_Pa", 3.0);
       }},
      {{"fung", "exponential of I₁"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return LawDraft(n, m)
             .hyperelastic("kind = \"fung\", mu_Pa = 1, b = 1")
             .modulus("tissue.hyperelastic.mu_Pa", 0.003, 10.0)
             .free("tissue.hyperelastic.b", 0.01, 30.0, Scale::logarithmic);
       }},
      {{"veronda_westmann", "exponential of I₁ with a term of I₂"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return LawDraft(n, m)
             .hyperelastic("kind = \"veronda_westmann\", c_Pa = 1, b = 1")
             .modulus("tissue.hyperelastic.c_Pa", 0.003, 30.0)
             .free("tissue.hyperelastic.b", 0.01, 30.0, Scale::logarithmic);
       }},
      {{"gent", "Gent, chains that are stretched out at a finite Ī₁"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return LawDraft(n, m)
             .hyperelastic("kind = \"gent\", mu_Pa = 1, limit = 10")
             .modulus("tissue.hyperelastic.mu_Pa", 0.003, 10.0)
             .free("tissue.hyperelastic.limit", 0.01, 1000.0, Scale::logarithmic);
       }},
      {{"fung_i2", "exponential of I₂"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return LawDraft(n, m)
             .hyperelastic("kind = \"invariants\", a2_Pa = 1, b2 = 1")
             .modulus("tissue.hyperelastic.a2_Pa", 0.003, 10.0)
             .free("tissue.hyperelastic.b2", 0.01, 30.0, Scale::logarithmic);
       }},
      {{"square_i2", "I₂ and its square"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return LawDraft(n, m)
             .hyperelastic("kind = \"invariants\", c01_Pa = 1")
             .modulus("tissue.hyperelastic.c01_Pa", 0.001, 10.0)
             .any_modulus("tissue.hyperelastic.c02_Pa", 3.0);
       }},
      {{"rivlin", "Rivlin's polynomial of second order, five moduli"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return LawDraft(n, m)
             .hyperelastic("kind = \"invariants\", c10_Pa = 1")
             .modulus("tissue.hyperelastic.c10_Pa", 1e-4, 10.0)
             .any_modulus("tissue.hyperelastic.c01_Pa", 3.0)
             .any_modulus("tissue.hyperelastic.c20_Pa", 3.0)
             .any_modulus("tissue.hyperelastic.c11_Pa", 3.0)
             .any_modulus("tissue.hyperelastic.c02_Pa", 3.0);
       }},
  };
}

std::vector<Known> ogden_laws() {
  return {
      {{"ogden", "Ogden, one term"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return LawDraft(n, m)
             .hyperelastic("kind = \"ogden\", mu_Pa = [1], alpha = [1]")
             .modulus("tissue.hyperelastic.mu_Pa[0]", 0.003, 10.0)
             .free("tissue.hyperelastic.alpha[0]", -25.0, 25.0, Scale::linear, 2.0);
       }},
      {{"ogden2", "Ogden, two terms, one that stiffens in compression and one in tension"},
       [](const auto& n, Stiffness m) -> LawSpec {
         return LawDraft(n, m)
             .hyperelastic("kind = \"ogden\", mu_Pa = [1, 1], alpha = [-2, 2]")
             .modulus("tissue.hyperelastic.mu_Pa[0]", 1e-5, 10.0)
             .free("tissue.hyperelastic.alpha[0]", -60.0, -0.1, Scale::linear)
             .modulus("tissue.hyperelastic.mu_Pa[1]", 1e-5, 10.0)
             .free("tissue.hyperelastic.alpha[1]", 0.1, 60.0, Scale::linear);
       }},
  };
}

const std::vector<Known>& all() {
  static const std::vector<Known> list = [] {
    std::vector<Known> both = stiffness_laws();
    for (Known& law : hyperelastic_laws()) both.push_back(std::move(law));
    for (Known& law : ogden_laws()) both.push_back(std::move(law));
    return both;
  }();
  return list;
}

}  // namespace

const std::vector<LawName>& known_laws() {
  static const std::vector<LawName> names = [] {
    std::vector<LawName> list;
    for (const Known& k : all()) list.push_back(k.name);
    return list;
  }();
  return names;
}

LawSpec law_candidate(const std::string& name, double modulus, bool specimen) {
  const Stiffness stiffness{modulus, (specimen ? kBulkOfSpecimens : kBulkOfBodies) * modulus};
  std::vector<std::string> names;
  for (const Known& k : all()) {
    if (k.name.name == name) return k.make(name, stiffness);
    names.push_back(k.name.name);
  }
  const std::string meant = scene::nearest(name, names);
  throw std::invalid_argument("there is no law \"" + name + "\" to fit; " +
                              (meant.empty() ? "known: " + scene::listed(names) : "did you mean \"" + meant + "\"?"));
}

}  // namespace glisson::fit
