// live_parameters.cpp — see live_parameters.h.
#include "view/engine/live_parameters.h"

#include <algorithm>
#include <cmath>

namespace glisson::view {
namespace {

constexpr double kFactor = 10.0;          // of a positive number, up and down
constexpr double kSpan = 5.0;             // of one that may have either sign
constexpr std::size_t kMostOfAList = 12;  // sliders
constexpr double kMostPoisson = 0.49, kMostShare = 0.95;

struct Range {
  double least = 0.0, most = 1.0;
  bool log = false;
};

/// About a value; @param scale  what is large where the value is 0
Range about(double value, double min, double max, double scale, bool keeps_sign) {
  if (value > 0.0 && (min >= 0.0 || keeps_sign))
    return {std::max(min, value / kFactor), std::min(max, value * kFactor), true};
  if (value < 0.0 && keeps_sign) return {std::max(min, value * kFactor), std::min(max, value / kFactor)};
  const double span = value != 0.0 ? kSpan * std::abs(value) : scale;
  return {std::max(min, -span), std::min(max, span)};
}

/// `above` → `Above`; letters that formulas have in Greek are so here.
std::string label_of(std::string_view name) {
  if (name == "mu") return "μ";
  if (name == "alpha") return "α";
  if (name == "moduli") return "Modulus M";
  if (name == "bulk_modulus") return "Bulk modulus κ";
  std::string label(name);
  std::replace(label.begin(), label.end(), '_', ' ');
  if (label.size() > 2) label.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(label.front())));
  return label;
}

std::string subscript(std::size_t number) {
  std::string digits;
  for (const char c : std::to_string(number)) digits += std::string("\xe2\x82") + static_cast<char>('\x80' + (c - '0'));
  return digits;
}

/// Gathers the parameters of one tissue.
class Collector {
 public:
  Collector(std::vector<TissueParameter>& out, const Tissue& tissue, std::size_t number, std::string name)
      : out_(out), tissue_(tissue), number_(number), name_(std::move(name)) {
    const LameParameters lame = tissue.lame();
    modulus_ = std::max(lame.mu, 1.0);
  }

  void all() {
    elasticity();
    if (!tissue_.hyperelastic) {
      stiffness_law("Law of E", tissue_.law, [](Tissue& t) { return &t.law; });
      if (tissue_.lambda_law) stiffness_law("Law of λ", *tissue_.lambda_law, [](Tissue& t) { return &*t.lambda_law; });
      if (tissue_.mu_law) stiffness_law("Law of μ", *tissue_.mu_law, [](Tissue& t) { return &*t.mu_law; });
    } else {
      hyperelastic();
    }
    begin("Fibres", "W = ½ c (a·E a)²");
    if (tissue_.fibres)
      add("Stiffness c", "along the fibres", "Pa", about(tissue_.fibres->stiffness, 0.0, kNoEnd, modulus_, true),
          [](Tissue& t) { return &t.fibres->stiffness; });
    begin("Viscosity", "");
    add("Viscosity η", "Kelvin–Voigt", "Pa·s", {0.0, std::max(100.0, kSpan * tissue_.viscosity)},
        [](Tissue& t) { return &t.viscosity; });
    maxwell();
  }

 private:
  static constexpr double kNoEnd = std::numeric_limits<double>::infinity();

  void begin(std::string group, std::string formula) {
    group_ = std::move(group);
    formula_ = std::move(formula);
  }

  void add(std::string label, std::string help, std::string unit, const Range& range,
           std::function<double*(Tissue&)> place) {
    Tissue tissue = tissue_;
    const double value = *place(tissue);
    out_.push_back({{.label = std::move(label),
                     .unit = std::move(unit),
                     .least = std::min(range.least, value),
                     .most = std::max(range.most, value),
                     .value = value,
                     .log = range.log,
                     .tissue = name_,
                     .group = group_,
                     .formula = formula_,
                     .help = std::move(help)},
                    number_,
                    std::move(place)});
  }

  void elasticity() {
    if (tissue_.hyperelastic) return;
    begin("Elasticity", "");
    add("Young's modulus E", "at rest", "Pa", about(tissue_.youngs_modulus, 0.0, kNoEnd, modulus_, true),
        [](Tissue& t) { return &t.youngs_modulus; });
    add("Poisson's ratio ν", "at rest", "–", {0.0, kMostPoisson}, [](Tissue& t) { return &t.poisson_ratio; });
  }

  void stiffness_law(const std::string& of, const StiffnessLaw& law, std::function<StiffnessLaw*(Tissue&)> place) {
    std::visit([&](const auto& x) { fields(of, x, [place](Tissue& t) { return place(t); }); }, law);
  }
  void hyperelastic() {
    const auto place = [](Tissue& t) { return &*t.hyperelastic; };
    std::visit([&](const auto& x) { fields("Hyperelastic law", x, place); }, *tissue_.hyperelastic);
  }

  /// A law's parameters, as it describes them. @param place  of the variant of laws that it stands in
  template <class Law, class Place>
  void fields(const std::string& of, const Law& law, Place place) {
    std::string name(Law::kName);
    std::replace(name.begin(), name.end(), '_', ' ');
    begin(of + ": " + name, std::string(Law::kHelp));
    each_field<Law>([&](const auto& x) {
      if (x.name != "arguments") parameter<Law>(x, law.*x.member, place);  // where a table's moduli stand is its shape
    });
  }
  template <class Law, class Place>
  void parameter(const FieldOf<Law, double>& x, double value, Place place) {
    add(label_of(x.name), std::string(x.help), unit_of(x), range_of(x, value),
        [place, member = x.member](Tissue& t) { return &(std::get<Law>(*place(t)).*member); });
  }
  template <class Law, class Place>
  void parameter(const FieldOf<Law, std::vector<double>>& x, const std::vector<double>& values, Place place) {
    for (std::size_t i = 0; i < std::min(values.size(), kMostOfAList); ++i) {
      add(label_of(x.name) + subscript(i + 1), std::string(x.help), unit_of(x), range_of(x, values[i]),
          [place, member = x.member, i](Tissue& t) { return &(std::get<Law>(*place(t)).*member)[i]; });
    }
  }
  static std::string unit_of(const FieldText& x) { return x.unit == "-" ? "–" : std::string(x.unit); }
  Range range_of(const FieldText& x, double value) const {
    const bool plain = x.unit == "-";
    return about(value, x.range.min, x.range.max, plain ? 1.0 : modulus_, plain);
  }

  void maxwell() {
    begin("Maxwell branches", "μ(t) = μ₀ (1 − Σ g (1 − exp(−t/τ)))");
    for (std::size_t i = 0; i < tissue_.maxwell.size(); ++i) {
      const std::string number = subscript(i + 1);
      add("Share g" + number, "of the modulus of an instant; all together below 1", "–", {0.001, kMostShare},
          [i](Tissue& t) { return &t.maxwell[i].share; });
      const double time = tissue_.maxwell[i].time;
      add("Time τ" + number, "over which it relaxes", "s", {time / (kFactor * kFactor), time * kFactor * kFactor, true},
          [i](Tissue& t) { return &t.maxwell[i].time; });
      if (!tissue_.maxwell[i].time_law) continue;
      const auto place = [i](Tissue& t) { return &*t.maxwell[i].time_law; };
      std::visit([&](const auto& law) { time_law(number, law, place); }, *tissue_.maxwell[i].time_law);
    }
  }

  template <class Law, class Place>
  void time_law(const std::string& number, const Law& law, Place place) {
    each_field<Law>([&](const auto& x) {
      add("τ" + number + " " + label_of(x.name), std::string(x.help), unit_of(x), range_of(x, law.*x.member),
          [place, member = x.member](Tissue& t) { return &(std::get<Law>(*place(t)).*member); });
    });
  }

  std::vector<TissueParameter>& out_;
  const Tissue& tissue_;
  std::size_t number_;
  std::string name_, group_, formula_;
  double modulus_ = 1.0;
};

}  // namespace

std::vector<TissueParameter> tissue_parameters(const Variant& variant) {
  std::vector<TissueParameter> all;
  Collector(all, variant.tissue, 0, variant.regions.empty() ? variant.tissue.name : "the body").all();
  for (std::size_t i = 0; i < variant.regions.size(); ++i)
    Collector(all, variant.regions[i].tissue, i + 1, variant.regions[i].name).all();
  return all;
}

double set_parameter(Variant& variant, const TissueParameter& parameter, double value) {
  const double kept = std::clamp(value, parameter.info.least, parameter.info.most);
  Tissue& tissue = parameter.tissue == 0 ? variant.tissue : variant.regions[parameter.tissue - 1].tissue;
  *parameter.place(tissue) = kept;
  return kept;
}

}  // namespace glisson::view
