// bind_material_point.cpp — a tissue without a body: prescribed stretch and stress, oscillation, torsion.
#include "glisson/material_point.h"

#include "bind.h"
#include "glisson/oscillation.h"
#include "glisson/torsion.h"
#include "rooms.h"

namespace glisson::python {
namespace {

using Components = std::map<std::string, double>;

std::size_t axis(char name) { return std::string_view("xyz").find(name); }

/// Sets the components by name: {"zz": 1.2}. @throws nb::value_error for a name that is none
void set_components(MaterialTargets& targets, MaterialControl control, const Components& values) {
  for (const auto& [name, value] : values) {
    if (name.size() != 2 || axis(name[0]) > 2 || axis(name[1]) > 2) {
      throw nb::value_error(
          ("\"" + name + "\" is no component; allowed: two of x, y, z, such as \"zz\" or \"xz\"").c_str());
    }
    targets(axis(name[0]), axis(name[1])) = {control, value};
  }
}

MaterialState advance(MaterialPoint& point, double h, const Components& deformation, const Components& stress) {
  MaterialTargets targets;
  set_components(targets, MaterialControl::deformation, deformation);
  set_components(targets, MaterialControl::nominal_stress, stress);
  return point.advance(h, targets);
}

std::vector<MaterialState> test(const Tissue& tissue, MaterialTest kind, const std::vector<double>& times,
                                const std::optional<std::vector<double>>& stretch,
                                const std::optional<std::vector<double>>& stress, std::size_t between) {
  if (stretch.has_value() == stress.has_value()) {
    throw nb::value_error("a test is driven by stretch or by stress; give one of the two");
  }
  return material_test(tissue, kind, stretch ? MaterialControl::deformation : MaterialControl::nominal_stress, times,
                       stretch ? *stretch : *stress, between);
}

/// G′ and G″ of each frequency [Pa].
std::vector<std::array<double, 2>> complex_moduli(const Tissue& tissue, const std::vector<double>& frequencies,
                                                  double stretch, OscillationMode mode) {
  std::vector<std::array<double, 2>> rows;
  for (const ComplexModulus& m : oscillation(tissue, frequencies, stretch, mode)) rows.push_back({m.storage, m.loss});
  return rows;
}

/// Torque [N m] and axial force [N] at each time.
std::vector<std::array<double, 2>> twisted(const Tissue& tissue, double radius, const std::vector<double>& times,
                                           const std::vector<double>& twists, const TorsionOptions& options) {
  std::vector<std::array<double, 2>> rows;
  for (const TorsionState& s : torsion(tissue, radius, times, twists, options)) {
    rows.push_back({s.torque, s.axial_force});
  }
  return rows;
}

}  // namespace

void bind_material_point(nb::module_& m) {
  Results<MaterialState>(m, "MaterialState")
      .read("time", &MaterialState::time)
      .read("deformation", &MaterialState::deformation)
      .read("nominal", &MaterialState::nominal)
      .read("cauchy", &MaterialState::cauchy)
      .read("converged", &MaterialState::converged)
      .read("message", &MaterialState::message);
  nb::class_<MaterialPoint>(m, "MaterialPoint", doc("MaterialPoint"))
      .def(nb::init<const Tissue&>(), "tissue"_a)
      .def_prop_ro(
          "state", [](const MaterialPoint& p) { return p.state(); }, doc("MaterialPoint::state"))
      .def("advance", &advance, "h"_a, "deformation"_a = Components(), "stress"_a = Components(),
           "Goes on by h [s], > 0. Components by name: `deformation` F [-], `stress` nominal stress P [Pa]; on the way "
           "there they "
           "change linearly with time. Those that are not named are held as at rest.\n\n"
           ":raises ValueError: naming the component, its value and the allowed range\n\n"
           ">>> point = MaterialPoint(Tissue())\n"
           ">>> round(float(point.advance(1.0, {\"zz\": 1.1}, stress={\"xx\": 0, \"yy\": 0}).nominal[2, 2]))\n360");
  m.def("run_material_test", &test, "tissue"_a, "test"_a, "times"_a, "stretch"_a = nb::none(), "stress"_a = nb::none(),
        "between"_a = 1, doc("material_test"));
  m.def("run_oscillation", &complex_moduli, "tissue"_a, "frequencies"_a, "stretch"_a, "mode"_a, doc("oscillation"));
  Options<TorsionOptions>(m, "TorsionOptions");
  m.def("run_torsion", &twisted, "tissue"_a, "radius"_a, "times"_a, "twists"_a, "options"_a, doc("torsion"));
}

}  // namespace glisson::python
