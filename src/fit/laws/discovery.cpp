#include "fit/laws/discovery.h"

#include <array>

#include "scene/parse/document.h"

namespace glisson::fit {
namespace {

constexpr double kBulk = 1000.0;              // κ/E: a homogeneous state cannot lock
constexpr double kLeast = 1e-5, kMost = 100;  // of a modulus, in E

/// A term of the invariants: its modulus, and the rate of an exponential.
struct Term {
  const char *name, *modulus, *rate;
  bool at_rest;  ///< it has a shear modulus at rest
};

constexpr std::array kTerms{
    Term{"I₁", "c10_Pa", nullptr, true},     Term{"I₂", "c01_Pa", nullptr, true},
    Term{"exp I₁", "a1_Pa", "b1", true},     Term{"exp I₂", "a2_Pa", "b2", true},
    Term{"I₁²", "c20_Pa", nullptr, false},   Term{"I₂²", "c02_Pa", nullptr, false},
    Term{"exp I₁²", "q1_Pa", "r1", false},   Term{"exp I₂²", "q2_Pa", "r2", false},
    Term{"I₁ I₂", "c11_Pa", nullptr, false}, Term{"I₁³", "c30_Pa", nullptr, false},
};

ParameterSpec free(const std::string& key, double low, double high, Scale scale) {
  ParameterSpec p;
  p.key = p.name = "tissue.hyperelastic." + key;
  p.low = low, p.high = high, p.scale = scale;
  return p;
}

LawSpec of_invariants(const std::vector<Term>& terms, double modulus) {
  LawSpec law;
  std::string keys;
  for (const Term& t : terms) {
    law.name += (law.name.empty() ? "" : " + ") + std::string(t.name);
    keys += std::string(", ") + t.modulus + " = " + scene::show(modulus);
    law.parameters.push_back(free(t.modulus, kLeast * modulus, kMost * modulus, Scale::logarithmic));
    if (t.rate) law.parameters.push_back(free(t.rate, 0.01, 500.0, Scale::logarithmic));
  }
  law.set.push_back({"tissue.hyperelastic",
                     "{ kind = \"invariants\"" + keys + ", bulk_modulus_Pa = " + scene::show(kBulk * modulus) + " }"});
  return law;
}

/// One exponent of either sign; of several terms they are kept apart, so that no two change places.
LawSpec of_stretches(int terms, double modulus) {
  using Ranges = std::array<std::array<double, 2>, 3>;
  static constexpr Ranges kOne{{{-60.0, 60.0}}}, kTwo{{{-60.0, -0.1}, {0.1, 60.0}}},
      kThree{{{-60.0, -8.0}, {0.1, 60.0}, {-8.0, -0.1}}};
  const Ranges& ranges = terms == 1 ? kOne : terms == 2 ? kTwo : kThree;
  LawSpec law;
  law.name = terms == 1 ? "λ^α" : std::to_string(terms) + " λ^α";
  std::string moduli, exponents;
  for (int k = 0; k < terms; ++k) {
    const auto [low, high] = ranges[static_cast<std::size_t>(k)];
    const double start = terms == 1 ? -10.0 : 0.5 * (low + high);  // α = 0 is no law
    const std::string at = "[" + std::to_string(k) + "]";
    moduli += (k ? ", " : "") + scene::show(modulus);
    exponents += (k ? ", " : "") + scene::show(start);
    law.parameters.push_back(free("mu_Pa" + at, kLeast * modulus, 10.0 * modulus, Scale::logarithmic));
    ParameterSpec alpha = free("alpha" + at, low, high, Scale::linear);
    alpha.start = start;
    law.parameters.push_back(std::move(alpha));
  }
  law.set.push_back({"tissue.hyperelastic", "{ kind = \"ogden\", mu_Pa = [" + moduli + "], alpha = [" + exponents +
                                                "], bulk_modulus_Pa = " + scene::show(kBulk * modulus) + " }"});
  return law;
}

/// Every subset of `size` terms from `first` on, after those that are taken.
void add_subsets(std::vector<Term>& taken, std::size_t first, int size, double modulus, std::vector<TermLaw>& laws) {
  if (static_cast<int>(taken.size()) == size) {
    bool at_rest = false;
    for (const Term& t : taken) at_rest = at_rest || t.at_rest;
    if (at_rest) laws.push_back({size, false, of_invariants(taken, modulus)});
    return;
  }
  for (std::size_t i = first; i < kTerms.size(); ++i) {
    taken.push_back(kTerms[i]);
    add_subsets(taken, i + 1, size, modulus, laws);
    taken.pop_back();
  }
}

}  // namespace

std::vector<TermLaw> term_laws(double modulus, int most_terms) {
  std::vector<TermLaw> laws;
  for (int size = 1; size <= most_terms; ++size) {
    std::vector<Term> taken;
    add_subsets(taken, 0, size, modulus, laws);
    if (size <= 3) laws.push_back({size, true, of_stretches(size, modulus)});
  }
  return laws;
}

}  // namespace glisson::fit
