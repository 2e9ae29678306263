// tissue_rules.cpp — tissues in which tets lock, and laws that store no energy.
#include <algorithm>

#include "glisson/material/locking.h"
#include "scene/advice/rules.h"

namespace glisson::advice {
namespace {

/// Whether a tissue's forces are a secant law's, whose closed cycles give or take work of their own.
bool has_cycle_work(const Tissue& t) {
  return !t.hyperelastic && !t.has_constant_moduli() && t.law_form == LawForm::secant;
}

}  // namespace

Texts locking(const Tissue& t, const std::string& table) {
  const std::optional<double> nu = locking_ratio(t);
  if (!nu) return {};
  return {
      fill("ν = {} with volume_change = \"element\": tets that keep their own volumes are too stiff;\n"
           "{}.volume_change = \"average_nodal\" mends it",
           {digits(3, *nu), table})};
}

Texts cycle_work(std::span<const Variant> variants) {
  std::vector<std::string> names;
  const auto look = [&](const Tissue& tissue) {
    const std::string name = "\"" + tissue.name + "\"";
    if (has_cycle_work(tissue) && std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const Variant& v : variants) {
    look(v.tissue);
    for (const RegionSpec& region : v.regions) look(region.tissue);
  }
  if (names.empty()) return {};
  return {
      fill("The stiffness law of {} is in secant form, the paper's, and stores no energy: over a closed cycle of "
           "deformation it can give\n"
           "work that nothing paid, and a body that nothing damps may gain energy. law_form = \"energy\" gives the "
           "force of an energy\n"
           "(docs/laws.md). A run says where that happens.",
           {listed(names)})};
}

}  // namespace glisson::advice
