// bind_tissues.cpp — tissues, their laws, and those that have a source.
//
// The classes of laws are made from the laws' own description of their parameters: a new law needs no line here.
#include <cctype>

#include "bind.h"
#include "glisson/material/tissue.h"
#include "glisson/scene/tissue_presets.h"

namespace glisson::python {
namespace {

/// "neo_hookean" → "NeoHookean": the struct's own name, but for a suffix.
std::string class_name(std::string_view kind) {
  std::string name;
  bool first = true;
  for (const char c : kind) {
    if (c != '_') name += first ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    first = c == '_';
  }
  return name;
}
template <class... Laws>
void bind_each(nb::module_& m, const char* suffix, std::type_identity<std::variant<Laws...>>) {
  ((Options<Laws>(m, (class_name(Laws::kName) + suffix).c_str()).attr("name") = std::string(Laws::kName)), ...);
}

/// A stiffness law at one value, or at all of an array, of the measure.
nb::object at_each(const nb::object& x, const std::function<double(double)>& f) {
  if (PyFloat_Check(x.ptr()) || PyLong_Check(x.ptr())) return nb::cast(f(nb::cast<double>(x)));
  const nb::object array = nb::module_::import_("numpy").attr("ascontiguousarray")(x, "float64");
  const auto numbers = nb::cast<nb::ndarray<const double, nb::c_contig, nb::device::cpu>>(array);
  std::vector<double> values(numbers.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = f(numbers.data()[i]);
  return scalars(std::move(values)).attr("reshape")(array.attr("shape"));
}

void bind_laws(nb::module_& m) {
  bind_each(m, "Law", std::type_identity<StiffnessLaw>());
  bind_each(m, "", std::type_identity<HyperelasticLaw>());
  m.def(
      "law_value",
      [](const StiffnessLaw& law, double base, const nb::object& x) {
        return at_each(x, [&](double at) { return law_value(law, base, at); });
      },
      "law"_a, "base"_a, "x"_a, doc("law_value"));
  m.def(
      "law_derivative",
      [](const StiffnessLaw& law, double base, const nb::object& x) {
        return at_each(x, [&](double at) { return law_derivative(law, base, at); });
      },
      "law"_a, "base"_a, "x"_a, doc("law_derivative"));
  m.def(
      "shear_modulus", [](const HyperelasticLaw& law) { return shear_modulus(law); }, "law"_a, doc("shear_modulus"));
  m.def(
      "bulk_modulus", [](const HyperelasticLaw& law) { return bulk_modulus(law); }, "law"_a, doc("bulk_modulus"));
}

std::pair<double, double> pair_of(const LameParameters& lame) { return {lame.lambda, lame.mu}; }

}  // namespace

void bind_tissues(nb::module_& m) {
  bind_laws(m);
  Options<Fibres>(m, "Fibres");
  bind_each(m, "Time", std::type_identity<TimeLaw>());
  m.def(
      "time_factor",
      [](const TimeLaw& law, const nb::object& x) {
        return at_each(x, [&](double at) { return time_factor(law, at); });
      },
      "law"_a, "x"_a, doc("time_factor"));
  Options<MaxwellBranch>(m, "MaxwellBranch");
  Options<Tissue> tissue(m, "Tissue");
  tissue.def(
      "lame", [](const Tissue& t) { return pair_of(t.lame()); }, doc("Tissue::lame"));
  tissue.def(
      "lame_at", [](const Tissue& t, double x) { return pair_of(lame_at(t, x)); }, "x"_a, doc("lame_at"));
  tissue.def("is_tensor_mass", &Tissue::is_tensor_mass, doc("Tissue::is_tensor_mass"));
  tissue.def(
      "check", [](const Tissue& t) { require_valid(t); }, doc("require_valid"));
  m.def(
      "lame_from_young", [](double e, double nu) { return pair_of(lame_from_young(e, nu)); }, "youngs_modulus"_a,
      "poisson_ratio"_a, doc("lame_from_young"));

  const auto of = [](const char* field) { return doc(std::string("TissuePreset::") + field); };
  nb::class_<TissuePreset>(m, "TissuePreset", doc("TissuePreset"))
      .def_ro("name", &TissuePreset::name, of("name"))
      .def_ro("what", &TissuePreset::what, of("what"))
      .def_ro("source", &TissuePreset::source, of("source"))
      .def_ro("fitted_to", &TissuePreset::fitted_to, of("fitted_to"))
      .def_ro("validity", &TissuePreset::validity, of("validity"))
      .def_ro("confirmed", &TissuePreset::confirmed, of("confirmed"))
      .def_prop_ro(
          "tissue", [](const TissuePreset& p) { return p.tissue; }, of("tissue"))
      .def_ro("toml", &TissuePreset::toml, of("toml"))
      .def("__repr__", [](const TissuePreset& p) { return "<TissuePreset " + p.name + ": " + p.what + ">"; });
  m.def("tissue_presets", &tissue_presets, doc("tissue_presets"));
  m.def(
      "tissue_preset", [](std::string_view name) { return tissue_preset(name); }, "name"_a, doc("tissue_preset"));
}

}  // namespace glisson::python
